// Objects that people look for in caves, and what a detector behind a vehicle's camera says of them.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core_stack/common/enum_names.h"
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
constexpr auto names_of(ObjectKind) {
  using enum ObjectKind;
  return std::to_array<Named<ObjectKind>>({{none, "none"},
                                           {person, "person"},
                                           {backpack, "backpack"},
                                           {helmet, "helmet"},
                                           {rope, "rope"},
                                           {lamp, "lamp"},
                                           {drill, "drill"},
                                           {extinguisher, "extinguisher"},
                                           {phone, "phone"}});
}

/// That there are to find.
constexpr int kObjectKinds = static_cast<int>(names_of(ObjectKind::none).size()) - 1;

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
