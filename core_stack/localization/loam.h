// LOAM: where the vehicle is, by matching each LiDAR sweep with a map of the rock around it (Zhang and Singh,
// RSS 2014).
//
//   sweep --find_features--> edges, planes --motion of the sweep--> as seen at its stamp
//         --scan to scan, where the prediction is weak--> guess --fit_to_map--> pose --keyframe?--> local map
#pragma once
#include <optional>
#include <string>

#include "core_stack/localization/features.h"
#include "core_stack/localization/registration.h"
#include "core_stack/localization/sweep_motion.h"

namespace karst::core {

struct LoamOptions {
  FeatureOptions features;
  LocalMapOptions map;
  RegistrationOptions registration;
  std::string scan_to_scan = "auto";    // auto: where the prediction does not cover the sweep
  double keyframe_distance_m = 0.5;     // from all keyframes around: then the sweep joins the map
  double keyframe_matched_share = 0.7;  // or where fewer of its features lie on surfaces of the map
  std::int64_t threads = 1;
};
void describe(OptionTable& t, LoamOptions& o);

struct LoamPose {
  TimeNs stamp = 0;
  Pose T_world_body;
  Matrix6 covariance = Matrix6::Zero();  // translation (world, m), rotation (body, rad); (100 m)^2 where free
  int free_directions = 0;               // in which the sweep says nothing, held from the prediction
  bool valid = false;
  std::string problem;  // why it is not valid
  double rms_residual_m = 0;
  int edges = 0, planes = 0;  // matched
};

class Loam {
 public:
  Loam(const LoamOptions& options, const Pose& T_world_start);

  /// The pose at the sweep's stamp. `predicted`: states propagated with the IMU; if they do not reach from
  /// the sweep's first point to its stamp, the last poses' velocity is held instead. A pose that is not valid
  /// is the prediction, and the map stays as it was.
  LoamPose process(const Sweep& sweep, const StateHistory& predicted);

  std::size_t map_bytes() const;
  std::size_t map_voxels() const;
  std::size_t keyframes() const { return keyframes_.size(); }

 private:
  struct Guess {
    Pose T_world_body;
    Twist twist;
    bool covered = false;  // by the prediction
  };
  Guess guess_for(const Sweep& sweep, const StateHistory& predicted, double length_s) const;
  SweepMotion motion_of(const Sweep& sweep, const StateHistory& predicted, const Guess& g,
                        double length_s) const;
  bool is_keyframe(const Vec3& position, double matched_share) const;
  void insert(const Sweep& sweep, const Features& features, const SweepMotion& motion,
              const Pose& T_world_body);

  LoamOptions options_;
  VoxelLevel edge_level_, fine_level_, coarse_level_;
  std::vector<Vec3> keyframes_;
  Pose T_world_last_;
  std::optional<TimeNs> last_stamp_, last_valid_stamp_;
  Twist twist_;  // between the last two valid poses
};

}  // namespace karst::core
