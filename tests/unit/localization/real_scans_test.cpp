// LOAM on scans of real sensors (../shared/data/scans). What can be asked of each is in docs/localization.md.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core_stack/localization/loam.h"
#include "tests/unit/localization/worlds.h"

namespace {

using namespace karst::core;
using namespace karst::test;

class RealScans : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << "skipped: no ../shared";
  }
  std::string folder_ = std::string(KARST_SOURCE_DIR) + "/../shared/data/scans";
};

std::vector<float> floats_of(const std::string& bytes) {
  std::vector<float> out(bytes.size() / sizeof(float));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(float));
  return out;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Points of a binary file after a text header that ends with `last_line`; x y z come first of `fields`
/// floats.
std::vector<Vec3f> points_after(const std::string& path, const std::string& last_line, std::size_t fields) {
  const std::string file = read_file(path);
  const std::vector<float> values = floats_of(file.substr(file.find(last_line) + last_line.size()));
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i + fields <= values.size(); i += fields)
    points.emplace_back(values[i], values[i + 1], values[i + 2]);
  return points;
}

/// Rings where a file has none: points within the same step of elevation, by azimuth.
std::vector<SweepPoint> by_elevation(const std::vector<Vec3f>& points, double step_rad,
                                     const std::vector<float>& time_s = {}) {
  std::map<int, std::vector<std::pair<float, SweepPoint>>> rings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f& p = points[i];
    const int ring = static_cast<int>(std::floor(std::atan2(p.z(), p.head<2>().norm()) / step_rad));
    const float time = time_s.empty() ? 0.0f : time_s[i];
    rings[ring].push_back({-std::atan2(p.y(), p.x()), {p, time, static_cast<std::uint16_t>(ring + 1000), 0}});
  }
  std::vector<SweepPoint> out;
  for (auto& [ring, of_ring] : rings) {
    std::sort(of_ring.begin(), of_ring.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [azimuth, p] : of_ring) out.push_back(p);
  }
  return out;
}

/// Rings of a Velodyne whose lasers follow one another in the file: a new one begins where the azimuth, which
/// runs through a turn, comes back to where it began.
std::vector<SweepPoint> by_laser(const std::vector<Vec3f>& points) {
  std::vector<SweepPoint> out;
  std::uint16_t ring = 0;
  double last = 0;
  for (const Vec3f& p : points) {
    double azimuth = std::atan2(p.y(), p.x());
    if (azimuth < 0) azimuth += 2 * std::numbers::pi;
    if (!out.empty() && azimuth < last - std::numbers::pi) ++ring;
    last = azimuth;
    out.push_back({p, 0, ring, 0});
  }
  return out;
}

TEST_F(RealScans, Kitti) {
  Loam loam({}, {});
  LoamPose pose;
  for (int i = 0; i < 16; ++i) {
    std::ostringstream name;
    name << folder_ << "/kitti00/0000" << (i < 10 ? "0" : "") << i << ".pcd";
    Sweep sweep;
    sweep.stamp = (i + 1) * 100 * kMillisecond;
    sweep.compensated = true;
    sweep.points = by_laser(points_after(name.str(), "DATA binary\n", 8));
    pose = loam.process(sweep, StateHistory{});
    ASSERT_TRUE(pose.valid) << i << ": " << pose.problem;
    EXPECT_EQ(pose.free_directions, 0);
  }
  // The camera's x, y, z are right, down, forward. ORB-SLAM2 and S-PTAM differ by 0.26 m.
  const Vec3 orb(11.598, 0.435, 0.102), sptam(11.858, 0.450, 0.087);
  std::printf("frame 15: %.3f %.3f %.3f m; to ORB-SLAM2 %.3f m, to S-PTAM %.3f m\n",
              pose.T_world_body.position.x(), pose.T_world_body.position.y(), pose.T_world_body.position.z(),
              (pose.T_world_body.position - orb).norm(), (pose.T_world_body.position - sptam).norm());
  EXPECT_LT((pose.T_world_body.position - 0.5 * (orb + sptam)).norm(), 0.25);
}

TEST_F(RealScans, PairOfSmallGicp) {
  Loam loam({}, {});
  LoamPose pose;
  for (const char* name : {"target", "source"}) {
    Sweep sweep;
    sweep.stamp = name[0] == 't' ? kSecond : 2 * kSecond;
    sweep.compensated = true;
    sweep.points =
        by_elevation(points_after(folder_ + "/small_gicp_pair/" + name + ".ply", "end_header\n", 4), 0.0072);
    pose = loam.process(sweep, StateHistory{});
    ASSERT_TRUE(pose.valid) << pose.problem;
  }
  std::ifstream in(folder_ + "/small_gicp_pair/T_target_source.txt");
  Eigen::Matrix4d T;
  for (int i = 0; i < 16; ++i) in >> T(i / 4, i % 4);
  const PoseError e = error_between(
      pose.T_world_body, {T.topRightCorner<3, 1>(), Quat(Eigen::Matrix3d(T.topLeftCorner<3, 3>()))});
  std::printf("to the given transform: %.4f m, %.4f rad\n", e.position_m, e.angle_rad);
  EXPECT_LT(e.position_m, 0.05);
  EXPECT_LT(e.angle_rad, 0.01);
}

/// The rigid transform that takes points `b` to points `a` (Kabsch).
Pose aligned(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  Eigen::Matrix3Xd A(3, a.size()), B(3, b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    A.col(static_cast<Eigen::Index>(i)) = a[i], B.col(static_cast<Eigen::Index>(i)) = b[i];
  const Eigen::Matrix4d T = Eigen::umeyama(B, A, false);
  return {T.topRightCorner<3, 1>(), Quat(Eigen::Matrix3d(T.topLeftCorner<3, 3>()))};
}

/// Neither an IMU nor stamps belong to these scans, so the prediction is a motion at constant rates to where
/// the data set puts the points of the last 2 ms. All others, compensated with it, have to be where it puts
/// them; and LOAM must say that the sweep, seen so, fits the deskewed cloud where it is.
TEST_F(RealScans, NewerCollegeDeskewed) {
  for (const char* number : {"00", "01", "02"}) {
    const auto file = [&](const char* kind) {
      return floats_of(read_file(folder_ + "/newer_college/" + kind + "_" + number + ".bin"));
    };
    const std::vector<float> raw = file("raw"), deskewed = file("deskewed"), times = file("times");
    const float length_s = *std::max_element(times.begin(), times.end());
    std::vector<Vec3f> raw_points, deskewed_points;
    std::vector<float> before_end;
    std::array<std::vector<Vec3>, 2> raw_of, deskewed_of;  // the first and the last 2 ms
    for (std::size_t i = 0; i < times.size(); ++i) {
      raw_points.emplace_back(raw[3 * i], raw[3 * i + 1], raw[3 * i + 2]);
      deskewed_points.emplace_back(deskewed[3 * i], deskewed[3 * i + 1], deskewed[3 * i + 2]);
      before_end.push_back(times[i] - length_s);
      for (const std::size_t end : {0, 1})
        if (end == 0 ? times[i] < 0.002f : before_end[i] > -0.002f)
          raw_of[end].push_back(raw_points[i].cast<double>()),
              deskewed_of[end].push_back(deskewed_points[i].cast<double>());
    }
    Sweep sweep;
    sweep.T_body_lidar = aligned(deskewed_of[0], raw_of[0]);
    const Pose T_start_end = aligned(deskewed_of[1], raw_of[1]) * sweep.T_body_lidar.inverse();
    const Twist twist = twist_between({}, T_start_end, static_cast<double>(length_s));
    const SweepMotion motion(static_cast<double>(length_s), sweep.T_body_lidar,
                             [&](double t) { return pose_after(twist, t); });
    double before = 0, after = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const Vec3 truth = deskewed_points[i].cast<double>();
      before += (sweep.T_body_lidar * raw_points[i].cast<double>() - truth).squaredNorm();
      after += (T_start_end * motion.to_body_at_end(raw_points[i], before_end[i]).cast<double>() - truth)
                   .squaredNorm();
    }

    Loam loam({}, {});
    Sweep map;
    map.stamp = kSecond;
    map.compensated = true;
    map.points = by_elevation(deskewed_points, 0.0092);
    ASSERT_TRUE(loam.process(map, StateHistory{}).valid);
    sweep.stamp = kSecond + from_seconds(static_cast<double>(length_s));
    sweep.points = by_elevation(raw_points, 0.0092, before_end);
    const Motion predicted = [&](TimeNs t) {
      return T_start_end * pose_after(twist, seconds(t - sweep.stamp));
    };
    const LoamPose pose = loam.process(sweep, states_of(predicted, sweep.stamp));
    EXPECT_TRUE(pose.valid) << pose.problem;
    const PoseError e = error_between(pose.T_world_body, T_start_end);
    const double n = static_cast<double>(times.size());
    std::printf(
        "%s: turned %.2f deg; rms to the deskewed points %.3f m raw, %.3f m compensated; pose off by %.4f m, "
        "%.4f rad\n",
        number, log_so3(T_start_end.orientation).norm() * 180 / std::numbers::pi, std::sqrt(before / n),
        std::sqrt(after / n), e.position_m, e.angle_rad);
    EXPECT_LT(after, before / 80);  // the true rates are not quite constant
    EXPECT_LT(e.position_m, 0.15);
    EXPECT_LT(e.angle_rad, 0.01);
  }
}

}  // namespace
