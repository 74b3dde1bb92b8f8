// The value of a selection: each cave in turn is left out of the experience, a policy is selected for it from
// the rest, and its result in that cave is compared with the best one there; and what simpler rules lose.
#pragma once
#include <array>
#include <optional>

#include "core_stack/common/enum_names.h"
#include "sdk/selection/select.h"

namespace karst::selection {

/// How a policy is chosen for a cave that is left out, from the flights in the others.
enum class Rule {
  selected,    // as `select` does
  conditions,  // as `select` does, with all caves alike: by goal and conditions
  overall,     // the best on average over all goals, conditions and caves
  goal,        // the best on average for this goal
  vehicle,     // the best on average of this vehicle
  chance       // the mean over all that flew there
};
constexpr auto names_of(Rule) {
  using enum Rule;
  return std::to_array<core::Named<Rule>>({{selected, "selected"},
                                           {conditions, "conditions"},
                                           {overall, "overall_best"},
                                           {goal, "best_by_goal"},
                                           {vehicle, "best_by_vehicle"},
                                           {chance, "chance"}});
}
inline constexpr std::size_t kRules = 6;

/// What one rule chose for a site and a goal.
struct Chosen {
  std::size_t contestant = 0;             // not of chance
  double value = kUnknown;                // in that cave
  double best = 0, within = 0, lost = 0;  // is the best; within 5 % of it; the share of the best that is lost
};

/// One choice that was made: a goal at a site of a cave that was left out.
struct LeftOut {
  std::size_t site = 0, metric = 0;  // in the experience
  std::size_t best = 0;              // contestant
  double best_value = 0;
  std::array<Chosen, kRules> by;
  bool refused = false;  // `select` would have refused; the figures are those of its best guess
  double nearest = 0;    // distance of the nearest known cave
};

/// Means of caves: of a cave's choices first, then over the caves. 95 % intervals over the caves.
struct Share {
  double mean = kUnknown, low = kUnknown, high = kUnknown;  // NaN: unknown, or of one cave alone
};
struct RuleValue {
  Share best, within, lost;
};

struct LeaveOneOut {
  std::vector<std::string> metrics;             // the goals
  std::vector<LeftOut> choices;                 // at sites where at least two contestants flew
  std::size_t caves = 0, refused = 0;           // refused choices
  std::array<RuleValue, kRules> all, answered;  // answered: without those refused
  const RuleValue& of(Rule rule) const { return all[static_cast<std::size_t>(rule)]; }
  const RuleValue& answered_of(Rule rule) const { return answered[static_cast<std::size_t>(rule)]; }
  /// What `selected` loses over what the rule loses; interval from caves drawn with replacement.
  std::array<Share, kRules> lost_ratio;
};

inline constexpr double kAsGood = 0.05;

/// `metrics`: the goals; each is known of five caves or more. Throws InputError like select, and with fewer
/// caves.
LeaveOneOut leave_one_out(const Experience& experience, const std::vector<std::string>& metrics,
                          const std::string& source);

/// The contestant that reached the greatest share of the best one's result, on average over the flights of a
/// vehicle: what to fly where no similar cave was flown.
struct BestOnAverage {
  std::size_t contestant = 0, caves = 0;
  std::string vehicle;  // "": over all vehicles, as this one has not flown
};
/// Nothing if the contestants are not told apart.
std::optional<BestOnAverage> best_on_average(const Experience& experience, std::size_t metric,
                                             const AskedConditions& asked);

/// The metrics of the goals (goal.h) that enough caves have, and that are not 0 in all of them.
std::vector<std::string> goals_flown(const Experience& experience);

/// The value over some choices only, such as those of one goal.
std::array<RuleValue, kRules> value_of(const Experience& experience, const std::vector<LeftOut>& choices);

}  // namespace karst::selection
