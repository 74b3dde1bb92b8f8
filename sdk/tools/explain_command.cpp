#include "sdk/tools/explain_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/counted.h"
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

constexpr std::size_t kMostListed = 60;  // decisions

struct Explained {
  DecisionRecord decision;
  /// The flight was over by then, at this time.
  std::optional<double> over_s;
};

evaluation::RunRecord record_of(const std::string& run) {
  if (evaluation::is_team(run))
    throw core::InputError(
        run, "",
        "is the run of a team; name one of its robots, such as " + (fs::path(run) / "robot_1").string());
  return evaluation::read_run(run);
}

Explained decision_of(const std::string& run, const std::string& at) {
  const auto at_s = evaluation::seconds_of_clock(at);
  if (!at_s) throw core::InputError("--at", at, "expected a time such as 1:34, or 94 for seconds");
  const evaluation::RunRecord record = record_of(run);
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
  const fs::path requests = evaluation::requests_file(run);
  const bool recorded = fs::exists(requests);
  std::vector<RecordedAnswer> answers;
  if (recorded) answers = answers_of(requests, decision);
  print_wrapped(stdout, 8, "%s", evaluation::decision_text(decision, answers).c_str());
  if (!recorded)
    print_wrapped(stdout, 0, "\n%s\n",
                  "Goals behind the accepted one are not recorded: fly with --record-requests to see all.");
  else if (answers.empty())
    print_wrapped(stdout, 0, "\n%s\n",
                  "The policy was not asked: requests.bin has no request of this decision.");
}

void list_decisions(const std::string& run) {
  const std::vector<DecisionRecord> all = evaluation::decisions_of(record_of(run));
  if (all.empty()) throw core::InputError(run, "events.jsonl", "holds no decision");
  const std::size_t first = all.size() > kMostListed ? all.size() - kMostListed : 0;
  const std::string part = first > 0 ? ", of which the last " + std::to_string(kMostListed) : "";
  print_out("%s%s:\n", core::counted(all.size(), "decision").c_str(), part.c_str());
  for (std::size_t i = first; i < all.size(); ++i)
    print_wrapped(stdout, 11, "%s", evaluation::decision_line(all[i]).c_str());
  print_out("`karst explain %s --at %s` explains one.\n", run.c_str(),
            evaluation::clock_text(all.back().t_s).c_str());
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
      "them, and the frontiers offered. Without a time it lists the decisions.\n\n"
      "  karst explain runs/demo\n"
      "  karst explain runs/demo --at 1:34\n"
      "  karst fly demo.info --record-requests --out runs/demo     keeps the whole ranked lists, too");
  explain->add_option("run", args->run, "run directory; of a team that of a robot")
      ->type_name(kFolder)
      ->required()
      ->check(not_empty());
  explain->add_option("--at", args->at, "time of the flight: 1:34, or 94 for seconds")
      ->type_name("TIME")
      ->check(not_empty());
  explain->callback([args] {
    if (args->at.empty())
      list_decisions(args->run);
    else
      explain_decision(args->run, args->at);
  });
}

}  // namespace karst::tools
