#include "sdk/replay/replay_run.h"

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/mapping/occupancy/rays.h"
#include "core_stack/mission/recording/recorder.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "sdk/replay/imu_prediction.h"
#include "sdk/replay/loop_files.h"

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

/// What is kept of a scan: where it was placed.
struct PlacedScan {
  TimeNs stamp = 0;
  Pose T_world_body;
  bool valid = false;
  std::string problem;
};

/// The run directory of a replay: like a flight's, without the files that only a flight has.
class ReplayFiles {
 public:
  ReplayFiles(const std::filesystem::path& run_dir, TimeNs origin) : recorder_(run_dir), origin_(origin) {
    // In the recording's own time, so that other tools find its ground truth; the recorder's file is unused.
    trajectory_.open(run_dir / "trajectory.tum", std::ios::trunc);
    if (!trajectory_) throw core::InputError((run_dir / "trajectory.tum").string(), "", "cannot be written");
  }

  void scan(const PlacedScan& pose, const std::vector<core::CellChange>& changes, const core::VoxelMap& map,
            const Vec3& velocity_mps) {
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

/// A map of placed scans, and the files that tell of them.
class Mapping {
 public:
  Mapping(const ReplayOptions& options, const std::filesystem::path& run_dir, TimeNs origin,
          std::optional<std::size_t> scans)
      : map_(options.map), range_m_(options.mapping_range_m), files_(run_dir, origin) {
    files_.begin(scans);
  }

  /// The returns of the sweep, in the world, are in `rays()` until the next call; none if it was not placed.
  void add(const core::Sweep& sweep, const PlacedScan& placed) {
    Vec3 velocity_mps = Vec3::Zero();
    if (!track_.states().empty() && sweep.stamp > track_.states().back().stamp)
      velocity_mps = (placed.T_world_body.position - track_.states().back().position) /
                     core::seconds(sweep.stamp - track_.states().back().stamp);
    std::vector<core::CellChange> changes;
    rays_.clear();
    if (placed.valid) {
      track_.push({sweep.stamp, placed.T_world_body.position, velocity_mps, placed.T_world_body.orientation,
                   Vec3::Zero()});
      rays_ = rays_of(sweep, track_, range_m_);
      changes = map_.insert(rays_);
    }
    files_.scan(placed, changes, map_, velocity_mps);
    last_ = placed.stamp;
  }
  void end(core::MissionOutcome outcome, const std::string& reason) {
    files_.end(last_, outcome, reason, map_);
  }
  void end_at(TimeNs stamp) { last_ = stamp; }
  const core::VoxelMap& map() const { return map_; }
  const std::vector<core::Ray>& rays() const { return rays_; }

 private:
  core::VoxelMap map_;
  double range_m_;
  ReplayFiles files_;
  core::StateHistory track_;
  std::vector<core::Ray> rays_;
  TimeNs last_ = 0;
};

/// How a replay ended.
struct Ending {
  core::MissionOutcome outcome = core::MissionOutcome::replayed;
  std::string reason = "the recording ended";
};

/// Collects what the loops need of each scan, and measures how long each search takes.
class LoopSearch {
 public:
  LoopSearch(const ReplayOptions& options, bool gravity_known)
      : loops_(options.loop_closing, gravity_known, static_cast<int>(options.loam.threads)) {}

  void add(const core::LoamPose& pose, const std::vector<core::Ray>& rays) {
    if (!pose.valid) return;
    points_.clear();
    for (const core::Ray& r : rays)
      if (r.hit) points_.push_back(r.end);
    core::SubmapBuilder::Seen seen{pose.stamp, pose.T_world_body, pose.free_directions == 0, 0, &points_};
    const double gap_s = last_ ? core::seconds(pose.stamp - *last_) : 0;
    if (pose.anew)
      seen.further_uncertainty_m = kAnew_m + kSpeed_mps * gap_s;
    else if (gap_s > kGap_s)
      seen.further_uncertainty_m = kGapDrift_mps * gap_s;
    last_ = pose.stamp;
    timed([&] { loops_.add(seen); });
  }
  void finish() {
    timed([&] { loops_.finish(); });
  }
  const core::LoopClosing& loops() const { return loops_; }
  double all_s() const { return all_s_; }
  double slowest_s() const { return slowest_s_; }

 private:
  static constexpr double kAnew_m = 10, kSpeed_mps = 2, kGap_s = 1, kGapDrift_mps = 0.05;

  template <class Work>
  void timed(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    all_s_ += took_s;
    slowest_s_ = std::max(slowest_s_, took_s);
  }

  core::LoopClosing loops_;
  std::vector<core::Vec3f> points_;
  std::optional<TimeNs> last_;
  double all_s_ = 0, slowest_s_ = 0;
};

/// A folder that is removed when its scope ends, by an exception too.
struct PassingFolder {
  explicit PassingFolder(std::filesystem::path p) : path(std::move(p)) { std::filesystem::remove_all(path); }
  ~PassingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  std::filesystem::path path;
};

/// Maps the scans again, at corrected poses, into a folder whose files then replace those of the run
/// directory. False if stopped: then nothing has changed.
bool map_again(SensorStream& sensors, const ReplayOptions& options, const std::filesystem::path& run_dir,
               const std::vector<PlacedScan>& placed, const core::TrackCorrection& corrected,
               const Ending& ending, const ReplayProgress& progress) {
  namespace fs = std::filesystem;
  const TimeNs origin = sensors.begin();
  const PassingFolder folder(run_dir / "corrected.part");
  const fs::path& part = folder.path;
  {
    Mapping mapping(options, part, origin, sensors.scans());
    for (std::size_t i = 0; i < placed.size(); ++i) {
      ReadNotes notes;
      std::optional<core::Sweep> sweep = sensors.next_sweep(notes);
      if (!sweep || sweep->stamp - origin != placed[i].stamp)
        throw core::InputError(run_dir.string(), "", "the recording changed while it was replayed");
      sweep->stamp -= origin;
      PlacedScan p = placed[i];
      p.T_world_body = corrected(p.stamp, p.T_world_body);
      mapping.add(*sweep, p);
      core::LoamPose shown;
      shown.stamp = p.stamp, shown.T_world_body = p.T_world_body, shown.valid = p.valid;
      if (!progress(i + 1, shown, mapping.map())) return false;
    }
    mapping.end(ending.outcome, ending.reason);
  }
  fs::rename(run_dir / "trajectory.tum", run_dir / "trajectory_odometry.tum");
  for (const auto& file : fs::directory_iterator(part))
    fs::rename(file.path(), run_dir / file.path().filename());
  return true;
}

}  // namespace

void describe(core::OptionTable& t, ReplayOptions& o) {
  t.section("localization.loam", o.loam);
  t.section("localization.estimator", o.estimator);
  t.section("map", o.map);
  t.add("replay.mapping_range", o.mapping_range_m, "m", 1, 200, "farther returns only clear space up to it");
  t.add("replay.level", o.level,
        "take the attitude at the start from the IMU's first moment, in which the sensor stood still");
  t.add("replay.still", o.still_s, "s", 0.01, 60, "length of this moment");
  t.add("replay.loops", o.loops, "recognize places seen before, and correct trajectory and map by them");
  t.section("loops", o.loop_closing);
}

ReplaySummary replay_recording(SensorStream& sensors, const ReplayOptions& options,
                               const std::filesystem::path& run_dir, const ReplayProgress& progress,
                               const ReopenSensors& reopen) {
  using Clock = std::chrono::steady_clock;
  const TimeNs origin = sensors.begin();
  std::optional<ImuPrediction> imu;
  if (sensors.has_imu()) imu.emplace(sensors, options.estimator, origin, options.level, options.still_s);
  core::Loam loam(options.loam, imu ? imu->T_world_start() : Pose{});
  Mapping mapping(options, run_dir, origin, sensors.scans());
  std::optional<LoopSearch> search;
  if (options.loops && reopen) search.emplace(options, imu.has_value());

  ReplaySummary summary;
  std::vector<PlacedScan> placed;
  const core::StateHistory nothing;
  Pose last;
  Ending ending;
  std::exception_ptr damage;
  for (bool go_on = true; go_on;) {
    ReadNotes notes;
    std::optional<core::Sweep> next;
    try {
      next = sensors.next_sweep(notes);
    } catch (const core::InputError& e) {
      mapping.end_at(notes.stamp - origin);
      ending = {core::MissionOutcome::aborted, e.what()};
      damage = std::current_exception();
      break;
    }
    if (!next) break;
    core::Sweep& sweep = *next;
    sweep.stamp -= origin;
    const core::StateHistory& predicted = imu ? imu->up_to(sweep.stamp) : nothing;

    const auto begin = Clock::now();
    const core::LoamPose pose = loam.process(sweep, predicted);
    const double took_s = std::chrono::duration<double>(Clock::now() - begin).count();
    if (imu) imu->correct(pose);

    const PlacedScan scan{pose.stamp, pose.T_world_body, pose.valid, pose.problem};
    mapping.add(sweep, scan);
    if (search) {
      search->add(pose, mapping.rays());
      placed.push_back(scan);
    }
    if (pose.valid) {
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
    go_on = progress(summary.scans, pose, mapping.map());
    if (!go_on) ending = {core::MissionOutcome::aborted, "stopped by the operator"};
  }
  mapping.end(ending.outcome, ending.reason);
  summary.imu_samples = imu ? imu->samples() : 0;
  if (search) {
    search->finish();
    const core::LoopClosing& loops = search->loops();
    write_loops(run_dir / "loops.csv", loops, origin);
    summary.loops = {loops.closed(),         loops.closures().size() - loops.closed(),
                     loops.submaps().size(), loops.bytes(),
                     loops.path_m(),         search->all_s(),
                     search->slowest_s()};
    if (loops.closed() > 0) {
      const core::TrackCorrection corrected = loops.correction();
      for (const PlacedScan& p : placed)
        summary.loops.largest_correction_m =
            std::max(summary.loops.largest_correction_m,
                     (corrected(p.stamp, p.T_world_body).position - p.T_world_body.position).norm());
      const std::unique_ptr<SensorStream> again = reopen();
      const bool stopped = ending.outcome == core::MissionOutcome::aborted && !damage;
      summary.loops.mapped_again = map_again(
          *again, options, run_dir, placed, corrected, ending,
          [&](std::size_t scan, const core::LoamPose& pose, const core::VoxelMap& map) {
            return progress(scan, pose, map) || stopped;  // stopped once: what was placed is still mapped
          });
    }
  }
  if (damage) std::rethrow_exception(damage);
  return summary;
}

}  // namespace karst::replay
