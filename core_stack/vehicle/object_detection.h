// Objects that people look for in caves, and what a detector behind a vehicle's camera says of them.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "core_stack/vehicle/messages.h"

namespace karst::core {

/// As its number on the radio: a kind never changes its number.
enum class ObjectKind : std::uint8_t {
  none,  // on the radio: taken back
  person,
  backpack,
  helmet,
  rope,
  lamp,
  drill,
  extinguisher,
  phone
};
constexpr std::array<const char*, 9> kObjectNames = {"none", "person", "backpack",     "helmet", "rope",
                                                     "lamp", "drill",  "extinguisher", "phone"};

/// "unknown" for a number that no kind has.
constexpr const char* name_of(ObjectKind kind) {
  const auto i = static_cast<std::size_t>(kind);
  return i < kObjectNames.size() ? kObjectNames[i] : "unknown";
}
/// `none` for a name that no kind has.
constexpr ObjectKind object_kind(std::string_view name) {
  for (std::size_t i = 1; i < kObjectNames.size(); ++i)
    if (name == kObjectNames[i]) return static_cast<ObjectKind>(i);
  return ObjectKind::none;
}

/// What the detector takes for an object, in the frame of the camera (CameraModel).
struct ObjectDetection {
  ObjectKind kind = ObjectKind::none;
  Vec3 direction = Vec3::UnitX();  // unit vector
  double range_m = 0;
  double bearing_sigma_rad = 0, range_sigma_m = 0;  // of direction, in each axis across it, and of range
  double confidence = 0;                            // 0..1
};

/// Of one look: an image of one camera.
struct ObjectDetections {
  TimeNs stamp = 0;
  std::shared_ptr<const CameraModel> camera;
  std::vector<ObjectDetection> found;
};

}  // namespace karst::core
