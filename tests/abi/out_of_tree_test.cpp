// The examples as their author built them (installed_sdk_test.sh), flown by this host.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/abi/room.h"

namespace karst::test {
namespace {

core::Decision first_decision(const std::string& folder, const std::string& policy) {
  const std::string file =
      std::string(KARST_BUILT_BY_AUTHOR) + "/" + folder + "/lib/karst/policies/" + policy + ".so";
  Room room;
  return host::load_policy(choice_of(policy), {{file}, {}})->decide(room.request);
}

bool built() { return std::filesystem::exists(std::string(KARST_BUILT_BY_AUTHOR) + "/plain_c/lib"); }

TEST(OutOfTree, PolicyInCppFlies) {
  if (!built()) GTEST_SKIP() << "skipped: the test installed_sdk has not run here";
  const core::Decision d = first_decision("right_hand", "right_hand");
  ASSERT_EQ(d.goals.size(), 1u);
  EXPECT_EQ(d.goals[0].frontier_id, 7u);
}

TEST(OutOfTree, PolicyInPlainCFlies) {
  if (!built()) GTEST_SKIP() << "skipped: the test installed_sdk has not run here";
  const core::Decision d = first_decision("plain_c", "deepest");
  ASSERT_EQ(d.goals.size(), 1u);
  EXPECT_EQ(d.goals[0].why, "the lowest, -5.5 m below the start");
}

}  // namespace
}  // namespace karst::test
