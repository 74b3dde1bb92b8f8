// Ground truth, written to files only: nothing in flight ever reads it.
#pragma once
#include <fstream>
#include <memory>
#include <string>

#include "core_stack/common/time.h"
#include "core_stack/vehicle/rgb_camera_model.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/dynamics/rigid_body.h"

namespace karst::sim {

struct TruthRow {
  double clearance_m = 0, speed_mps = 0, battery = 0, power_w = 0;
  core::Vec3 wind_mps = core::Vec3::Zero();
};

/// `ground_truth.tum` (time x y z qx qy qz qw), `truth.csv`, `truth_events.jsonl` and, with a colour camera,
/// `ground_truth_frames.csv`, and with objects of interest `truth_objects.jsonl` in a run directory.
/// Numbers have a fixed format, so that replays give the same bytes. Without a directory nothing is written.
class TruthLog {
 public:
  /// Throws InputError if the files cannot be created.
  explicit TruthLog(const std::string& run_dir);
  void pose(core::TimeNs stamp, const core::Pose& T_world_body);
  /// Writes a line of ground_truth_frames.csv, which the first picture creates: the camera's pose (x along
  /// its axis), the tangents of half its fields of view, and the limits within which surface counts as seen.
  void picture(core::TimeNs stamp, const core::Pose& T_world_camera, const core::RgbCameraModel& model);
  void row(core::TimeNs stamp, const TruthRow& row);
  /// `what` is one of start, take-off, landed, contact, battery, rockfall, fault.
  void event(core::TimeNs stamp, const std::string& what, const BodyState& s, const std::string& detail);
  /// Writes a line of truth_objects.jsonl, which the first call creates: placed, first in view, or seen.
  void object(core::TimeNs stamp, const char* what, std::size_t number, const cave::CaveObject& o);
  /// Hands everything to the operating system, so that a run cut short is complete to the last second.
  void flush();
  /// Throws InputError if anything could not be written, such as on a full disk.
  void close();

 private:
  std::string run_dir_;
  std::ofstream tum_, csv_, events_, pictures_, objects_;
};

}  // namespace karst::sim
