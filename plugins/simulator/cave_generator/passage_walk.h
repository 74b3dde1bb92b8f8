// Passages grow as random walks that avoid each other.
#pragma once
#include <string>

#include "plugins/simulator/cave_generator/plan.h"

namespace karst::cave {

constexpr double kLevelStartM = 6;  // the first passage leaves the entrance chamber level

struct Walk {
  core::Vec3 from = core::Vec3::Zero();
  double heading_rad = 0, pitch_rad = 0, length_m = 0;
  double width_factor = 1;
  bool level_start = false;
};

/// `name` selects the random stream, so that adding or removing a passage does not change the others.
Passage walk_passage(const CavePlan& plan, const CaveRecipe& recipe, std::uint64_t seed, const Walk& w,
                     const std::string& name);

/// Metres from p to the nearest cross-section of the plan and of the unfinished passage `own`, less half a
/// passage and a wall; negative where there is no room for another passage. Cross-sections around `but`, and
/// the latest of `own`, do not count.
double room(const CavePlan& plan, const CaveRecipe& recipe, const core::Vec3& p, const core::Vec3& but,
            const Passage& own = {});

double passages_length_m(const CavePlan& plan);

core::Vec3 direction(double heading_rad, double pitch_rad);

}  // namespace karst::cave
