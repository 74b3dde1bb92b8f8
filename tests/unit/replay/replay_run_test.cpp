// Scans of a room written to files, replayed, and the trajectory compared with the one they were taken from.
#include "sdk/replay/replay_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/replay/decimal_time.h"
#include "plugins/replay/recording.h"
#include "sdk/evaluation/record/poses.h"
#include "tests/unit/replay/folder.h"

namespace karst::replay {
namespace {

using core::Pose;
using core::Vec3;
using test::Folder;
using test::put;

constexpr double kBegin_s = 1000, kPeriod_s = 0.1;
constexpr int kScans = 25, kRings = 16, kColumns = 360;

/// A walk through the room: up to 0.8 m/s, turning by 0.3 rad/s; at rest at first.
Pose pose_at(double t_s) {
  const double s = std::max(0.0, t_s), along = 0.8 * (s - std::tanh(s));
  return {Vec3(along, 0.3 * std::sin(0.8 * along), 0.1 * std::sin(along)),
          core::from_heading(0.3 * (s - std::tanh(s)))};
}

/// Range from inside a 14 x 9 x 5 m room with two square pillars.
double range_in_room(const Vec3& from, const Vec3& direction) {
  double nearest = 1e9;
  const auto slab = [&](const Vec3& low, const Vec3& high, bool inside) {
    double enter = -1e9, leave = 1e9;
    for (int a = 0; a < 3; ++a) {
      const double u = (low[a] - from[a]) / direction[a], v = (high[a] - from[a]) / direction[a];
      enter = std::max(enter, std::min(u, v)), leave = std::min(leave, std::max(u, v));
    }
    if (inside) nearest = std::min(nearest, leave);
    if (!inside && enter > 0 && enter < leave) nearest = std::min(nearest, enter);
  };
  slab({-6, -4, -1.5}, {8, 5, 3.5}, true);
  slab({3, 2, -1.5}, {4, 3, 3.5}, false);
  slab({-3, -3, -1.5}, {-2.2, -2.2, 3.5}, false);
  return nearest;
}

/// One turn of the sensor, clockwise from behind, written as records x y z t ring.
std::string scan_at(double end_s, core::Random& noise) {
  std::string bytes;
  for (int ring = 0; ring < kRings; ++ring)
    for (int j = 0; j < kColumns; ++j) {
      const double before_s = kPeriod_s * (1 - (j + 1.0) / kColumns);
      const Pose T = pose_at(end_s - before_s);
      const double azimuth = std::numbers::pi * (1 - 2 * (j + 0.5) / kColumns),
                   elevation = 0.35 - 0.7 * ring / (kRings - 1);
      const Vec3 d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                   std::sin(elevation));
      const Vec3 p = d * (range_in_room(T.position, T.orientation * d) + 0.01 * noise.normal());
      for (int a = 0; a < 3; ++a) put(bytes, static_cast<float>(p[a]));
      put(bytes, static_cast<float>(kPeriod_s - before_s));
      put(bytes, static_cast<float>(ring));
    }
  return bytes;
}

std::string name_of(int i) { return "scan" + std::to_string(i) + ".bin"; }

void write_recording(const Folder& dir, bool with_imu) {
  std::string info =
      "bin { fields \"x y z t ring\" }\nstamp { from file file stamps.txt of start }\nlidar { max_range \"50 "
      "m\" }\n";
  core::Random noise(1);
  std::string stamps, imu;
  for (int i = 0; i < kScans; ++i) {
    dir.write(name_of(i), scan_at((i + 1) * kPeriod_s, noise));
    stamps += decimal_seconds(core::from_seconds(kBegin_s + i * kPeriod_s)) + "\n";
  }
  dir.write("stamps.txt", stamps);
  if (with_imu) info += "imu { file imu.txt }\n";
  dir.write("recording.info", info);
  constexpr double h = 1e-3;
  for (double t = -0.5; t < kScans * kPeriod_s + 0.1; t += 0.005) {
    const Pose a = pose_at(t - h), b = pose_at(t), c = pose_at(t + h);
    const Vec3 force =
        b.orientation.conjugate() * ((c.position - 2 * b.position + a.position) / (h * h) + Vec3(0, 0, 9.81));
    const double rate =
        core::wrap_angle(core::heading_of(c.orientation) - core::heading_of(a.orientation)) / (2 * h);
    char line[200];
    std::snprintf(line, sizeof line, "%.4f %.6f %.6f %.6f 0 0 %.6f\n", kBegin_s + t, force.x(), force.y(),
                  force.z(), rate);
    imu += line;
  }
  dir.write("imu.txt", imu);
}

ReplaySummary replay(const Folder& dir, const std::filesystem::path& out) {
  FolderSensors sensors(open_recording(dir.path(), ""));
  return replay_recording(sensors, {}, out,
                          [](std::size_t, const core::LoamPose&, const core::VoxelMap&) { return true; });
}

void expect_followed(const std::filesystem::path& run, double metres, double radians) {
  std::vector<std::string> problems;
  const auto poses = evaluation::read_tum(run / "trajectory.tum", problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(kScans));
  EXPECT_NEAR(poses.front().t_s, kBegin_s + kPeriod_s, 1e-3);
  const Pose T_truth_found = pose_at(poses.front().t_s - kBegin_s) * poses.front().T_world_body.inverse();
  for (const auto& p : poses) {
    const Pose truth = pose_at(p.t_s - kBegin_s), found = T_truth_found * p.T_world_body;
    EXPECT_LT((found.position - truth.position).norm(), metres) << "at " << p.t_s;
    EXPECT_LT(found.orientation.angularDistance(truth.orientation), radians) << "at " << p.t_s;
  }
}

TEST(Replay, FollowsTheWayTheScansWereTakenOnWithoutAnImu) {
  Folder dir;
  write_recording(dir, false);
  const ReplaySummary s = replay(dir, dir.path() / "run");
  EXPECT_EQ(s.scans, static_cast<std::size_t>(kScans));
  EXPECT_EQ(s.lost, 0u) << s.last_problem;
  expect_followed(dir.path() / "run", 0.06, 0.02);
}

TEST(Replay, FollowsItWithAnImu) {
  Folder dir;
  write_recording(dir, true);
  const ReplaySummary s = replay(dir, dir.path() / "run");
  EXPECT_EQ(s.lost, 0u) << s.last_problem;
  EXPECT_GT(s.imu_samples, 400u);
  expect_followed(dir.path() / "run", 0.05, 0.02);
}

TEST(Replay, MapsTheRoom) {
  Folder dir;
  write_recording(dir, false);
  replay(dir, dir.path() / "run");
  const core::VoxelMap map = core::read_octomap((dir.path() / "run" / "map.bt").string());
  ASSERT_GT(map.occupied_cells(), 2000u);
  std::size_t off = 0;
  map.for_each_known([&](const core::CellKey& k, core::Cell c, float) {
    if (c != core::Cell::occupied) return;
    const Vec3 p = map.center_of(k);
    const double walls = std::min({std::abs(p.x() + 6), std::abs(p.x() - 8), std::abs(p.y() + 4),
                                   std::abs(p.y() - 5), std::abs(p.z() + 1.5), std::abs(p.z() - 3.5)});
    const double pillars = std::min((p - Vec3(3.5, 2.5, p.z())).norm(), (p - Vec3(-2.6, -2.6, p.z())).norm());
    off += walls > 0.35 && pillars > 0.9;
  });
  EXPECT_LT(off, map.occupied_cells() / 50);
  EXPECT_EQ(map.at(Vec3(1, 0.5, 0.5)), core::Cell::free);
}

TEST(Replay, GivesTheSameBytesEveryTime) {
  Folder dir;
  write_recording(dir, true);
  replay(dir, dir.path() / "a");
  replay(dir, dir.path() / "b");
  for (const char* file :
       {"trajectory.tum", "map.bt", "map.ot", "map.ply", "map_growth.bin", "events.jsonl", "telemetry.csv"})
    EXPECT_EQ(file_bytes((dir.path() / "a" / file).string()), file_bytes((dir.path() / "b" / file).string()))
        << file;
}

TEST(Replay, ADamagedScanInTheMiddleEndsItWithWhatCameBefore) {
  Folder dir;
  write_recording(dir, false);
  std::filesystem::resize_file(dir.path() / name_of(12), 1003);
  try {
    replay(dir, dir.path() / "run");
    ADD_FAILURE() << "it was read";
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find(name_of(12)), std::string::npos) << e.what();
  }
  std::vector<std::string> problems;
  EXPECT_EQ(evaluation::read_tum(dir.path() / "run" / "trajectory.tum", problems).size(), 12u);
  EXPECT_GT(core::read_octomap((dir.path() / "run" / "map.bt").string()).occupied_cells(), 1000u);
}

TEST(Replay, ScansOfNothingAreLostAndNoCrash) {
  Folder dir;
  write_recording(dir, false);
  std::string nan;
  for (int i = 0; i < 500; ++i) put(nan, std::nanf(""));
  dir.write(name_of(10), nan);
  dir.write(name_of(11), "");
  const ReplaySummary s = replay(dir, dir.path() / "run");
  EXPECT_EQ(s.lost, 2u) << s.last_problem;
  EXPECT_EQ(s.scans, static_cast<std::size_t>(kScans));
}

}  // namespace
}  // namespace karst::replay
