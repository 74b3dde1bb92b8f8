// One source of a policy, through several compilers, libraries and levels: one host, the same decisions.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/abi/room.h"

namespace karst::test {
namespace {

std::unique_ptr<host::HostedPolicy> load_file(const std::string& file, const std::string& policy) {
  return host::load_policy(choice_of(policy), {{file}, {}});
}

void expect_same_flight(core::PolicyPort& a, core::PolicyPort& b) {
  Room room;
  for (int i = 0; i < 20; ++i, ++room.request.sequence) {
    room.request.stamp += core::kSecond;
    room.request.state.position.x() = 1.5 + 0.3 * i;
    room.request.frontiers[0].path_length_m = 8.5 - room.request.state.position.x();
    const core::Decision da = a.decide(room.request), db = b.decide(room.request);
    ASSERT_EQ(da.outcome, db.outcome);
    ASSERT_EQ(da.reason, db.reason);
    ASSERT_EQ(da.goals.size(), db.goals.size());
    for (std::size_t k = 0; k < da.goals.size(); ++k) {
      EXPECT_EQ(da.goals[k].position, db.goals[k].position);
      EXPECT_EQ(da.goals[k].score, db.goals[k].score);
      EXPECT_EQ(da.goals[k].why, db.goals[k].why);
    }
  }
}

class OtherBuild : public ::testing::TestWithParam<const char*> {};

TEST_P(OtherBuild, DecidesAsTheTreesOwn) {
  const std::string other = plugin_file(std::string("nearest_frontier_") + GetParam());
  if (!std::filesystem::exists(other)) GTEST_SKIP() << "skipped: this machine cannot build " << GetParam();
  host::PolicyChoice c = choice_of("nearest_frontier");
  c.parameters.put("min_cells", "4");
  const auto a =
      host::load_policy(c, {{std::string(KARST_BINARY_DIR) + "/lib/karst/policies/nearest_frontier.so"}, {}});
  const auto b = host::load_policy(c, {{other}, {}});
  expect_same_flight(*a, *b);
  Room room;
  EXPECT_EQ(a->decide(room.request).goals.size(), 1u) << "a comparison of nothing proves nothing";
}

INSTANTIATE_TEST_SUITE_P(Compilers, OtherBuild, ::testing::Values("clang_libcxx", "gcc_O0", "gcc_O3_cxx20"));

TEST(PlainC, OptimizedAndNotDecideAlike) {
  const auto a = load_file(plugin_file("plain"), "plain"), b = load_file(plugin_file("plain_O0"), "plain");
  const auto c = load_file(plugin_file("plain_O3"), "plain");
  expect_same_flight(*a, *b);
  expect_same_flight(*a, *c);
}

}  // namespace
}  // namespace karst::test
