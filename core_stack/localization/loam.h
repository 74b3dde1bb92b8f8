// LOAM: where the vehicle is, by matching each LiDAR sweep with a map of the rock around it (after Zhang and
// Singh, RSS 2014; docs/localization.md).
//
//   sweep --find_features--> edges, planes --motion during the sweep--> a cloud as seen at its stamp
//         --fit to the last sweep, where the prediction is weak--> guess
//         --fit to the local map--> pose --new place?--> local map
#pragma once
#include <optional>
#include <string>

#include "core_stack/localization/features.h"
#include "core_stack/localization/registration.h"
#include "core_stack/localization/sweep_motion.h"

namespace karst::core {

/// Whether a sweep is fitted to the one before it first; automatic: where the prediction does not cover it.
enum class ScanToScan { automatic, always, never };
constexpr auto names_of(ScanToScan) {
  using enum ScanToScan;
  return std::to_array<Named<ScanToScan>>({{automatic, "auto"}, {always, "always"}, {never, "never"}});
}

struct LoamOptions {
  FeatureOptions features;
  LocalMapOptions map;
  RegistrationOptions registration;
  ScanToScan scan_to_scan = ScanToScan::automatic;
  double max_correction_m = 1.5;  // of the guess by a fit; a larger one is not believed
  double max_correction_rad = 0.35;
  double restart_s = 5;  // without a valid pose: a sweep that does not lie on the local map begins another
  std::int64_t threads = 1;
};
void describe(OptionTable& t, LoamOptions& o);

struct LoamPose {
  TimeNs stamp = 0;
  Pose T_world_body;
  Matrix6 covariance = Matrix6::Zero();  // translation (world, m), rotation (body, rad); (100 m)^2 where free
  int free_directions = 0;               // along which the sweep says nothing: held from the prediction
  bool valid = false;
  bool anew = false;    // the local map begins anew with it: it is where the prediction was
  std::string problem;  // why it is not valid, or what else is wrong with it
  double rms_residual_m = 0;
  int edges = 0, planes = 0;  // matched
};

class Loam {
 public:
  Loam(const LoamOptions& options, const Pose& T_world_start);

  /// The pose at the sweep's stamp. `predicted`: states propagated with the IMU; where they do not reach from
  /// the sweep's first point to its stamp, the last poses' velocity is held instead. A pose that is not valid
  /// is the prediction, and the local map is as before. The first sweep is taken to be where it is predicted.
  LoamPose process(const Sweep& sweep, const StateHistory& predicted);

  const LocalMap& map() const { return map_; }

 private:
  /// Where the vehicle should be at the stamp, and how it moved during the sweep.
  struct Prediction {
    bool covered = false;  // by the states handed in
    Pose T_world_body;
    Twist twist;  // if not covered
  };
  Prediction predict(const Sweep& sweep, double length_s, const StateHistory& states) const;
  LoamPose locate(const Sweep& sweep, const StateHistory& states);
  LoamPose begin_map(const Cloud& cloud, LoamPose pose, bool bent);
  void accept(const LoamPose& pose, const Cloud& cloud);

  LoamOptions options_;
  LocalMap map_;
  LocalMap last_sweep_;  // in the world; empty unless scan to scan is in use
  Workspace workspace_;
  Pose T_world_last_;  // of the last valid pose, the start before that
  Twist twist_;        // at the last valid pose
  std::optional<TimeNs> last_stamp_, last_valid_;
  bool first_is_bent_ = false;  // the map holds one sweep, whose motion was not known
};

}  // namespace karst::core
