// A recorded scan, read as `karst replay` reads it, is the sweep of the flight.
#include "sdk/flight/recorded_scan.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "core_stack/common/format_text.h"
#include "core_stack/localization/sweep.h"
#include "plugins/replay/recording.h"
#include "tests/unit/replay/folder.h"

namespace karst::flight {
namespace {

using core::kMillisecond;
using core::LidarScan;

std::shared_ptr<core::LidarModel> small_lidar() {
  auto model = std::make_shared<core::LidarModel>();
  model->columns = 12;
  model->elevation_rad = {0.4f, 0.1f, -0.3f};
  model->azimuth_offset_rad = {0.0f, 0.02f, -0.02f};
  model->beam_origin_m = 0.03f;
  model->min_range_m = 0.1f;
  model->T_body_lidar = {
      {0.1, -0.02, 0.25},
      core::Quat(Eigen::AngleAxisd(0.7, core::Vec3::UnitZ()) * Eigen::AngleAxisd(-0.3, core::Vec3::UnitY()) *
                 Eigen::AngleAxisd(0.2, core::Vec3::UnitX()))};
  return model;
}

LidarScan scan_of(const std::shared_ptr<const core::LidarModel>& model, core::TimeNs stamp) {
  LidarScan scan{stamp, model, {}, {}};
  const int n = model->columns * model->channels();
  for (int i = 0; i < n; ++i) {
    scan.range_m.push_back(2.0f + 0.37f * static_cast<float>(i));
    scan.intensity.push_back(static_cast<float>(i) / static_cast<float>(n));
  }
  scan.range_m[3] = std::numeric_limits<float>::infinity();
  scan.range_m[7] = std::numeric_limits<float>::quiet_NaN();
  scan.range_m[11] = std::numeric_limits<float>::infinity();  // the last column of the first ring
  return scan;
}

void write(const test::Folder& folder, const LidarScan& scan) {
  folder.write("imu.csv", "t,ax,ay,az,wx,wy,wz\n");
  folder.write("recording.info", recording_info_of(*scan.model));
  folder.write(core::format_text("%015lld.pcd", static_cast<long long>(sweep_begin(scan))), pcd_of(scan));
}

void expect_same(const core::Sweep& a, const core::Sweep& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const core::SweepPoint &p = a.points[i], &q = b.points[i];
    EXPECT_EQ(p.ring, q.ring);
    EXPECT_EQ(p.intensity, q.intensity);
    EXPECT_LT((p.position - q.position).norm(), 1e-5f);  // rounded in another order
    const auto at = [i](const core::Sweep& s) {
      return core::seconds(s.stamp) + static_cast<double>(s.points[i].time_s);
    };
    EXPECT_NEAR(at(a), at(b), 1e-7);
  }
}

TEST(RecordedScan, ItsRangeIsSaidInTheFewestDigits) {
  const auto model = small_lidar();
  model->min_range_m = 0.3f;
  EXPECT_NE(recording_info_of(*model).find("min_range \"0.3 m\""), std::string::npos)
      << recording_info_of(*model);
}

TEST(RecordedScan, ReadBackIsTheSweepOfTheFlight) {
  const LidarScan scan = scan_of(small_lidar(), 1230 * kMillisecond);
  const test::Folder folder;
  write(folder, scan);
  const replay::Recording recording = replay::open_recording(folder.path(), "");
  ASSERT_EQ(recording.files.size(), 1u);
  EXPECT_EQ(recording.files[0].stamp, 1130 * kMillisecond);
  const core::Sweep read = replay::read_sweep(recording, 0), flown = core::to_sweep(scan, 0);
  EXPECT_EQ(read.points.size(), 33u);
  expect_same(read, flown);
  EXPECT_TRUE(read.T_body_lidar.position.isApprox(scan.model->T_body_lidar.position, 1e-8));
  EXPECT_LT(read.T_body_lidar.orientation.angularDistance(scan.model->T_body_lidar.orientation), 1e-8);
}

TEST(RecordedScan, AMountingThatLooksStraightDownIsKept) {
  auto model = small_lidar();
  model->T_body_lidar.orientation = core::Quat(Eigen::AngleAxisd(0.6, core::Vec3::UnitZ()) *
                                               Eigen::AngleAxisd(std::numbers::pi / 2, core::Vec3::UnitY()));
  const LidarScan scan = scan_of(model, 1000 * kMillisecond);
  const test::Folder folder;
  write(folder, scan);
  EXPECT_LT(replay::open_recording(folder.path(), "")
                .layout.T_body_lidar.orientation.angularDistance(model->T_body_lidar.orientation),
            1e-6);
}

LidarScan scan_without_rings() {
  auto model = std::make_shared<core::LidarModel>();
  model->elevation_rad = {0.5f, -0.1f};
  LidarScan scan{500 * kMillisecond, model, {1.0f, 2.0f}, {0.5f, 0.25f}};
  scan.time_s = {-0.05f, 0};
  scan.direction = {{1, 0, 0}, {0, 1, 0}};
  return scan;
}

TEST(RecordedScan, OfALidarWithoutRingsHasNoRings) {
  const LidarScan scan = scan_without_rings();
  const std::string file = pcd_of(scan);
  EXPECT_NE(file.find("FIELDS x y z intensity t\n"), std::string::npos) << file;
  const test::Folder folder;
  const replay::Scan read = replay::read_scan(folder.write("a.pcd", file));
  ASSERT_EQ(read.points.size(), 2u);
  EXPECT_EQ(read.points[1].position, core::Vec3f(0, 2, 0));
  EXPECT_NEAR(read.points[0].time, 50e6, 2);  // ns since the sweep began; floats give it
  EXPECT_NEAR(read.points[1].time, 100e6, 2);
}

TEST(RecordedScan, OfALidarWithoutRingsIsReadBackWithItsRecordingFile) {
  const LidarScan scan = scan_without_rings();
  const test::Folder folder;
  write(folder, scan);
  const core::Sweep read = replay::read_sweep(replay::open_recording(folder.path(), ""), 0);
  EXPECT_FALSE(read.has_rings);
  EXPECT_EQ(read.points.size(), 2u);
}

TEST(RecordedScan, AScanThatDoesNotFitItsModelIsNone) {
  LidarScan scan = scan_of(small_lidar(), 0);
  scan.range_m.pop_back();
  EXPECT_EQ(pcd_of(scan), "");
}

TEST(RecordedScan, WithoutAnyReturnIsAFileWithoutPoints) {
  LidarScan scan = scan_of(small_lidar(), 500 * kMillisecond);
  for (float& r : scan.range_m) r = std::numeric_limits<float>::infinity();
  const test::Folder folder;
  EXPECT_TRUE(replay::read_scan(folder.write("a.pcd", pcd_of(scan))).points.empty());
}

}  // namespace
}  // namespace karst::flight
