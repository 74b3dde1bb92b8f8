// A recording with loops, simulated as it is replayed: how far trajectory and map are off before and after
// loops are closed. docs/results/loops.md
//
//   loop_recording CAVE.info PATH.txt OUT [UNIT [COLUMNS [GYROSCOPE_FACTOR [NOISE_M]]]] [KEY=VALUE ...]
//
// A LiDAR and an IMU move along PATH.txt (x y z a line, frame of the cave) at 2 m/s, as in
// localization_bench. The gyroscope's bias, walk and noise are multiplied by the factor; NOISE_M is that of a
// range.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core_stack/common/error.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "plugins/simulator/sensors/lidar.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/replay/replay_run.h"
#include "tests/benchmark/cave_flight.h"

namespace karst::bench {
namespace {

namespace fs = std::filesystem;
using namespace core;

constexpr double kSpeed_mps = 2, kStill_s = 3;

/// The sensors on a flight, without files.
class SimulatedSensors : public replay::SensorStream {
 public:
  SimulatedSensors(const cave::Cave& cave, const Flight& flight, const sim::Lidar& lidar)
      : cave_(cave), flight_(flight), lidar_(lidar) {}
  TimeNs begin() const override { return 0; }
  std::optional<std::size_t> scans() const override {
    return static_cast<std::size_t>(flight_.truth.back().stamp / kPeriod) - 1;
  }
  std::optional<Sweep> next_sweep(replay::ReadNotes& notes) override {
    stamp_ += kPeriod;
    notes.stamp = stamp_;
    if (stamp_ > flight_.truth.back().stamp) return std::nullopt;
    return to_sweep(
        lidar_.sweep(cave_, flight_.truth, stamp_, Random(static_cast<std::uint64_t>(stamp_ / kPeriod))),
        0.3);
  }
  bool has_imu() const override { return true; }
  std::optional<ImuSample> next_imu() override {
    if (next_imu_ == flight_.imu.size()) return std::nullopt;
    return flight_.imu[next_imu_++];
  }

 private:
  static constexpr TimeNs kPeriod = 100 * kMillisecond;
  const cave::Cave& cave_;
  const Flight& flight_;
  const sim::Lidar& lidar_;
  TimeNs stamp_ = kPeriod;
  std::size_t next_imu_ = 0;
};

std::vector<Vec3> read_path(const std::string& file) {
  std::ifstream in(file);
  std::vector<Vec3> path;
  for (Vec3 p; in >> p.x() >> p.y() >> p.z();) path.push_back(p);
  if (path.size() < 2) throw InputError(file, "", "expected lines of x y z");
  return path;
}

/// The replay begins at the origin with heading 0: its frame in the cave's.
Pose frame_of(const Flight& flight) {
  const Pose& start = flight.truth.front().pose;
  return {start.position, from_heading(heading_of(start.orientation))};
}

void print_errors(const char* name, const fs::path& trajectory, const Flight& flight) {
  std::vector<std::string> problems;
  const auto poses = evaluation::read_tum(trajectory, problems);
  const Pose T_cave_replay = frame_of(flight);
  double squares = 0, most = 0, end = 0, turn = 0;
  for (const auto& p : poses) {
    const Pose truth = sim::pose_at(flight.truth, from_seconds(p.t_s)),
               found = T_cave_replay * p.T_world_body;
    end = (found.position - truth.position).norm();
    turn = found.orientation.angularDistance(truth.orientation) * 180 / std::numbers::pi;
    squares += end * end;
    most = std::max(most, end);
  }
  std::printf("%-10s position rms %.3f m, at most %.3f m, at the end %.3f m and %.2f deg\n", name,
              std::sqrt(squares / static_cast<double>(poses.size())), most, end, turn);
}

/// Distance of the map's rock from the cave's.
void print_map_error(const char* name, const VoxelMap& map, const cave::Cave& cave, const Flight& flight) {
  const Pose T_cave_replay = frame_of(flight);
  std::vector<double> off;
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    if (c == Cell::occupied)
      off.push_back(cave.scene.distance_to_rock(T_cave_replay * map.center_of(k), 10.0));
  });
  double squares = 0, far = 0;
  for (const double d : off) squares += d * d, far += d > 0.3;
  std::sort(off.begin(), off.end());
  const auto n = static_cast<double>(off.size());
  std::printf(
      "%-10s map: %zu occupied cells, rms %.3f m from the rock, 95 %% within %.3f m, %.1f %% farther "
      "than 0.3 m; %.0f m3 free\n",
      name, off.size(), std::sqrt(squares / n), off[static_cast<std::size_t>(0.95 * n)], 100 * far / n,
      map.free_volume_m3());
}

void write_truth(const fs::path& file, const Flight& flight) {
  std::ofstream out(file);
  for (std::size_t i = 0; i < flight.truth.size(); i += 20) {
    const auto& [stamp, pose] = flight.truth[i];
    char line[200];
    std::snprintf(line, sizeof line, "%.3f %.5f %.5f %.5f %.8f %.8f %.8f %.8f\n", seconds(stamp),
                  pose.position.x(), pose.position.y(), pose.position.z(), pose.orientation.x(),
                  pose.orientation.y(), pose.orientation.z(), pose.orientation.w());
    out << line;
  }
}

int run(const std::vector<std::string>& all) {
  replay::ReplayOptions options;
  OptionTable table;
  describe(table, options);
  std::vector<std::string> args;
  for (const std::string& a : all) {
    const auto equals = a.find('=');
    if (equals == std::string::npos)
      args.push_back(a);
    else
      table.set("argument", a.substr(0, equals), a.substr(equals + 1));
  }
  if (args.size() < 3) throw InputError("loop_recording", "", "CAVE.info PATH.txt OUT [UNIT [COLUMNS ...]]");
  const auto number = [&](std::size_t i, double otherwise) {
    return i < args.size() ? std::atof(args[i].c_str()) : otherwise;
  };
  const cave::Cave cave = cave::load_cave(args[0], "");
  const std::vector<Vec3> path = read_path(args[1]);
  sim::LidarOptions lidar_options;
  if (args.size() > 3) lidar_options.unit = args[3];
  lidar_options.columns = static_cast<std::int64_t>(number(4, 512));
  lidar_options.noise_m = number(6, lidar_options.noise_m);
  sim::ImuOptions imu;
  const double factor = number(5, 1);
  imu.gyroscope_bias_radps *= factor, imu.gyroscope_noise_radps *= factor, imu.gyroscope_walk *= factor;
  const Vec3 ahead = path[1] - path[0];
  const Flight flight = fly_along(path, std::atan2(ahead.y(), ahead.x()), kSpeed_mps, kStill_s, imu, 5);
  const sim::Lidar lidar(lidar_options);
  double clearance_m = 10;
  for (std::size_t i = 0; i < flight.truth.size(); i += 100)
    clearance_m = std::min(clearance_m, cave.scene.distance_to_rock(flight.truth[i].pose.position, 10));
  SimulatedSensors sensors(cave, flight, lidar);
  std::printf("%.0f m at %.1f m/s, at least %.2f m from rock; %zu scans of %s x %lld\n", flight.length_m,
              kSpeed_mps, clearance_m, *sensors.scans(), lidar_options.unit.c_str(),
              static_cast<long long>(lidar_options.columns));
  const fs::path out = args[2];
  fs::create_directories(out);
  write_truth(out / "ground_truth.tum", flight);
  const std::size_t count = *sensors.scans();
  int passes = 0;
  const replay::ReplaySummary s = replay::replay_recording(
      sensors, options, out,
      [&](std::size_t scan, const LoamPose& pose, const VoxelMap& map) {
        if (scan % 1000 == 0)
          std::fprintf(stderr, "%zu %.2f m\n", scan,
                       (frame_of(flight) * pose.T_world_body.position -
                        sim::pose_at(flight.truth, pose.stamp).position)
                           .norm());
        if (scan == count) print_map_error(passes++ == 0 ? "odometry" : "loops", map, cave, flight);
        return true;
      },
      [&] { return std::make_unique<SimulatedSensors>(cave, flight, lidar); });
  std::printf("%zu scans, %zu lost, %zu degenerate; LOAM %.1f ms a scan\n", s.scans, s.lost, s.degenerate,
              1e3 * s.localization_s / static_cast<double>(s.scans));
  const bool closed = fs::exists(out / "trajectory_odometry.tum");
  print_errors("odometry", out / (closed ? "trajectory_odometry.tum" : "trajectory.tum"), flight);
  if (closed) print_errors("loops", out / "trajectory.tum", flight);
  std::printf("%zu closures, %zu not used; %zu submaps, search %.1f s = %.0f ms a submap, %.1f MB a km\n",
              s.loops.closed, s.loops.unused, s.loops.submaps, s.loops.search_s,
              1e3 * s.loops.search_s / static_cast<double>(std::max<std::size_t>(1, s.loops.submaps)),
              1e-3 * static_cast<double>(s.loops.bytes) / std::max(1.0, s.loops.path_m));
  return 0;
}

}  // namespace
}  // namespace karst::bench

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    return karst::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
