// `karst report` of a team's run directory: what it refuses, leaving all as it was, and what it mends.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "sdk/tools/report_command.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::tools {
namespace {

using nlohmann::json;
using test::TemporaryDirectory;

/// "" or why it was refused.
std::string report(const std::filesystem::path& run) {
  CLI::App app;
  add_report_command(app, [](const auto&...) { return std::optional<std::filesystem::path>(); });
  try {
    app.parse(std::vector<std::string>{"--no-report", run.string(), "report"});
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

/// A flight of two that was killed: neither metrics nor maps.
void write_killed_team(const TemporaryDirectory& dir) {
  test::FakeRunOptions small;
  small.length_m = 36;
  small.map_resolution_m = 0.5;
  for (const char* robot : {"robot_1", "robot_2"}) test::write_fake_run(dir.path() / robot, small);
  dir.write("mission.info", "seed 11\npolicy\n{\n name lateral_frontier\n}\nteam\n{\n robots 2\n}\n");
  dir.write("team.jsonl", R"({"t":0,"kind":"team","robots":2}
{"t":0,"kind":"start","robot":1}
{"t":20,"kind":"start","robot":2}
)");
}

json metrics_in(const std::filesystem::path& folder) {
  std::ifstream in(folder / "metrics.json");
  return json::parse(in, nullptr, false);
}

TEST(TeamReport, WithoutTheLogOrARobotIsRefusedAndNothingIsOverwritten) {
  for (const char* missing : {"team.jsonl", "robot_1", "robot_2"}) {
    TemporaryDirectory dir;
    write_killed_team(dir);
    for (const char* file : {"metrics.json", "telemetry.csv", "robot_1/metrics.json", "robot_2/metrics.json"})
      dir.write(file, "as it was");
    std::filesystem::remove_all(dir.path() / missing);
    EXPECT_NE(report(dir.path()).find(std::string(missing) + ": not there"), std::string::npos) << missing;
    for (const char* file : {"metrics.json", "telemetry.csv", "robot_1/metrics.json", "robot_2/metrics.json"})
      if (std::ifstream in(dir.path() / file); in) {
        EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "as it was") << file;
      }
  }
}

TEST(TeamReport, OfAKilledFlightSaysWhatFlewAndThatItWasAborted) {
  TemporaryDirectory dir;
  write_killed_team(dir);
  ASSERT_EQ(report(dir.path()), "");
  const json m = metrics_in(dir.path());
  EXPECT_EQ(m["schema"], "karst.metrics/1");
  EXPECT_EQ(m["policy"], "lateral_frontier");
  EXPECT_TRUE(m["cave"].is_null()) << "its mission names none";
  EXPECT_EQ(m["seed"], 11);
  EXPECT_EQ(m["outcome"], "aborted");
  EXPECT_DOUBLE_EQ(m["path_length_m"].get<double>(),
                   2 * metrics_in(dir.path() / "robot_1")["path_length_m"].get<double>());
  EXPECT_GT(m["explored_volume_m3"], 0);
  EXPECT_TRUE(m["robots_landed"].is_null());
}

TEST(TeamReport, CompletesWhatAFlightWroteBeforeItsEvaluationWasKilled) {
  TemporaryDirectory dir;
  write_killed_team(dir);
  dir.write("metrics.json", R"({"outcome": "landed", "robots_landed": 1.0, "path_length_m": null})");
  ASSERT_EQ(report(dir.path()), "");
  const json m = metrics_in(dir.path());
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_EQ(m["robots_landed"], 1.0);
  EXPECT_GT(m["path_length_m"], 0);
  EXPECT_GT(m["explored_volume_m3"], 0);
}

}  // namespace
}  // namespace karst::tools
