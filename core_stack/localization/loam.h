// LOAM: estimates the pose by matching each LiDAR sweep with a map of the surrounding rock (after Zhang and
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

/// Whether a sweep is first fitted to the previous one; automatic: only where no prediction covers it.
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
  double max_correction_m = 1.5;  // greatest correction of the prediction by a fit; larger ones are rejected
  double max_correction_rad = 0.35;
  double restart_s = 5;  // without a valid pose; then a sweep that does not fit the map starts a new one
  std::int64_t threads = 1;
};
void describe(OptionTable& t, LoamOptions& o);

/// Half: about half the features of a sweep, where there is no time for all of them.
enum class LoamEffort { full, half };

struct LoamPose {
  TimeNs stamp = 0;
  Pose T_world_body;
  Matrix6 covariance = Matrix6::Zero();  // translation (world, m), rotation (body, rad); (100 m)^2 where free
  int free_directions = 0;               // not observed by the sweep: the prediction is kept along them
  bool valid = false;
  bool anew = false;    // the local map was restarted at this sweep, at the predicted pose
  std::string problem;  // why the pose is not valid, or another problem of the sweep
  double rms_residual_m = 0;
  int edges = 0, planes = 0;  // number of matches
};

class Loam {
 public:
  Loam(const LoamOptions& options, const Pose& T_world_start);

  /// The pose at the sweep's stamp. `predicted`: states propagated with the IMU; if they do not span the time
  /// from the sweep's first point to its stamp, the last poses' velocity is held. A pose that is not valid
  /// equals the prediction and leaves the local map unchanged. The first sweep is placed at its prediction.
  LoamPose process(const Sweep& sweep, const StateHistory& predicted, LoamEffort effort = LoamEffort::full);

  /// What was flown up to the next sweep is not known, nor how long it took.
  void note_gap() { gap_ = true; }

  const LocalMap& map() const { return map_; }

 private:
  /// The predicted pose at the stamp and the predicted motion during the sweep.
  struct Prediction {
    bool covered = false;  // by the given states
    Pose T_world_body;
    Twist twist;  // used if not covered
  };
  Prediction predict(const Sweep& sweep, double length_s, const StateHistory& states) const;
  LoamPose locate(const Sweep& sweep, const StateHistory& states, LoamEffort effort);
  LoamPose begin_map(const Cloud& cloud, LoamPose pose, bool bent);
  void accept(const LoamPose& pose, const Cloud& cloud);

  LoamOptions options_;
  LocalMap map_;
  LocalMap last_sweep_;  // in the world frame; empty unless scan to scan is in use
  Workspace workspace_;
  Pose T_world_last_;  // the last valid pose; the start pose before the first one
  Twist twist_;        // twist at the last valid pose
  std::optional<TimeNs> last_stamp_, last_valid_;
  bool gap_ = false;            // since the last valid pose
  bool first_is_bent_ = false;  // the map holds one sweep, compensated with an unknown motion
};

}  // namespace karst::core
