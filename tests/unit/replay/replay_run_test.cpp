// Scans of a room written to files, replayed, and the trajectory compared with the one they were taken from.
#include "sdk/replay/replay_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/replay/recording.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "sdk/evaluation/record/poses.h"
#include "tests/unit/replay/folder.h"
#include "tests/unit/replay/room_walk.h"

namespace karst::replay {
namespace {

using core::Pose;
using core::Vec3;
using test::Folder;
using test::kBegin_s;
using test::kPeriod_s;
using test::kScans;
using test::pose_at;
using test::put;
using test::scan_at;

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
