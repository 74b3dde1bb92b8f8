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

TEST(Safety, NothingIsDoneWhileAllIsWell) {
  SafetySupervisor s{SafetyOptions{}};
  for (int i = 0; i < 100; ++i) EXPECT_EQ(s.judge(well(0.1 * i)).action, SafetyAction::none);
}

TEST(Safety, EachCauseHasItsAction) {
  using A = SafetyAction;
  const auto action = [](auto spoil) {
    SafetyObservation o = well(1);
    spoil(o);
    SafetySupervisor s{SafetyOptions{}};
    const SafetyVerdict v = s.judge(o);
    EXPECT_FALSE(v.reason.empty());
    return v.action;
  };
  EXPECT_EQ(action([](auto& o) { o.estimate.health = Health::lost; }), A::land);
  EXPECT_EQ(action([](auto& o) { o.estimate.health = Health::degraded; }), A::slow);
  EXPECT_EQ(action([](auto& o) { o.battery_s = 11; }), A::land);
  EXPECT_EQ(action([](auto& o) { o.blind_s = 1.1; }), A::brake);
  EXPECT_EQ(action([](auto& o) { o.blind_s = 10.1; }), A::home);
  EXPECT_EQ(action([](auto& o) { o.tracking_error_m = 0.5; }), A::slow);
  EXPECT_EQ(action([](auto& o) { o.tracking_error_m = 0.9; }), A::brake);
  EXPECT_EQ(action([](auto& o) { o.hull_clearance_m = 0.05; }), A::slow);
}

TEST(Safety, AnEstimateThatStaysDegradedEndsTheExploration) {
  SafetySupervisor s{SafetyOptions{}};
  SafetyAction last = SafetyAction::none;
  for (double t = 0; t < 5.25; t += 0.1) {
    SafetyObservation o = well(t);
    o.estimate.health = Health::degraded;
    last = s.judge(o).action;
    EXPECT_EQ(last, t > 5.0001 ? SafetyAction::home : SafetyAction::slow) << t;
  }
  EXPECT_EQ(last, SafetyAction::home);
}

TEST(Safety, AnActionOutlivesItsCauseByASecond) {
  SafetySupervisor s{SafetyOptions{}};
  SafetyObservation o = well(0);
  o.tracking_error_m = 0.5;
  s.judge(o);
  EXPECT_EQ(s.judge(well(0.9)).action, SafetyAction::slow);
  EXPECT_EQ(s.judge(well(1.0)).action, SafetyAction::none);
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
  RC_ASSERT(a.judge(mild).action <= b.judge(worse).action);
}

}  // namespace
}  // namespace karst::core
