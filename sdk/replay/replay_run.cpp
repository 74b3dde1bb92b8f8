#include "sdk/replay/replay_run.h"

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/mapping/occupancy/rays.h"
#include "core_stack/mission/recording/recorder.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "sdk/replay/imu_prediction.h"

namespace karst::replay {
namespace {

using core::Pose;
using core::TimeNs;
using core::Vec3;

/// The rays of a sweep, each from the sensor's position when it was measured; the track between two poses is
/// assumed to be straight.
std::vector<core::Ray> rays_of(const core::Sweep& sweep, const core::StateHistory& track,
                               double max_range_m) {
  std::vector<core::Ray> rays;
  rays.reserve(sweep.points.size());
  const Pose at_stamp = track.pose_at(sweep.stamp) * sweep.T_body_lidar;
  const bool moving = !sweep.compensated;
  for (const core::SweepPoint& p : sweep.points) {
    const Pose T_world_lidar =
        moving && p.time_s < 0
            ? track.pose_at(sweep.stamp + core::from_seconds(static_cast<double>(p.time_s))) *
                  sweep.T_body_lidar
            : at_stamp;
    const Vec3 point = p.position.cast<double>();
    const double range = point.norm();
    const bool hit = range <= max_range_m;
    const Vec3 end = T_world_lidar * (hit ? point : Vec3(point * (max_range_m / range)));
    rays.push_back({T_world_lidar.position.cast<float>(), end.cast<float>(), hit});
  }
  return rays;
}

/// The run directory of a replay: like a flight's, without the files that only a flight has.
class ReplayFiles {
 public:
  ReplayFiles(const std::filesystem::path& run_dir, TimeNs origin) : recorder_(run_dir), origin_(origin) {
    // In the recording's own time, so that other tools find its ground truth; the recorder's file is unused.
    trajectory_.open(run_dir / "trajectory.tum", std::ios::trunc);
    if (!trajectory_) throw core::InputError((run_dir / "trajectory.tum").string(), "", "cannot be written");
  }

  void scan(const core::LoamPose& pose, const std::vector<core::CellChange>& changes,
            const core::VoxelMap& map, const Vec3& velocity_mps) {
    const Vec3& p = pose.T_world_body.position;
    const core::Quat& q = pose.T_world_body.orientation;
    std::array<char, 256> line;
    std::snprintf(line.data(), line.size(), "%s %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n",
                  decimal_seconds(origin_ + pose.stamp).c_str(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                  q.w());
    if (pose.valid) trajectory_ << line.data();
    const bool was_lost = lost_;
    lost_ = !pose.valid;
    if (lost_ != was_lost) {
      using enum core::event::LocalizationState;
      recorder_.write(pose.stamp, core::event::Localization{.reason = lost_ ? pose.problem : "",
                                                            .state = lost_ ? lost : found});
    }
    recorder_.map_changes(pose.stamp, changes);
    core::Telemetry row;
    row.stamp = pose.stamp;
    row.phase = core::Phase::replay;
    row.state = {pose.stamp, p, velocity_mps, q, Vec3::Zero()};
    row.reference = Vec3::Constant(std::nan(""));
    row.battery_fraction = row.battery_seconds_left = row.home_distance_m = std::nan("");
    row.explored_m3 = map.free_volume_m3();
    recorder_.telemetry(row);
  }

  void end(TimeNs stamp, core::MissionOutcome outcome, const std::string& reason, const core::VoxelMap& map) {
    recorder_.write(stamp, core::event::Outcome{outcome, reason});
    recorder_.final_map(map);
    trajectory_.flush();
    if (!recorder_.flush() || !trajectory_)
      throw core::InputError(recorder_.directory().string(), "", "cannot be written: is the disk full?");
  }
  void begin(std::optional<std::size_t> scans) {
    recorder_.write(0, core::event::Phase{core::Phase::replay,
                                          scans ? std::to_string(*scans) + " scans" : "the scans of a bag"});
  }

 private:
  core::Recorder recorder_;
  std::ofstream trajectory_;
  TimeNs origin_;
  bool lost_ = false;
};

}  // namespace

void describe(core::OptionTable& t, ReplayOptions& o) {
  t.section("localization.loam", o.loam);
  t.section("localization.estimator", o.estimator);
  t.section("map", o.map);
  t.add("replay.mapping_range", o.mapping_range_m, "m", 1, 200, "farther returns only clear space up to it");
  t.add("replay.level", o.level,
        "take the attitude at the start from the IMU's first moment, in which the sensor stood still");
  t.add("replay.still", o.still_s, "s", 0.01, 60, "length of this moment");
}

ReplaySummary replay_recording(SensorStream& sensors, const ReplayOptions& options,
                               const std::filesystem::path& run_dir, const ReplayProgress& progress) {
  using Clock = std::chrono::steady_clock;
  const TimeNs origin = sensors.begin();
  std::optional<ImuPrediction> imu;
  if (sensors.has_imu()) imu.emplace(sensors, options.estimator, origin, options.level, options.still_s);
  core::Loam loam(options.loam, imu ? imu->T_world_start() : Pose{});
  core::VoxelMap map(options.map);
  ReplayFiles files(run_dir, origin);
  files.begin(sensors.scans());

  ReplaySummary summary;
  core::StateHistory track;
  const core::StateHistory nothing;
  Pose last;
  TimeNs last_stamp = 0;
  bool go_on = true;
  while (go_on) {
    ReadNotes notes;
    std::optional<core::Sweep> next;
    try {
      next = sensors.next_sweep(notes);
    } catch (const core::InputError& e) {
      files.end(notes.stamp - origin, core::MissionOutcome::aborted, e.what(), map);
      throw;
    }
    if (!next) break;
    core::Sweep& sweep = *next;
    sweep.stamp -= origin;
    const core::StateHistory& predicted = imu ? imu->up_to(sweep.stamp) : nothing;

    const auto begin = Clock::now();
    const core::LoamPose pose = loam.process(sweep, predicted);
    const double took_s = std::chrono::duration<double>(Clock::now() - begin).count();
    if (imu) imu->correct(pose);

    Vec3 velocity_mps = Vec3::Zero();
    if (!track.states().empty() && sweep.stamp > track.states().back().stamp)
      velocity_mps = (pose.T_world_body.position - track.states().back().position) /
                     core::seconds(sweep.stamp - track.states().back().stamp);
    std::vector<core::CellChange> changes;
    if (pose.valid) {
      track.push({sweep.stamp, pose.T_world_body.position, velocity_mps, pose.T_world_body.orientation,
                  Vec3::Zero()});
      changes = map.insert(rays_of(sweep, track, options.mapping_range_m));
      if (summary.scans > summary.lost) summary.path_m += (pose.T_world_body.position - last.position).norm();
      last = pose.T_world_body;
    } else {
      ++summary.lost;
      summary.last_problem = pose.problem;
    }
    ++summary.scans;
    summary.degenerate += pose.free_directions > 0;
    summary.points += sweep.points.size();
    summary.dropped_points += notes.dropped;
    summary.without_times = summary.without_times || notes.without_times;
    summary.localization_s += took_s;
    summary.slowest_s = std::max(summary.slowest_s, took_s);
    files.scan(pose, changes, map, velocity_mps);
    last_stamp = sweep.stamp;
    go_on = progress(summary.scans, pose, map);
  }
  files.end(last_stamp, go_on ? core::MissionOutcome::replayed : core::MissionOutcome::aborted,
            go_on ? "the recording ended" : "stopped by the operator", map);
  summary.imu_samples = imu ? imu->samples() : 0;
  return summary;
}

}  // namespace karst::replay
