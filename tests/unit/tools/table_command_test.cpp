// `karst table`: a line each run, the last column of which says how it ended.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "sdk/tools/table_command.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::tools {
namespace {

using test::TemporaryDirectory;

std::vector<std::string> table(const std::vector<std::filesystem::path>& runs) {
  std::vector<std::string> words{"table"};
  for (const auto& run : runs) words.push_back(run.string());
  std::reverse(words.begin(), words.end());
  CLI::App app;
  add_table_command(app);
  ::testing::internal::CaptureStdout();
  app.parse(words);
  std::istringstream said(::testing::internal::GetCapturedStdout());
  std::vector<std::string> lines;
  for (std::string line; std::getline(said, line);) lines.push_back(line);
  return lines;
}

constexpr const char* kMetrics = R"({"cave": "small", "outcome": "landed", "battery_left": 0.62})";
std::string home_because(const std::string& reason) {
  return R"({"t": 1, "kind": "phase", "phase": "explore"}
{"t": 64, "kind": "phase", "phase": "home", "reason": ")" +
         reason + R"("}
{"t": 92, "kind": "outcome", "outcome": "landed", "reason": "at the start"}
)";
}

std::ptrdiff_t bars(const std::string& line) { return std::count(line.begin(), line.end(), '|'); }

TEST(TableCommand, SaysInItsLastColumnHowEachRunEnded) {
  TemporaryDirectory told, silent;
  told.write("metrics.json", kMetrics);
  told.write("events.jsonl", home_because("explored: no frontier can be reached"));
  silent.write("metrics.json", kMetrics);
  const auto lines = table({told.path(), silent.path()});
  ASSERT_EQ(lines.size(), 9u) << "head, rule, two runs, five of their spread";
  EXPECT_TRUE(lines[0].ends_with("| ended |"));
  EXPECT_TRUE(lines[1].ends_with("|---|"));
  EXPECT_TRUE(lines[2].ends_with("| home because nothing was left to explore; 62 % battery left |"))
      << lines[2];
  EXPECT_TRUE(lines[3].ends_with("|  |")) << "without events nobody knows: " << lines[3];
  for (const std::string& line : lines) EXPECT_EQ(bars(line), bars(lines[0])) << line;
}

TEST(TableCommand, KeepsItsColumnsWhateverAPolicySays) {
  TemporaryDirectory run;
  run.write("metrics.json", kMetrics);
  run.write("events.jsonl", home_because("the policy asked for it: left | right\\nand home"));
  const auto lines = table({run.path()});
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(
      lines[2].ends_with("| home because the policy asked for it (left / right and home); 62 % battery "
                         "left |"))
      << lines[2];
}

TEST(TableCommand, LeavesOutColumnsThatNoRunHas) {
  TemporaryDirectory battery, coverage;
  battery.write("metrics.json", kMetrics);
  EXPECT_EQ(table({battery.path()})[0], "| cave | policy | seed | outcome | battery % | ended |");
  coverage.write("metrics.json", R"({"cave": "small", "coverage": 0.5, "path_length_m": null})");
  const auto lines = table({battery.path(), coverage.path()});
  EXPECT_EQ(lines[0], "| cave | policy | seed | outcome | coverage % | battery % | ended |");
  EXPECT_EQ(lines[2], "| small | - | - | landed | - | 62 |  |") << "another run has it";
}

TEST(TableCommand, OfATeamNamesTheRobotsThatDidNotDoAsMeant) {
  TemporaryDirectory team;
  team.write("metrics.json", R"({"cave": "small", "outcome": "landed"})");
  team.write("team.jsonl", "{\"t\": 0, \"kind\": \"team\", \"robots\": 2}\n");
  for (const char* robot : {"robot_1", "robot_2"}) std::filesystem::create_directory(team.path() / robot);
  team.write("robot_1/events.jsonl", home_because("explored: "));
  team.write("robot_2/events.jsonl", R"({"t": 1, "kind": "phase", "phase": "explore"}
{"t": 30, "kind": "outcome", "outcome": "contact", "reason": "touched rock"}
)");
  EXPECT_TRUE(
      table({team.path()})[2].ends_with("| robot 2: contact after 29 s while exploring: touched rock |"));
}

}  // namespace
}  // namespace karst::tools
