// All options of localization: source of poses, IMU filters, LOAM.
#pragma once
#include "core_stack/localization/estimator.h"
#include "core_stack/localization/loam.h"

namespace karst::core {

/// LOAM on vehicles with a LiDAR; or the vehicle's own pose sensor, if it has one.
enum class PoseSource { lidar, pose_sensor };
constexpr auto names_of(PoseSource) {
  using enum PoseSource;
  return std::to_array<Named<PoseSource>>({{lidar, "lidar"}, {pose_sensor, "pose_sensor"}});
}

struct LocalizationOptions {
  PoseSource source = PoseSource::lidar;
  EstimatorOptions estimator;
  LoamOptions loam;
};
inline void describe(OptionTable& t, LocalizationOptions& o) {
  t.add("source", o.source,
        "lidar: LOAM, on vehicles that have a LiDAR, others use their pose sensor; pose_sensor: always that");
  describe(t, o.estimator);
  t.section("loam", o.loam);
}

}  // namespace karst::core
