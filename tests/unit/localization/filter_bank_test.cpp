// The bank of filters against what sensors do to it: late, wrong, missing and contradicting measurements.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>

#include "core_stack/common/random.h"
#include "core_stack/common/so3.h"
#include "core_stack/localization/estimator.h"
#include "tests/unit/localization/closed_form_flight.h"

namespace karst::core {
namespace {

const Vec3 kEarthField(0, 20.5, -44.5);  // world: north and down, microtesla
constexpr TimeNs kPosePeriod = 100 * kMillisecond;

Vec3 gaussian(Random& r, double sigma) { return sigma * Vec3(r.normal(), r.normal(), r.normal()); }

Matrix6 spread(double position_m, double angle_rad) {
  Matrix6 c = Matrix6::Zero();
  c.diagonal() << Vec3::Constant(position_m * position_m), Vec3::Constant(angle_rad * angle_rad);
  return c;
}

/// Flies the closed form, with noise and biases; what a scenario changes of the measurements is its own.
struct Bench {
  Estimator e;
  Random random{11};
  TimeNs now = 0;
  std::function<bool(PoseMeasurement&)> pose = [](PoseMeasurement&) { return true; };  // false: does not come
  std::function<Vec3(double t)> field = [](double) { return kEarthField; };
  bool imu = true, biased = true;
  Vec3 gust_mps2 = Vec3::Zero(), rate_lag_radps = Vec3::Zero();  // that commands do not know of
  bool hovering = false;  // for ever: in motion, accelerations and positions tell the heading

  explicit Bench(const EstimatorOptions& o = {}) : e(o, {}) {}

  void run_until(
      double end_s, const std::function<void(double)>& look = [](double) {}) {
    for (; now <= from_seconds(end_s); now += kImuPeriod) {
      const double t = flight_time(now);
      const ImuSample truth{now, Flight::specific_force(t), Flight::body_rate(t)};
      ImuSample measured = truth;
      measured.specific_force_mps2 += gaussian(random, 0.05) + (biased ? kAccelBias : Vec3::Zero());
      measured.body_rate_radps += gaussian(random, 0.003) + (biased ? Vec3(0.1 * kGyroBias) : Vec3::Zero());
      if (imu) {
        e.on_imu(measured);
      } else if (now % (2 * kImuPeriod) == 0) {
        // Commands as a controller gives them: a little off.
        e.bridge({now, Vec3(0, 0, truth.specific_force_mps2.z() * 1.02) + gust_mps2,
                  truth.body_rate_radps + rate_lag_radps});
      }
      if (now % (20 * kMillisecond) == 0)
        e.on_magnetometer(
            {now, Flight::orientation(t).conjugate() * field(seconds(now)) + gaussian(random, 0.3)});
      const TimeNs old = now - 80 * kMillisecond;
      if (old >= 0 && old % kPosePeriod == 0) {
        const double s = flight_time(old);
        PoseMeasurement p{old,
                          {Flight::position(s) + gaussian(random, 0.01),
                           (Flight::orientation(s) * exp_so3(gaussian(random, 0.002))).normalized()},
                          spread(0.003, 0.001)};
        if (pose(p)) e.on_lidar_pose(p);
      }
      look(seconds(now));
    }
  }
  double flight_time(TimeNs t) const { return hovering ? 0 : seconds(t); }
  double position_error_m() const {
    return (e.state().position - Flight::position(flight_time(e.state().stamp))).norm();
  }
  double heading_error_rad() const {
    return std::abs(wrap_angle(heading_of(e.state().orientation) -
                               heading_of(Flight::orientation(flight_time(e.state().stamp)))));
  }
};

TEST(InertialFilter, ItsCovarianceIsWhatNoiseMakesOfManyFlights) {
  // Monte Carlo: four seconds on the IMU alone; start pose and biases are drawn as the filter supposes. (The
  // velocity is not: it starts at 0, which matters by 1 %.)
  InertialNoise noise;
  noise.accel_noise_mps2 = 0.2, noise.gyro_noise_radps = 0.1;
  constexpr int kRuns = 1500;
  Random r(3);
  Eigen::Matrix3d spread_p = Eigen::Matrix3d::Zero(), spread_a = Eigen::Matrix3d::Zero();
  Matrix15 said = Matrix15::Zero();
  const double end_s = 4;
  for (int run = 0; run < kRuns; ++run) {
    const Pose start{Flight::position(0) + gaussian(r, 0.05),
                     (Flight::orientation(0) * exp_so3(gaussian(r, 0.02))).normalized()};
    InertialFilter f(noise, start);
    const Vec3 accel_bias = gaussian(r, 0.2), gyro_bias = gaussian(r, 0.02);
    for (TimeNs t = 0; t <= from_seconds(end_s); t += kImuPeriod)
      f.on_imu({t, Flight::specific_force(seconds(t)) + gaussian(r, 0.2) + accel_bias,
                Flight::body_rate(seconds(t)) + gaussian(r, 0.1) + gyro_bias});
    const Vec3 dp = f.state().position - Flight::position(end_s);
    const Vec3 da = log_so3((f.state().orientation.conjugate() * Flight::orientation(end_s)).normalized());
    spread_p += dp * dp.transpose() / kRuns;
    spread_a += da * da.transpose() / kRuns;
    said += f.covariance() / kRuns;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::sqrt(spread_p(i, i) / said(i, i)), 1, 0.08) << "position " << i;
    EXPECT_NEAR(std::sqrt(spread_a(i, i) / said(6 + i, 6 + i)), 1, 0.08) << "attitude " << i;
  }
}

TEST(FilterBank, FollowsPosesOfALidarThatArriveLate) {
  Bench b;
  double worst_m = 0, worst_rad = 0;
  b.run_until(60, [&](double t) {
    if (t < 10) return;
    worst_m = std::max(worst_m, b.position_error_m());
    worst_rad = std::max(worst_rad, b.heading_error_rad());
  });
  EXPECT_LT(worst_m, 0.05);
  EXPECT_LT(worst_rad, 0.01);
  EXPECT_EQ(b.e.health(b.now), Health::good);
  EXPECT_EQ(b.e.believed(), Hypothesis::lidar);
}

TEST(FilterBank, ASinglePoseFarOffChangesNothing) {
  Bench b;
  b.pose = [](PoseMeasurement& p) {
    if (p.stamp == 20 * kSecond) p.T_world_body.position += Vec3(1, 0, 0);
    return true;
  };
  double worst_m = 0;
  b.run_until(25, [&](double t) { worst_m = t < 10 ? 0 : std::max(worst_m, b.position_error_m()); });
  EXPECT_LT(worst_m, 0.08);
  EXPECT_EQ(b.e.restarts(), 0);
}

TEST(FilterBank, ASecondWithoutPosesIsBridgedByTheImu) {
  Bench b;
  b.pose = [](PoseMeasurement& p) { return p.stamp < 20 * kSecond || p.stamp > 21 * kSecond; };
  double worst_m = 0;
  Health worst = Health::good;
  b.run_until(25, [&](double t) {
    if (t < 15) return;
    worst_m = std::max(worst_m, b.position_error_m());
    worst = std::max(worst, b.e.health(b.now));
  });
  EXPECT_LT(worst_m, 0.15);
  EXPECT_EQ(worst, Health::degraded);
  EXPECT_EQ(b.e.health(b.now), Health::good) << "again";
}

TEST(FilterBank, PosesThatStayElsewhereAreBelievedAfterASecondOrTwo) {
  Bench b;
  const Vec3 jump(3, 0, 0);
  b.pose = [&](PoseMeasurement& p) {
    if (p.stamp >= 20 * kSecond) p.T_world_body.position += jump;
    return true;
  };
  b.run_until(20.9);
  EXPECT_EQ(b.e.restarts(), 0);
  EXPECT_LT(b.position_error_m(), 0.2);
  b.run_until(25);
  EXPECT_EQ(b.e.restarts(), 1);
  EXPECT_LT((b.e.state().position - jump - Flight::position(25)).norm(), 0.1);
  EXPECT_EQ(b.e.health(b.now), Health::good);
}

TEST(FilterBank, PosesThatAgreeWithNothingAreNeverBelieved) {
  Bench b;
  Random r(5);
  b.pose = [&](PoseMeasurement& p) {
    if (p.stamp >= 20 * kSecond) p.T_world_body.position += gaussian(r, 5);
    return true;
  };
  bool degraded = false;
  b.run_until(21.9, [&](double) { degraded |= b.e.health(b.now) == Health::degraded; });
  EXPECT_TRUE(degraded);
  EXPECT_LT(b.position_error_m(), 0.5);
  EXPECT_EQ(b.e.restarts(), 0);
  b.run_until(24);
  EXPECT_EQ(b.e.health(b.now), Health::lost);
}

TEST(FilterBank, TheCompassHoldsTheHeadingThatTheLidarLeavesOpen) {
  // As in a round shaft: rotation about the vertical is free.
  const auto open_heading = [](PoseMeasurement& p) {
    if (p.stamp < 10 * kSecond) return true;
    const Vec3 up = p.T_world_body.orientation.conjugate() * Vec3::UnitZ();
    p.covariance.bottomRightCorner<3, 3>() += 1e4 * up * up.transpose();
    p.T_world_body.orientation = from_heading(0.5) * p.T_world_body.orientation;  // says nothing
    return true;
  };
  Bench with;
  with.pose = open_heading, with.hovering = true;
  with.run_until(200);
  EXPECT_EQ(with.e.believed(), Hypothesis::magnetic);
  EXPECT_LT(with.heading_error_rad(), 0.05);

  Bench without;
  without.pose = open_heading, without.hovering = true;
  without.field = [](double t) { return t < 10 ? kEarthField : Vec3(30, 5, -60); };
  without.run_until(200);
  EXPECT_EQ(without.e.believed(), Hypothesis::lidar) << "a field of another strength is not trusted";
  EXPECT_GT(without.heading_error_rad(), 0.0);
}

TEST(FilterBank, OreThatBendsTheFieldBySixtyDegreesDoesNotTurnTheHeading) {
  for (const double fraction : {1.0, 1.4}) {  // of the same strength, or stronger
    Bench b;
    b.field = [&](double t) -> Vec3 {
      const double bend = 1.05 * std::exp(-std::pow((t - 25) / 4, 2));
      return (1 + (fraction - 1) * bend) * (from_heading(bend) * kEarthField);
    };
    double worst_rad = 0;
    b.run_until(40, [&](double t) { worst_rad = t < 10 ? 0 : std::max(worst_rad, b.heading_error_rad()); });
    EXPECT_LT(worst_rad, 0.017) << fraction;
    EXPECT_LT(b.position_error_m(), 0.05);
  }
}

TEST(FilterBank, WithoutTheImuCommandsAndPosesCarryItForASecond) {
  Bench b;
  b.run_until(20);
  b.imu = false;
  double worst_m = 0;
  Health worst = Health::good;
  b.run_until(21, [&](double) {
    worst_m = std::max(worst_m, b.position_error_m());
    worst = std::max(worst, b.e.health(b.now));
  });
  EXPECT_EQ(worst, Health::degraded);
  b.imu = true;
  b.run_until(25);
  EXPECT_LT(worst_m, 0.2);
  EXPECT_LT(b.position_error_m(), 0.05);
  EXPECT_EQ(b.e.health(b.now), Health::good);
}

TEST(FilterBank, WithoutTheImuAGustAndATurnDoNotMakeItRefuseTheLidar) {
  Bench b;
  b.run_until(20);
  b.imu = false;
  b.gust_mps2 = {0.7, -0.3, 0};
  b.rate_lag_radps = {0.05, -0.05, 0.25};
  double worst_m = 0, refused_until_s = 0;
  const auto look = [&](double t_s) {
    worst_m = std::max(worst_m, b.position_error_m());
    if (b.e.diagnose(from_seconds(t_s)).reason == std::string("poses contradict the IMU"))
      refused_until_s = std::max(refused_until_s, t_s);
  };
  b.run_until(21, look);
  b.imu = true;
  b.run_until(23, look);
  EXPECT_LT(worst_m, 0.15);
  EXPECT_EQ(refused_until_s, 0) << "poses were refused for more than half a second";
  EXPECT_EQ(b.e.restarts(), 0);
  EXPECT_EQ(b.e.health(b.now - kImuPeriod), Health::good);
}

TEST(FilterBank, APositionThatOneDirectionLeavesOpenIsKnownEverWorse) {
  Bench b;
  b.biased = false;
  b.pose = [](PoseMeasurement& p) {
    if (p.stamp >= 20 * kSecond) p.covariance(0, 0) += 1e4;
    return true;
  };
  double degraded_s = 0, lost_s = 0;
  b.run_until(120, [&](double t) {
    const Health h = b.e.health(b.now);
    if (h != Health::good && degraded_s == 0 && t > 5) degraded_s = t;
    if (h == Health::lost && lost_s == 0 && t > 5) lost_s = t;
  });
  EXPECT_GT(degraded_s, 22);
  EXPECT_GT(lost_s, degraded_s);
}

TEST(Compass, KnowsTheHeadingOnceItHasLearntTheField) {
  Compass c;
  const auto measured = [](const Quat& q, const Vec3& field) {
    return MagnetometerSample{0, q.conjugate() * field};
  };
  EXPECT_FALSE(c.read(measured(Quat::Identity(), kEarthField), Quat::Identity()).valid);
  for (int i = 0; i < 30; ++i) c.learn(measured(from_heading(0.1 * i), kEarthField), from_heading(0.1 * i));
  const Quat tilt(Eigen::AngleAxisd(0.3, Vec3(1, 1, 0).normalized()));
  for (double heading = -3; heading < 3; heading += 0.5) {
    const Quat truth = from_heading(heading) * tilt, wrong = from_heading(heading + 0.7) * tilt;
    const Compass::Reading r = c.read(measured(truth, kEarthField), wrong);
    ASSERT_TRUE(r.valid);
    EXPECT_NEAR(wrap_angle(r.heading_rad - heading_of(truth)), 0, 1e-9) << "whatever heading was assumed";
  }
  EXPECT_FALSE(c.read(measured(Quat::Identity(), 1.2 * kEarthField), Quat::Identity()).valid);
  EXPECT_FALSE(c.read(measured(Quat::Identity(), Vec3(0, 40, -28)), Quat::Identity()).valid) << "its dip";
}

}  // namespace
}  // namespace karst::core
