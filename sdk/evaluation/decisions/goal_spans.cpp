#include "sdk/evaluation/decisions/goal_spans.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::evaluation {
namespace {

using core::Vec3;
namespace event = core::event;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr double kSameGoal_m = 0.75;

struct GoalSpan {
  double t_s = 0;
  std::optional<double> until_s;
  std::optional<Vec3> position;
  std::optional<double> heading_rad, score;
  std::string why, fate, fate_reason;
};

std::optional<Vec3> known(const Vec3& p) { return p.allFinite() ? std::optional(p) : std::nullopt; }
std::optional<double> known(double v) { return std::isfinite(v) ? std::optional(v) : std::nullopt; }

double distance(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  return a && b ? (*a - *b).norm() : std::numeric_limits<double>::infinity();
}

class GoalSpans {
 public:
  /// `appended`: it follows the goal under way, which goes on however near it is.
  void accept(const GoalSpan& goal, bool appended) {
    const std::optional<std::size_t> under_way =
        appended && !open_.empty() ? std::optional(open_.front()) : std::nullopt;
    std::erase_if(open_, [&](std::size_t i) {  // the same goal again, on another path
      const bool same = i != under_way && distance(spans_[i].position, goal.position) < kSameGoal_m;
      if (same) close(i, goal.t_s, kPlannedAnew, "");
      return same;
    });
    while (open_.size() > 1) close_last(goal.t_s);  // replaces the goal appended before
    open_.push_back(spans_.size());
    spans_.push_back(goal);
  }
  /// Ends the open goal at `position` and those accepted before it; without a position, the oldest one.
  void end(double t_s, const std::optional<Vec3>& position, const std::string& fate,
           const std::string& reason) {
    if (open_.empty()) return;
    const auto nearest = std::min_element(open_.begin(), open_.end(), [&](std::size_t a, std::size_t b) {
      return distance(spans_[a].position, position) < distance(spans_[b].position, position);
    });
    // The goal that replaced it at this time may lie near it, and is accepted by then.
    if (GoalSpan* replaced = just_replaced(t_s, position, distance(spans_[*nearest].position, position))) {
      replaced->fate = fate;
      replaced->fate_reason = reason;
      return;
    }
    if (position && !(distance(spans_[*nearest].position, position) < kSameGoal_m)) return;  // ended before
    for (auto i = open_.begin(); i != nearest; ++i)
      close(*i, t_s, core::name_of(event::GoalState::superseded), "");
    close(*nearest, t_s, fate, reason);
    open_.erase(open_.begin(), nearest + 1);
  }
  void end_all(double t_s) {
    while (!open_.empty()) close_last(t_s);
  }
  const std::vector<GoalSpan>& spans() const { return spans_; }

 private:
  /// The goal that another one ended at this time, if it was nearer than this to `position`.
  GoalSpan* just_replaced(double t_s, const std::optional<Vec3>& position, double than_m) {
    GoalSpan* found = nullptr;
    for (GoalSpan& s : spans_) {
      if (s.until_s != t_s || !s.fate_reason.empty() || !(distance(s.position, position) < than_m)) continue;
      found = &s;
      than_m = distance(s.position, position);
    }
    return found;
  }
  void close(std::size_t i, double t_s, const std::string& fate, const std::string& reason) {
    spans_[i].until_s = t_s;
    spans_[i].fate = fate;
    spans_[i].fate_reason = reason;
  }
  void close_last(double t_s) {
    close(open_.back(), t_s, core::name_of(event::GoalState::superseded), "");
    open_.pop_back();
  }

  std::vector<GoalSpan> spans_;
  std::vector<std::size_t> open_;  // indices, oldest first
};

ordered_json number_or_null(const std::optional<double>& v) { return v ? ordered_json(*v) : nullptr; }

}  // namespace

ordered_json goal_spans(const RunRecord& run) {
  GoalSpans goals;
  std::optional<double> appended_s;  // when a decision was made for a goal to follow the one under way
  for (const json& e : run.events) {
    const double t_s = e["t"];
    if (const auto decision = event::as<event::Decision>(e))
      appended_s = decision->appending ? std::optional(t_s) : std::nullopt;
    const auto phase = event::as<event::Phase>(e);
    if (phase && !core::traits_of(phase->phase).explores) goals.end_all(t_s);
    const auto goal = event::as<event::Goal>(e);
    if (!goal || goal->state == event::GoalState::rejected) continue;
    if (goal->state == event::GoalState::accepted)
      goals.accept({t_s, std::nullopt, known(goal->position), known(goal->heading_rad), known(goal->score),
                    goal->why, "", ""},
                   appended_s == t_s);
    else
      goals.end(t_s, known(goal->position), core::name_of(goal->state), goal->reason);
  }
  ordered_json list = ordered_json::array();
  for (const GoalSpan& g : goals.spans()) {
    const ordered_json position =
        g.position ? ordered_json{g.position->x(), g.position->y(), g.position->z()} : ordered_json(nullptr);
    list.push_back({{"t", g.t_s},
                    {"until", number_or_null(g.until_s)},
                    {"position", position},
                    {"heading", number_or_null(g.heading_rad)},
                    {"score", number_or_null(g.score)},
                    {"why", g.why},
                    {"fate", g.fate},
                    {"fate_reason", g.fate_reason}});
  }
  return list;
}

}  // namespace karst::evaluation
