// A recording that goes around a block of rock and beyond its beginning: its loop is closed, and the map made
// again.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core_stack/common/temporary_folder.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/replay/replay_run.h"
#include "tests/unit/localization/worlds.h"

namespace karst::replay {
namespace {

namespace fs = std::filesystem;
using namespace core;

/// A corridor of 4 m around a block, with pillars and steps of different sizes at its walls.
test::World corridor() {
  std::vector<test::Box> rock{{{4, 4, -3}, {16, 10, 4}}};
  Random r(4);
  for (int i = 0; i < 46; ++i) {
    const double u = r.uniform(0, 20), v = r.uniform(0, 14), size = r.uniform(0.3, 0.8);
    const Vec3 at = i % 4 == 0   ? Vec3(u, 0, r.uniform(-1.5, 2))
                    : i % 4 == 1 ? Vec3(u, 14, r.uniform(-1.5, 2))
                    : i % 4 == 2 ? Vec3(0, v, r.uniform(-1.5, 2))
                                 : Vec3(20, v, r.uniform(-1.5, 2));
    rock.push_back({at - Vec3::Constant(size), at + Vec3(size, size, r.uniform(0.3, 2))});
  }
  return test::room({{0, 0, -1.5}, {20, 14, 2.5}}, rock);
}

/// Once around and 12 m on, at 2 m/s, with rounded corners.
Pose on_path(double t_s) {
  constexpr double kStraight[2] = {12, 6}, kRadius = 2;
  constexpr double kCorner = kRadius * std::numbers::pi / 2;
  double s = 2 * std::max(0.0, t_s - 0.5);
  Pose T{Vec3(4, 2, 0), Quat::Identity()};
  for (int side = 0;; side = (side + 1) % 4) {
    const double straight = kStraight[side % 2];
    if (s < straight) return T * Pose{Vec3(s, 0, 0), Quat::Identity()};
    s -= straight;
    T = T * Pose{Vec3(straight, 0, 0), Quat::Identity()};
    const double a = std::min(s, kCorner) / kRadius;
    const Pose turned{Vec3(kRadius * std::sin(a), kRadius * (1 - std::cos(a)), 0), from_heading(a)};
    if (s < kCorner) return T * turned;
    s -= kCorner;
    T = T * turned;
  }
}

constexpr std::size_t kScans = 310;

class WalkedCorridor : public SensorStream {
 public:
  explicit WalkedCorridor(std::size_t scans = kScans) : scans_(scans) {}
  TimeNs begin() const override { return 1000 * kSecond; }
  std::optional<std::size_t> scans() const override { return scans_; }
  std::optional<Sweep> next_sweep(ReadNotes& notes) override {
    if (next_ == scans_) return std::nullopt;
    static const test::World world = corridor();
    static const auto model = test::lidar(16, 240, 30);
    const TimeNs since = static_cast<TimeNs>(++next_) * 100 * kMillisecond;
    Sweep sweep = test::sweep_of(
        world, model, [](TimeNs t) { return on_path(seconds(t)); }, since, 0.01, next_);
    sweep.stamp = notes.stamp = begin() + since;
    return sweep;
  }
  bool has_imu() const override { return false; }
  std::optional<ImuSample> next_imu() override { return std::nullopt; }

 private:
  std::size_t scans_, next_ = 0;
};

ReplayOptions options_with(bool loops, int threads) {
  ReplayOptions o;
  o.loops = loops;
  o.loam.threads = threads;
  o.loop_closing.min_path_m = 25;
  return o;
}

ReplaySummary replayed(
    const fs::path& run, const ReplayOptions& options,
    const ReplayProgress& progress = [](std::size_t, const LoamPose&, const VoxelMap&) { return true; },
    std::size_t scans = kScans) {
  WalkedCorridor sensors(scans);
  return replay_recording(sensors, options, run, progress,
                          [=] { return std::make_unique<WalkedCorridor>(scans); });
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

double largest_error(const fs::path& trajectory) {
  std::vector<std::string> problems;
  const auto poses = evaluation::read_tum(trajectory, problems);
  EXPECT_EQ(poses.size(), kScans);
  const auto truth = [](double t_s) { return on_path(t_s - 1000); };
  const Pose T_truth_run = truth(poses.front().t_s) * poses.front().T_world_body.inverse();
  double most = 0;
  for (const auto& p : poses)
    most = std::max(most, ((T_truth_run * p.T_world_body).position - truth(p.t_s).position).norm());
  return most;
}

TEST(LoopReplay, ClosesTheLoopAndMapsAgain) {
  const TemporaryFolder folder("loop_replay");
  const fs::path with = folder.path() / "with", without = folder.path() / "without",
                 more = folder.path() / "more";
  const ReplaySummary s = replayed(with, options_with(true, 1));
  EXPECT_EQ(s.scans, kScans);
  EXPECT_EQ(s.lost, 0u) << s.last_problem;
  EXPECT_GE(s.loops.closed, 2u);
  EXPECT_TRUE(s.loops.mapped_again);
  // Both are compared from the first pose on, whose own small turn counts at the far end.
  EXPECT_LT(largest_error(with / "trajectory.tum"), 0.25);
  EXPECT_LT(largest_error(with / "trajectory.tum"), largest_error(with / "trajectory_odometry.tum") + 0.02);
  EXPECT_FALSE(fs::exists(with / "corrected.part"));
  std::ifstream lines(with / "loops.csv");
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) ++count;
  EXPECT_EQ(count, 1 + s.loops.closed + s.loops.unused);

  // The odometry is what it was without loops.
  const ReplaySummary plain = replayed(without, options_with(false, 1));
  EXPECT_EQ(plain.loops.submaps, 0u);
  EXPECT_EQ(bytes_of(with / "trajectory_odometry.tum"), bytes_of(without / "trajectory.tum"));
  EXPECT_NE(bytes_of(with / "trajectory.tum"), bytes_of(without / "trajectory.tum"));
  EXPECT_FALSE(fs::exists(without / "loops.csv"));

  replayed(more, options_with(true, 4));
  for (const char* same : {"trajectory.tum", "trajectory_odometry.tum", "map.ot", "map_growth.bin",
                           "telemetry.csv", "events.jsonl"})
    EXPECT_EQ(bytes_of(with / same), bytes_of(more / same)) << same;
}

TEST(LoopReplay, StoppedWhileItMapsAgainKeepsWhatItHad) {
  const TemporaryFolder folder("loop_replay");
  const fs::path run = folder.path() / "run";
  std::size_t calls = 0;
  const ReplaySummary s =
      replayed(run, options_with(true, 1),
               [&](std::size_t, const LoamPose&, const VoxelMap&) { return ++calls != kScans + 100; });
  EXPECT_EQ(s.scans, kScans);
  EXPECT_GE(s.loops.closed, 2u);
  EXPECT_FALSE(s.loops.mapped_again);
  EXPECT_FALSE(fs::exists(run / "corrected.part"));
  EXPECT_FALSE(fs::exists(run / "trajectory_odometry.tum"));
  EXPECT_TRUE(fs::exists(run / "map.ot"));
  EXPECT_LT(largest_error(run / "trajectory.tum"), 0.3);
}

TEST(LoopReplay, OfHalfTheWayAroundChangesNothing) {
  const TemporaryFolder folder("loop_replay");
  const fs::path with = folder.path() / "with", without = folder.path() / "without";
  const auto go_on = [](std::size_t, const LoamPose&, const VoxelMap&) { return true; };
  EXPECT_EQ(replayed(with, options_with(true, 1), go_on, 120).loops.closed, 0u);
  replayed(without, options_with(false, 1), go_on, 120);
  for (const char* same : {"trajectory.tum", "map.ot", "map_growth.bin", "telemetry.csv", "events.jsonl"})
    EXPECT_EQ(bytes_of(with / same), bytes_of(without / same)) << same;
  EXPECT_FALSE(fs::exists(with / "trajectory_odometry.tum"));
}

}  // namespace
}  // namespace karst::replay
