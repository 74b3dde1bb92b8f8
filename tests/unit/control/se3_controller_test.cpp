#include "core_stack/control/se3_controller.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/unit/control/quadrotor_model.h"

namespace karst::core::test {
namespace {

constexpr double kMass = 2.0, kMaxThrust = 45.0, kMaxRate = 6.0;
constexpr double kPhysicsStep = 0.001;
constexpr int kControlEvery = 10;

/// A smooth reference of up to 2 m/s and 1.6 m/s^2 in closed form, heading turning steadily.
Reference lissajous(double t) {
  const Vec3 size(2.6, 1.3, 0.4), w(0.6, 1.2, 0.9);
  Reference r;
  r.stamp = from_seconds(t);
  for (int i = 0; i < 3; ++i) {
    const double s = std::sin(w[i] * t), c = std::cos(w[i] * t);
    r.position[i] = size[i] * s;
    r.velocity_mps[i] = size[i] * w[i] * c;
    r.acceleration_mps2[i] = -size[i] * w[i] * w[i] * s;
    r.jerk_mps3[i] = -size[i] * w[i] * w[i] * w[i] * c;
  }
  r.heading_rate_radps = 0.5;
  r.heading_rad = wrap_angle(0.5 * t);
  return r;
}

struct Tracking {
  double rms_m = 0, worst_m = 0, heading_worst_rad = 0, mean_speed_mps = 0;
  Vec3 disturbance_mps2 = Vec3::Zero();
};

Tracking fly(QuadrotorModel quad, double duration_s, Reference (*reference)(double)) {
  Se3Controller controller({}, kMass, kMaxThrust, kMaxRate);
  const Reference start = reference(0);
  quad.state.position = start.position;
  quad.state.velocity_mps = start.velocity_mps;
  quad.state.orientation = from_heading(start.heading_rad);
  AttitudeRateCommand command;
  Tracking out;
  double sum = 0, speed = 0;
  int n = 0;
  for (int k = 0; k * kPhysicsStep < duration_s; ++k) {
    if (k % kControlEvery == 0) {
      const Reference r = reference(seconds(quad.state.stamp));
      command = controller.update(quad.state, r, kControlEvery * kPhysicsStep);
      if (quad.state.stamp > 5 * kSecond) {
        const double e = (r.position - quad.state.position).norm();
        sum += e * e, speed += r.velocity_mps.norm(), ++n;
        out.worst_m = std::max(out.worst_m, e);
        out.heading_worst_rad = std::max(
            out.heading_worst_rad, std::abs(wrap_angle(r.heading_rad - heading_of(quad.state.orientation))));
      }
    }
    quad.step(command, kPhysicsStep);
  }
  out.rms_m = std::sqrt(sum / n);
  out.mean_speed_mps = speed / n;
  out.disturbance_mps2 = controller.disturbance_mps2();
  return out;
}

Reference hover(double t) {
  Reference r;
  r.stamp = from_seconds(t);
  r.position = {1, -2, 3};
  r.heading_rad = 0.4;
  return r;
}

TEST(Se3Controller, AtRestOnTheReferenceItCommandsHover) {
  Se3Controller controller({}, kMass, kMaxThrust, kMaxRate);
  State s;
  s.orientation = from_heading(0.4);
  s.position = {1, -2, 3};
  const AttitudeRateCommand c = controller.update(s, hover(0), 0.01);
  EXPECT_NEAR(c.thrust_n, kMass * 9.81, 1e-9);
  EXPECT_LT(c.body_rate_radps.norm(), 1e-9);
  EXPECT_TRUE(c.armed);
}

TEST(Se3Controller, LeansTowardsTheReferenceAndTurnsToItsHeading) {
  Se3Controller controller({}, kMass, kMaxThrust, kMaxRate);
  State s;
  Reference r;
  r.position = {0.3, 0, 0};  // ahead: nose down is a positive rate about y (left)
  r.heading_rad = 0.3;       // to the left: positive about z
  const AttitudeRateCommand c = controller.update(s, r, 0.01);
  EXPECT_GT(c.body_rate_radps.y(), 0.5);
  EXPECT_GT(c.body_rate_radps.z(), 0.5);
}

TEST(Se3Controller, FollowsACurveInStillAirWithinFourCentimetres) {
  QuadrotorModel quad;
  const Tracking t = fly(quad, 40, lissajous);
  EXPECT_LT(t.rms_m, 0.04);
  EXPECT_LT(t.heading_worst_rad, 0.05);
  RecordProperty("rms_mm", static_cast<int>(1000 * t.rms_m));
}

TEST(Se3Controller, FollowsACurveInGustsWithinTenCentimetres) {
  QuadrotorModel quad;
  quad.gust_mps = 3;
  const Tracking t = fly(quad, 120, lissajous);
  EXPECT_LT(t.rms_m, 0.10);
  EXPECT_LT(t.worst_m, 0.30);
  RecordProperty("rms_mm", static_cast<int>(1000 * t.rms_m));
  std::printf("gusts of 3 m/s: tracking rms %.3f m, worst %.3f m, mean speed %.2f m/s\n", t.rms_m, t.worst_m,
              t.mean_speed_mps);
}

TEST(Se3Controller, RemovesTheErrorOfAConstantWindAndFindsIt) {
  QuadrotorModel quad;
  quad.steady_wind_mps = {4, -2, 0};
  const Tracking t = fly(quad, 30, hover);
  EXPECT_LT((t.disturbance_mps2 - quad.drag_per_s * quad.steady_wind_mps).norm(), 0.02);
  QuadrotorModel windless;
  EXPECT_LT(fly(windless, 30, hover).disturbance_mps2.norm(), 0.02);
}

TEST(Se3Controller, AForceFixedToTheBodyIsLearnedWhileTurning) {
  QuadrotorModel quad;
  quad.body_force_n = {0.8, 0, 0};
  const auto turning = [](double t) {
    Reference r = hover(t);
    r.heading_rate_radps = 0.5;
    r.heading_rad = wrap_angle(0.4 + 0.5 * t);
    return r;
  };
  EXPECT_LT(fly(quad, 40, turning).rms_m, 0.04);
}

TEST(Se3Controller, StaysStableWithTwiceTheLags) {
  QuadrotorModel quad;
  quad.rate_lag_s *= 2;
  quad.motor_lag_s *= 2;
  quad.gust_mps = 3;
  EXPECT_LT(fly(quad, 60, lissajous).worst_m, 0.6);
}

TEST(Se3Controller, FeedforwardRateIsTheDerivativeOfTheDesiredAttitude) {
  // With the state on the reference, the attitude error and the derivative come from finite differences: the
  // attitude that makes the command zero-error is found by integrating the command itself.
  Se3Options options;
  options.attitude_gain = 20;
  options.world_integral_gain = options.body_integral_gain = 0;
  Se3Controller controller(options, kMass, kMaxThrust, 50);
  State s;
  s.orientation = from_heading(0);
  const double dt = 1e-3;
  double worst = 0;
  for (int k = 0; k < 4000; ++k) {
    const Reference r = lissajous(k * dt);
    s.position = r.position;
    s.velocity_mps = r.velocity_mps;
    const Vec3 rate = controller.update(s, r, dt).body_rate_radps;
    s.orientation = s.orientation * Quat(Eigen::AngleAxisd(rate.norm() * dt, rate.normalized()));
    if (k < 1000) continue;
    const Vec3 z = (r.acceleration_mps2 + Vec3(0, 0, 9.81)).normalized();
    worst = std::max(worst, (s.orientation * Vec3::UnitZ() - z).norm());
    worst = std::max(worst, std::abs(wrap_angle(heading_of(s.orientation) - r.heading_rad)));
  }
  // Without feedforward the lag would be rate / gain, here 0.025 rad.
  EXPECT_LT(worst, 1e-3);
}

TEST(Se3Controller, ResetForgetsTheDisturbance) {
  Se3Controller controller({}, kMass, kMaxThrust, kMaxRate);
  State s;
  Reference r;
  r.position = {0.2, 0, 0};
  for (int i = 0; i < 200; ++i) controller.update(s, r, 0.01);
  EXPECT_GT(controller.disturbance_mps2().norm(), 0.1);
  controller.reset();
  EXPECT_EQ(controller.disturbance_mps2(), Vec3::Zero());
  Se3Controller fresh({}, kMass, kMaxThrust, kMaxRate);
  EXPECT_EQ(controller.update(s, r, 0.01).thrust_n, fresh.update(s, r, 0.01).thrust_n);
}

TEST(Se3Controller, DisturbanceIsBoundedAndNotWoundUpBehindALimit) {
  Se3Options options;
  Se3Controller controller(options, kMass, kMaxThrust, kMaxRate);
  State s;
  Reference r;
  r.position = {0.4, 0, 0};
  for (int i = 0; i < 2000; ++i) controller.update(s, r, 0.01);
  EXPECT_LT(controller.disturbance_mps2().norm(), 2 * options.max_disturbance_mps2 + 1e-9);
  Se3Controller far(options, kMass, kMaxThrust, kMaxRate);
  r.position = {50, 0, 0};  // tilt is at its limit at once: nothing may be learned in that direction
  for (int i = 0; i < 2000; ++i) far.update(s, r, 0.01);
  EXPECT_LT(far.disturbance_mps2().norm(), 1e-6);
}

RC_GTEST_PROP(Se3Controller, CommandsAreFiniteAndWithinLimits, (std::uint64_t seed)) {
  Random r(seed);
  const auto any = [&](double size) {
    return Vec3(r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size));
  };
  Se3Controller controller({}, kMass, kMaxThrust, kMaxRate);
  for (int i = 0; i < 20; ++i) {
    State s;
    s.position = any(100);
    s.velocity_mps = any(20);
    s.orientation = Quat(r.normal(), r.normal(), r.normal(), r.normal()).normalized();
    Reference ref;
    ref.acceleration_mps2 = any(5);
    ref.jerk_mps3 = any(20);
    ref.heading_rad = r.uniform(-3.2, 3.2);
    const AttitudeRateCommand c = controller.update(s, ref, 0.01);
    RC_ASSERT(c.body_rate_radps.allFinite());
    RC_ASSERT(c.body_rate_radps.norm() <= kMaxRate + 1e-9);
    RC_ASSERT(c.thrust_n >= 0.0);
    RC_ASSERT(c.thrust_n <= kMaxThrust);
  }
}

RC_GTEST_PROP(LimitedForce, KeepsTiltAndThrustAndTheVerticalFirst, (std::uint64_t seed)) {
  Random r(seed);
  const Vec3 wanted(r.uniform(-40, 40), r.uniform(-40, 40), r.uniform(-30, 60));
  const double tilt = r.uniform(0.1, 1.0), most = r.uniform(12, 40);
  const Vec3 f = limited_force(wanted, tilt, most);
  RC_ASSERT(f.norm() <= most + 1e-9);
  RC_ASSERT(std::hypot(f.x(), f.y()) <= f.z() * std::tan(tilt) + 1e-9);
  RC_ASSERT(f.z() > 0);
  if (wanted.z() > 2 && wanted.z() < most) RC_ASSERT(f.z() == wanted.z());
  RC_ASSERT(f.x() * wanted.y() - f.y() * wanted.x() < 1e-6);
  if (wanted.norm() < most && wanted.z() > 2 &&
      std::hypot(wanted.x(), wanted.y()) < wanted.z() * std::tan(tilt))
    RC_ASSERT((f - wanted).norm() < 1e-12);
}

}  // namespace
}  // namespace karst::core::test
