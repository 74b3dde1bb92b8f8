#include "sdk/host/in_process/crash_note.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <future>
#include <string>
#include <thread>

#include "core_stack/common/sanitized.h"

namespace karst::host {
namespace {

using Handler = void (*)(int);

constexpr int kFatal[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};

Handler handler_of(int signal) {
  struct sigaction now {};
  sigaction(signal, nullptr, &now);
  return now.sa_handler;
}

void crash_with(int signal, const std::string& text) {
  CrashNote note(text);
  std::raise(signal);
}

class CrashNotes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "skipped: sanitizers have handlers of their own";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
  }
};

TEST_F(CrashNotes, SayWhatWasPreparedAndTheSignalAndTheProcessEndsByIt) {
  EXPECT_EXIT(crash_with(SIGSEGV, "in decide(), request 7"), ::testing::KilledBySignal(SIGSEGV),
              "in decide\\(\\), request 7 \\(SIGSEGV\\)\n");
  EXPECT_EXIT(crash_with(SIGABRT, "x"), ::testing::KilledBySignal(SIGABRT), "x \\(SIGABRT\\)\n");
  EXPECT_EXIT(crash_with(SIGBUS, "x"), ::testing::KilledBySignal(SIGBUS), "x \\(SIGBUS\\)\n");
  EXPECT_EXIT(crash_with(SIGFPE, "x"), ::testing::KilledBySignal(SIGFPE), "x \\(SIGFPE\\)\n");
  EXPECT_EXIT(crash_with(SIGILL, "x"), ::testing::KilledBySignal(SIGILL), "x \\(SIGILL\\)\n");
}

TEST_F(CrashNotes, OfALongTextAreCutAndStillALine) {
  EXPECT_EXIT(crash_with(SIGSEGV, std::string(100'000, 'x')), ::testing::KilledBySignal(SIGSEGV),
              "xxx \\(SIGSEGV\\)\n");
}

/// Another thread is in a call of its own; the thread that crashes speaks.
void second_of_two_crashes() {
  std::promise<void> noted;
  std::thread other([&noted] {
    CrashNote note("the first");
    noted.set_value();
    std::this_thread::sleep_for(std::chrono::hours(1));
  });
  noted.get_future().wait();
  crash_with(SIGSEGV, "the second");
  other.join();
}

TEST_F(CrashNotes, OfSeveralThreadsAreApart) {
  EXPECT_EXIT(second_of_two_crashes(), ::testing::KilledBySignal(SIGSEGV), "the second \\(SIGSEGV\\)\n");
}

/// The first call has ended, the second is still under way.
void crash_after_another_call_has_ended() {
  std::promise<void> noted, ended;
  std::thread other([&] {
    {
      CrashNote note("the first");
      noted.set_value();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ended.set_value();
  });
  noted.get_future().wait();
  CrashNote note("the second");
  ended.get_future().wait();
  std::raise(SIGSEGV);
  other.join();
}

TEST_F(CrashNotes, LastAsLongAsTheirOwnCall) {
  EXPECT_EXIT(crash_after_another_call_has_ended(), ::testing::KilledBySignal(SIGSEGV), "the second");
}

/// The core crashes on a thread that calls no policy.
void crash_elsewhere() {
  std::promise<void> noted;
  std::thread other([&noted] {
    CrashNote note("a policy");
    noted.set_value();
    std::this_thread::sleep_for(std::chrono::hours(1));
  });
  noted.get_future().wait();
  std::raise(SIGSEGV);
  other.join();
}

TEST_F(CrashNotes, DoNotBlameThePolicyForAnotherThread) {
  EXPECT_EXIT(crash_elsewhere(), ::testing::KilledBySignal(SIGSEGV),
              ::testing::Not(::testing::HasSubstr("a policy")));
}

TEST_F(CrashNotes, LeaveHandlersAndStackAsTheyWere) {
  stack_t before{}, after{};
  sigaltstack(nullptr, &before);
  for (const int signal : kFatal) ASSERT_EQ(handler_of(signal), SIG_DFL);
  {
    CrashNote outer("outer");
    for (const int signal : kFatal) EXPECT_NE(handler_of(signal), SIG_DFL);
    { CrashNote inner("inner"); }
    for (const int signal : kFatal) EXPECT_NE(handler_of(signal), SIG_DFL) << "the outer one is still there";
  }
  for (const int signal : kFatal) EXPECT_EQ(handler_of(signal), SIG_DFL) << signal;
  sigaltstack(nullptr, &after);
  EXPECT_EQ(before.ss_flags, after.ss_flags);
  EXPECT_EQ(before.ss_sp, after.ss_sp);
}

TEST_F(CrashNotes, LeaveAHandlerThatIsThere) {
  const Handler own = [](int) {};
  std::signal(SIGFPE, own);
  {
    CrashNote note("x");
    EXPECT_EQ(handler_of(SIGFPE), own);
    EXPECT_NE(handler_of(SIGSEGV), SIG_DFL);
    std::signal(SIGILL, own);  // as a policy may do in its call
  }
  EXPECT_EQ(handler_of(SIGFPE), own);
  EXPECT_EQ(handler_of(SIGILL), own);
  EXPECT_EQ(handler_of(SIGSEGV), SIG_DFL);
  std::signal(SIGFPE, SIG_DFL);
  std::signal(SIGILL, SIG_DFL);
}

TEST_F(CrashNotes, WithoutATextThereIsNone) {
  CrashNote note("");
  for (const int signal : kFatal) EXPECT_EQ(handler_of(signal), SIG_DFL);
}

}  // namespace
}  // namespace karst::host
