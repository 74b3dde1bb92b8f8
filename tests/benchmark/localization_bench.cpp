// LOAM against PCL's GICP and NDT on the same simulated flights: time a 64x1024 sweep on one thread, drift,
// memory. `localization_bench [PCL_LENGTH_M [LONG_LENGTH_M]]`: metres flown with all three, and with LOAM
// alone.
//
// The vehicle flies at 2 m/s through caves of ../shared (or, without these, a generated one), shaken by
// gusts; ranges have 2 cm of noise, sweeps are distorted by motion, the prediction comes from an IMU with
// noise and bias through the estimator, which each method feeds with its own poses.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "core_stack/localization/estimator.h"
#include "core_stack/localization/loam.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "plugins/simulator/sensors/lidar.h"
#include "tests/benchmark/cave_flight.h"
#include "tests/benchmark/pcl_registration.h"
#include "tests/benchmark/times.h"

namespace karst::bench {
namespace {

using namespace core;
using core::bench::cpu_ms;
using core::bench::Times;

struct Stage {
  std::string name;
  cave::Cave cave;
};

double resident_mb() {
  std::ifstream in("/proc/self/statm");
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

std::vector<Vec3f> compensated(const Sweep& sweep, const StateHistory& states) {
  const Pose end = states.pose_at(sweep.stamp);
  const SweepMotion motion(0.1, sweep.T_body_lidar, [&](double time_s) {
    return end.inverse() * states.pose_at(sweep.stamp + from_seconds(time_s));
  });
  std::vector<Vec3f> points;
  for (const SweepPoint& p : sweep.points) points.push_back(motion.to_body_at_end(p.position, p.time_s));
  return points;
}

/// One method with its own estimator.
struct Odometry {
  std::string name;
  std::optional<Loam> loam;
  std::optional<PclOdometry> pcl;
  Estimator estimator;
  Times times;
  std::size_t next_imu = 0;
  Pose last;
  double worst_m = 0, worst_heading = 0;
  int refused = 0;

  Odometry(const std::string& method, const Pose& start) : name(method), estimator({}, start) {
    if (method == "LOAM")
      loam.emplace(LoamOptions{}, start);
    else
      pcl.emplace(method, start);
  }

  void process(const LidarScan& scan, const Flight& flight) {
    while (next_imu < flight.imu.size() && flight.imu[next_imu].stamp <= scan.stamp)
      estimator.on_imu(flight.imu[next_imu++]);
    times.ms.push_back(cpu_ms([&] {
      const Sweep sweep = to_sweep(scan, 0.3);
      if (loam) {
        const LoamPose pose = loam->process(sweep, estimator.history());
        last = pose.T_world_body;
        refused += !(pose.valid && estimator.on_lidar_pose({pose.stamp, pose.T_world_body, pose.covariance}));
      } else {
        last = pcl->process(compensated(sweep, estimator.history()), estimator.history().pose_at(scan.stamp));
        estimator.on_pose({scan.stamp, last});
      }
    }));
    const Pose truth = sim::pose_at(flight.truth, scan.stamp);
    worst_m = std::max(worst_m, (last.position - truth.position).norm());
    worst_heading = std::max(
        worst_heading, std::abs(wrap_angle(heading_of(last.orientation) - heading_of(truth.orientation))));
  }

  void print(const Flight& flight, double path_m) const {
    const Pose truth = sim::pose_at(flight.truth, estimator.state().stamp);
    const double end_m = (last.position - truth.position).norm();
    Times t = times;
    std::printf(
        "  %-5s %7.1f %7.1f %7.1f ms | end %7.3f m = %6.3f %%, worst %7.3f m = %6.3f %%, heading %6.3f deg",
        name.c_str(), t.at(0.5), t.at(0.99), t.at(1.0), end_m, 100 * end_m / path_m, worst_m,
        100 * worst_m / path_m, worst_heading * 180 / std::numbers::pi);
    if (loam)
      std::printf(" | refused %d, map %.1f MB", refused, static_cast<double>(loam->map().bytes()) / 1e6);
    std::printf("\n");
  }
};

void fly(const Stage& stage, const sim::LidarOptions& lidar_options, double length_m,
         const std::vector<std::string>& methods, bool long_flight) {
  const sim::Lidar lidar(lidar_options);
  ClearGrid grid(stage.cave.scene, stage.cave.description.start.position, 0.8);
  const Flight flight =
      fly_along(grid.tour(length_m), stage.cave.description.start.heading_rad, 2.0, 3.0, {}, 5);
  std::vector<Odometry> all;
  for (const std::string& m : methods) all.emplace_back(m, sim::pose_at(flight.truth, 0));
  std::printf("%s, %.0f m, %s x %d\n", stage.name.c_str(), flight.length_m, lidar.model()->name.c_str(),
              lidar.model()->columns);
  double path_m = 0, reported_m = 0;
  Pose before = flight.truth.front().pose;
  std::uint64_t seed = 1000;
  for (TimeNs stamp = 200 * kMillisecond; stamp <= flight.truth.back().stamp; stamp += 100 * kMillisecond) {
    const LidarScan scan = lidar.sweep(stage.cave, flight.truth, stamp, Random(seed++));
    for (Odometry& o : all) o.process(scan, flight);
    const Pose now = sim::pose_at(flight.truth, stamp);
    path_m += (now.position - before.position).norm(), before = now;
    if (long_flight && path_m > reported_m + 100) {
      reported_m += 100;
      std::printf("    at %5.0f m: local map %5.1f MB in %zu voxels, process %6.1f MB resident\n", path_m,
                  static_cast<double>(all[0].loam->map().bytes()) / 1e6, all[0].loam->map().voxels(),
                  resident_mb());
    }
  }
  for (const Odometry& o : all) o.print(flight, path_m);
}

Stage generated(const char* preset, std::uint64_t seed) {
  cave::GeneratedCave made = cave::generate_cave(cave::cave_preset(preset), seed);
  cave::CaveDescription description;
  description.start = made.start;
  return {std::string("generated, ") + preset + " " + std::to_string(seed),
          {description, cave::RayScene(std::move(made.mesh))}};
}

}  // namespace
}  // namespace karst::bench

int main(int argc, char** argv) {
  using namespace karst;
  using namespace karst::bench;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const double pcl_m = argc > 1 ? std::atof(argv[1]) : 60, long_m = argc > 2 ? std::atof(argv[2]) : 1000;
  const std::string shared = std::string(KARST_SOURCE_DIR) + "/../shared/data/caves/develop/";
  const bool has_shared = std::filesystem::exists(shared);
  const auto real = [&](const char* file, const char* start) {
    return Stage{file, cave::load_cave(shared + file, start)};
  };
  sim::LidarOptions os1;
  os1.unit = "os1_64", os1.columns = 1024;
  std::printf(
      "Processor time a sweep: median, 99th percentile, worst; errors of position at the end and at worst\n");

  const std::vector<std::string> everyone{"LOAM", "GICP", "NDT"}, loam{"LOAM"};
  const Stage large = generated("large", 5);
  if (pcl_m > 0) {
    fly(large, os1, pcl_m, everyone, false);
    if (has_shared) fly(real("indian_tunnel.stl", "-2.2 87.5 -5.8 270"), os1, pcl_m, everyone, false);
  }
  fly(large, os1, 300, loam, false);
  if (!has_shared) {
    std::printf("skipped: no ../shared\n");
    fly(large, os1, long_m, loam, true);
    return 0;
  }
  const Stage darpa_1 = real("darpa_cave_01.ply", "14.0 0.1 1.3 0");
  fly(real("indian_tunnel.stl", "-2.2 87.5 -5.8 270"), os1, 300, loam, false);
  fly(real("rough_tunnel.stl", "11.1 -0.5 2.1 0"), os1, 300, loam, false);
  fly(real("jean_bernard.ply", "97.5 51.8 108.8 0"), os1, 300, loam, false);
  fly(real("darpa_cave_02.ply", "16.0 -0.1 1.4 0"), os1, 300, loam, false);
  sim::LidarOptions os0;
  os0.unit = "os0_32", os0.columns = 512;
  fly(darpa_1, os0, 300, loam, false);
  fly(darpa_1, os1, long_m, loam, true);
  return 0;
}
