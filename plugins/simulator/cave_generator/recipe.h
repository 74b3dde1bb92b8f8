// The parameters of a generated cave.
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/options.h"

namespace karst::cave {

struct CaveRecipe {
  double volume_m3 = 5000;
  double passage_width_m = 5;
  double verticality = 0.3;  // 0: level, 1: steep
  double branching = 0.5;    // 0: one passage, 1: mostly side passages
  std::int64_t loops = 1, domes = 2, shafts = 1, chimneys = 1;
  double breakdown = 0.5, speleothems = 0.5;  // density, 0..1
  double roughness_m = 0.3;
  double grid_m = 0.3;  // grid step of the surface's vertices
};
void describe(core::OptionTable& t, CaveRecipe& r);

/// Names of the presets, smallest cave first.
const std::vector<std::string>& cave_presets();

/// Throws InputError if there is none of that name, with the nearest one.
CaveRecipe cave_preset(const std::string& name);

}  // namespace karst::cave
