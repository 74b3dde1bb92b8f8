// Every setting of localization: where poses come from, the filters on the IMU, LOAM.
#pragma once
#include "core_stack/localization/estimator.h"
#include "core_stack/localization/loam.h"

namespace karst::core {

struct LocalizationOptions {
  std::string source =
      "lidar";  // LOAM, on vehicles that have a LiDAR; or pose_sensor: the vehicle's own, if fitted
  EstimatorOptions estimator;
  LoamOptions loam;
};
inline void describe(OptionTable& t, LocalizationOptions& o) {
  t.add("source", o.source, {"lidar", "pose_sensor"},
        "lidar: LOAM, on vehicles that have a LiDAR, others use their pose sensor; pose_sensor: always that");
  describe(t, o.estimator);
  t.section("loam", o.loam);
}

}  // namespace karst::core
