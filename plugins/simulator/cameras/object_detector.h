// A simulated object detector on the vehicle's cameras: it reports most of the objects in view, with position
// noise, and occasional false detections.
//
// An object is in view of an image if its centre is in the field of view and in range, the angle to the
// normal of the rock that it lies on is small enough, nothing stands between, dust leaves at least a tenth of
// its light, and, for the colour camera, the vehicle's lamp lights it with at least 2 lux.
#pragma once
#include "core_stack/common/random.h"
#include "plugins/simulator/cameras/rgb_camera.h"
#include "plugins/simulator/environment/clouds.h"
#include "plugins/simulator/environment/object_options.h"

namespace karst::sim {

/// An object counts as seen once it was in view in so many images: with a detection rate of 0.9, fewer than
/// three of six images yield a detection once in 800 times.
constexpr int kSeenAfter = 6;

struct InView {
  std::size_t object = 0;                 // index in the cave's list
  core::Vec3 place = core::Vec3::Zero();  // camera frame
  double clear = 1;                       // two-way transmittance of the air, 0..1
};

/// The camera's light source: depth cameras have their own, pictures need the vehicle's lamp.
enum class Light { own, lamp };

class ObjectDetector {
 public:
  ObjectDetector(const ObjectOptions& o, const RgbOptions& rgb) : options_(o), rgb_(rgb) {}

  std::vector<InView> in_view(const cave::Cave& cave, const core::Pose& T_world_camera,
                              const core::CameraModel& camera, Light light,
                              std::span<const cave::Cloud> clouds = {}) const;
  /// The detections in one image.
  std::vector<core::ObjectDetection> detect(const cave::Cave& cave, const core::Pose& T_world_camera,
                                            const core::CameraModel& camera, Light light,
                                            const std::vector<InView>& in_view, core::Random random) const;

 private:
  core::ObjectDetection measured(core::ObjectKind kind, const core::Vec3& place, Light light,
                                 core::Random& random) const;

  ObjectOptions options_;
  RgbOptions rgb_;
};

}  // namespace karst::sim
