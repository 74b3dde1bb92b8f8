// Plugins that load, and misbehave when they are asked: the mission must go on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <chrono>
#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core_stack/common/sanitized.h"
#include "sdk/abi/karst_abi.h"
#include "tests/abi/room.h"

namespace karst::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

/// The reason of the hold a first failure leads to.
std::string first_failure(const std::string& file, const std::string& name = "plain") {
  Room room;
  const core::Decision d = load(file, name)->decide(room.request);
  return d.outcome == core::Outcome::hold && d.goals.empty() ? d.reason : "no failure";
}

TEST(PlainPolicy, FliesAMetreAhead) {
  Room room;
  const auto policy = load("plain");
  const core::Decision d = policy->decide(room.request);
  ASSERT_EQ(d.goals.size(), 1u);
  EXPECT_EQ(d.outcome, core::Outcome::goals);
  EXPECT_EQ(d.goals[0].position, core::Vec3(6.5, 5.5, 5.5));
  EXPECT_EQ(d.goals[0].why, "ahead");
  EXPECT_EQ(policy->version(), "1.2.3");
}

TEST(MisbehavingPlugin, ExceptionThroughTheRawTableIsCaught) {
  EXPECT_THAT(first_failure("throwing"),
              AllOf(HasSubstr("exception across the border"), HasSubstr("out of the blue")));
}

TEST(MisbehavingPlugin, ExceptionThatIsNoStdExceptionIsCaughtByTheFace) {
  EXPECT_THAT(first_failure("throwing_init", "throwing_init"), HasSubstr("not a std::exception"));
}

TEST(MisbehavingPlugin, MemoryHogIsRefusedItsMemory) {
  if (kSanitized)
    GTEST_SKIP() << "a sanitizer's operator new ends the process; it never throws std::bad_alloc";
  EXPECT_THAT(first_failure("memory_hog", "memory_hog"), HasSubstr("decide():"));
}

TEST(MisbehavingPlugin, MillionGoalsAreRefusedAsAWhole) {
  EXPECT_THAT(first_failure("million_goals"), HasSubstr("1000000 goals, the limit is 64"));
}

TEST(MisbehavingPlugin, TooManyGoalsInSmallPortionsAreRefusedThoughItClaimsSuccess) {
  EXPECT_THAT(first_failure("ignores_refusal"), HasSubstr("65 goals, the limit is 64"));
}

TEST(MisbehavingPlugin, SuccessWithoutAnOutcomeIsAFailure) {
  EXPECT_THAT(first_failure("no_outcome"), HasSubstr("returned without an outcome"));
}

TEST(MisbehavingPlugin, MalformedGoalsAreDroppedAndTheOthersFlown) {
  Room room;
  const core::Decision d = load("nan_goal")->decide(room.request);
  ASSERT_EQ(d.goals.size(), 1u);
  EXPECT_THAT(d.log, Contains(HasSubstr("goal 1: its position is not finite")));
  EXPECT_THAT(d.log, Contains(HasSubstr("goal 3: its why is not valid UTF-8")));
}

TEST(MisbehavingPlugin, OnlyMalformedGoalsAreAFailure) {
  EXPECT_THAT(first_failure("only_nan_goals"),
              HasSubstr("no goal was well formed: goal 1: its score is not finite"));
}

TEST(MisbehavingPlugin, ThreeFailuresInARowEndIt) {
  Room room;
  const auto policy = load("failing");
  for (room.request.sequence = 1; room.request.sequence <= 12; ++room.request.sequence) {
    const core::Decision d = policy->decide(room.request);
    const bool fails = room.request.sequence % 2 == 1 || room.request.sequence > 10;
    EXPECT_EQ(d.outcome, fails ? core::Outcome::hold : core::Outcome::goals) << room.request.sequence;
    if (fails) {
      EXPECT_THAT(d.reason, HasSubstr("the stars are not right"));
    }
  }
  EXPECT_THAT(failure_of(*policy, room.request),
              AllOf(HasSubstr("failed 3 times in a row"), HasSubstr("the stars are not right")));
  EXPECT_FALSE(policy->abandoned());
}

TEST(MisbehavingPlugin, ChangedLocaleIsPutBackAndTold) {
  Room room;
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const core::Decision d = load("locale_changer")->decide(room.request);
  EXPECT_EQ(std::setlocale(LC_ALL, nullptr), before);
  EXPECT_EQ(d.goals.size(), 1u);
  EXPECT_THAT(d.log, Contains(AllOf(HasSubstr("locale"), HasSubstr("C.UTF-8"))));
}

TEST(MisbehavingPlugin, LocaleAndRoundingChangedWhileItIsOpenedArePutBackAndTold) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const int rounding = std::fegetround();
  const auto policy = load("changes_process_at_load");
  EXPECT_EQ(std::setlocale(LC_ALL, nullptr), before);
  EXPECT_EQ(std::fegetround(), rounding);
  Room room;
  const core::Decision d = policy->decide(room.request);
  EXPECT_EQ(d.goals.size(), 1u);
  EXPECT_THAT(d.log, Contains(AllOf(HasSubstr("locale (to C.UTF-8)"), HasSubstr("when it was opened"))));
}

TEST(MisbehavingPlugin, WhatItWritesToStdoutDoesNotTouchItsDecision) {
  ::testing::internal::CaptureStdout();
  Room room;
  const core::Decision d = load("talkative")->decide(room.request);
  ::testing::internal::GetCapturedStdout();
  EXPECT_EQ(d.goals.size(), 1u);
}

TEST(HangingPlugin, PoliteOneIsToldToStopAndFindsItsServicesClosed) {
  const auto note = std::filesystem::temp_directory_path() / "karst_slow_but_polite.txt";
  std::filesystem::remove(note);
  setenv("KARST_TEST_NOTE", note.c_str(), 1);
  {
    host::PolicyChoice c = choice_of("plain");
    c.hang_limit_s = 0.2;
    Room room;
    const auto policy = load("slow_but_polite", c);
    EXPECT_THAT(failure_of(*policy, room.request), HasSubstr("did not return within 0.2 s"));
    EXPECT_TRUE(policy->abandoned());
    EXPECT_THAT(failure_of(*policy, room.request), HasSubstr("hangs"));
  }
  // Room, map and policy are gone, and its thread still ends well. It has all the time it wants.
  std::string code;
  while (code.empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::ifstream(note) >> code;
  }
  EXPECT_EQ(code, std::to_string(KARST_ERROR_ABANDONED));
  std::filesystem::remove(note);
}

TEST(HangingPlugin, EndlessLoopCostsThePolicyAndTheProcessStillEnds) {
  // In a child, for the thread never ends.
  const auto run = [] {
    host::PolicyChoice c = choice_of("plain");
    c.hang_limit_s = 0.2;
    Room room;
    auto policy = load("endless_loop", c);
    std::string said = failure_of(*policy, room.request);
    policy->notify({core::PolicyEvent::Kind::homing, 0, {}, ""});
    policy.reset();
    std::fprintf(stderr, "%s\n", said.c_str());
    std::_Exit(said.empty() ? 1 : 0);
  };
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(0), "did not return within 0.2 s: it is given up");
}

}  // namespace
}  // namespace karst::test
