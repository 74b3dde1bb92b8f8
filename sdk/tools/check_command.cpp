#include "sdk/tools/check_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/output_file.h"
#include "sdk/check/run_check.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/interrupt.h"

namespace karst::tools {
namespace {

using check::Level;
using check::Test;
using check::TestResult;
using check::Verdict;
using nlohmann::ordered_json;

constexpr int kFailed = 2;  // exit code when a test failed

struct CheckArguments {
  check::CheckOptions options;
  std::string work, out;
  bool json = false, list = false;
};

CLI::Validator level_by_name() {
  return {[](std::string& text) {
            const auto level = core::parse<Level>(text);
            if (!level) return "expected basic, strict or pedantic, got \"" + text + "\"";
            text = std::to_string(static_cast<int>(*level));
            return std::string();
          },
          ""};
}

int list_tests(bool json) {
  ordered_json out = ordered_json::array();
  for (const Test& t : check::all_tests()) {
    if (json)
      out.push_back({{"name", t.name}, {"level", core::name_of(t.level)}, {"description", t.description}});
    else
      print_out("%-30s %-9s %s\n", t.name, core::name_of(t.level), t.description);
  }
  if (json) print_json(out);
  return 0;
}

std::string figures_text(const ordered_json& figures) {
  std::string out;
  for (const auto& [key, value] : figures.items())
    out += (out.empty() ? "" : ", ") + key + " " + core::json_text(value);
  return out;
}

void print(const TestResult& r) {
  const bool failed = r.verdict == Verdict::failed;
  const char* mark = failed                                 ? "FAILED"
                     : r.verdict == Verdict::not_applicable ? "n/a"
                                                            : core::name_of(r.verdict);
  const std::string say = r.verdict == Verdict::passed ? figures_text(r.figures) : r.reason;
  print_out("  %-8s %-30s %s\n", mark, r.test->name, say.c_str());
  if (failed) print_out("           %s\n           repeat: %s\n", r.test->description, r.repeat.c_str());
  std::fflush(stdout);
}

ordered_json to_json(const TestResult& r) {
  ordered_json j{
      {"name", r.test->name}, {"level", core::name_of(r.test->level)}, {"description", r.test->description}};
  if (!r.policy.empty()) j["policy"] = r.policy;
  j["outcome"] = core::name_of(r.verdict);
  if (!r.reason.empty()) j["reason"] = r.reason;
  if (!r.figures.empty()) j["figures"] = r.figures;
  if (r.verdict == Verdict::failed) j["repeat"] = r.repeat;
  j["wall_s"] = r.wall_s;
  return j;
}

int check_file(CheckArguments& args) {
  if (args.list) return list_tests(args.json);
  if (args.options.file.empty())
    throw core::InputError("karst policy check", "",
                           "needs a FILE, or --list; see karst policy check --help");
  args.options.karst = std::filesystem::read_symlink("/proc/self/exe");
  const std::atomic<bool>& interrupted = watch_for_interrupt();
  args.options.stop = &interrupted;
  std::string policy;
  if (!args.json)
    print_out("%s, level %s, seed %llu\n", args.options.file.c_str(), core::name_of(args.options.level),
              static_cast<unsigned long long>(args.options.seed));
  const std::vector<TestResult> results = check::run_check(args.options, [&](const TestResult& r) {
    if (args.json) return;
    if (r.policy != policy) print_out("%s\n", (policy = r.policy).c_str());
    print(r);
  });
  if (interrupted) {
    print_error("karst: stopped after %zu tests\n", results.size());
    return kInterrupted;
  }
  std::map<Verdict, int> count;
  ordered_json tests = ordered_json::array();
  for (const TestResult& r : results) {
    ++count[r.verdict];
    tests.push_back(to_json(r));
  }
  const bool passed = count[Verdict::failed] == 0;
  const auto notes = static_cast<std::size_t>(count[Verdict::noted]);
  if (args.json)
    print_json(ordered_json{{"schema", 1},
                            {"file", args.options.file},
                            {"level", core::name_of(args.options.level)},
                            {"seed", args.options.seed},
                            {"passed", passed},
                            {"tests", tests}});
  else
    print_out("%d passed, %d failed, %d not applicable, %d not run%s\n", count[Verdict::passed],
              count[Verdict::failed], count[Verdict::not_applicable], count[Verdict::not_run],
              count[Verdict::noted] > 0 ? (", " + core::counted(notes, "note")).c_str() : "");
  return passed ? 0 : kFailed;
}

check::Context context_of(const CheckArguments& args, check::Progress& progress) {
  check::Context c;
  c.file = args.options.file;
  c.karst = std::filesystem::read_symlink("/proc/self/exe").string();
  c.id = args.options.policy;
  c.seed = args.options.seed;
  c.level = args.options.level;
  c.progress = &progress;
  return c;
}

void run_one(const CheckArguments& args) {
  const Test* test = args.options.tests.size() == 1 ? check::find_test(args.options.tests[0]) : nullptr;
  if (test == nullptr) throw core::InputError("karst policy check-one", "", "runs one test, by its name");
  check::Progress progress(std::filesystem::path(args.work) / "progress");
  check::Context context = context_of(args, progress);
  run_test(context, *test, args.work);
}

void write_answers(const CheckArguments& args) {
  check::Progress progress(args.out + ".progress");
  std::filesystem::remove(args.out + ".progress");
  check::Context context = context_of(args, progress);
  check::choose_policy(context);
  std::string answers;
  try {
    answers = check::answers_to_compare(context);
  } catch (const check::Failed& f) {
    throw core::InputError(args.options.file, "", f.reason);
  }
  std::ofstream out = core::open_output(args.out);
  out << answers;
  if (!out.flush()) throw core::InputError(args.out, "", "cannot be written");
}

void add_common(CLI::App& app, CheckArguments& args) {
  app.add_option("file", args.options.file, "policy plugin (.so) or file of Python (.py)")->type_name(kFile)->check(not_empty());
  app.add_option("--policy", args.options.policy, "only this policy of the file")->check(not_empty());
  app.add_option("--seed", args.options.seed, "seed of caves, flights and damage; default 1")
      ->type_name("UINT")
      ->check(whole_64_bits());
  app.add_option("--level", args.options.level, "basic, strict (default) or pedantic")
      ->transform(level_by_name())
      ->type_name("LEVEL");
  app.add_option("--test", args.options.tests,
                 "only this test, or this group of tests; may be given several times")
      ->allow_extra_args(false)
      ->check(not_empty());
}

}  // namespace

void add_check_command(CLI::App& policy) {
  auto args = std::make_shared<CheckArguments>();
  CLI::App* check_app = policy.add_subcommand(
      "check",
      "Test a policy plugin from outside, each test in a process of its own\n\n"
      "  karst policy check build/lib/karst/policies/mine.so\n"
      "  karst policy check mine.so --level pedantic --seed 7 --json\n"
      "  karst policy check mine.so --test goals --test determinism.repeat\n\n"
      "Levels: basic is what a flight needs, strict what a policy given to others should hold, pedantic adds "
      "tidiness.\nExit code: 0 all passed, 2 a test failed, 1 not checked: a wrong argument, or no such "
      "file.");
  add_common(*check_app, *args);
  check_app
      ->add_option("--hang-limit", args->options.hang_limit_s, "a call that takes longer hangs; default 10 s")
      ->type_name("SECONDS")
      ->check(number_in(0.1, 600.0));
  check_app->add_flag("--json", args->json, "write JSON");
  check_app->add_flag("--list", args->list, "list the tests and end");
  check_app->callback([args] {
    if (const int code = check_file(*args); code != 0) throw CLI::RuntimeError(code);
  });

  // The command of `check`'s child processes; the empty group hides it from --help.
  CLI::App* one = policy.add_subcommand("check-one", "Run one test of karst policy check")->group("");
  add_common(*one, *args);
  one->add_option("--work", args->work, "folder for the result")->required();
  one->callback([args] { run_one(*args); });
  CLI::App* answers =
      policy.add_subcommand("check-answers", "Write a policy's answers into a file")->group("");
  add_common(*answers, *args);
  answers->add_option("--out", args->out, "file")->required();
  answers->callback([args] { write_answers(*args); });
}

}  // namespace karst::tools
