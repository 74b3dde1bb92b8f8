#include "core_stack/localization/estimator.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <deque>
#include <limits>

#include "core_stack/common/random.h"
#include "tests/unit/localization/closed_form_flight.h"

namespace karst::core {
namespace {

struct Scenario {
  double duration_s = 60;
  TimeNs pose_period = 25 * kMillisecond;
  TimeNs pose_delay = 50 * kMillisecond;
  double noise = 1;  // of all sensors, as a share of the usual
};

struct Errors {
  double position_rms_m = 0, velocity_rms_mps = 0, attitude_rms_rad = 0, worst_step_m = 0;
  double delayed_position_rms_m = 0;
};

/// Runs the flight's sensors through `e`; errors are those after ten seconds.
Errors run(Estimator& e, const Scenario& setup) {
  Random r(5);
  const auto noise = [&](double sigma) {
    return Vec3(setup.noise * sigma * Vec3(r.normal(), r.normal(), r.normal()));
  };
  std::deque<PoseSample> on_the_way;
  Errors out;
  int n = 0;
  Vec3 before = Vec3::Zero();
  for (TimeNs now = 0; now <= from_seconds(setup.duration_s); now += kImuPeriod) {
    const double t = seconds(now);
    while (!on_the_way.empty() && on_the_way.front().stamp + setup.pose_delay <= now) {
      e.on_pose(on_the_way.front());
      on_the_way.pop_front();
    }
    e.on_imu({now, Flight::specific_force(t) + kAccelBias + noise(0.05),
              Flight::body_rate(t) + kGyroBias + noise(0.005)});
    if (now % setup.pose_period == 0) {
      PoseSample p{now, {Flight::position(t) + noise(0.01), Flight::orientation(t)}};
      const Vec3 tilt = noise(0.0035);
      if (tilt.norm() > 0)
        p.T_world_body.orientation =
            p.T_world_body.orientation * Quat(Eigen::AngleAxisd(tilt.norm(), tilt.normalized()));
      on_the_way.push_back(p);
    }
    const State& s = e.state();
    if (now > 10 * kSecond) {
      out.position_rms_m += (s.position - Flight::position(t)).squaredNorm();
      out.velocity_rms_mps += (s.velocity_mps - Flight::velocity(t)).squaredNorm();
      out.attitude_rms_rad += std::pow(s.orientation.angularDistance(Flight::orientation(t)), 2);
      const Vec3 step = s.position - before - s.velocity_mps * seconds(kImuPeriod);
      out.worst_step_m = std::max(out.worst_step_m, step.norm());
      const TimeNs past = now - 200 * kMillisecond;
      out.delayed_position_rms_m +=
          (e.history().pose_at(past).position - Flight::position(seconds(past))).squaredNorm();
      ++n;
    }
    before = s.position;
  }
  out.position_rms_m = std::sqrt(out.position_rms_m / n);
  out.velocity_rms_mps = std::sqrt(out.velocity_rms_mps / n);
  out.attitude_rms_rad = std::sqrt(out.attitude_rms_rad / n);
  out.delayed_position_rms_m = std::sqrt(out.delayed_position_rms_m / n);
  return out;
}

TEST(Estimator, InFlightAtTwoMetresASecondItIsGoodToACentimetre) {
  Estimator e({}, {});
  const Errors err = run(e, {});
  std::printf("rms: position %.4f m, velocity %.4f m/s, attitude %.4f rad; worst jump of position %.4f m\n",
              err.position_rms_m, err.velocity_rms_mps, err.attitude_rms_rad, err.worst_step_m);
  EXPECT_LT(err.position_rms_m, 0.012);
  EXPECT_LT(err.velocity_rms_mps, 0.03);
  EXPECT_LT(err.attitude_rms_rad, 0.003);
  EXPECT_LT(err.worst_step_m, 0.008);  // a pose's correction, of 1 cm noise, does not kick the controller
  EXPECT_LT(err.delayed_position_rms_m, 0.012);
  EXPECT_EQ(e.health(from_seconds(60)), Health::good);
}

TEST(Estimator, HoldsAtTwentyPosesASecond) {
  Estimator e({}, {});
  Scenario s;
  s.pose_period = 50 * kMillisecond;
  const Errors err = run(e, s);
  EXPECT_LT(err.position_rms_m, 0.02);
  EXPECT_LT(err.velocity_rms_mps, 0.05);
}

TEST(Estimator, FindsTheBiases) {
  Estimator e({}, {});
  run(e, {});
  EXPECT_LT((e.active().accel_bias_mps2() - kAccelBias).norm(), 0.04);
  EXPECT_LT((e.active().gyro_bias_radps() - kGyroBias).norm(), 0.002);
}

TEST(Estimator, WithoutNoiseOnlyLearningTheBiasesCostsMillimetresAndDelayDoesNotMatter) {
  Scenario s;
  s.noise = 0;
  Estimator late({}, {}), prompt({}, {});
  EXPECT_LT(run(late, s).position_rms_m, 0.004);
  s.pose_delay = 0;
  EXPECT_LT(run(prompt, s).position_rms_m, 0.004);
}

TEST(Estimator, ACorrectionArrivingLateEqualsOneThatArrivedInTime) {
  // Same poses, one estimator told at once, the other 50 ms later: from then on their states agree.
  Estimator prompt({}, {}), late({}, {});
  const auto imu_at = [](TimeNs t) {
    return ImuSample{t, Flight::specific_force(seconds(t)) + kAccelBias, Flight::body_rate(seconds(t))};
  };
  for (TimeNs t = 0; t <= 4 * kSecond; t += kImuPeriod) {
    prompt.on_imu(imu_at(t));
    late.on_imu(imu_at(t));
    const auto pose = [](TimeNs stamp) {
      const double s = seconds(stamp);
      return PoseSample{stamp, {Flight::position(s) + Vec3(0.01, 0, 0), Flight::orientation(s)}};
    };
    if (t % (100 * kMillisecond) == 0) prompt.on_pose(pose(t));
    const TimeNs old = t - 50 * kMillisecond;
    if (old >= 0 && old % (100 * kMillisecond) == 0) {
      late.on_pose(pose(old));
      ASSERT_LT((prompt.state().position - late.state().position).norm(), 1e-9);
      ASSERT_LT((prompt.state().velocity_mps - late.state().velocity_mps).norm(), 1e-9);
      ASSERT_LT(prompt.state().orientation.angularDistance(late.state().orientation), 1e-7);
      ASSERT_LT(
          (prompt.history().states().front().position - late.history().states().front().position).norm(),
          1e-9);
    }
  }
}

TEST(Estimator, HistoryCoversTwoSecondsAtEveryImuSample) {
  Estimator e({}, {});
  Scenario s;
  s.duration_s = 5;
  run(e, s);
  const auto& states = e.history().states();
  EXPECT_GE(states.back().stamp - states.front().stamp, 2 * kSecond - kImuPeriod);
  for (std::size_t i = 1; i < states.size(); ++i)
    ASSERT_EQ(states[i].stamp - states[i - 1].stamp, kImuPeriod);
  EXPECT_EQ(states.back().position, e.state().position);
}

TEST(Estimator, HealthFollowsTheSilenceOfPoses) {
  EstimatorOptions o;
  o.pose_timeout_s = 0.5;
  Estimator e(o, {});
  TimeNs t = 0;
  for (; t <= kSecond; t += kImuPeriod) {
    e.on_imu({t, Vec3(0, 0, 9.81), Vec3::Zero()});
    if (t % (50 * kMillisecond) == 0) e.on_pose({t, {}});
  }
  const TimeNs last_pose = kSecond;
  EXPECT_EQ(e.health(last_pose + 400 * kMillisecond), Health::good);
  for (; t <= 4 * kSecond; t += kImuPeriod) {
    e.on_imu({t, Vec3(0, 0, 9.81), Vec3::Zero()});
    const Health expected = t - last_pose > 2 * kSecond          ? Health::lost
                            : t - last_pose > 500 * kMillisecond ? Health::degraded
                                                                 : Health::good;
    ASSERT_EQ(e.health(t), expected) << "at " << seconds(t);
  }
  e.on_pose({t - kImuPeriod, {}});
  EXPECT_EQ(e.health(t), Health::good);
}

TEST(Estimator, HealthFollowsTheSilenceOfTheImu) {
  Estimator e({}, {});
  for (TimeNs t = 0; t <= kSecond; t += kImuPeriod) e.on_imu({t, Vec3(0, 0, 9.81), Vec3::Zero()});
  e.on_pose({kSecond, {}});
  EXPECT_EQ(e.health(kSecond + 600 * kMillisecond), Health::degraded);
  EXPECT_EQ(e.health(kSecond + 2100 * kMillisecond), Health::lost);
}

// The link that carried the IMU was silent while the autopilot hovered: a barometer half a metre off then
// pulled the wide guess of the height, and with it the velocity, by 0.9 m/s; the next scan was fitted from
// there, and the vehicle touched rock.
TEST(Estimator, AfterASilenceInWhichAnotherSteeredTheBarometerDoesNotBecomeSpeed) {
  Estimator e({}, {});
  const Vec3 hover(0, 0, 9.81);
  const auto fly = [&](double from_s, double to_s, bool link, TimeNs delay, double height_m) {
    for (TimeNs now = from_seconds(from_s); now < from_seconds(to_s); now += kImuPeriod) {
      if (link)
        e.on_imu({now, hover, Vec3::Zero()});
      else if (now % (10 * kMillisecond) == 0)
        e.bridge({now, hover, Vec3::Zero()}, Estimator::Expected::another_steers);
      if (link && now % (50 * kMillisecond) == 0) e.on_barometer({now, height_m});
      if (now > delay && (now - delay) % (100 * kMillisecond) == 0)
        e.on_lidar_pose({now - delay, {}, 1e-5 * Matrix6::Identity()});
      if (from_s < 10) continue;
      EXPECT_LT(e.state().velocity_mps.norm(), 0.1) << seconds(now);
      EXPECT_LT(e.state().position.norm(), 0.02) << seconds(now);
    }
  };
  fly(0, 5, true, 60 * kMillisecond, 0);
  EXPECT_FALSE(e.guesses());
  fly(5, 10, false, 380 * kMillisecond, 0);
  EXPECT_TRUE(e.guesses());
  EXPECT_EQ(e.health(from_seconds(10)), Health::lost) << "no IMU";
  fly(10, 10.1, true, 60 * kMillisecond, -0.5);
  EXPECT_TRUE(e.guesses()) << "one pose after the silence does not tell the velocity";
  fly(10.1, 11, true, 60 * kMillisecond, -0.5);
  EXPECT_FALSE(e.guesses());
}

// The core stood still for a second, and its clock was set back: the stamps have no gap, but the vehicle has
// braked meanwhile. The way to the next pose, flown in 0.1 s, then became a speed of 4 m/s.
TEST(Estimator, WhatWasFlownUnseenDoesNotBecomeSpeed) {
  Estimator e({}, {});
  const Vec3 speed(0.8, -0.3, 0);
  TimeNs t = 0;
  const auto fly = [&](TimeNs until, const Vec3& from, const Vec3& velocity) {
    for (const TimeNs begin = t; t < until; t += kImuPeriod) {
      e.on_imu({t, Vec3(0, 0, 9.81), Vec3::Zero()});
      if (t % (100 * kMillisecond) == 0)
        e.on_lidar_pose(
            {t, {from + velocity * seconds(t - begin), Quat::Identity()}, 1e-5 * Matrix6::Identity()});
    }
  };
  fly(2 * kSecond, Vec3::Zero(), Vec3::Zero());
  e.on_imu({t, Vec3(0, 0, 9.81), Vec3::Zero()});
  const auto expect_found = [&](const Vec3& stopped) {
    EXPECT_TRUE(e.guesses());
    fly(t + 350 * kMillisecond, stopped, Vec3::Zero());
    EXPECT_FALSE(e.guesses());
    EXPECT_LT(e.state().velocity_mps.norm(), 0.1);
    EXPECT_LT((e.state().position - stopped).norm(), 0.02);
  };
  e.lose_track();
  expect_found(speed);
  t += kSecond;  // a clock was set: the stamps leap
  e.on_imu({t, Vec3(0, 0, 9.81), Vec3::Zero()});
  expect_found(2 * speed);
}

// As it was: the samples of the silence were dropped when they came, and what was predicted stayed.
TEST(Estimator, SamplesThatComeLateTakeThePlaceOfThePredictedOnes) {
  using Expected = Estimator::Expected;
  for (const Expected how : {Expected::as_commanded, Expected::another_steers}) {
    Estimator late({}, {}), in_time({}, {});
    const auto sample = [](TimeNs t) {
      return ImuSample{t, Vec3(0.5 * std::sin(seconds(t)), 0.3, 9.81), Vec3(0.1, -0.05, 0.2)};
    };
    TimeNs t = 0;
    for (; t <= kSecond; t += kImuPeriod) late.on_imu(sample(t)), in_time.on_imu(sample(t));
    const TimeNs silent_from = t, silent_to = t + 700 * kMillisecond;
    for (; t <= silent_to; t += kImuPeriod) {
      in_time.on_imu(sample(t));
      if (t > silent_from + 20 * kMillisecond && t % (10 * kMillisecond) == 0)
        late.bridge({t, Vec3(0, 0, 9.81), Vec3::Zero()}, how);
    }
    EXPECT_GT((late.state().velocity_mps - in_time.state().velocity_mps).norm(), 0.1);
    EXPECT_EQ(late.guesses(), how == Expected::another_steers);
    for (t = silent_from; t <= silent_to; t += kImuPeriod) late.on_imu(sample(t));
    EXPECT_EQ(late.state().position, in_time.state().position);
    EXPECT_EQ(late.state().velocity_mps, in_time.state().velocity_mps);
    EXPECT_EQ(late.active().covariance(), in_time.active().covariance());
    EXPECT_FALSE(late.guesses()) << "all was measured";
  }
}

// The vehicle's process stood still: its clock is set back, and the first samples have stamps of long ago.
TEST(Estimator, SamplesThatComeTooLateDoNotEndAGuess) {
  Estimator e({}, {});
  const Vec3 hover(0, 0, 9.81);
  TimeNs t = 0;
  for (; t <= kSecond; t += kImuPeriod) e.on_imu({t, hover, Vec3::Zero()});
  e.on_lidar_pose({kSecond, {}, 1e-5 * Matrix6::Identity()});
  const TimeNs silent_from = t;
  for (; t <= 3 * kSecond; t += kImuPeriod)
    e.bridge({t, hover, Vec3::Zero()}, Estimator::Expected::another_steers);
  for (TimeNs old = silent_from; old < silent_from + 80 * kMillisecond; old += kImuPeriod)
    e.on_imu({old, hover, Vec3::Zero()});
  EXPECT_TRUE(e.guesses());
  e.on_imu({t, hover, Vec3::Zero()});
  EXPECT_TRUE(e.guesses());
  EXPECT_EQ(e.track_lost_at(), t);
}

class AfterAGuess : public testing::Test {
 protected:
  void measure(TimeNs until) {
    for (; t < until; t += kImuPeriod) e.on_imu({t, kHover, Vec3::Zero()});
  }
  void guess(TimeNs until) {
    for (; t < until; t += kImuPeriod)
      e.bridge({t, kHover, Vec3::Zero()}, Estimator::Expected::another_steers);
  }
  bool locate() { return e.on_lidar_pose({t - kImuPeriod, {}, 1e-5 * Matrix6::Identity()}); }

  const Vec3 kHover{0, 0, 9.81};
  Estimator e{{}, {}};
  TimeNs t = 0;
};

TEST_F(AfterAGuess, SamplesThatComeLateButNotAllLeaveItAGuess) {
  measure(kSecond);
  locate();
  const TimeNs silent_from = t;
  guess(silent_from + 400 * kMillisecond);
  t = silent_from + 200 * kMillisecond;  // those before are lost
  measure(silent_from + 500 * kMillisecond);
  EXPECT_TRUE(e.guesses());
  locate();
  EXPECT_TRUE(e.guesses());
  measure(t + 100 * kMillisecond);
  locate();
  EXPECT_FALSE(e.guesses());
}

TEST_F(AfterAGuess, AShortSilenceDoesNotEndTheWaitForPoses) {
  measure(kSecond);
  locate();
  e.lose_track();
  const TimeNs silent_from = t;
  guess(silent_from + 30 * kMillisecond);
  t = silent_from;
  measure(silent_from + 60 * kMillisecond);  // all of it comes late
  EXPECT_TRUE(e.guesses());
}

TEST(Estimator, InputsThatAreNotFiniteAreIgnoredAndDegradeHealth) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Estimator e({}, {}), clean({}, {});
  TimeNs t = 0;
  const auto feed = [&](Estimator& to, TimeNs at) {
    to.on_imu({at, Vec3(0, 0, 9.81), Vec3(0.1, 0, 0)});
    to.on_pose({at, {Vec3(0.001, 0, 0), Quat::Identity()}});
  };
  for (; t <= kSecond; t += kImuPeriod) feed(e, t), feed(clean, t);
  e.on_imu({t, Vec3(nan, 0, 9.81), Vec3::Zero()});
  e.on_pose({t, {Vec3(0, nan, 0), Quat::Identity()}});
  e.on_pose({t, {Vec3::Zero(), Quat(0, 0, 0, 0)}});
  EXPECT_EQ(e.health(t), Health::degraded);
  feed(e, t), feed(clean, t);
  EXPECT_EQ(e.state().position, clean.state().position);
  EXPECT_EQ(e.state().orientation.coeffs(), clean.state().orientation.coeffs());
  EXPECT_EQ(clean.health(t), Health::good);
  const TimeNs later = t + 600 * kMillisecond;
  for (; t <= later; t += kImuPeriod) feed(e, t);
  EXPECT_EQ(e.health(t), Health::good);
}

TEST(Estimator, SamplesOutOfOrderChangeNothing) {
  Estimator e({}, {});
  for (TimeNs t = 0; t <= kSecond; t += kImuPeriod) e.on_imu({t, Vec3(0.2, 0, 9.81), Vec3::Zero()});
  e.on_pose({900 * kMillisecond, {}});
  const State before = e.state();
  e.on_imu({kSecond, Vec3(5, 5, 5), Vec3(1, 1, 1)});
  e.on_imu({500 * kMillisecond, Vec3(5, 5, 5), Vec3(1, 1, 1)});
  e.on_pose({800 * kMillisecond, {Vec3(9, 9, 9), Quat::Identity()}});
  e.on_magnetometer({kSecond, Vec3(20, 0, -40)});
  EXPECT_EQ(e.state().position, before.position);
  EXPECT_EQ(e.state().velocity_mps, before.velocity_mps);
}

TEST(Estimator, StartsAtTheDeclaredPose) {
  const Pose start{{3, -1, 2}, from_heading(0.7)};
  Estimator e({}, start);
  EXPECT_EQ(e.state().position, start.position);
  e.on_imu({kSecond, Vec3(0, 0, 9.81), Vec3::Zero()});
  EXPECT_EQ(e.state().position, start.position);
  EXPECT_EQ(e.state().stamp, kSecond);
  EXPECT_NEAR(heading_of(e.state().orientation), 0.7, 1e-12);
}

TEST(Estimator, ATurnOnATiltedMapCostsOneRestart) {
  // As it was in a shaft of the Jean-Bernard: the map had tilted slowly. The bias of the accelerometer
  // explained it, until the vehicle turned about: the bias turned with it. Each restart kept the bias, and
  // the next poses contradicted it again, until the vehicle had to land.
  Estimator e({}, {});
  double heading_rad = 0;
  int refused = 0, refused_late = 0;
  for (TimeNs now = 0; now <= 140 * kSecond; now += kImuPeriod) {
    const bool turns = now > 120 * kSecond && now <= 122 * kSecond;
    const double rate_radps = turns ? 0.5 * M_PI : 0;
    heading_rad += rate_radps * seconds(kImuPeriod);
    const Quat tilt(Eigen::AngleAxisd(0.05 * std::min(1.0, seconds(now) / 100), Vec3::UnitX()));
    const Quat upright(Eigen::AngleAxisd(heading_rad, Vec3::UnitZ()));
    e.on_imu({now, upright.conjugate() * Vec3(0, 0, 9.81), Vec3(0, 0, rate_radps)});
    if (now == 0 || now % (100 * kMillisecond) != 0) continue;
    if (e.on_lidar_pose({now, {Vec3::Zero(), tilt * upright}, 1e-6 * Matrix6::Identity()})) continue;
    ++refused;
    if (now > 126 * kSecond) ++refused_late;
  }
  EXPECT_LE(refused, 15) << "three until it is doubted, and ten until another filter has settled";
  EXPECT_EQ(refused_late, 0);
  EXPECT_EQ(e.diagnose(140 * kSecond).health, Health::good);
  EXPECT_LT(e.state().position.norm(), 0.1);
}

TEST(Estimator, ErrorsAgreeWithTheSteadyStateOfTheRiccatiEquation) {
  // Position, velocity and bias of one axis in discrete time: the covariance's fixed point, found by
  // iterating the equation written out here, predicts the spread of the position error when tilt is exact.
  EstimatorOptions o;
  o.imu.accel_noise_mps2 = 0.05;
  o.imu.accel_bias_drift_mps2 = 0.001;
  const double dt = 0.025, q = 0.05 * 0.05 / 200, b = 1e-6, R = 1e-4;
  Eigen::Matrix3d F, P = Eigen::Matrix3d::Identity();
  F << 1, dt, -dt * dt / 2, 0, 1, -dt, 0, 0, 1;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Q.topLeftCorner<2, 2>() << q * dt * dt * dt / 3, q * dt * dt / 2, q * dt * dt / 2, q * dt;
  Q(2, 2) = b * dt;
  for (int i = 0; i < 20000; ++i) {
    P = F * P * F.transpose() + Q;
    const Vec3 k = P.col(0) / (P(0, 0) + R);
    P = (Eigen::Matrix3d::Identity() - k * Vec3::UnitX().transpose()) * P;
  }
  Estimator e(o, {});
  Random r(9);
  double sum = 0;
  int n = 0;
  for (TimeNs t = 0; t <= 400 * kSecond; t += kImuPeriod) {
    e.on_imu({t, Vec3(0, 0, 9.81) + 0.05 * Vec3(r.normal(), r.normal(), r.normal()), Vec3::Zero()});
    if (t % (25 * kMillisecond) != 0) continue;
    e.on_pose({t, {0.01 * Vec3(r.normal(), r.normal(), r.normal()), Quat::Identity()}});
    if (t > 40 * kSecond) sum += e.state().position.squaredNorm() / 3, ++n;
  }
  EXPECT_NEAR(std::sqrt(sum / n) / std::sqrt(P(0, 0)), 1.0, 0.15);
}

}  // namespace
}  // namespace karst::core
