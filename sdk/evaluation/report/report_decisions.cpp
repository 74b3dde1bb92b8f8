#include "sdk/evaluation/report/report_decisions.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/rounded.h"
#include "sdk/evaluation/decisions/decided_by.h"
#include "sdk/evaluation/decisions/ranked_goals.h"
#include "sdk/evaluation/decisions/recorded_answers.h"

namespace karst::evaluation {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMaxListedGoals = 30000;  // over all decisions: about 5 MB
constexpr std::size_t kLeastOfADecision = 5;

ordered_json finite_or_null(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(nullptr); }

ordered_json listed(const RankedGoal& g) {
  ordered_json position = nullptr;
  if (g.position.allFinite())
    position = ordered_json{core::to_hundredths(g.position.x()), core::to_hundredths(g.position.y()),
                            core::to_hundredths(g.position.z())};
  ordered_json row = {{"position", std::move(position)},
                      {"frontier", g.frontier},
                      {"score", finite_or_null(g.score)},
                      {"why", g.why},
                      {"fate", g.fate}};
  if (std::isfinite(g.max_speed_mps) && g.max_speed_mps > 0) row["max_speed"] = g.max_speed_mps;
  return row;
}

ordered_json listed(const std::vector<RankedGoal>& goals, std::size_t most) {
  ordered_json rows = ordered_json::array();
  for (std::size_t i = 0; i < std::min(most, goals.size()); ++i) rows.push_back(listed(goals[i]));
  return rows;
}

ordered_json of_answer(const RecordedAnswer& answer, const DecisionRecord& decision, std::size_t most) {
  ordered_json row;
  row["request"] = answer.request;
  const auto read = judged(answer, decision);
  if (!read) {
    row["text"] = answer.answer;
  } else if (!read->failure.empty()) {
    row["failure"] = read->failure;
  } else {
    row["outcome"] = read->outcome;
    row["reason"] = read->reason;
    row["goals"] = listed(read->goals, most);
    row["left_out"] = read->goals.size() - std::min(most, read->goals.size());
  }
  return row;
}

/// What stands before the damage, if there is some.
std::vector<RecordedAnswer> all_answers(const std::filesystem::path& requests,
                                        std::vector<std::string>& problems) {
  std::vector<RecordedAnswer> answers;
  try {
    for_each_answer(requests, [&](const RecordedAnswer& a) {
      answers.push_back(a);
      return true;
    });
  } catch (const core::InputError& e) {
    problems.push_back(std::string(e.what()) + "; of the decisions after it not all goals are known");
  }
  return answers;
}

}  // namespace

ordered_json decision_choices(const RunRecord& run, std::vector<std::string>& problems) {
  const std::vector<DecisionRecord> decisions = decisions_of(run);
  const std::filesystem::path requests = requests_file(run.directory);
  std::error_code not_there;
  const bool recorded = std::filesystem::is_regular_file(requests, not_there);
  const std::vector<RecordedAnswer> answers =
      recorded ? all_answers(requests, problems) : std::vector<RecordedAnswer>();
  const std::size_t most =
      std::max(kLeastOfADecision, kMaxListedGoals / std::max<std::size_t>(1, decisions.size()));
  std::size_t left_out = 0;
  ordered_json choices = ordered_json::array();
  for (const DecisionRecord& d : decisions) {
    ordered_json rows = ordered_json::array();
    for (const RecordedAnswer& a : answers)
      if (was_asked_for(d, a.stamp_s)) rows.push_back(of_answer(a, d, most));
    const bool whole = !rows.empty();
    if (!whole) {
      ordered_json events_alone;
      events_alone["goals"] = listed(tried_goals(d), most);
      rows.push_back(std::move(events_alone));
    }
    for (const ordered_json& row : rows)
      if (row.contains("left_out")) left_out += row["left_out"].get<std::size_t>();
    ordered_json choice = {{"t", d.t_s}, {"recorded", whole}};
    // In words for people, where the recorded ones would be misread.
    if (d.decision.policy == kFallback) choice["by"] = decided_by(d);
    if (const std::string result = outcome_words(d); !result.starts_with(core::name_of(d.decision.outcome)))
      choice["result"] = result;
    choice["answers"] = std::move(rows);
    choices.push_back(std::move(choice));
  }
  if (left_out > 0)
    problems.push_back("report: of each answer the first " + std::to_string(most) +
                       " goals are shown, to keep the page small; karst explain shows all");
  return choices;
}

}  // namespace karst::evaluation
