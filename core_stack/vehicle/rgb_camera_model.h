// A colour camera: what it looks like to the core, and its pictures.
#pragma once
#include <cstdint>

#include "core_stack/vehicle/messages.h"

namespace karst::core {

/// Where it looks, and what of the rock its pictures show well enough to count as seen: within its range,
/// where the lamp lights it and it is sharp, and not too much at a slant.
struct RgbCameraModel {
  CameraModel camera;
  double max_incidence_rad = 1.2217;  // between the surface's normal and the way to the camera: 70 degrees
};

/// A picture, or the moment at which one was taken.
struct RgbFrame {
  TimeNs stamp = 0;
  std::shared_ptr<const RgbCameraModel> model;
  std::vector<std::uint8_t> rgb;  // row-major, three bytes a pixel, sRGB; empty if no pictures are kept
};

}  // namespace karst::core
