#include "plugins/mavlink/hand_over.h"

#include <gtest/gtest.h>

namespace karst::mavlink {
namespace {

using core::Authority;
using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

constexpr std::uint32_t kPosition = 3u << 16, kHold = 4u << 16 | 3u << 24, kLand = 4u << 16 | 6u << 24,
                        kOffboard = 6u << 16, kStabilized = 7u << 16;

/// An autopilot whose telemetry comes ten times a second.
struct Session {
  HandOver hand_over;
  TimeNs now = kSecond;
  std::uint32_t mode = kPosition;
  std::uint8_t base = kCustomMode, status = kActive;
  int asked = 0;

  explicit Session(Engage engage = Engage::pilot, Resume resume = Resume::after_link_loss,
                   Firmware firmware = Firmware::px4)
      : hand_over(firmware, engage, resume) {}

  HandOver::Steering pass(double s, bool link = true) {
    HandOver::Steering out;
    for (const TimeNs end = now + core::from_seconds(s); now < end; now += 100 * kMillisecond) {
      if (link && now % kSecond == 0) hand_over.on_heartbeat({mode, 2, 12, base, status, 3}, now);
      if (link) hand_over.on_any_message(now);
      asked += hand_over.asks(now, true) ? 1 : 0;
      out = hand_over.steering(now);
    }
    return out;
  }
  void say(const std::string& text, std::uint8_t severity = 2) {
    Statustext m;
    m.severity = severity;
    std::copy(text.begin(), text.end(), m.text.begin());
    hand_over.on_text(m, now);
  }
  void fly() {
    base = kCustomMode | kArmed;
    mode = kOffboard;
    EXPECT_EQ(pass(2).who, Authority::core);
    hand_over.on_ground(false);
  }
};

TEST(HandOver, TheCoreSteersOnlyWhileArmedAndInOffboard) {
  Session s;
  EXPECT_EQ(s.hand_over.steering(s.now).reason, "no autopilot yet");
  s.mode = kOffboard;
  EXPECT_EQ(s.pass(2).reason, "not armed");
  s.base = kCustomMode | kArmed;
  EXPECT_EQ(s.pass(2).who, Authority::core);
  for (const std::uint32_t mode : {kPosition, kStabilized, kHold, kLand, 99u}) {
    s.mode = mode;
    EXPECT_EQ(s.pass(2).who, Authority::pilot) << mode;
  }
  EXPECT_EQ(s.asked, 0) << "the pilot selects the mode";
}

TEST(HandOver, KarstAsksOnTheGroundOnceArmedAndNotInTheAir) {
  Session s(Engage::arming);
  s.hand_over.on_ground(true);
  s.pass(3);
  EXPECT_EQ(s.asked, 0) << "not armed";
  s.base = kCustomMode | kArmed;
  s.pass(3);
  EXPECT_GE(s.asked, 2) << "once a second until it is granted";
  s.hand_over.on_refused("denied");
  EXPECT_EQ(s.pass(0.2).reason, "mode offboard refused: denied");
  s.fly();
  s.asked = 0;
  s.mode = kPosition;
  EXPECT_EQ(s.pass(10).who, Authority::pilot);
  s.hand_over.on_ground(true);
  s.pass(5);
  EXPECT_EQ(s.asked, 0) << "what the pilot took, karst does not ask for";
}

TEST(HandOver, KarstThatStartsBesideAnArmedVehicleAsksForNothing) {
  for (const bool says_it_stands : {false, true}) {
    Session s(Engage::arming);
    s.base = kCustomMode | kArmed;
    if (says_it_stands) s.hand_over.on_ground(true);
    s.pass(5);
    EXPECT_EQ(s.asked, 0);
  }
}

TEST(HandOver, AFailsafeIsTheAutopilotsWithItsWords) {
  Session s;
  s.fly();
  s.say("Failsafe: critical battery, landing");
  s.mode = kLand, s.status = kCritical;
  const auto steering = s.pass(2);
  EXPECT_EQ(steering.who, Authority::autopilot);
  EXPECT_EQ(steering.reason, "mode land: Failsafe: critical battery, landing");
  s.pass(20);
  EXPECT_EQ(s.asked, 0);
}

TEST(HandOver, AnExplanationMayComeAfterTheHeartbeat) {
  Session s;
  s.fly();
  s.mode = kLand, s.status = kCritical;
  EXPECT_EQ(s.pass(1.5).reason, "mode land");
  s.say("Failsafe: critical battery");
  EXPECT_EQ(s.pass(0.2).reason, "mode land: Failsafe: critical battery");
}

TEST(HandOver, ASilentAutopilotSteersAfterLessThanHalfASecondAndNotAtOnce) {
  Session s;
  s.fly();
  EXPECT_EQ(s.pass(0.3, false).who, Authority::core);
  const auto steering = s.pass(0.4, false);
  EXPECT_EQ(steering.who, Authority::autopilot);
  EXPECT_EQ(steering.reason, "no heartbeat");
}

TEST(HandOver, AfterASilenceKarstAsksAgainIfTheAutopilotHoldsByItself) {
  Session s;
  s.fly();
  s.pass(5, false);
  s.mode = kHold, s.status = kCritical;
  EXPECT_EQ(s.pass(2).who, Authority::autopilot);
  EXPECT_GE(s.asked, 1);
}

TEST(HandOver, AfterASilenceKarstDoesNotAskForWhatThePilotTook) {
  for (const std::uint32_t mode : {kPosition, kHold, kLand}) {
    Session s;
    s.fly();
    s.pass(5, false);
    s.mode = mode;  // and no failsafe
    EXPECT_EQ(s.pass(20).who, Authority::pilot);
    EXPECT_EQ(s.asked, 0) << mode;
  }
  Session battery;  // a failsafe of another kind
  battery.fly();
  battery.pass(5, false);
  battery.mode = kLand, battery.status = kCritical;
  battery.pass(20);
  EXPECT_EQ(battery.asked, 0);
}

TEST(HandOver, NeverAsksAgainIfItMayNot) {
  Session s(Engage::pilot, Resume::never);
  s.fly();
  s.pass(5, false);
  s.mode = kHold, s.status = kCritical;
  s.pass(20);
  EXPECT_EQ(s.asked, 0);
}

TEST(HandOver, ArduPilotStaysInGuidedAndTheCoreGoesOnUnlessItMayNot) {
  for (const Resume resume : {Resume::after_link_loss, Resume::never}) {
    Session s(Engage::pilot, resume, Firmware::ardupilot);
    s.base = kCustomMode | kArmed, s.mode = 4;
    EXPECT_EQ(s.pass(2).who, Authority::core);
    EXPECT_EQ(s.pass(5, false).who, Authority::autopilot);
    EXPECT_EQ(s.pass(2).who, resume == Resume::never ? Authority::pilot : Authority::core);
    s.mode = 5;  // loiter, and guided again
    EXPECT_EQ(s.pass(2).reason, "mode loiter");
    s.mode = 4;
    EXPECT_EQ(s.pass(2).who, Authority::core);
  }
}

TEST(HandOver, AskedAgainIfOnlyTheWayToTheAutopilotWasLost) {
  Session s;
  s.fly();
  s.say("Failsafe: offboard control signal lost");
  s.mode = kHold, s.status = kCritical;
  EXPECT_EQ(s.pass(2).who, Authority::autopilot);
  EXPECT_GE(s.asked, 1);
}

}  // namespace
}  // namespace karst::mavlink
