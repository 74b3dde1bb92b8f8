// What a detector of objects behind the vehicle's cameras would report: which are in view, and of those most,
// not quite in their places, and now and then one where there is none.
//
// An object is in view of an image if its middle is in the field of view and in range, not too much at a
// slant to the rock it lies on, nothing stands between, no dust dims it to less than a tenth, and, for the
// colour camera, the vehicle's lamp lights it with 2 lux at least.
#pragma once
#include "core_stack/common/random.h"
#include "plugins/simulator/cameras/rgb_camera.h"
#include "plugins/simulator/environment/clouds.h"
#include "plugins/simulator/environment/object_options.h"

namespace karst::sim {

/// An object counts as seen when it was in view in so many images: of six looks at a share of 0.9 fewer than
/// three come off once in 800 times.
constexpr int kSeenAfter = 6;

struct InView {
  std::size_t object = 0;                 // index in the cave's list
  core::Vec3 place = core::Vec3::Zero();  // camera frame
  double clear = 1;                       // share of light that is left, there and back
};

/// What a camera sees by: depth cameras bring their own light, pictures need the vehicle's lamp.
enum class Light { own, lamp };

class ObjectDetector {
 public:
  ObjectDetector(const ObjectOptions& o, const RgbOptions& rgb) : options_(o), rgb_(rgb) {}

  std::vector<InView> in_view(const cave::Cave& cave, const core::Pose& T_world_camera,
                              const core::CameraModel& camera, Light light,
                              std::span<const cave::Cloud> clouds = {}) const;
  /// What is reported of one image.
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
