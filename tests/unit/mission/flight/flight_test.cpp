#include "core_stack/mission/flight/flight.h"

#include <gtest/gtest.h>

#include "core_stack/mission/flight/route.h"
#include "tests/unit/mission/drawn_map.h"
#include "tests/unit/planning/oracles.h"

namespace karst::core {
namespace {

/// A vehicle that is always where its reference says: enough for the bookkeeping of trajectories.
struct IdealFlight {
  VehicleDescription vehicle;
  Flight flight{CoreOptions{}, vehicle};
  TimeNs now = 0;

  void advance(double s) {
    for (const TimeNs end = now + from_seconds(s); now < end;) {
      now += 10 * kMillisecond;
      flight.control(now);
    }
  }
  /// For `s` seconds, along a line of 20 m. Where it set out.
  Vec3 fly_ahead(double s) {
    const Vec3 from = flight.reference().position;
    HeadingPlan heading;
    heading.along_path = false;
    flight.follow({.points = {from, from + Vec3(20, 0, 0)}, .start = now, .heading = heading});
    advance(s);
    return from;
  }
};

TEST(Flight, IsDisarmedUntilItClimbs) {
  IdealFlight f;
  EXPECT_FALSE(f.flight.control(10 * kMillisecond).rates.armed);
  f.flight.climb(10 * kMillisecond, 1.0, 0.5);
  EXPECT_TRUE(f.flight.control(20 * kMillisecond).rates.armed);
  f.flight.disarm();
  EXPECT_FALSE(f.flight.control(30 * kMillisecond).rates.armed);
}

// The core's own thrust was taken for flown although the autopilot flew the reference: in a second the mass
// went from 2 to 2.7 kg.
TEST(Flight, WhoFliesTheReferenceTeachesNoMass) {
  for (const bool takes_reference : {false, true}) {
    VehicleDescription vehicle;
    vehicle.takes_reference = takes_reference;
    Flight flight{CoreOptions{}, vehicle};
    const auto hover = [&](TimeNs now) { flight.on_imu({now, Vec3(0, 0, 7), Vec3::Zero()}, now); };
    hover(0);
    flight.climb(0, 1.0, 0.5);
    for (TimeNs now = 5 * kMillisecond; now < 4 * kSecond; now += 5 * kMillisecond) {
      hover(now);
      flight.on_pose({now, {Vec3(0, 0, 0.5), Quat::Identity()}});
      if (now % (10 * kMillisecond) == 0) flight.control(now);
    }
    if (takes_reference)
      EXPECT_EQ(flight.mass_kg(), vehicle.mass_kg);
    else
      EXPECT_GT(std::abs(flight.mass_kg() - vehicle.mass_kg), 0.1);
  }
}

TEST(Flight, MotorsThatWereSwitchedOffStayOff) {
  IdealFlight f;
  f.flight.climb(0, 1.0, 0.5);
  f.advance(3);
  f.flight.disarm();
  f.flight.climb(f.now, 1.0, 0.5);
  f.flight.follow({.points = {Vec3::Zero(), Vec3(5, 0, 0)}, .start = f.now});
  f.flight.land_now(f.now);
  EXPECT_FALSE(f.flight.control(f.now + 10 * kMillisecond).rates.armed);
  EXPECT_FALSE(f.flight.airborne());
}

TEST(Flight, LandsAtOnceWhateverElseItIsTold) {
  IdealFlight f;
  f.flight.climb(0, 2.0, 0.5);
  f.advance(6);
  const Vec3 from = f.fly_ahead(4);
  const Vec3 at = f.flight.reference().position;
  const double speed = f.flight.reference().velocity_mps.norm();
  ASSERT_GT(speed, 1.5);
  f.flight.land_now(f.now);
  f.flight.follow({.points = {at, at + Vec3(0, 20, 0)}, .start = f.now});
  f.advance(1);
  f.flight.brake(f.now);
  f.flight.cap_speed(f.now, 0.5);
  f.flight.climb(f.now, 5, 0.5);
  f.advance(4);
  const Vec3 end = f.flight.reference().position;
  EXPECT_LT(end.x() - at.x(), speed * speed / MotionLimits{}.max_acceleration_mps2 + 0.5);
  EXPECT_NEAR(end.y(), from.y(), 0.02);
  EXPECT_NEAR(f.flight.reference().velocity_mps.z(), -MissionOptions{}.landing_speed_mps, 0.02);
  EXPECT_LT(end.z(), at.z() - 0.8);
}

TEST(Flight, ThatBreaksOffItsLandingHoversWhereThePoseFoundAgainSaysNotWhereTheReferenceWas) {
  // As it was: the reference stayed in the column that the vehicle was to come down in by the pose that had
  // drifted away by half a metre, and the vehicle shot there, through what was between.
  IdealFlight f;
  f.flight.climb(0, 2.0, 0.5);
  f.advance(6);
  f.flight.land_now(f.now);
  f.advance(3);
  ASSERT_LT(f.flight.reference().velocity_mps.z(), -0.2);
  const Vec3 found(0.5, -0.3, 1.2);
  for (int i = 0; i < 100; ++i) {
    f.now += 10 * kMillisecond;
    f.flight.on_imu({f.now, Vec3(0, 0, 9.81), Vec3::Zero()}, f.now);
    PoseSample pose;
    pose.stamp = f.now;
    pose.T_world_body.position = found;
    f.flight.on_pose(pose);
  }
  f.flight.hover_here(f.now);
  const Vec3 here = f.flight.state().position;
  EXPECT_LT((here - found).norm(), 0.1);
  EXPECT_TRUE(f.flight.at_rest(f.now));
  f.advance(1);
  EXPECT_LT((f.flight.reference().position - here).norm(), 1e-6);

  f.flight.follow({.points = {here, here + Vec3(3, 0, 0)}, .start = f.now});
  f.advance(1);
  EXPECT_GT(f.flight.reference().velocity_mps.x(), 0.5) << "it does as it is told again";
  const double height_m = f.flight.reference().position.z();
  f.flight.land_now(f.now);
  f.advance(4);
  EXPECT_LT(f.flight.reference().position.z(), height_m - 0.5) << "and may land a second time";
}

TEST(Flight, ClimbsToTheHeightAndRests) {
  IdealFlight f;
  f.flight.climb(0, 1.0, 0.5);
  f.advance(6);
  EXPECT_TRUE(f.flight.at_rest(f.now));
  EXPECT_NEAR(f.flight.reference().position.z(), 1.0, 0.02);
}

TEST(Flight, BrakesOnThePathAndWithinTheStoppingDistance) {
  IdealFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(4);
  const Vec3 from = f.fly_ahead(5);
  const Vec3 at_brake = f.flight.reference().position;
  const double speed = f.flight.reference().velocity_mps.norm();
  ASSERT_GT(speed, 1.5);
  f.flight.brake(f.now);
  f.advance(5);
  const Vec3 stop = f.flight.reference().position;
  const double limit = MotionLimits{}.max_acceleration_mps2;
  EXPECT_LT((stop - at_brake).norm(), speed * speed / limit + 0.5);
  EXPECT_NEAR(stop.y(), from.y(), 0.02);
  EXPECT_NEAR(f.flight.reference().velocity_mps.norm(), 0, 0.02);
}

TEST(Flight, TheStretchUntilStopBeginsWhereTheReferenceWillBe) {
  IdealFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(4);
  const Vec3 from = f.fly_ahead(4);
  const Flight::CommittedSegment ahead = f.flight.until_stop(f.now + 300 * kMillisecond);
  const Flight::CommittedSegment all = f.flight.until_end(f.now + 300 * kMillisecond);
  f.advance(0.3);
  EXPECT_LT((f.flight.reference().position - ahead.points.front()).norm(), 0.25) << "tracking lag only";
  EXPECT_NEAR((all.points.back() - from).norm(), 20, 1e-6);
  const double committed = (ahead.points.back() - ahead.points.front()).norm();
  EXPECT_GT(committed, ahead.speed_mps * ahead.speed_mps / (2 * MotionLimits{}.max_acceleration_mps2));
}

/// Flies ahead from rest for a while, then turns off by `turn_rad` as far ahead as it could stop: how far the
/// reference strays from the joined path, m.
double strays_m(const VoxelMap& free, double turn_rad, double after_s) {
  IdealFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(4);
  f.fly_ahead(after_s);
  const RouteStart start{
      .at = f.now, .committed = f.flight.until_stop(f.now), .limits = f.flight.limits(), .narrow_places = {}};
  Path path;
  const Vec3 corner = start.committed.points.back(), away(std::cos(turn_rad), 0, std::sin(turn_rad));
  for (double s = 0; s < 4; s += 0.1) path.points.push_back(corner + s * away);
  const Route route = make_route(free, CoreOptions{}, f.vehicle, start, path, std::nullopt);
  EXPECT_LT(start.committed.speed_mps, 1.06 * greatest_start_speed_mps(route.points, start.limits));
  f.flight.follow({.points = route.points,
                   .start_speed_mps = route.start_speed_mps,
                   .start = f.now,
                   .heading = route.heading});
  double most = 0;
  for (int i = 0; i < 60; ++i) {
    f.advance(0.1);
    most = std::max(most, testing::distance_to_path(route.points, f.flight.reference().position));
  }
  return most;
}

TEST(Flight, TurningBackAtSpeedTheReferenceStaysOnThePath) {
  // As it was: the parabola turned 0.3 m before the vehicle could stop, and where it could stop left the jerk
  // out. The reference left the path, and one of 20 flights touched rock.
  VoxelMap free({});
  carve_box(free, {-5, -2, -5}, {14, 2, 6});
  for (const double turn_rad : {1.6, 2.0, 2.4, 2.8, 3.0, 3.14})
    for (const double after_s : {0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 2.0, 4.0})
      EXPECT_LT(strays_m(free, turn_rad, after_s), 0.12) << turn_rad << " rad after " << after_s << " s";
}

TEST(Flight, ACapOnSpeedHoldsUntilItIsLifted) {
  IdealFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(4);
  const Vec3 from = f.flight.reference().position;
  HeadingPlan heading;
  heading.along_path = false;
  f.flight.follow({.points = {from, from + Vec3(30, 0, 0)}, .start = f.now, .heading = heading});
  f.advance(4);
  ASSERT_GT(f.flight.reference().velocity_mps.norm(), 1.7);
  f.flight.cap_speed(f.now, 0.8);
  f.advance(2);
  EXPECT_LT(f.flight.reference().velocity_mps.norm(), 0.85);
  f.advance(2);
  EXPECT_GT(f.flight.reference().velocity_mps.norm(), 0.7);
  f.flight.cap_speed(f.now, 2.0);
  f.advance(3);
  EXPECT_GT(f.flight.reference().velocity_mps.norm(), 1.7);
  f.advance(15);
  EXPECT_NEAR(f.flight.reference().position.x(), 30, 0.02);
}

TEST(Flight, ABrakeForgetsTheHeadingThatThePathWasToEndWith) {
  // As it was: slowed down while braking, it turned to the goal's heading on the spot before it was at rest.
  IdealFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(4);
  const Vec3 from = f.flight.reference().position;
  HeadingPlan heading;
  heading.along_path = false;
  heading.goal_heading_rad = 3.0;
  f.flight.follow({.points = {from, from + Vec3(30, 0, 0)}, .start = f.now, .heading = heading});
  f.advance(1);
  f.flight.brake(f.now);
  f.advance(0.2);
  f.flight.cap_speed(f.now, 1.0);
  f.advance(4);
  EXPECT_LT(f.flight.reference().heading_rad, 1.5) << "the turn under way is ended, not completed";
}

TEST(Flight, LooksOnceAround) {
  IdealFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(4);
  f.flight.look_around(f.now, 2 * std::numbers::pi);
  double turned = 0, last = f.flight.reference().heading_rad;
  for (int i = 0; i < 200 && !f.flight.at_rest(f.now); ++i) {
    f.advance(0.1);
    turned += wrap_angle(f.flight.reference().heading_rad - last);
    last = f.flight.reference().heading_rad;
  }
  f.advance(2);
  turned += wrap_angle(f.flight.reference().heading_rad - last);
  EXPECT_NEAR(turned, 2 * M_PI, 0.1);
}

}  // namespace
}  // namespace karst::core
