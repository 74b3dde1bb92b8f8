// The drawer again, each plugin in a process of its own: whatever it does there, the host goes on, says why
// in the same words every time, and asks somebody else after the second time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <optional>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "core_stack/common/sanitized.h"
#include "sdk/host/isolation/file_access.h"
#include "sdk/host/isolation/isolated_policy.h"
#include "sdk/host/isolation/sandbox.h"
#include "tests/abi/room.h"

namespace karst::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

host::PolicyChoice isolated(const std::string& policy = "plain") {
  host::PolicyChoice c = choice_of(policy);
  c.isolation = host::Isolation::process;
  c.cpu_limit_s = 1.0;
  c.memory_limit_mib = 512;
  return c;
}

std::unique_ptr<host::HostedPolicy> load_isolated(const std::string& file,
                                                  const std::string& policy = "plain") {
  return load(file, isolated(policy));
}

std::string why_of(const std::string& file, host::Isolation isolation) {
  host::PolicyChoice c = isolated();
  c.isolation = isolation;
  Room room;
  return load(file, c)->decide(room.request).goals.at(0).why;
}

struct Breaker {
  const char* file;
  const char* says;            // of the first break
  double hang_limit_s = 60.0;  // far above anything a loaded machine needs
  double cpu_limit_s = 1.0;
};
void PrintTo(const Breaker& b, std::ostream* out) { *out << b.file; }

class BreakingPlugin : public ::testing::TestWithParam<Breaker> {};

TEST_P(BreakingPlugin, IsHeldOnceStartedOnceMoreThenGivenUp) {
  if (kSanitized && std::string(GetParam().file) == "memory_flood")
    GTEST_SKIP() << "skipped: a sanitizer's shadow fits no memory limit";
  host::PolicyChoice c = isolated();
  c.hang_limit_s = GetParam().hang_limit_s;
  c.cpu_limit_s = GetParam().cpu_limit_s;
  Room room;
  const auto policy = load(GetParam().file, c);
  const core::Decision d = policy->decide(room.request);
  EXPECT_EQ(d.outcome, core::Outcome::hold);
  EXPECT_TRUE(d.goals.empty());
  // Sanitizers catch signals, print, and exit instead.
  const std::string says = kSanitized && std::string(GetParam().says).find("signal") != std::string::npos
                               ? "its process ended in decide()"
                               : GetParam().says;
  const std::string asked = "request 1 at 5.0 s";  // the room's, both times
  EXPECT_THAT(d.reason,
              AllOf(HasSubstr("plain broke, and was started once more"), HasSubstr(says), HasSubstr(asked)));
  EXPECT_THAT(d.log, Contains(HasSubstr(says)));
  const pid_t second = dynamic_cast<host::IsolatedPolicy&>(*policy).process_id();
  EXPECT_THAT(failure_of(*policy, room.request),
              AllOf(StartsWith("plain: "), HasSubstr(says), HasSubstr(asked),
                    HasSubstr("had been started once more before")));
  EXPECT_EQ(kill(second, 0), -1) << "its process is still there";
  EXPECT_THAT(failure_of(*policy, room.request), HasSubstr(says));
  policy->notify({core::PolicyEvent::Kind::homing, 0, {}, ""});
  EXPECT_FALSE(policy->abandoned());
}

INSTANTIATE_TEST_SUITE_P(
    Drawer, BreakingPlugin,
    ::testing::Values(Breaker{"segfault", "ended in decide(): killed by signal 11 (Segmentation fault)"},
                      Breaker{"aborting", "ended in decide(): killed by signal 6 (Aborted)"},
                      Breaker{"exiting", "ended in decide(): exit code 0"},
                      Breaker{"spinning", "decide() took more than 1 s of processor time"},
                      Breaker{"endless_loop", "decide() did not return within 5 s", 5.0},
                      // A loaded machine may take longer than a second to hand out the pages.
                      Breaker{"memory_flood", "ended in decide(): killed by signal 11", 60.0, 60.0},
                      // Under a sanitizer 64 threads take more than a second to start.
                      Breaker{"thread_bomb", "ran more than 64 threads in decide()", 60.0, 60.0},
                      Breaker{"stack_overflow", "ended in decide(): killed by signal 11"},
                      Breaker{"other_architecture", "ended in decide(): killed by signal 31"},
                      Breaker{"stops_itself", "process stopped itself in decide()"},
                      Breaker{"scribbling", "garbage came from its process in decide()"}),
    [](const auto& i) { return std::string(i.param.file); });

double processor_s(pid_t process) {
  clockid_t clock{};
  timespec t{};
  EXPECT_EQ(clock_getcpuclockid(process, &clock), 0);
  EXPECT_EQ(clock_gettime(clock, &t), 0);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// What a process computed between two calls was never counted, and it may ignore the kernel's signal.
TEST(IsolatedPlugin, ThatComputesBetweenTwoCallsIsEnded) {
  host::PolicyChoice c = isolated();
  c.cpu_limit_s = 1;
  Room room;
  const auto policy = load("busy_between", c);
  EXPECT_EQ(policy->decide(room.request).outcome, core::Outcome::goals);
  const pid_t first = dynamic_cast<host::IsolatedPolicy&>(*policy).process_id();
  while (processor_s(first) < 4) usleep(10000);
  const core::Decision d = policy->decide(room.request);
  EXPECT_EQ(d.outcome, core::Outcome::hold);
  EXPECT_THAT(d.reason, HasSubstr("its process took more than 1 s of processor time between two calls"));
  EXPECT_EQ(kill(first, 0), -1) << "its process is still there";
}

/// What fails without breaking the process is told in the same words as in process.
class FailingPlugin : public ::testing::TestWithParam<const char*> {};

TEST_P(FailingPlugin, FailsAsInProcess) {
  const std::string name = GetParam();
  if (kSanitized && name == "memory_hog")
    GTEST_SKIP() << "a sanitizer's operator new ends the process; it never throws std::bad_alloc";
  const std::string policy = name == "memory_hog" || name == "throwing_init" ? name : "plain";
  const auto in_process = load(name, policy), in_child = load_isolated(name, policy);
  Room room;
  for (int i = 0; i < 2; ++i) {
    const core::Decision a = in_process->decide(room.request), b = in_child->decide(room.request);
    EXPECT_EQ(a.outcome, core::Outcome::hold);
    EXPECT_EQ(b.outcome, core::Outcome::hold);
    EXPECT_EQ(a.reason, b.reason);
    EXPECT_EQ(a.log, b.log);
  }
  const std::string failure = failure_of(*in_process, room.request);
  EXPECT_THAT(failure,
              AllOf(StartsWith(policy + " failed 3 times in a row"), HasSubstr("request 1 at 5.0 s")));
  EXPECT_EQ(failure_of(*in_child, room.request), failure);
}

INSTANTIATE_TEST_SUITE_P(Drawer, FailingPlugin,
                         ::testing::Values("throwing", "throwing_init", "memory_hog", "million_goals",
                                           "ignores_refusal", "no_outcome", "only_nan_goals", "babbling"),
                         [](const auto& i) { return std::string(i.param); });

/// What is refused when it is opened is refused in the same words.
class RefusedPlugin : public ::testing::TestWithParam<const char*> {};

TEST_P(RefusedPlugin, IsRefusedAsInProcess) {
  std::string in_process, in_child;
  try {
    load(GetParam());
  } catch (const core::InputError& e) {
    in_process = e.what();
  }
  try {
    load_isolated(GetParam());
  } catch (const core::InputError& e) {
    in_child = e.what();
  }
  EXPECT_NE(in_process, "");
  EXPECT_EQ(in_child, in_process);
}

INSTANTIATE_TEST_SUITE_P(Drawer, RefusedPlugin,
                         ::testing::Values("no_entry", "wrong_major", "newer_minor", "missing_slot",
                                           "bad_default", "crash_at_load"),
                         [](const auto& i) { return std::string(i.param); });

/// What answers in spite of all, answers the same.
class OddPlugin : public ::testing::TestWithParam<const char*> {};

TEST_P(OddPlugin, AnswersAsInProcess) {
  const auto in_process = load(GetParam()), in_child = load_isolated(GetParam());
  EXPECT_EQ(in_process->version(), in_child->version());
  EXPECT_EQ(in_process->parameters(), in_child->parameters());
  Room room;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const core::Decision a = in_process->decide(room.request), b = in_child->decide(room.request);
  ::testing::internal::GetCapturedStdout();
  ::testing::internal::GetCapturedStderr();
  ASSERT_EQ(a.goals.size(), 1u);
  ASSERT_EQ(b.goals.size(), 1u);
  EXPECT_EQ(a.goals[0].position, b.goals[0].position);
  EXPECT_EQ(a.goals[0].why, b.goals[0].why);
  EXPECT_EQ(a.log, b.log);
  EXPECT_EQ(a.reason, b.reason);
}

INSTANTIATE_TEST_SUITE_P(Drawer, OddPlugin,
                         ::testing::Values("plain", "nan_goal", "locale_changer", "changes_process_at_load",
                                           "talkative", "flooding_stdout", "writes_request"),
                         [](const auto& i) { return std::string(i.param); });

TEST(IsolatedPlugin, ReachesNothingButItsOwnFilesAndTheSystemsLibraries) {
  EXPECT_EQ(why_of("reaching_out", host::Isolation::process),
            host::landlock_version() > 0
                ? "own+ library+ parent- etc- list- write- create- inet- unix- signal- exec- limit- "
                : "own+ library+ parent+ etc+ list+ write- create- inet- unix- signal- exec- limit- ");
  EXPECT_THAT(why_of("reaching_out", host::Isolation::in_process),
              HasSubstr("own+ library+ parent+ etc+ list+ write+ create+"));  // the plugin does try
}

TEST(IsolatedPlugin, CannotFork) {
  EXPECT_EQ(why_of("forking", host::Isolation::process), "could not fork");
  EXPECT_EQ(why_of("forking", host::Isolation::in_process), "forked");
}

TEST(IsolatedPlugin, GoesOnWithItsStateAndItsRandomNumbersAfterACrash) {
  Room room;
  const auto policy = load_isolated("remembering");
  const auto never_crashed = load("remembering");
  std::vector<double> scores, expected;
  for (room.request.sequence = 1; room.request.sequence <= 5; ++room.request.sequence) {
    const core::Decision d = policy->decide(room.request);
    EXPECT_EQ(d.goals.empty(), room.request.sequence == 3u);
    if (!d.goals.empty()) scores.push_back(d.goals[0].score);
  }
  for (int i = 0; i < 2; ++i) expected.push_back(never_crashed->decide(room.request).goals.at(0).score);
  ASSERT_EQ(scores.size(), 4u);
  EXPECT_EQ(scores[0], expected[0]);
  EXPECT_EQ(scores[1], expected[1]);
  EXPECT_EQ(std::floor(scores[2]), 3);  // what was lost is the decision it crashed in
  EXPECT_EQ(std::floor(scores[3]), 4);
  core::Random drawn = core::Random::stream(isolated().seed, "policy plain");
  for (const double s : scores) EXPECT_NEAR(s - std::floor(s), drawn.uniform(), 1e-12);
}

TEST(IsolatedPlugin, ThatCrashesInAnEventTellsWithTheNextDecision) {
  Room room;
  const auto policy = load_isolated("crash_in_event");
  EXPECT_EQ(policy->decide(room.request).goals.size(), 1u);
  policy->notify({core::PolicyEvent::Kind::goal_reached, 7 * core::kSecond, {}, ""});
  EXPECT_THAT(policy->decide(room.request).reason,
              AllOf(HasSubstr("in on_event()"), HasSubstr("event reached at 7.0 s")));
  EXPECT_EQ(policy->decide(room.request).goals.size(), 1u);
  policy->notify({core::PolicyEvent::Kind::goal_reached, 0, {}, ""});
  EXPECT_THAT(failure_of(*policy, room.request), HasSubstr("in on_event()"));
}

/// 64 goals that are refused are 64 events: each within the limit, together minutes.
TEST(IsolatedPlugin, ThatTakesLongOverManyEventsPassesTheLimitOfTheRound) {
  Room room;
  host::PolicyChoice c = isolated();
  c.hang_limit_s = 2.5;
  const auto policy = load("dawdling", c);
  EXPECT_EQ(policy->decide(room.request).goals.size(), 1u);
  const auto told = [&] { policy->notify({core::PolicyEvent::Kind::goal_rejected, 0, {}, ""}); };
  for (int i = 0; i < 3; ++i) told();
  EXPECT_THAT(policy->decide(room.request).reason, HasSubstr("on_event() did not return within 2.5 s"));
}

TEST(IsolatedPlugin, WhoseProcessIsKilledFromOutsideIsStartedOnceMore) {
  Room room;
  const auto policy = load_isolated("plain");
  EXPECT_EQ(policy->decide(room.request).goals.size(), 1u);
  kill(dynamic_cast<host::IsolatedPolicy&>(*policy).process_id(), SIGKILL);
  EXPECT_THAT(policy->decide(room.request).reason, HasSubstr("killed by signal 9"));
  EXPECT_EQ(policy->decide(room.request).goals.size(), 1u);
}

/// In a process of its own: asks an isolated policy once, says what the policy's process is, and waits.
[[noreturn]] void host_a_policy(const std::string& file, int out) {
  try {
    Room room;
    const auto policy = load_isolated(file);
    policy->decide(room.request);
    const pid_t id = dynamic_cast<host::IsolatedPolicy&>(*policy).process_id();
    if (write(out, &id, sizeof id) != sizeof id) _exit(1);
    for (;;) pause();
  } catch (...) {  // or the tests would run a second time, in this process
    _exit(1);
  }
}

/// Waits for `id`, a child by adoption; nothing if it is still there after ten seconds.
std::optional<int> end_of(pid_t id) {
  for (int i = 0; i < 1000; ++i) {
    int status = 0;
    if (waitpid(id, &status, WNOHANG) == id) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return std::nullopt;
}

/// Its process is adopted by this one when the host is gone, and found to have been ended by the kernel.
class OutlivingPlugin : public ::testing::TestWithParam<const char*> {};

TEST_P(OutlivingPlugin, EndsWithAHostThatIsKilled) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t host = fork();
  ASSERT_GE(host, 0);
  if (host == 0) host_a_policy(GetParam(), ends[1]);
  close(ends[1]);
  pid_t policy = -1;
  ASSERT_EQ(read(ends[0], &policy, sizeof policy), static_cast<ssize_t>(sizeof policy));
  close(ends[0]);
  ASSERT_EQ(kill(policy, 0), 0);
  kill(host, SIGKILL);
  ASSERT_TRUE(end_of(host));
  const std::optional<int> status = end_of(policy);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
  if (!status) kill(policy, SIGKILL);
  ASSERT_TRUE(status) << "the policy's process outlived the host";
  EXPECT_TRUE(WIFSIGNALED(*status));
  EXPECT_EQ(WTERMSIG(*status), SIGKILL);
}

INSTANTIATE_TEST_SUITE_P(Drawer, OutlivingPlugin, ::testing::Values("plain", "outliving", "remembering"),
                         [](const auto& i) { return std::string(i.param); });

/// The thread that loaded it is not the one that flies it.
TEST(IsolatedPlugin, GoesOnWhenTheThreadThatLoadedItHasEnded) {
  Room room;
  std::unique_ptr<host::HostedPolicy> policy;
  std::thread([&] { policy = load_isolated("plain"); }).join();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(policy->decide(room.request).goals.size(), 1u);
}

/// Every service, asked of a map that changes between requests.
TEST(IsolatedPlugin, GetsTheSameAnswersOfEveryService) {
  Room here, there;
  const auto in_process = load("inquisitive", "inquisitive"),
             in_child = load_isolated("inquisitive", "inquisitive");
  for (int i = 0; i < 3; ++i) {
    const core::Decision a = in_process->decide(here.request), b = in_child->decide(there.request);
    EXPECT_EQ(a.outcome, b.outcome);
    EXPECT_EQ(a.log, b.log);
    ASSERT_EQ(a.goals.size(), b.goals.size());
    ASSERT_GT(a.goals.size(), 10u);
    for (std::size_t j = 0; j < a.goals.size(); ++j) EXPECT_EQ(a.goals[j].why, b.goals[j].why) << j;
    ASSERT_EQ(a.drawings.size(), b.drawings.size());
    for (std::size_t j = 0; j < a.drawings.size(); ++j) {
      EXPECT_EQ(a.drawings[j].points, b.drawings[j].points);
      EXPECT_EQ(a.drawings[j].text, b.drawings[j].text);
    }
    for (Room* room : {&here, &there})
      room->roadmap.update(room->map, room->map.declare_free({10.5, 4.5, 4.5 + i % 2}, 0.6));
  }
}

}  // namespace
}  // namespace karst::test
