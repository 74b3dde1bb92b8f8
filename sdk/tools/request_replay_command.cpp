#include "sdk/tools/request_replay_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "sdk/host/load_policy.h"
#include "sdk/host/serialization/request_log.h"
#include "sdk/host/plugin/selection.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using host::RequestLogReader;
using nlohmann::ordered_json;

constexpr int kDiffers = 2;
constexpr std::string_view kFlysPrefix = "policy.parameters.";  // of the same parameter in karst fly
constexpr double kNoLimit_s = 1e7;                              // a debugger may stop the policy for any time

struct ReplayArguments {
  std::string run, policy;
  std::vector<std::string> plugins, settings;
  std::uint32_t from = 1, to = std::numeric_limits<std::uint32_t>::max();
  bool expect_same = false, json = false;
};

host::PolicyChoice choice_of(const ReplayArguments& args, const host::RequestLogHeader& header) {
  host::PolicyChoice c;
  c.name = args.policy.empty() ? header.policy : args.policy;
  c.plugin_files = args.plugins;
  if (c.name == header.policy) c.parameters = header.parameters;
  for (const std::string& setting : args.settings) {
    const std::size_t equals = setting.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw core::InputError("--set", setting, "expected parameter=value");
    std::string key = setting.substr(0, equals);
    if (key.starts_with(kFlysPrefix)) key.erase(0, kFlysPrefix.size());
    if (key.empty()) throw core::InputError("--set", setting, "expected parameter=value");
    c.parameters.put(key, setting.substr(equals + 1));
  }
  c.source = args.run;
  c.seed = header.seed;
  c.isolation = host::Isolation::in_process;  // a debugger sees the policy's code
  c.hang_limit_s = c.cpu_limit_s = kNoLimit_s;
  return c;
}

std::string ask(host::HostedPolicy& policy, const core::DecisionRequest& request) {
  try {
    return host::answer_text(policy.decide(request));
  } catch (const core::PolicyFailure& failure) {
    return core::json_text(ordered_json{{"failure", failure.what()}});
  }
}

void print(const core::DecisionRequest& r, const std::string& recorded, const std::string& now) {
  print_out("%5u  %7.1f s  %3zu frontiers  %s  %s\n", r.sequence, core::seconds(r.stamp), r.frontiers.size(),
            recorded == now ? "same   " : "DIFFERS", host::answer_line(now).c_str());
  if (recorded != now) print_out("%31s recorded: %s\n", "", host::answer_line(recorded).c_str());
}

int replay(const ReplayArguments& args) {
  const fs::path file =
      fs::is_directory(args.run) ? fs::path(args.run) / host::kRequestLogName : fs::path(args.run);
  if (!fs::exists(file) && fs::is_directory(args.run))
    throw core::InputError(args.run, "", "holds no requests: fly with --record-requests");
  if (args.from > args.to) throw core::InputError("--from", std::to_string(args.from), "is after --to");
  RequestLogReader log(file);
  const std::unique_ptr<host::HostedPolicy> policy = host::load_policy(choice_of(args, log.header()));
  std::size_t asked = 0, different = 0;
  ordered_json decisions = ordered_json::array();
  std::string now;
  bool shown = false;
  for (RequestLogReader::Kind kind = log.next(); kind != RequestLogReader::Kind::end; kind = log.next()) {
    if (kind == RequestLogReader::Kind::event) policy->notify(log.event());
    if (kind == RequestLogReader::Kind::request) {
      if (log.request().sequence > args.to) break;
      now = ask(*policy, log.request());
      shown = log.request().sequence >= args.from;
    }
    if (kind != RequestLogReader::Kind::answer || !shown) continue;
    ++asked;
    different += now != log.answer();
    if (args.json)
      decisions.push_back({{"sequence", log.request().sequence},
                           {"t", core::seconds(log.request().stamp)},
                           {"same", now == log.answer()},
                           {"recorded", core::json_of<ordered_json>(log.answer())},
                           {"now", core::json_of<ordered_json>(now)}});
    else
      print(log.request(), log.answer(), now);
  }
  if (log.skipped_bytes() > 0)
    print_error("karst: %s: its last record is cut short, %llu bytes of it are passed over\n", file.c_str(),
                static_cast<unsigned long long>(log.skipped_bytes()));
  if (args.json)
    print_json(ordered_json{{"schema", 1},
                            {"policy", policy->name()},
                            {"asked", asked},
                            {"different", different},
                            {"decisions", decisions}});
  else
    print_out("%s of %s %s, %zu as recorded, %zu different\n", core::counted(asked, "decision").c_str(),
              policy->name().c_str(), policy->version().c_str(), asked - different, different);
  if (args.expect_same && asked == 0)
    throw core::InputError(file.string(), "--expect-same", "no decision was compared");
  return args.expect_same && different > 0 ? kDiffers : 0;
}

}  // namespace

void add_request_replay_command(CLI::App& policy) {
  auto args = std::make_shared<ReplayArguments>();
  CLI::App* app = policy.add_subcommand(
      "replay",
      "Put the requests of a flight to a policy once more, without a vehicle\n\n"
      "  karst fly demo.info --record-requests --out runs/demo\n"
      "  karst policy replay runs/demo                         the same policy, the same parameters\n"
      "  karst policy replay runs/demo --set path_weight=2     what it would have said with another value\n"
      "  gdb --args karst policy replay runs/demo --plugin build/lib/karst/policies/mine.so --to 40\n\n"
      "Exit code: 0 replayed, 2 with --expect-same: an answer differs, 1 an error.");
  app->add_option("run", args->run, "run directory, or a file of recorded requests")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  app->add_option("--policy", args->policy, "another policy than the one recorded")
      ->type_name(kPolicy)
      ->check(not_empty());
  app->add_option("--plugin", args->plugins, "file with policies (.so or .py) to look in first")
      ->type_name(kFile)
      ->allow_extra_args(false)
      ->check(not_empty());
  app->add_option("--set", args->settings,
                  "parameter=value, or policy.parameters.parameter=value as of karst fly")
      ->allow_extra_args(false);
  app->add_option("--from", args->from,
                  "show decisions from this number on; those before are put to it as well");
  app->add_option("--to", args->to, "end after this decision");
  app->add_flag("--expect-same", args->expect_same,
                "exit code 2 if an answer shown differs from the one recorded");
  app->add_flag("--json", args->json, "write JSON, with whole answers");
  app->callback([args] {
    host::take_policy_file(args->policy, args->plugins);
    if (const int code = replay(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
