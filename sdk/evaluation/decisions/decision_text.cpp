#include "sdk/evaluation/decisions/decision_text.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/decisions/clock.h"

namespace karst::evaluation {
namespace {

using core::counted;
using core::format_text;
using core::Vec3;
using nlohmann::json;
namespace event = core::event;

constexpr double kSamePlace_m = 1e-6;  // as events and answers hold a goal
constexpr double kUnderWay_m = 0.3;    // nearer than this the vehicle flies on to the goal that it has

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

Vec3 place_of(const json& goal) {
  Vec3 p = Vec3::Constant(event::kUnknown);
  const auto found = goal.find("position");
  if (found == goal.end() || !found->is_array() || found->size() != 3) return p;
  for (std::size_t i = 0; i < 3; ++i)
    if ((*found)[i].is_number()) p[static_cast<Eigen::Index>(i)] = (*found)[i].get<double>();
  return p;
}

std::uint32_t frontier_of(const json& goal) {
  const auto found = goal.find("frontier");
  return found != goal.end() && found->is_number_unsigned() ? found->get<std::uint32_t>() : 0;
}

std::string fate_in(const DecisionRecord& d, const Vec3& place) {
  const auto is_here = [&](const event::Goal& g) { return (g.position - place).norm() < kSamePlace_m; };
  if (d.accepted && is_here(*d.accepted)) return "accepted";
  const auto refused = std::find_if(d.refused.begin(), d.refused.end(), is_here);
  if (refused != d.refused.end()) return "refused: " + refused->reason;
  const bool under_way =
      !d.accepted && d.flown && d.flown->position && (*d.flown->position - place).norm() < kUnderWay_m;
  return under_way ? "under way already" : "not tried";
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
  const json answer = core::json_of(recorded.answer);
  if (!answer.is_object()) return head + recorded.answer + "\n";
  if (const std::string failure = event_text(answer, "failure"); !failure.empty())
    return head + "the policy failed: " + failure + "\n";
  const auto goals = answer.find("goals");
  if (goals == answer.end() || !goals->is_array()) return head + recorded.answer + "\n";
  std::string text = head + event_text(answer, "outcome") + after(", ", event_text(answer, "reason")) + ", " +
                     counted(goals->size(), "goal") + (goals->empty() ? "\n" : ", best first:\n");
  std::size_t rank = 0;
  for (const json& goal : *goals) {
    const Vec3 place = place_of(goal);
    text += format_text("%4zu  score ", ++rank) +
            number_text(event_number(goal, "score").value_or(event::kUnknown), "%.3f") + "  " +
            place_text(place) + " m, " + frontier_text(frontier_of(goal)) +
            after(", ", event_text(goal, "why")) + "\n        " + fate_in(d, place) + "\n";
  }
  return text;
}

}  // namespace karst::evaluation
