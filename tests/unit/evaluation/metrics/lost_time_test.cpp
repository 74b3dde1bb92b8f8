// What a flight lost time for, against flights whose speed is known in closed form.
#include "sdk/evaluation/metrics/lost_time.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace karst::evaluation {
namespace {

/// A flight drawn step by step, with limits of 2 m/s, 2 m/s^2 and 1 rad/s.
class DrawnFlight {
 public:
  explicit DrawnFlight(double speed_mps = 0) : speed_mps_(speed_mps) { note(); }
  /// Speeds up or down evenly to `to_mps`, turning the path and the heading at these rates.
  DrawnFlight& fly(double for_s, double to_mps, double turn_radps = 0, double heading_radps = 0) {
    const double from_mps = speed_mps_;
    const int steps = static_cast<int>(std::lround(for_s / kStep_s));
    for (int i = 1; i <= steps; ++i) {
      constexpr int kFine = 100;
      for (int k = 0; k < kFine; ++k) {
        const double part = (i - 1 + (k + 0.5) / kFine) / steps;
        speed_mps_ = from_mps + part * (to_mps - from_mps);
        course_rad_ += turn_radps * kStep_s / kFine;
        x_ += speed_mps_ * std::cos(course_rad_) * kStep_s / kFine;
        y_ += speed_mps_ * std::sin(course_rad_) * kStep_s / kFine;
      }
      heading_rad_ = std::remainder(heading_rad_ + heading_radps * kStep_s, 2 * M_PI);
      t_s_ += kStep_s;
      note();
    }
    speed_mps_ = to_mps;
    return *this;
  }
  RunRecord run(double look_until_s = 0) const {
    RunRecord run;
    run.telemetry.numbers = columns_;
    run.telemetry.rows = columns_.at("t_s").size();
    run.settings = {{"motion.max_speed", "2 m/s"},
                    {"motion.max_acceleration", "2 m/s^2"},
                    {"motion.max_heading_rate", "1 rad/s"}};
    if (look_until_s > 0) run.phases.push_back({"look", 0, look_until_s});
    run.phases.push_back({"explore", look_until_s, t_s_});
    return run;
  }
  LostTime lost(double look_until_s = 0) const { return lost_time(run(look_until_s)).value(); }

 private:
  static constexpr double kStep_s = 0.1;
  void note() {
    columns_["t_s"].push_back(t_s_);
    columns_["ref_x"].push_back(x_);
    columns_["ref_y"].push_back(y_);
    columns_["ref_z"].push_back(1);
    columns_["heading_rad"].push_back(heading_rad_);
  }
  double speed_mps_;
  double t_s_ = 0, x_ = 0, y_ = 0, course_rad_ = 0, heading_rad_ = 0;
  std::map<std::string, std::vector<double>> columns_;
};

double sum_of_parts_s(const LostTime& lost) {
  double sum = lost.look_around_s + lost.turning_s + lost.waiting_s + lost.nearly_full_speed_s;
  for (const Slowdown& s : lost.slowdowns) sum += s.total_s();
  return sum;
}

TEST(LostTime, AtFullSpeedNothingIsLost) {
  DrawnFlight flight(2);
  flight.fly(20, 2);
  EXPECT_LT(flight.lost().total_s, 1e-6);
}

TEST(LostTime, AtHalfSpeedHalfOfTheTimeIs) {
  DrawnFlight flight(1);
  flight.fly(20, 1);
  const LostTime lost = flight.lost();
  EXPECT_NEAR(lost.total_s, 10, 0.2);
  EXPECT_NEAR(lost[SlowdownCause::other].at_s, 10, 0.2) << "nothing shows why";
  EXPECT_NEAR(lost.path_m / lost.explored_s, 1, 0.02);
}

TEST(LostTime, AStopCostsItsBrakingTheWaitAndTheSpeedingUp) {
  DrawnFlight flight(2);
  flight.fly(5, 2).fly(1, 0).fly(3, 0).fly(1, 2).fly(5, 2);
  const LostTime lost = flight.lost();
  // Each ramp of 1 s loses half a second, of which its part above 0.9 of full speed is 5 ms.
  EXPECT_NEAR(lost[SlowdownCause::stop].before_s, 0.5, 0.1);
  EXPECT_NEAR(lost[SlowdownCause::stop].after_s, 0.5, 0.1);
  EXPECT_NEAR(lost.waiting_s + lost[SlowdownCause::stop].at_s, 3, 0.15);
  EXPECT_NEAR(lost.total_s, 4, 0.25);
}

TEST(LostTime, ABendIsToldFromALimitOfTheHeadingRate) {
  DrawnFlight bend(2);  // of 0.55 m at 1 m/s: 1.8 m/s^2 across
  bend.fly(5, 2).fly(0.5, 1).fly(2, 1, 1.8, 0.2).fly(0.5, 2).fly(5, 2);
  const LostTime at_bend = bend.lost();
  EXPECT_NEAR(at_bend[SlowdownCause::bend].at_s, 1, 0.15);
  EXPECT_GT(at_bend[SlowdownCause::bend].before_s, 0.05);
  EXPECT_GT(at_bend[SlowdownCause::bend].after_s, 0.05);
  EXPECT_EQ(at_bend[SlowdownCause::heading].total_s(), 0);

  DrawnFlight turn(2);
  turn.fly(5, 2).fly(0.5, 1).fly(2, 1, 0.3, 0.95).fly(0.5, 2).fly(5, 2);
  const LostTime at_turn = turn.lost();
  EXPECT_NEAR(at_turn[SlowdownCause::heading].at_s, 1, 0.15);
  EXPECT_EQ(at_turn[SlowdownCause::bend].total_s(), 0);
}

TEST(LostTime, AVehicleThatFacesElsewhereDoesNotSlowDownForItsHeading) {
  // As it was: a vehicle with a LiDAR, which turns to its goal's heading in flight, lost time to its heading
  // rate.
  DrawnFlight flight(2);
  flight.fly(5, 2, 0, -0.3).fly(1, 1).fly(2, 1, 0, -1).fly(1, 2).fly(5, 2);
  const LostTime lost = flight.lost();
  EXPECT_EQ(lost[SlowdownCause::heading].total_s(), 0);
  EXPECT_NEAR(lost[SlowdownCause::other].at_s, 1, 0.2);
}

TEST(LostTime, TurningOnTheSpotAndLookingAroundAreNoWaiting) {
  DrawnFlight flight;
  flight.fly(6, 0, 0, 1).fly(4, 0, 0, 0.9).fly(2, 0);
  const LostTime lost = flight.lost(6);
  EXPECT_NEAR(lost.look_around_s, 6, 0.2);
  EXPECT_NEAR(lost.turning_s, 4, 0.2);
  EXPECT_NEAR(lost.waiting_s, 2, 0.2);
  EXPECT_EQ(lost[SlowdownCause::stop].total_s(), 0);
}

TEST(LostTime, CountsUpToAMoment) {
  DrawnFlight flight;
  flight.fly(10, 0).fly(10, 0);
  EXPECT_NEAR(lost_time(flight.run(), 5).value().total_s, 5, 0.2);
}

TEST(LostTime, NeedsTheReferenceAndTheLimits) {
  DrawnFlight flight;
  flight.fly(5, 1);
  RunRecord run = flight.run();
  run.settings.clear();
  EXPECT_FALSE(lost_time(run).has_value());
  run = flight.run();
  run.settings[0].value = "0 m/s";
  EXPECT_FALSE(lost_time(run).has_value());
  run = flight.run();
  run.telemetry.numbers.erase("ref_y");
  EXPECT_FALSE(lost_time(run).has_value());
  run = flight.run();
  run.phases.clear();
  EXPECT_FALSE(lost_time(run).has_value());
  run = flight.run();
  for (double& t : run.telemetry.numbers["t_s"]) t = std::nan("");
  EXPECT_FALSE(lost_time(run).has_value());
}

RC_GTEST_PROP(LostTime, PartsAreNeverNegativeAndSumUpToTheTotal, ()) {
  DrawnFlight flight;
  for (int i = *rc::gen::inRange(1, 30); i > 0; --i)
    flight.fly(0.1 * *rc::gen::inRange(1, 20), 0.1 * *rc::gen::inRange(0, 21),
               0.1 * *rc::gen::inRange(-20, 21), 0.1 * *rc::gen::inRange(-10, 11));
  RunRecord run = flight.run();
  auto& x = run.telemetry.numbers["ref_x"];
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i)
    x[*rc::gen::inRange(std::size_t{0}, x.size())] = std::nan("");
  const auto lost = lost_time(run);
  if (!lost) return;
  RC_ASSERT(std::abs(sum_of_parts_s(*lost) - lost->total_s) < 1e-9);
  RC_ASSERT(lost->total_s <= lost->explored_s + 1e-9);
  for (const Slowdown& s : lost->slowdowns) RC_ASSERT(s.at_s >= 0 && s.before_s >= 0 && s.after_s >= 0);
}

}  // namespace
}  // namespace karst::evaluation
