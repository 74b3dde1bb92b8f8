#include "sdk/host/boundary/decision_box.h"

#include <cmath>

#include "sdk/host/boundary/text.h"

namespace karst::host {
namespace {

constexpr double kFarthest_m = 1e5;  // no cave is wider; beyond it float rounding would matter
constexpr double kLongestTolerance_m = 100.0, kHighestSpeed_mps = 1000.0;
constexpr double kLowestSpeed_mps = 0.05;  // the smallest allowed motion.min_speed

core::Goal to_core(const karst_goal_t& g) {
  core::Goal out;
  out.position = {g.position.x, g.position.y, g.position.z};
  out.heading_rad = g.heading_rad;
  out.tolerance_m = g.tolerance_m;
  out.max_speed_mps = g.max_speed_mps;
  out.frontier_id = g.frontier_id;
  out.score = g.score;
  out.why = cleaned(g.why, kLineLimit);
  return out;
}

}  // namespace

std::string goal_fault(const karst_goal_t& g) {
  for (const double v : {g.position.x, g.position.y, g.position.z}) {
    if (!std::isfinite(v)) return "its position is not finite";
    if (std::abs(v) > kFarthest_m) return "its position is more than 100 km away";
  }
  if (std::isinf(g.heading_rad)) return "its heading is infinite (NaN stands for any)";
  if (!(g.tolerance_m > 0 && g.tolerance_m <= kLongestTolerance_m))
    return "its tolerance is not in (0, 100] m";
  if (!(g.max_speed_mps >= 0 && g.max_speed_mps <= kHighestSpeed_mps))
    return "its speed limit is not a speed (0 stands for the mission's)";
  if (g.max_speed_mps > 0 && g.max_speed_mps < kLowestSpeed_mps)
    return "its speed limit is below 0.05 m/s (0 stands for the mission's)";
  if (!std::isfinite(g.score)) return "its score is not finite";
  const std::string text = fault_of(g.why, kLineLimit);
  return text.empty() ? "" : "its why " + text;
}

karst_decision_sink_t DecisionBox::sink() {
  karst_decision_sink_t s{};
  s.size = sizeof s;
  s.max_goals = kMaxGoals;
  s.context = this;
  s.add_goals = [](const karst_decision_sink_t* self, const karst_goal_t* goals, std::uint64_t count,
                   karst_error_t* error) noexcept {
    return static_cast<DecisionBox*>(self->context)->add(goals, count, error);
  };
  s.set_outcome = [](const karst_decision_sink_t* self, karst_outcome_t outcome, std::uint32_t flags,
                     karst_text_t reason, karst_error_t* error) noexcept {
    return static_cast<DecisionBox*>(self->context)->set(outcome, flags, reason, error);
  };
  return s;
}

std::int32_t DecisionBox::add(const karst_goal_t* goals, std::uint64_t count, karst_error_t* error) {
  if (count > 0 && goals == nullptr) {
    fault_ = "add_goals was given a count and no goals";
    fill_error(error, KARST_ERROR_ARGUMENT, fault_);
    return KARST_ERROR_ARGUMENT;
  }
  if (count > kMaxGoals || offered_ + count > kMaxGoals) {
    fault_ = "it offered " + std::to_string(offered_ + count) + " goals, the limit is " +
             std::to_string(kMaxGoals);
    fill_error(error, KARST_ERROR_LIMIT, fault_);
    return KARST_ERROR_LIMIT;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string fault = goal_fault(goals[i]);
    if (fault.empty())
      goals_.push_back(to_core(goals[i]));
    else
      refused_.emplace_back(to_core(goals[i]), "goal " + std::to_string(offered_ + i + 1) + ": " + fault);
  }
  offered_ += count;
  return KARST_OK;
}

std::int32_t DecisionBox::set(karst_outcome_t outcome, std::uint32_t flags, const karst_text_t& reason,
                              karst_error_t* error) {
  std::string fault;
  if (outcome_ != 0) fault = "it set an outcome twice";
  if (outcome < KARST_OUTCOME_GOALS || outcome > KARST_OUTCOME_GO_HOME)
    fault = "it set an unknown outcome, " + std::to_string(outcome);
  if (const std::string text = fault_of(reason, kLineLimit); !text.empty()) fault = "its reason " + text;
  if (!fault.empty()) {
    fault_ = fault;
    fill_error(error, KARST_ERROR_ARGUMENT, fault);
    return KARST_ERROR_ARGUMENT;
  }
  outcome_ = outcome;
  tour_ = (flags & KARST_DECISION_TOUR) != 0;
  reason_ = cleaned(reason, kLineLimit);
  return KARST_OK;
}

std::string DecisionBox::fault() const {
  if (!fault_.empty()) return fault_;
  if (outcome_ == 0) return "it returned without an outcome";
  if (outcome_ == KARST_OUTCOME_GOALS && goals_.empty())
    return refused_.empty() ? "it said goals, but offered none"
                            : "no goal was well formed: " + refused_[0].second;
  return "";
}

core::Decision DecisionBox::decision() const {
  core::Decision d;
  switch (outcome_) {
    case KARST_OUTCOME_GOALS:
      d.outcome = core::Outcome::goals;
      d.goals = goals_;
      break;
    case KARST_OUTCOME_EXPLORED:
      d.outcome = core::Outcome::explored;
      break;
    case KARST_OUTCOME_GO_HOME:
      d.outcome = core::Outcome::go_home;
      break;
    default:
      d.outcome = core::Outcome::hold;
  }
  d.reason = reason_;
  return d;
}

}  // namespace karst::host
