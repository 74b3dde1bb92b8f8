// Plugins that crash in the host's process: the process ends, and its last words name policy, call and
// request.
#include <gtest/gtest.h>

#include <csignal>

#include "core_stack/common/sanitized.h"
#include "tests/abi/room.h"

namespace karst::test {
namespace {

struct Crash {
  const char* file;
  int signal;
  const char* says;  // a regular expression
};
void PrintTo(const Crash& c, std::ostream* out) { *out << c.file; }

/// As in a flight: a decision, what became of it, and the next decision.
void decide_and_notify(const std::string& file) {
  Room room;
  const auto policy = load(file);
  for (room.request.sequence = 1; room.request.sequence < 5; ++room.request.sequence) {
    policy->decide(room.request);
    policy->notify({core::PolicyEvent::Kind::goal_reached, room.request.stamp, {}, ""});
  }
}

class CrashingPlugin : public ::testing::TestWithParam<Crash> {};

TEST_P(CrashingPlugin, IsNamedWithItsCallAndItsRequest) {
  if (kSanitized) GTEST_SKIP() << "skipped: sanitizers have handlers of their own";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(decide_and_notify(GetParam().file), ::testing::KilledBySignal(GetParam().signal),
              GetParam().says);
}

INSTANTIATE_TEST_SUITE_P(
    Drawer, CrashingPlugin,
    ::testing::Values(
        Crash{"segfault", SIGSEGV,
              "karst: the policy plain crashed in decide\\(\\), request 1 \\(SIGSEGV\\)\n"},
        Crash{"aborting", SIGABRT,
              "karst: the policy plain crashed in decide\\(\\), request 1 \\(SIGABRT\\)\n"},
        Crash{"stack_overflow", SIGSEGV,
              "karst: the policy plain crashed in decide\\(\\), request 1 \\(SIGSEGV\\)\n"},
        Crash{"crash_later", SIGSEGV,
              "karst: the policy plain crashed in decide\\(\\), request 3 \\(SIGSEGV\\)\n"},
        Crash{"crash_in_event", SIGSEGV,
              "karst: the policy plain crashed in on_event\\(\\), after request 1 \\(SIGSEGV\\)\n"}),
    [](const auto& i) { return std::string(i.param.file); });

}  // namespace
}  // namespace karst::test
