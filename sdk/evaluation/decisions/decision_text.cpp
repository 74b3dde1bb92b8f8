#include "sdk/evaluation/decisions/decision_text.h"

#include <cmath>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "sdk/evaluation/decisions/clock.h"

namespace karst::evaluation {
namespace {

using core::counted;
using core::format_text;
using core::Vec3;
namespace event = core::event;

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

std::string goal_line(const char* what, const event::Goal& g) {
  return format_text("  %-9s", what) + place_text(g.position) + " m, " + frontier_text(g.frontier) +
         ", score " + number_text(g.score, "%.3f") + after(", ", g.why) + after(": ", g.reason) + "\n";
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
                     " offered:\n    id  unknown cells  distance, m  centroid, m\n";
  for (const event::Cluster& c : d.offered) {
    const std::string distance = d.vehicle ? format_text("%.1f", (c.centroid - *d.vehicle).norm()) : "?";
    text += format_text("%6u  %13u  %11s  ", c.id, c.unknown_cells, distance.c_str()) +
            place_text(c.centroid) + "\n";
  }
  return text;
}

}  // namespace

std::string decision_text(const DecisionRecord& d) {
  std::string text = format_text("Decision %zu of %zu at ", d.number, d.of) + clock_text(d.t_s) +
                     after(", phase ", d.phase) + after(", by ", d.decision.policy) + ": " +
                     core::name_of(d.decision.outcome) + after(", ", d.decision.reason) + ". " +
                     counted(d.decision.goals, "goal") + " proposed" +
                     (d.decision.appending ? ", to follow the goal under way" : "") + ".\n";
  for (const event::Goal& g : d.refused) text += goal_line("refused", g);
  if (d.accepted) text += goal_line("accepted", *d.accepted);
  text += fate_text(d) + frontier_lines(d);
  for (const event::Frontier& f : d.unseen)
    text += "Left out: frontier " + std::to_string(f.id) + " at " + place_text(f.position) + " m" +
            after(": ", f.reason) + "\n";
  return text;
}

std::string answer_table(const RecordedAnswer& recorded, const DecisionRecord& d) {
  const std::string head =
      "Request " + std::to_string(recorded.request) + " at " + clock_text(recorded.stamp_s) + ": ";
  const auto answer = judged(recorded, d);
  if (!answer) return head + recorded.answer + "\n";
  if (!answer->failure.empty()) return head + "the policy failed: " + answer->failure + "\n";
  std::string text = head + answer->outcome + after(", ", answer->reason) + ", " +
                     counted(answer->goals.size(), "goal") +
                     (answer->goals.empty() ? "\n" : ", best first:\n");
  std::size_t rank = 0;
  for (const RankedGoal& goal : answer->goals)
    text += format_text("%4zu  score ", ++rank) + number_text(goal.score, "%.3f") + "  " +
            place_text(goal.position) + " m, " + frontier_text(goal.frontier) + after(", ", goal.why) +
            "\n        " + goal.fate + "\n";
  return text;
}

}  // namespace karst::evaluation
