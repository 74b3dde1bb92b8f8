// The appearance of rock close up: light and dark, bands and bumps, as a function of the world position only,
// so that the same stone looks the same in every picture and two pictures of it can be matched.
#pragma once
#include "core_stack/common/geometry.h"

namespace karst::sim {

struct RockLook {
  core::Vec3f tint =
      core::Vec3f::Ones();  // factors of the reflectivity for red, green and blue; mean about 1
  core::Vec3f slope = core::Vec3f::Zero();  // gradient of the bumps' height, m/m
};

/// Band-limited noise: octaves from 1.6 m down to `finest_m`, a pixel's footprint. Finer ones would flicker.
RockLook rock_look(const core::Vec3& place, float finest_m);

}  // namespace karst::sim
