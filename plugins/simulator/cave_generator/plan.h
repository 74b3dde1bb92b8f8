// The plan of a cave: centre lines with cross-sections, chambers, and the blocks and speleothems in them.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/random.h"
#include "plugins/simulator/cave_generator/recipe.h"

namespace karst::cave {

/// A cross-section: an ellipse, cut flat at the floor, with a slot below it where water cut down (keyhole).
struct Station {
  core::Vec3 center = core::Vec3::Zero();
  double half_width_m = 1, half_height_m = 1;
  double floor_m = 1;  // from the centre down
  double slot = 0;     // 0: none, 1: as deep as the ellipse is high
};

using Passage =
    std::vector<Station>;  // about kStationStepM apart; a path for the vehicle runs along their centres
constexpr double kStationStepM = 1.25;

/// An ellipsoid, level, cut flat at its floor.
struct Chamber {
  core::Vec3 center = core::Vec3::Zero();
  core::Vec3 radii = core::Vec3::Ones();
  double heading_rad = 0;
  double floor_z = 0;
};

struct Boulder {
  core::Vec3 center = core::Vec3::Zero(), half = core::Vec3::Ones();
  core::Quat orientation = core::Quat::Identity();
};

/// A stalactite, stalagmite or column: a cone with round ends.
struct Speleothem {
  core::Vec3 base = core::Vec3::Zero(), tip = core::Vec3::Zero();
  double base_radius_m = 0.3, tip_radius_m = 0.1;
};

struct CavePlan {
  core::Vec3 start = core::Vec3(0, 0, 0.9);  // in the entrance chamber, whose floor lies at -0.3 to 0
  double start_heading_rad = 0;
  std::vector<Passage> passages;  // the first begins in the entrance chamber
  std::vector<Chamber> chambers;  // the first is the entrance
  std::vector<Boulder> boulders;
  std::vector<Speleothem> speleothems;
  double roughness_m = 0.3;   // amplitude of features smaller than a passage
  double undulation_m = 0.6;  // amplitude of features as large as a passage
  double undulation_length_m = 6;
  std::uint32_t noise_seed = 0;
};

constexpr double kMinHalfM = 1.05;  // no passage is narrower or lower than twice this

/// Lays out passages of about `length_m` in total, without boulders and speleothems.
CavePlan lay_out(const CaveRecipe& recipe, std::uint64_t seed, double length_m);

/// Makes every cross-section, and every chamber but the entrance, wider and higher by a factor; the centre
/// lines stay as they are.
void scale_sections(CavePlan& plan, double factor);

/// Adds heaps of blocks on the floors, and dripstone on floors and ceilings.
void furnish(CavePlan& plan, const CaveRecipe& recipe, std::uint64_t seed);

}  // namespace karst::cave
