// One source of a policy, through several compilers, libraries, standards and levels: one host, the same
// decisions.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/abi/same_answers.h"

namespace karst::test {
namespace {

std::unique_ptr<host::HostedPolicy> load_file(const std::string& file, const std::string& policy) {
  host::PolicyChoice c = choice_of(policy);
  if (policy == "nearest_frontier") c.parameters.put("min_cells", "4");
  return host::load_policy(c, {{file}, {}});
}

class OtherBuild : public ::testing::TestWithParam<const char*> {};

TEST_P(OtherBuild, DecidesAsTheTreesOwn) {
  const std::string name = GetParam(), policy = name.starts_with("deepest") ? "deepest" : "nearest_frontier";
  const std::string other = plugin_file(name);
  if (!std::filesystem::exists(other)) GTEST_SKIP() << "skipped: this machine cannot build " << name;
  const auto a = load_file(policy == "deepest" ? plugin_file("deepest_gcc_c11")
                                               : KARST_BINARY_DIR "/lib/karst/policies/nearest_frontier.so",
                           policy);
  const auto b = load_file(other, policy);
  EXPECT_GE(expect_same_answers(*a, *b), 10u);
}

INSTANTIATE_TEST_SUITE_P(Compilers, OtherBuild, ::testing::Values(KARST_OTHER_BUILDS),
                         [](const auto& build) { return std::string(build.param); });

}  // namespace
}  // namespace karst::test
