#include "sdk/tools/explain_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/evaluation/decisions/clock.h"
#include "sdk/evaluation/decisions/decision_text.h"
#include "sdk/evaluation/decisions/recorded_answers.h"
#include "sdk/evaluation/team/team_folders.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using evaluation::DecisionRecord;
using evaluation::RecordedAnswer;

struct Explained {
  DecisionRecord decision;
  /// The flight was over by then, at this time.
  std::optional<double> over_s;
};

Explained decision_of(const std::string& run, const std::string& at) {
  if (evaluation::is_team(run))
    throw core::InputError(
        run, "",
        "is the run of a team; name one of its robots, such as " + (fs::path(run) / "robot_1").string());
  const auto at_s = evaluation::seconds_of_clock(at);
  if (!at_s) throw core::InputError("--at", at, "expected a time such as 1:34, or 94 for seconds");
  const evaluation::RunRecord record = evaluation::read_run(run);
  if (auto decision = evaluation::decision_at(record, *at_s)) {
    const bool over = !record.phases.empty() && *at_s > record.phases.back().end_s;
    return {*std::move(decision), over ? std::optional(record.phases.back().end_s) : std::nullopt};
  }
  const auto last = evaluation::decision_at(record, evaluation::kLongestRun_s);
  throw core::InputError(run, last ? "--at " + at : "events.jsonl",
                         last ? "no decision had been made by then" : "holds no decision");
}

/// What the policy answered to the requests of this decision: two where it was asked again for narrow
/// passages, none where the fallback decided.
std::vector<RecordedAnswer> answers_of(const fs::path& requests, const DecisionRecord& decision) {
  std::vector<RecordedAnswer> answers;
  evaluation::for_each_answer(requests, [&](const RecordedAnswer& a) {
    if (a.stamp_s > decision.t_s) return false;
    if (evaluation::was_asked_for(decision, a.stamp_s)) answers.push_back(a);
    return true;
  });
  return answers;
}

void explain_decision(const std::string& run, const std::string& at) {
  const auto [decision, over_s] = decision_of(run, at);
  if (over_s)
    print_out("The flight ended at %s. Its last decision:\n", evaluation::clock_text(*over_s).c_str());
  print_out("%s", evaluation::decision_text(decision).c_str());
  const fs::path requests = evaluation::requests_file(run);
  if (!fs::exists(requests)) {
    print_out("\nGoals behind the accepted one are not recorded: fly with --record-requests to see all.\n");
    return;
  }
  const std::vector<RecordedAnswer> answers = answers_of(requests, decision);
  if (answers.empty())
    print_out("\nThe policy was not asked: requests.bin has no request of this decision.\n");
  for (const RecordedAnswer& a : answers) print_out("\n%s", evaluation::answer_table(a, decision).c_str());
}

}  // namespace

void add_explain_command(CLI::App& app) {
  struct Arguments {
    std::string run, at;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* explain = app.add_subcommand(
      "explain",
      "Say why the vehicle flew to a goal\n\n"
      "Prints the decision at a time of the flight, or the last one before it: its goals, what became of "
      "them, and the frontiers offered.\n\n"
      "  karst explain runs/demo --at 1:34\n"
      "  karst fly demo.info --record-requests --out runs/demo     keeps the whole ranked lists, too");
  explain->add_option("run", args->run, "run directory; of a team that of a robot")
      ->type_name(kFolder)
      ->required()
      ->check(not_empty());
  explain->add_option("--at", args->at, "time of the flight: 1:34, or 94 for seconds")->required();
  explain->callback([args] { explain_decision(args->run, args->at); });
}

}  // namespace karst::tools
