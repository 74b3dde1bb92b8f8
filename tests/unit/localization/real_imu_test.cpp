// The inertial filter on a recorded IMU with the poses of the same stretch (Newer College,
// ../shared/data/scans): poses come at 10 Hz and 100 ms late, as LOAM's do, and are withheld for a second now
// and then.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core_stack/common/so3.h"
#include "core_stack/localization/inertial_filter.h"

namespace {

using namespace karst::core;

struct Recording {
  std::vector<ImuSample> imu;
  std::vector<PoseMeasurement> poses;
};

/// The poses are of the IMU, in a world whose z axis points up.
Recording read_recording(const std::string& folder) {
  Recording r;
  std::ifstream imu(folder + "/imu.txt"), poses(folder + "/traj.txt");
  constexpr double kBegin_s = 1647090478;
  double t;
  Vec3 a, b;
  while (imu >> t >> a.x() >> a.y() >> a.z() >> b.x() >> b.y() >> b.z())
    r.imu.push_back({from_seconds(t - kBegin_s), a, b});
  Quat q;
  while (poses >> t >> a.x() >> a.y() >> a.z() >> q.x() >> q.y() >> q.z() >> q.w()) {
    PoseMeasurement p;
    p.stamp = from_seconds(t - kBegin_s), p.T_world_body = {a, q.normalized()};
    p.covariance.diagonal() << Vec3::Constant(1e-4), Vec3::Constant(1e-5);
    r.poses.push_back(p);
  }
  return r;
}

double middle_of(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

TEST(RealImu, BridgesASecondWithoutPosesBetterThanTheLastVelocityDoes) {
  const std::string folder = std::string(KARST_SOURCE_DIR) + "/../shared/data/scans/newer_college";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: no ../shared";
  const Recording r = read_recording(folder);
  ASSERT_GT(r.imu.size(), 23'000u);
  ASSERT_GT(r.poses.size(), 2'300u);

  constexpr TimeNs kLate = 100 * kMillisecond, kEvery = 4 * kSecond, kWithheld = kSecond;
  const TimeNs begin = r.imu.front().stamp;
  const auto withheld = [&](TimeNs t) { return (t - begin) % kEvery >= kEvery - kWithheld; };
  auto first = std::find_if(r.poses.begin(), r.poses.end(), [&](const auto& p) { return p.stamp >= begin; });
  InertialFilter filter({}, first->T_world_body);
  std::vector<double> bridged_m, bridged_rad, held_m, held_rad;
  auto due = first;
  for (const ImuSample& sample : r.imu) {
    filter.on_imu(sample);
    for (; due != r.poses.end() && due->stamp + kLate <= sample.stamp; ++due) {
      if (!withheld(due->stamp)) {
        EXPECT_EQ(filter.on_pose(*due, 6), InertialFilter::Verdict::accepted) << seconds(due->stamp);
        continue;
      }
      // The last one withheld, a second after the last that was taken in.
      if (due + 1 == r.poses.end() || withheld((due + 1)->stamp) || due - first < 20) continue;
      const Pose& truth = due->T_world_body;
      const Pose bridged = filter.history().pose_at(due->stamp);
      bridged_m.push_back((bridged.position - truth.position).norm());
      bridged_rad.push_back(bridged.orientation.angularDistance(truth.orientation));
      const auto last = due - 10;
      ASSERT_FALSE(withheld(last->stamp));
      const Pose step = (last - 1)->T_world_body.inverse() * last->T_world_body;
      const Vec3 velocity = last->T_world_body.position - (last - 1)->T_world_body.position;
      held_m.push_back((last->T_world_body.position + 10 * velocity - truth.position).norm());
      held_rad.push_back((last->T_world_body.orientation * exp_so3(10 * log_so3(step.orientation)))
                             .angularDistance(truth.orientation));
    }
  }
  ASSERT_GE(bridged_m.size(), 50u);
  std::printf(
      "after 1 s without poses (%zu times): IMU %.3f m, %.4f rad (worst %.3f m); last velocity %.3f m, %.4f "
      "rad\n",
      bridged_m.size(), middle_of(bridged_m), middle_of(bridged_rad),
      *std::max_element(bridged_m.begin(), bridged_m.end()), middle_of(held_m), middle_of(held_rad));
  EXPECT_LT(middle_of(bridged_m), 0.5 * middle_of(held_m));
  EXPECT_LT(middle_of(bridged_rad), 0.2 * middle_of(held_rad));
  EXPECT_LT(*std::max_element(bridged_m.begin(), bridged_m.end()), 0.05);
}

}  // namespace
