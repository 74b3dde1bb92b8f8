#include "sdk/tools/policy_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace {

using ::testing::HasSubstr;

/// What it prints; it must end with `code`.
std::string said(const std::string& arguments, int code = 0) {
  CLI::App app;
  karst::tools::add_policy_command(app);
  ::testing::internal::CaptureStdout();
  int ended = 0;
  try {
    app.parse(arguments);
  } catch (const CLI::RuntimeError& e) {
    ended = e.get_exit_code();
  }
  EXPECT_EQ(ended, code);
  return ::testing::internal::GetCapturedStdout();
}

TEST(PolicyList, JsonNamesThePoliciesThatComeWithKarstWithTheirParameters) {
  const nlohmann::json out = nlohmann::json::parse(said("policy list --json"));
  std::map<std::string, nlohmann::json> found;
  for (const auto& p : out.at("policies")) found[p.at("id")] = p;
  for (const char* id : {"nearest_frontier", "lateral_frontier", "highest_frontier", "unknown_ratio",
                         "information_gain", "viewpoint_tour", "deep_cave", "beyond_survey"}) {
    ASSERT_TRUE(found.contains(id)) << id;
    EXPECT_EQ(found[id].at("abi"), "1.0");
    for (const auto& p : found[id].at("parameters")) EXPECT_FALSE(p.at("help").get<std::string>().empty());
  }
  const auto& side = found["lateral_frontier"].at("parameters").at(0);
  EXPECT_EQ(side.at("id"), "side");
  EXPECT_EQ(side.at("choices").size(), 4u);
}

TEST(PolicyList, BrokenPluginThatWasAskedForIsListedWithItsReasonAndFails) {
  const std::string text = said("policy list --plugin /no/such/plugin.so", 1);
  EXPECT_THAT(text, HasSubstr("broken: /no/such/plugin.so"));
  EXPECT_THAT(text, HasSubstr("cannot be opened"));
  EXPECT_THAT(text, HasSubstr("nearest_frontier 1.0.0"));
}

TEST(PolicyList, FileWhoseNameIsNoUtf8DoesNotEndTheList) {
  const nlohmann::json out = nlohmann::json::parse(said("policy list --json --plugin /no/such/\xff.so", 1));
  EXPECT_EQ(out.at("broken").at(0).at("file"), "/no/such/\xEF\xBF\xBD.so");
  EXPECT_GT(out.at("policies").size(), 5u);
}

TEST(PolicyList, VerboseTellsParametersAndFolders) {
  const std::string text = said("policy list --verbose");
  EXPECT_THAT(text, HasSubstr("min_cells = 10  (1 to 10000)"));
  EXPECT_THAT(text, HasSubstr("searched:"));
}

}  // namespace
