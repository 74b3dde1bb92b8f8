#include "core_stack/mission/flight/safety.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace karst::core {
namespace {

SafetyObservation well(double t_s) {
  SafetyObservation o;
  o.now = from_seconds(t_s);
  o.battery_s = 300;
  return o;
}

SafetyObservation degraded(double t_s) {
  SafetyObservation o = well(t_s);
  o.estimate.health = Health::degraded;
  return o;
}

SafetyObservation blind(double t_s, double blind_s) {
  SafetyObservation o = well(t_s);
  o.blind_s = blind_s;
  return o;
}

TEST(Safety, NothingIsDoneWhileAllIsWell) {
  SafetySupervisor s{SafetyOptions{}};
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(s.judge(well(0.1 * i)).action, SafetyAction::none);
    EXPECT_FALSE(s.judge(well(0.1 * i)).go_home);
  }
}

TEST(Safety, EachCauseHasItsAction) {
  using A = SafetyAction;
  const auto action = [](auto spoil) {
    SafetyObservation o = well(1);
    spoil(o);
    SafetySupervisor s{SafetyOptions{}};
    const SafetyVerdict v = s.judge(o);
    EXPECT_FALSE(v.reason.empty());
    EXPECT_EQ(v.go_home.has_value(), o.blind_s > 10);
    return v.action;
  };
  EXPECT_EQ(action([](auto& o) { o.estimate.health = Health::lost; }), A::land);
  EXPECT_EQ(action([](auto& o) { o.estimate.health = Health::degraded; }), A::slow);
  EXPECT_EQ(action([](auto& o) { o.battery_s = 11; }), A::land);
  EXPECT_EQ(action([](auto& o) { o.blind_s = 1.1; }), A::brake);
  EXPECT_EQ(action([](auto& o) { o.blind_s = 10.1; }), A::slow);
  EXPECT_EQ(action([](auto& o) { o.tracking_error_m = 0.5; }), A::slow);
  EXPECT_EQ(action([](auto& o) { o.tracking_error_m = 0.9; }), A::brake);
  EXPECT_EQ(action([](auto& o) { o.hull_clearance_m = 0.05; }), A::slow);
}

TEST(Safety, OutsideItsRegionTheVehicleGoesHomeSlowly) {
  SafetySupervisor s{SafetyOptions{}};
  SafetyObservation o = well(1);
  o.outside = "region.keep_in";
  const SafetyVerdict v = s.judge(o);
  EXPECT_EQ(v.action, SafetyAction::slow);
  EXPECT_EQ(v.reason, "the vehicle is outside region.keep_in");
  EXPECT_EQ(v.go_home, v.reason);
  EXPECT_FALSE(s.judge(well(1.1)).go_home);
}

TEST(Safety, AnEstimateThatStaysDegradedEndsTheExploration) {
  SafetySupervisor s{SafetyOptions{}};
  for (double t = 0; t < 5.25; t += 0.1) {
    const SafetyVerdict& v = s.judge(degraded(t));
    EXPECT_EQ(v.action, SafetyAction::slow);
    EXPECT_EQ(v.go_home.has_value(), t > 5.0001) << t;
  }
}

TEST(Safety, NoCauseToGoHomeHidesACauseToBrake) {
  SafetySupervisor s{SafetyOptions{}};
  s.judge(degraded(0));
  SafetyObservation o = degraded(6);
  o.tracking_error_m = 0.9;
  const SafetyVerdict& v = s.judge(o);
  EXPECT_EQ(v.action, SafetyAction::brake);
  EXPECT_EQ(v.reason, "far from the reference");
  EXPECT_EQ(v.go_home, "the state estimate stays degraded");
}

TEST(Safety, BlindForLongItDoesNotWaitAnyMoreAndGoesHomeSlowly) {
  SafetySupervisor s{SafetyOptions{}};
  EXPECT_EQ(s.judge(blind(0, 9.95)).action, SafetyAction::brake);
  const SafetyVerdict& v = s.judge(blind(0.1, 10.05));
  EXPECT_EQ(v.action, SafetyAction::slow);
  EXPECT_EQ(v.go_home, "no sensor sees the cave any more");
  EXPECT_FALSE(s.judge(blind(0.2, 0)).go_home);
}

TEST(Safety, AnActionOutlivesItsCauseByASecond) {
  SafetySupervisor s{SafetyOptions{}};
  SafetyObservation o = well(0);
  o.tracking_error_m = 0.5;
  s.judge(o);
  EXPECT_EQ(s.judge(well(0.9)).action, SafetyAction::slow);
  EXPECT_EQ(s.judge(well(1.0)).action, SafetyAction::none);
}

TEST(Safety, AnActionThatFollowsAGraverOneIsKeptAsLong) {
  SafetySupervisor s{SafetyOptions{}};
  s.judge(blind(0, 1.1));
  EXPECT_EQ(s.judge(degraded(0.9)).action, SafetyAction::brake);
  EXPECT_EQ(s.judge(degraded(1.0)).action, SafetyAction::slow);
  EXPECT_EQ(s.judge(well(1.9)).action, SafetyAction::slow);
  EXPECT_EQ(s.judge(well(2.0)).action, SafetyAction::none);
}

RC_GTEST_PROP(Safety, AWorseObservationNeverGetsAMilderAction, ()) {
  const auto share = [] { return *rc::gen::inRange(0, 1000) / 1000.0; };
  SafetyObservation mild = well(20);
  mild.tracking_error_m = 2 * share();
  mild.blind_s = 20 * share();
  mild.battery_s = 40 * share();
  mild.hull_clearance_m = share();
  SafetyObservation worse = mild;
  worse.tracking_error_m += share();
  worse.blind_s += 10 * share();
  worse.battery_s -= 10 * share();
  worse.hull_clearance_m = *worse.hull_clearance_m - share();
  SafetySupervisor a{SafetyOptions{}}, b{SafetyOptions{}};
  const SafetyVerdict to_mild = a.judge(mild), to_worse = b.judge(worse);
  RC_ASSERT(!to_mild.go_home || to_worse.go_home);
  const bool waits_no_longer = to_worse.go_home && !to_mild.go_home;  // to see something again
  RC_ASSERT(to_mild.action <= to_worse.action ||
            (waits_no_longer && to_mild.reason == "no sensor sees the cave"));
}

}  // namespace
}  // namespace karst::core
