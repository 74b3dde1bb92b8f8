#include "sdk/evaluation/decisions/decision_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "sdk/evaluation/decisions/clock.h"
#include "sdk/evaluation/decisions/decided_by.h"

namespace karst::evaluation {
namespace {

using core::counted;
using core::format_text;
using core::Vec3;
namespace event = core::event;

constexpr double kSameGoalPlace_m = 1e-6;

std::string number_text(double v, const char* format) {
  return std::isfinite(v) ? format_text(format, v) : "?";
}

std::string place_text(const Vec3& p) {
  return p.allFinite() ? format_text("(%.2f %.2f %.2f)", p.x(), p.y(), p.z()) : "(?)";
}

std::string frontier_text(std::uint32_t id) {
  return id == 0 ? "no frontier" : "frontier " + std::to_string(id);
}

/// The text behind an introduction, such as ", "; nothing if there is no text.
std::string after(const std::string& introduction, const std::string& text) {
  return text.empty() ? "" : introduction + text;
}

std::string goal_lines(const std::vector<RankedGoal>& goals) {
  std::string text;
  std::size_t rank = 0;
  for (const RankedGoal& goal : goals)
    text += format_text("%4zu  score ", ++rank) + number_text(goal.score, "%.3f") + "  " +
            place_text(goal.position) + " m, " + frontier_text(goal.frontier) + after(", ", goal.why) +
            "\n        " + goal.fate + "\n";
  return text;
}

/// The goals with events that none of the answers has, by who proposed them: all, without answers.
std::string tried_lines(const DecisionRecord& d, const std::vector<JudgedAnswer>& answers) {
  const auto is_answered = [&](const RankedGoal& tried) {
    return std::any_of(answers.begin(), answers.end(), [&](const JudgedAnswer& answer) {
      return std::any_of(answer.goals.begin(), answer.goals.end(), [&](const RankedGoal& goal) {
        return goal.why == tried.why && (goal.position - tried.position).norm() < kSameGoalPlace_m;
      });
    });
  };
  std::vector<RankedGoal> own, fallback;
  for (const RankedGoal& goal : tried_goals(d)) {
    if (is_of_fallback(goal))
      fallback.push_back(goal);
    else if (!is_answered(goal))
      own.push_back(goal);
  }
  const std::string policy = d.flown_policy.empty() ? "the policy" : d.flown_policy;
  return (own.empty() ? "" : "Goals of " + policy + " that were tried, best first:\n" + goal_lines(own)) +
         (fallback.empty()
              ? ""
              : "Goals of the fallback policy that were tried, best first:\n" + goal_lines(fallback));
}

std::string fate_text(const DecisionRecord& d) {
  if (!d.flown) return "The vehicle flew to no goal.\n";
  const FlownGoal& g = *d.flown;
  std::string text = d.accepted
                         ? "The goal was "
                         : "Flew on to the goal accepted at " + clock_text(g.accepted_s) + ", which was ";
  if (g.planned_anew > 0)
    text += "planned anew " + counted(static_cast<std::size_t>(g.planned_anew), "time") + ", then ";
  if (!g.until_s) return text + "still flown to when the record ends.\n";
  return text + g.fate + " at " + clock_text(*g.until_s) + ", " + format_text("%.1f", *g.until_s - d.t_s) +
         " s later" + after(": ", g.reason) + ".\n";
}

std::string frontier_lines(const DecisionRecord& d) {
  if (d.offered.empty()) return "No frontiers were offered.\n";
  std::string text = counted(d.offered.size(), "frontier") + (d.offered.size() == 1 ? " was" : " were") +
                     " offered:\n    id  unknown cells  straight, m  centroid, m\n";
  for (const event::Cluster& c : d.offered) {
    const std::string distance = d.vehicle ? format_text("%.1f", (c.centroid - *d.vehicle).norm()) : "?";
    text += format_text("%6u  %13u  %11s  ", c.id, c.unknown_cells, distance.c_str()) +
            place_text(c.centroid) + "\n";
  }
  return text;
}

/// A decision takes effect some time after the request that it answers.
std::string times_text(const DecisionRecord& d, const std::vector<RecordedAnswer>& answers) {
  if (answers.empty()) return " at " + clock_text(d.t_s);
  return std::string(answers.size() > 1 ? ", last asked at " : ", asked at ") +
         clock_text(answers.back().stamp_s) + ", decided at " + clock_text(d.t_s);
}

}  // namespace

std::string decision_text(const DecisionRecord& d, const std::vector<RecordedAnswer>& answers) {
  std::string text = format_text("Decision %zu of %zu", d.number, d.of) + times_text(d, answers) +
                     after(", phase ", d.phase) + after(", by ", decided_by(d)) + ": " + outcome_words(d) +
                     ". " + counted(d.decision.goals, "goal") + " proposed" +
                     (d.decision.appending ? ", to follow the goal under way" : "") + ".\n";
  std::vector<JudgedAnswer> read;
  for (const RecordedAnswer& a : answers) {
    text += answer_table(a, d);
    if (auto answer = judged(a, d)) read.push_back(*std::move(answer));
  }
  text += tried_lines(d, read) + fate_text(d) + frontier_lines(d);
  for (const event::Frontier& f : d.unseen)
    text += "Left out: frontier " + std::to_string(f.id) + " at " + place_text(f.position) + " m" +
            after(": ", f.reason) + "\n";
  return text;
}

std::string answer_table(const RecordedAnswer& recorded, const DecisionRecord& d) {
  const std::string head = "Request " + std::to_string(recorded.request) + " at " +
                           clock_text(recorded.stamp_s) + after(", answered by ", d.flown_policy) + ": ";
  const auto answer = judged(recorded, d);
  if (!answer) return head + recorded.answer + "\n";
  if (!answer->failure.empty()) return head + "the policy failed: " + answer->failure + "\n";
  return head + answer->outcome + after(", ", answer->reason) + ", " + counted(answer->goals.size(), "goal") +
         (answer->goals.empty() ? "\n" : ", best first:\n") + goal_lines(answer->goals);
}

std::string decision_line(const DecisionRecord& d) {
  std::string text = format_text("%9s  ", clock_text(d.t_s).c_str());
  if (d.accepted) {
    const RankedGoal goal = tried_goals(d).back();
    return text + place_text(goal.position) + " m, " + frontier_text(goal.frontier) + after(", ", goal.why) +
           "\n";
  }
  if (d.decision.outcome == core::Outcome::goals && d.flown && d.flown->position)
    return text + place_text(*d.flown->position) + " m, as before" + after(": ", d.decision.reason) + "\n";
  return text + outcome_words(d) + "\n";
}

}  // namespace karst::evaluation
