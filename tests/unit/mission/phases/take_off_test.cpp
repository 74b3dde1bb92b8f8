#include "core_stack/mission/phases/take_off.h"

#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

class TakeOffTest : public OnboardTest {
 protected:
  TakeOff take_off{onboard, phases, path};
  void begin() {
    take_off.begin();
    phases.enter(Phase::takeoff, now());
  }
};

TEST_F(TakeOffTest, HoversOnceItHasRestedAtTheHeight) {
  begin();
  EXPECT_EQ(take_off.step(false), TakeOff::State::climbs);
  double hovers_after_s = 0;
  while (take_off.step(false) == TakeOff::State::climbs && hovers_after_s < 20) {
    advance(0.1);
    hovers_after_s += 0.1;
  }
  EXPECT_NEAR(onboard.flight.reference().position.z(), onboard.options.mission.takeoff_height_m, 0.02);
  EXPECT_GT(hovers_after_s, 1.0 + onboard.options.mission.takeoff_height_m / 0.5);
  EXPECT_LT(hovers_after_s, 10);
  EXPECT_FALSE(take_off.below_roof());
}

TEST_F(TakeOffTest, SaysWhenItDoesNotLift) {
  begin();
  advance(10);
  EXPECT_EQ(take_off.step(true), TakeOff::State::does_not_lift);
}

TEST_F(TakeOffTest, BelowARoofThatStoppedItChoosesAHoverOnTheMapLaneAndSaysSo) {
  begin();
  advance(1);
  path.brake(now());
  advance(3);
  EXPECT_EQ(take_off.step(false), TakeOff::State::climbs) << "the choice is under way";
  EXPECT_TRUE(take_off.below_roof());
  EXPECT_EQ(told("a low roof"), 0u);
  advance(0.2);
  EXPECT_EQ(told("a low roof"), 1u);
  advance(5);
  EXPECT_EQ(take_off.step(false), TakeOff::State::hovers);
  EXPECT_EQ(told("a low roof"), 1u);
}

}  // namespace
}  // namespace karst::core
