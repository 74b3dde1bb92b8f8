// What a policy in a process of its own prints reaches its author, and keeps nobody up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "core_stack/common/error.h"
#include "core_stack/common/sanitized.h"
#include "sdk/host/boundary/policy_output.h"
#include "tests/abi/room.h"

namespace karst::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Printing {
  std::shared_ptr<host::PolicyOutput> output = std::make_shared<host::PolicyOutput>();
  host::PolicyChoice choice = choice_of("plain");

  Printing() {
    choice.isolation = host::Isolation::process;
    choice.cpu_limit_s = 60;
    choice.memory_limit_mib = 512;
    choice.output = output;
  }
};

TEST(PrintedOutput, ArrivesFromTheOpeningOfThePluginOn) {
  Printing p;
  Room room;
  auto policy = load("talkative", p.choice);
  EXPECT_EQ(policy->decide(room.request).goals.size(), 1u);
  policy.reset();
  EXPECT_EQ(p.output->last_lines(), "{\"policies\": \"mine!\"}\n{\"policies\": \"mine!\"}\n");
  EXPECT_EQ(p.output->before_break(), "");
}

TEST(PrintedOutput, OfARefusedPolicyArrives) {
  Printing p;
  p.choice.parameters.put("nonsense", "1");
  EXPECT_THROW(load("talkative", p.choice), core::InputError);
  EXPECT_EQ(p.output->last_lines(), "{\"policies\": \"mine!\"}\n");
}

TEST(PrintedOutput, BeforeACrashIsKeptWithoutEscapeSequences) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer prints more";
  Printing p;
  Room room;
  const auto policy = load("last_words", p.choice);
  for (room.request.sequence = 1; room.request.sequence <= 2; ++room.request.sequence)
    EXPECT_EQ(policy->decide(room.request).outcome, core::Outcome::goals);
  EXPECT_EQ(policy->decide(room.request).outcome, core::Outcome::hold);
  EXPECT_EQ(p.output->before_break(),
            "?[31mrequest 1?[0m\n?[31mrequest 2?[0m\n?[31mrequest 3?[0m\nabout to crash\n");
  EXPECT_THAT(failure_of(*policy, room.request), HasSubstr("had been started once more before"));
  EXPECT_THAT(p.output->before_break(), EndsWith("?[31mrequest 3?[0m\nabout to crash\n"));
}

TEST(PrintedOutput, AFloodIsCutAndThePolicyAnswers) {
  Printing p;
  const std::filesystem::path file =
      std::filesystem::path(KARST_BINARY_DIR) / "test_runs" / "printed_flood.txt";
  std::filesystem::create_directories(file.parent_path());
  std::filesystem::remove(file);
  p.output->write_to(file);
  Room room;
  auto policy = load("flooding_stdout", p.choice);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(policy->decide(room.request).outcome, core::Outcome::goals);
  policy.reset();
  EXPECT_LT(std::filesystem::file_size(file), host::kOutputBudget_bytes + 100);
  EXPECT_GT(std::filesystem::file_size(file), host::kOutputBudget_bytes - 100);
  EXPECT_THAT(p.output->last_lines(), StartsWith("0123456789"));
}

TEST(PrintedOutput, OfAPolicyThatClosesStdoutEndsThereAndThePolicyAnswers) {
  Printing p;
  Room room;
  auto policy = load("closes_stdout", p.choice);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(policy->decide(room.request).outcome, core::Outcome::goals);
  policy.reset();
  EXPECT_EQ(p.output->last_lines(), "open\n");
}

/// In a process of its own, whose limit on memory is below that of the policy's.
[[noreturn]] void decide_under_a_lower_limit() {
  try {
    Printing p;
    p.choice.memory_limit_mib = 16 * 1024;
    const rlim_t bytes = rlim_t{8} << 30;
    const rlimit low{bytes, bytes};
    Room room;
    if (setrlimit(RLIMIT_AS, &low) != 0) _exit(2);
    _exit(load("plain", p.choice)->decide(room.request).goals.size() == 1 ? 0 : 3);
  } catch (...) {  // or the tests would run a second time, in this process
    _exit(1);
  }
}

TEST(IsolatedPolicy, StartsUnderALowerLimitOfTheUsersOwn) {
  if (kSanitized) GTEST_SKIP() << "skipped: a sanitizer's shadow fits no memory limit";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) decide_under_a_lower_limit();
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// In a process of its own: a file may not grow to the size of the memory that is to be shared.
[[noreturn]] void load_under_a_limit_on_files() {
  try {
    const Printing p;
    const rlimit small{60'000, 60'000};
    if (setrlimit(RLIMIT_FSIZE, &small) != 0) _exit(2);
    load("plain", p.choice);
    _exit(3);
  } catch (const host::CannotConfine& e) {
    _exit(std::string(e.what()).find("File too large") == std::string::npos ? 4 : 0);
  } catch (...) {
    _exit(1);
  }
}

// As it was: the signal of that limit ended the host.
TEST(IsolatedPolicy, UnderALimitOnFilesItIsSaidThatThereIsNoProcess) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) load_under_a_limit_on_files();
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by a signal";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace karst::test
