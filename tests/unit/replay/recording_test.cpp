// Folders of scans: which files in which order, stamped when, and each as a sweep.
#include "plugins/replay/recording.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/common/error.h"
#include "plugins/replay/rings.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "tests/unit/replay/folder.h"

namespace karst::replay {
namespace {

using core::InputError;
using core::kSecond;
using test::Folder;
using test::put;

std::string xyz(const std::vector<std::array<float, 3>>& points) {
  std::string bytes;
  for (const auto& p : points)
    for (const float v : p) put(bytes, v);
  return bytes;
}
const std::string kOne = xyz({{1, 0, 0}, {0, 2, 0}});
constexpr const char* kPlain =
    "bin { fields \"x y z\" }\nrings { count 3 lowest \"-10 deg\" highest \"10 deg\" }\n";

std::string error_of(const Folder& dir) {
  try {
    const Recording r = open_recording(dir.path(), "");
    for (std::size_t i = 0; i < r.files.size(); ++i) read_sweep(r, i);
  } catch (const InputError& e) {
    return e.what();
  }
  return "read";
}
void expect_error(const Folder& dir, const std::string& file, const std::string& reason) {
  const std::string error = error_of(dir);
  EXPECT_NE(error.find(file), std::string::npos) << error;
  EXPECT_NE(error.find(reason), std::string::npos) << error;
}

TEST(Recording, TakesFilesInTheOrderOfTheirNumbersAndStampsThemByRate) {
  Folder dir;
  dir.write("recording.info",
            std::string(kPlain) + "scans \"scan_*.bin\"\nstamp { rate \"20 Hz\" of end }\n");
  for (const char* name : {"scan_10.bin", "scan_9.bin", "scan_100.bin", "other_1.bin", "scan_2.txt"})
    dir.write(name, kOne);
  const Recording r = open_recording(dir.path(), "");
  ASSERT_EQ(r.files.size(), 3u);
  EXPECT_EQ(r.files[0].path.filename(), "scan_9.bin");
  EXPECT_EQ(r.files[2].path.filename(), "scan_100.bin");
  EXPECT_EQ(r.files[2].stamp, kSecond / 10);
}

TEST(Recording, StampsOfNamesAndFilesKeepTheirNanoseconds) {
  Folder dir;
  dir.write("recording.info", std::string(kPlain) + "stamp { from names }\n");
  dir.write("s1647090478.710633039.bin", kOne);
  dir.write("s1647090478.810633040.bin", kOne);
  EXPECT_EQ(open_recording(dir.path(), "").files[1].stamp, 1647090478810633040);
  dir.write("times.txt", "# stamp\n1647090478710633039 a\n1647090478810633041 b\n");
  dir.write("recording.info", std::string(kPlain) + "stamp { from file file times.txt unit ns }\n");
  EXPECT_EQ(open_recording(dir.path(), "").files[1].stamp, 1647090478810633041);
  EXPECT_EQ(decimal_seconds(1647090478810633041), "1647090478.810633041");
  EXPECT_EQ(decimal_seconds(-1500000000), "-1.500000000");
}

TEST(Recording, PointTimesCountBackFromTheEndOfTheSweep) {
  Folder dir;
  dir.write("recording.info",
            std::string(kPlain) +
                "scans \"raw_*.bin\"\npoint_times { files \"times_*.bin\" }\nstamp { from names of start }\n"
                "lidar { position \"0 0 0.5\" rotation \"0 0 90\" }\n");
  dir.write("raw_7.bin", xyz({{1, 0, 0}, {0, 2, 0}, {0, 0, 0}, {-3, 0, 0}}));
  std::string times;
  for (const float t : {0.0f, 0.025f, 0.03f, 0.1f}) put(times, t);
  dir.write("times_7.bin", times);
  const Recording r = open_recording(dir.path(), "");
  ReadNotes notes;
  const core::Sweep sweep = read_sweep(r, 0, &notes);
  EXPECT_NEAR(core::seconds(sweep.stamp), 7.1, 1e-6);
  ASSERT_EQ(sweep.points.size(), 3u);
  EXPECT_EQ(notes.dropped, 1u) << "the point at the origin is no return";
  EXPECT_NEAR(sweep.points[0].time_s, -0.1, 1e-6);
  EXPECT_NEAR(sweep.points[1].time_s, -0.075, 1e-6);
  EXPECT_EQ(sweep.points[2].time_s, 0);
  EXPECT_FALSE(sweep.compensated);
  EXPECT_LT((sweep.T_body_lidar * core::Vec3(1, 0, 0) - core::Vec3(0, 1, 0.5)).norm(), 1e-12);
}

TEST(Recording, TimesAreWorkedOutFromTheTurnWhereThereAreNone) {
  Folder dir;
  dir.write("recording.info", std::string(kPlain) + "time { direction clockwise period \"200 ms\" }\n");
  dir.write("0.bin", xyz({{1, 0, 0}, {0, -1, 0}, {-1, 0, 0}, {0, 1, 0}}));
  const core::Sweep sweep = read_sweep(open_recording(dir.path(), ""), 0);
  ASSERT_EQ(sweep.points.size(), 4u);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(sweep.points[static_cast<std::size_t>(i)].time_s, 0.05 * (i - 3), 1e-6);
}

TEST(Recording, RingsByElevationAreTheNearestAndWhatIsFarFromAllIsLeftOut) {
  RecordingInfo info;
  info.rings = 5, info.lowest_rad = -0.2, info.highest_rad = 0.2;
  Scan scan;
  for (const double e : {0.21, 0.19, 0.06, 0.04, -0.14, -0.2, -0.29, -0.5, 0.9})
    scan.points.push_back(
        {core::Vec3f(static_cast<float>(10 * std::cos(e)), 0, static_cast<float>(10 * std::sin(e))), 0, 0,
         0});
  rings_by_elevation(scan, info);
  std::vector<int> rings;
  for (const ScanPoint& p : scan.points) rings.push_back(p.ring);
  EXPECT_EQ(rings, (std::vector<int>{0, 0, 1, 2, 3, 4, 4}));
}

TEST(Recording, RingsThatFollowEachOtherAreToldApartDespiteJitterAndGaps) {
  Scan scan;
  std::vector<int> truth;
  for (int ring = 0; ring < 8; ++ring)
    for (int i = 0; i < 360; ++i) {
      if (ring == 3 && i > 100 && i < 160) continue;  // nothing came back
      const double azimuth = (i + 0.6 * std::sin(40.0 * i + ring)) * std::numbers::pi / 180 + 0.01;
      scan.points.push_back({core::Vec3f(static_cast<float>(5 * std::cos(azimuth)),
                                         static_cast<float>(5 * std::sin(azimuth)), 0),
                             0, 0, 0});
      truth.push_back(ring);
    }
  rings_by_order(scan);
  int wrong = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) wrong += scan.points[i].ring != truth[i];
  EXPECT_LE(wrong, 8) << "one point a seam may fall to the neighbour";
}

TEST(Recording, SaysWhichFileOrKeyIsWrong) {
  Folder dir;
  expect_error(dir, dir.path().string(), "holds no scan");
  dir.write("0.bin", kOne);
  dir.write("recording.info", "bin { fields \"x y z\" }\n");
  expect_error(dir, "0.bin", "rings.count");
  dir.write("recording.info", std::string(kPlain) + "ring { count 4 }\n");
  expect_error(dir, "recording.info: ring.count", "did you mean rings.count");
  dir.write("recording.info", std::string(kPlain) + "stamp { rate fast }\n");
  expect_error(dir, "recording.info: stamp.rate", "got \"fast\"");
  dir.write("recording.info", std::string(kPlain) + "lidar { position \"1 2\" }\n");
  expect_error(dir, "recording.info: lidar.position", "three numbers");
  dir.write("recording.info", "bin { fields \"x y w\" }\n");
  expect_error(dir, "recording.info: bin.fields", "no field z");
  dir.write("recording.info", "bin { fields \"x y z\" types \"float32 float16 float32\" }\n");
  expect_error(dir, "recording.info: bin.types", "float16");
  dir.write("recording.info", std::string(kPlain) + "stamp { from file file times.txt }\n");
  expect_error(dir, "times.txt", "cannot be opened");
  dir.write("times.txt", "1\n2\n");
  expect_error(dir, "times.txt", "2 stamps for 1 scans");
  dir.write("times.txt", "soon\n");
  expect_error(dir, "times.txt: line 1", "got \"soon\"");
  dir.write("recording.info", std::string(kPlain) + "point_times { files \"t*.bin\" }\nscans \"*.bin\"\n");
  expect_error(dir, "point_times.files", "no file t0.bin for the scan 0.bin");
  dir.write("recording.info", std::string(kPlain) + "stamp { from names }\n");
  dir.write("a0.bin", kOne);
  expect_error(dir, "a0.bin", "not after that of the scan before it");
  dir.write("recording.info", "rings { by field }\nbin { fields \"x y z\" }\n");
  expect_error(dir, "0.bin", "no field with rings");
}

TEST(ImuFile, ReadsColumnsInAnyOrderTurnsThemAndNamesTheBadLine) {
  Folder dir;
  const std::string file = dir.write("imu.csv",
                                     "stamp,wx,wy,wz,ax,ay,az,temperature\n# a comment\n"
                                     "1000.5,0.1,0.2,0.3,1,2,3,20\n1001.25,0,0,0,0,0,9.81,20\n");
  ImuFile imu(file, "t wx wy wz ax ay az temperature", nanoseconds_of("ms"),
              core::from_heading(std::numbers::pi / 2));
  const auto first = imu.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp, 1000500000);
  EXPECT_LT((first->specific_force_mps2 - core::Vec3(-2, 1, 3)).norm(), 1e-12);
  EXPECT_LT((first->body_rate_radps - core::Vec3(-0.2, 0.1, 0.3)).norm(), 1e-12);
  EXPECT_TRUE(imu.next());
  EXPECT_FALSE(imu.next());
  for (const auto& [text, reason] : {std::pair{"1 2 3\n", "fewer columns"},
                                     {"1 2 3 4 5 6 nan\n", "is not the numbers"},
                                     {"2 0 0 0 0 0 0\n1 0 0 0 0 0 0\n", "line 2: goes back in time"}}) {
    ImuFile bad(dir.write("bad.txt", text), "t ax ay az wx wy wz", kSecond, core::Quat::Identity());
    try {
      while (bad.next()) continue;
      ADD_FAILURE() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(reason), std::string::npos) << e.what();
    }
  }
  EXPECT_THROW(ImuFile(file, "t ax ay az wx wy", kSecond, core::Quat::Identity()), InputError);
}

}  // namespace
}  // namespace karst::replay
