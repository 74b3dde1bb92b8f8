#include "sdk/check/run_check.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_file.h"
#include "core_stack/common/options.h"
#include "core_stack/common/shell_word.h"
#include "core_stack/common/temporary_folder.h"
#include "sdk/host/isolation/process.h"
#include "sdk/host/plugin/probe.h"

namespace karst::check {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr double kTestLimit_s = 600;  // for a whole test, on a busy machine

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

bool of_file(const Test& t) { return t.of == Test::Of::file || t.of == Test::Of::file_gate; }
bool is_gate(const Test& t) { return t.of == Test::Of::file_gate || t.of == Test::Of::policy_gate; }

std::string repeat_command(const CheckOptions& o, const std::string& policy, const Test& test) {
  return "karst policy check " + core::shell_word(o.file) + (policy.empty() ? "" : " --policy " + policy) +
         " --seed " + std::to_string(o.seed) + " --level " + core::name_of(o.level) + " --test " + test.name;
}

bool stopped(const CheckOptions& o) { return o.stop != nullptr && *o.stop; }

/// Waits for the child. Returns "", or why it was terminated.
std::string wait_for(pid_t child, const Progress& progress, const CheckOptions& o, host::ProcessEnd& end) {
  const auto begin = Clock::now();
  std::uint64_t count = progress.count();
  auto changed = begin;
  while (!host::has_ended(child, end)) {
    if (progress.count() != count) {
      count = progress.count();
      changed = Clock::now();
    }
    const bool inside = count % 2 == 1;
    const bool hangs = inside && seconds_since(changed) > o.hang_limit_s;
    if (stopped(o)) {
      host::end_process(child);
      return "it was stopped";
    }
    if (hangs || seconds_since(begin) > kTestLimit_s) {
      host::end_process(child);
      char limit[32];
      std::snprintf(limit, sizeof limit, "%g s", o.hang_limit_s);
      return hangs ? progress.what() + " did not return within " + limit
                   : "the test took more than ten minutes";
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(inside ? 2 : 1));
  }
  return "";
}

TestResult run_in_child(const CheckOptions& o, const std::string& policy, const Test& test) {
  const core::TemporaryFolder work("check");
  const fs::path& folder = work.path();
  const Progress progress(folder / "progress");
  TestResult r{
      &test, policy, Verdict::passed, "", ordered_json::object(), 0, repeat_command(o, policy, test)};
  std::vector<std::string> argv = {o.karst.string(), "policy",
                                   "check-one",      fs::absolute(o.file).string(),
                                   "--test",         test.name,
                                   "--seed",         std::to_string(o.seed),
                                   "--level",        core::name_of(o.level),
                                   "--work",         folder.string()};
  if (!policy.empty()) argv.insert(argv.end(), {"--policy", policy});
  const auto begin = Clock::now();
  host::ProcessEnd end;
  const std::string ended = wait_for(host::start_process(argv, folder / "output"), progress, o, end);
  r.wall_s = seconds_since(begin);
  // The plugin under test may have written it.
  const auto said = core::json_of_file<ordered_json>((folder / "result.json").string());
  const auto text = [&](const char* key) {
    return said.contains(key) && said[key].is_string() ? said[key].get<std::string>() : std::string();
  };
  if (ended.empty() && end.signal == 0 && end.exit_code == 0 && said.is_object()) {
    r.reason = text("reason");
    if (said.contains("figures") && said["figures"].is_object()) r.figures = said["figures"];
    r.verdict = core::parse<Verdict>(text("outcome")).value_or(Verdict::failed);
    // Asked for by its name, it counts.
    if (r.verdict == Verdict::failed && test.level > o.level && o.tests.empty()) r.verdict = Verdict::noted;
    return r;
  }
  r.verdict = Verdict::failed;
  const bool inside = progress.count() % 2 == 1;
  const std::string where = inside ? " in " + progress.what() : " outside of any call";
  r.reason = !ended.empty() ? ended
             : end.signal
                 ? host::describe(end) + where
                 : "it ended the process" + where + " (exit code " + std::to_string(end.exit_code) + ")";
  return r;
}

bool wanted(const CheckOptions& o, const Test& t) {
  if (o.tests.empty()) return t.level <= o.level || t.noted_below;
  const std::string name = t.name;
  return std::any_of(o.tests.begin(), o.tests.end(), [&](const std::string& asked) {
    return name == asked || name.starts_with(asked + ".");
  });
}

void check_names(const CheckOptions& o) {
  std::vector<std::string> names;
  for (const Test& t : all_tests()) {
    const std::string name = t.name;
    names.push_back(name);
    names.push_back(name.substr(0, name.find('.')));
  }
  for (const std::string& asked : o.tests) {
    if (std::find(names.begin(), names.end(), asked) != names.end()) continue;
    const std::string near = core::nearest_name(asked, names);
    throw InputError("--test", asked,
                     "there is no such test" + (near.empty() ? "" : "; did you mean " + near + "?"));
  }
}

/// Ids of the policies to be tested. If the file is broken, the tests of the file report the error, if they
/// are selected.
std::vector<std::string> policies_of(const CheckOptions& o) {
  std::vector<std::string> ids;
  std::string broken;
  for (const host::PolicyListing& p : host::probe(o.file, o.hang_limit_s)) {
    broken = p.broken;
    if (p.broken.empty() && (o.policy.empty() || p.id == o.policy)) ids.push_back(p.id);
  }
  if (!broken.empty()) throw InputError(o.file, "", broken);
  if (ids.empty() && !o.policy.empty()) throw InputError(o.file, o.policy, "the file offers no such policy");
  return ids;
}

}  // namespace

std::vector<TestResult> run_check(const CheckOptions& o, const std::function<void(const TestResult&)>& done) {
  core::check_input(o.file, core::kMaxPluginBytes);
  if (access(o.file.c_str(), R_OK) != 0) throw InputError(o.file, "", "cannot be read");
  check_names(o);
  std::vector<TestResult> results;
  std::string broken_gate;
  const auto run = [&](const std::string& policy, const Test& test) {
    if (!wanted(o, test) || stopped(o)) return;
    TestResult r{&test, policy, Verdict::not_run, broken_gate + " failed", ordered_json::object(), 0, ""};
    if (broken_gate.empty()) r = run_in_child(o, policy, test);
    if (stopped(o)) return;
    if (is_gate(test) && r.verdict == Verdict::failed) broken_gate = test.name;
    done(r);
    results.push_back(std::move(r));
  };
  for (const Test& t : all_tests())
    if (of_file(t)) run("", t);
  const std::string file_gate = broken_gate;
  const bool of_policies =
      !stopped(o) && std::any_of(all_tests().begin(), all_tests().end(),
                                 [&](const Test& t) { return !of_file(t) && wanted(o, t); });
  if (!of_policies) return results;
  for (const std::string& id : file_gate.empty() ? policies_of(o) : std::vector<std::string>{""}) {
    broken_gate = file_gate;
    for (const Test& t : all_tests())
      if (!of_file(t)) run(id, t);
  }
  return results;
}

}  // namespace karst::check
