// Plugins of every released ABI, kept as they were built then: this host loads them, and they answer as a
// build of today of the same source does.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/abi/same_answers.h"

namespace karst::test {
namespace {

class Kept : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
#ifndef __x86_64__
    GTEST_SKIP() << "skipped: the kept plugins are for x86-64";
#endif
  }
  const std::string policy = GetParam();
  const std::string file = std::string(KARST_SOURCE_DIR) + "/tests/abi/kept/1.0/" + policy + ".so";
};

TEST_P(Kept, IsListedAsOfItsOwnAbi) {
  const auto all = host::list_policies({{file}, {}});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].broken, "");
  EXPECT_EQ(all[0].id, policy);
  EXPECT_EQ(all[0].abi, "1.0");
}

TEST_P(Kept, AnswersAsIfBuiltToday) {
  const auto kept = host::load_policy(choice_of(policy), {{file}, {}});
  const auto today = host::load_policy(choice_of(policy), {{plugin_file("kept_" + policy)}, {}});
  EXPECT_GE(expect_same_answers(*kept, *today), 20u);
}

INSTANTIATE_TEST_SUITE_P(Abi1_0, Kept, ::testing::Values("right_hand", "deepest", "inquisitive"),
                         [](const auto& plugin) { return std::string(plugin.param); });

}  // namespace
}  // namespace karst::test
