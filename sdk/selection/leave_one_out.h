// The value of a selection: each cave in turn is left out of the experience, a policy is selected for it from
// the rest, and its result in that cave is compared with the best one there.
#pragma once
#include "sdk/selection/select.h"

namespace karst::selection {

struct LeftOut {
  std::size_t cave = 0;
  std::size_t best = 0, selected = 0,
              overall = 0;  // contestants: in that cave, selected, best in the other caves
  double best_value = 0, selected_value = 0, overall_value = 0, chance_value = 0;  // in that cave
  double chance_best = 0, chance_within = 0;             // expected of a contestant drawn at random
  bool selected_within = false, overall_within = false;  // within 5 % of the best
  bool refused = false;  // `select` would have refused; the figures are those of its best guess
  double nearest = 0;
};

struct LeaveOneOut {
  std::vector<LeftOut> caves;  // those in which at least two contestants flew
  std::size_t refused = 0;
  // Fractions over all caves, and over those not refused.
  struct Shares {
    double best = 0, within = 0;
    double regret = 0;  // mean of the lost fraction of the best value
  };
  Shares selected, overall, chance, selected_answered, overall_answered, chance_answered;
};

inline constexpr double kAsGood = 0.05;

/// Throws InputError like select, and with fewer than four caves.
LeaveOneOut leave_one_out(const Experience& experience, const SelectOptions& options,
                          const std::string& source);

}  // namespace karst::selection
