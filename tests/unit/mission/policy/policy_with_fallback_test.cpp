#include "core_stack/mission/policy/policy_with_fallback.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

struct Counting final : PolicyPort {
  int asked = 0, told = 0;
  bool fails = false;
  Decision answer;
  std::string name() const override { return "counting"; }
  Decision decide(const DecisionRequest&) override {
    ++asked;
    if (fails) throw PolicyFailure("it hangs");
    return answer;
  }
  void notify(const PolicyEvent&) override { ++told; }
};

TEST(PolicyWithFallback, AsksThePolicyInItsTurn) {
  Counting policy;
  policy.answer.reason = "as it says";
  PolicyWithFallback asked(policy);
  const PolicyAnswer answer = asked.ask({}, DecidedBy::policy);
  EXPECT_EQ(answer.by, DecidedBy::policy);
  EXPECT_EQ(answer.name, "counting");
  EXPECT_EQ(answer.decision.reason, "as it says");
  EXPECT_EQ(answer.failure, "");
  EXPECT_EQ(asked.ask({}, DecidedBy::fallback).name, "fallback");
  EXPECT_EQ(asked.ask_fallback({}).by, DecidedBy::fallback);
  EXPECT_EQ(policy.asked, 1);
}

TEST(PolicyWithFallback, APolicyThatFailsIsNeitherAskedNorToldAgain) {
  Counting policy;
  PolicyWithFallback asked(policy);
  asked.notify({PolicyEvent::Kind::homing, 0, {}, ""});
  policy.fails = true;
  const PolicyAnswer first = asked.ask({}, DecidedBy::policy), second = asked.ask({}, DecidedBy::policy);
  EXPECT_EQ(first.by, DecidedBy::fallback);
  EXPECT_EQ(first.name, "fallback");
  EXPECT_EQ(first.failure, "it hangs");
  EXPECT_EQ(second.by, DecidedBy::fallback);
  EXPECT_EQ(second.failure, "") << "said once";
  asked.notify({PolicyEvent::Kind::homing, 0, {}, ""});
  EXPECT_EQ(policy.asked, 1);
  EXPECT_EQ(policy.told, 1);
}

TEST(PolicyWithFallback, TwoSecondsOfStandingIdleCostThePolicyOneTurn) {
  Counting policy;
  PolicyWithFallback asked(policy);
  std::string turns;
  for (int half_seconds = 0; half_seconds < 11; ++half_seconds) {
    const TimeNs now = half_seconds * kSecond / 2;
    turns += asked.begin_cycle(now) == DecidedBy::policy ? 'p' : 'f';
    asked.note_idle(now);
  }
  EXPECT_EQ(turns, "ppppfpppfpp") << "idle since its first cycle, and again since the fallback's";
}

TEST(PolicyWithFallback, AVehicleThatIsBusyIsNotIdle) {
  Counting policy;
  PolicyWithFallback asked(policy);
  asked.note_idle(0);
  asked.note_busy();
  asked.note_idle(kSecond);
  EXPECT_EQ(asked.begin_cycle(3 * kSecond - 1), DecidedBy::policy);
  EXPECT_EQ(asked.begin_cycle(3 * kSecond), DecidedBy::fallback);
}

TEST(PolicyWithFallback, APolicyThatSaysExploredIsNotOverruled) {
  Counting policy;
  PolicyWithFallback asked(policy);
  for (int half_seconds = 0; half_seconds < 20; ++half_seconds) {
    EXPECT_EQ(asked.begin_cycle(half_seconds * kSecond / 2), DecidedBy::policy) << half_seconds;
    asked.note_explored(DecidedBy::policy);
  }
  EXPECT_FALSE(asked.fallback_stands_by());
}

TEST(PolicyWithFallback, APolicyThatNowHoldsAndNowSaysExploredLosesItsTurnLikeOneThatHolds) {
  Counting policy;
  PolicyWithFallback asked(policy);
  std::string turns;
  for (int half_seconds = 0; half_seconds < 8; ++half_seconds) {
    const TimeNs now = half_seconds * kSecond / 2;
    turns += asked.begin_cycle(now) == DecidedBy::policy ? 'p' : 'f';
    if (half_seconds % 2 == 1) {
      asked.note_explored(DecidedBy::policy);
    } else {
      asked.note_idle(now);
    }
  }
  EXPECT_EQ(turns, "pppppfpp") << "never straight after `explored`, and idle anew since the fallback's turn";
}

TEST(PolicyWithFallback, AFallbackThatFoundNothingStandsByUntilTheVehicleIsBusy) {
  Counting policy;
  PolicyWithFallback asked(policy);
  asked.note_idle(0);
  ASSERT_EQ(asked.begin_cycle(2 * kSecond), DecidedBy::fallback);
  EXPECT_FALSE(asked.fallback_stands_by());
  asked.note_explored(DecidedBy::fallback);
  EXPECT_TRUE(asked.fallback_stands_by());
  asked.note_explored(DecidedBy::policy);
  asked.note_idle(9 * kSecond);
  EXPECT_EQ(asked.begin_cycle(60 * kSecond), DecidedBy::policy) << "the policy is asked first";
  EXPECT_TRUE(asked.fallback_stands_by());
  asked.note_busy();
  EXPECT_FALSE(asked.fallback_stands_by());
}

TEST(PolicyWithFallback, InPlaceOfAFailedPolicyTheFallbackIsAskedOnce) {
  Counting policy;
  PolicyWithFallback asked(policy);
  policy.fails = true;
  asked.note_explored(asked.ask({}, DecidedBy::policy).by);
  EXPECT_FALSE(asked.fallback_stands_by());
}

TEST(PolicyWithFallback, LimitsWhatThePolicyDrawsInAFlight) {
  Counting policy;
  policy.answer.drawings.resize(OutputLimits{}.drawings);
  PolicyWithFallback asked(policy);
  EXPECT_EQ(asked.ask({}, DecidedBy::policy).decision.drawings.size(), OutputLimits{}.drawings);
  EXPECT_EQ(asked.ask({}, DecidedBy::policy).decision.drawings.size(), 0u);
}

}  // namespace
}  // namespace karst::core
