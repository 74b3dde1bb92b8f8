#include "sdk/evaluation/report/report.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "core_stack/common/error.h"
#include "sdk/evaluation/decisions/goal_spans.h"
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/metrics/summary.h"
#include "sdk/evaluation/report/team_report.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TemporaryDirectory;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The data inside the page.
json data_of(const std::string& page) {
  const std::string mark = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(mark) + mark.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

bool mentions(const json& problems, const std::string& text) {
  for (const json& p : problems)
    if (p.get<std::string>().find(text) != std::string::npos) return true;
  return false;
}

TEST(Report, IsOneFileThatLoadsNothing) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  write_report(dir.path());
  const std::string page = bytes_of(dir.path() / "report.html");
  EXPECT_LT(page.size(), 10u << 20);
  // In the markup, that is outside scripts, nothing refers to another file.
  const std::string markup = std::regex_replace(page.substr(0, page.find("<style>")), std::regex("\n"), " ");
  EXPECT_FALSE(std::regex_search(markup, std::regex("(src|href)=\"(?!data:)")));
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("<link rel=\"stylesheet\""), std::string::npos);
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);  // and the browser is told to load nothing
  EXPECT_EQ(page.find("@data@"), std::string::npos);
}

TEST(Report, HoldsTheRunsData) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  write_report(dir.path());
  const json d = data_of(bytes_of(dir.path() / "report.html"));
  EXPECT_EQ(d["metrics"]["policy"], "lateral");
  const auto growth_cells = fs::file_size(dir.path() / "map_growth.bin") / 16;
  EXPECT_EQ(d["cloud"]["count"], growth_cells);
  EXPECT_EQ(d["cloud"]["cells"].get<std::string>().size(), (growth_cells * 6 + 2) / 3 * 4);
  EXPECT_GT(d["goals"].size(), 5u);
  EXPECT_EQ(d["phases"].size(), 4u);
  EXPECT_FALSE(d["curves"]["volume"].empty());
}

TEST(Report, ShowsTheRegionAndSaysThatItsCoverageIsOfIt) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  write_report(dir.path());
  EXPECT_TRUE(data_of(bytes_of(dir.path() / "report.html"))["region"].is_null());
  EXPECT_FALSE(evaluate_run(dir.path(), {}).contains("coverage_of"));
  std::ofstream(dir.path() / "mission.info", std::ios::app)
      << "region { keep_in \"polygon -5 -5 30 -5 30 9\" keep_out \"box 1 2 -1 3 4 1.5\" margin 0.5 }\n";
  auto metrics = evaluate_run(dir.path(), {});
  EXPECT_EQ(metrics["coverage_of"], "region");
  metrics["coverage"] = 0.994;
  EXPECT_NE(summary_of(metrics, {}).find("(99.4 % of what can be reached in the region)"), std::string::npos)
      << summary_of(metrics, {});
  write_report(dir.path());
  const json bodies = data_of(bytes_of(dir.path() / "report.html"))["region"];
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_EQ(bodies[0]["keep"], "in");
  EXPECT_EQ(bodies[0]["outline"], json::parse("[[-5,-5],[30,-5],[30,9]]"));
  EXPECT_LT(bodies[0]["low"].get<double>(), 0) << "an open height ends with the map";
  EXPECT_LT(bodies[0]["high"].get<double>() - bodies[0]["low"].get<double>(), 50);
  EXPECT_EQ(bodies[1]["keep"], "out");
  EXPECT_EQ(bodies[1]["low"], -1);
  EXPECT_EQ(bodies[1]["high"], 1.5);
}

TEST(Report, ShowsTheLoopsOfAReplayAndThePathBefore) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  write_report(dir.path());
  json d = data_of(bytes_of(dir.path() / "report.html"));
  EXPECT_TRUE(d["loops"].is_null() && d["odometry_track"].is_null());
  fs::copy_file(dir.path() / "trajectory.tum", dir.path() / "trajectory_odometry.tum");
  std::ofstream(dir.path() / "loops.csv")
      << "older_s,newer_s,state,older_x,older_y,older_z,newer_x,newer_y,newer_z\n"
      << "1,40,closed,1,2,3,1.5,2,3\n2,50,alone,4,5,6,4,5,7\n3,60,closed,nan,5,6,4,5,7\n";
  write_report(dir.path());
  d = data_of(bytes_of(dir.path() / "report.html"));
  EXPECT_EQ(d["loops"], json::parse("[[[1,2,3],[1.5,2,3],true],[[4,5,6],[4,5,7],false]]"));
  EXPECT_EQ(d["odometry_track"], d["track"]);
}

TEST(Report, HoldsTheDrawingsThatItIsGivenAndTheirNote) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  write_report(dir.path(), {{{"Plan", "<svg><text>A &lt;b&gt;</text></svg>"}}, "One is left out."});
  const std::string page = bytes_of(dir.path() / "report.html");
  const json drawn = data_of(page)["cave_drawings"];
  ASSERT_EQ(drawn["pages"].size(), 1u);
  EXPECT_EQ(drawn["pages"][0]["title"], "Plan");
  EXPECT_EQ(drawn["pages"][0]["svg"], "<svg><text>A &lt;b&gt;</text></svg>");
  EXPECT_EQ(drawn["note"], "One is left out.");
  write_report(dir.path());
  const json none = data_of(bytes_of(dir.path() / "report.html"))["cave_drawings"];
  EXPECT_TRUE(none["pages"].empty());
  EXPECT_EQ(none["note"], "");
}

TEST(Report, SumsTheFlightUpAndSaysWhetherItWentAsMeant) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  write_report(dir.path());
  const json whole = data_of(bytes_of(dir.path() / "report.html"));
  EXPECT_EQ(whole["as_meant"], true);
  const std::string summary = whole["summary"];
  EXPECT_EQ(summary.find("lateral explored "), 0u) << summary;
  EXPECT_NE(summary.find(" of winding_tunnel in 76 s, "), std::string::npos) << summary;
  EXPECT_NE(summary.find("; home after 38 s; 87 % battery left"), std::string::npos) << summary;
  std::ofstream(dir.path() / "events.jsonl", std::ios::app)
      << R"({"t": 10, "kind": "safety", "action": "home", "reason": "no sensor sees the cave any more"})"
      << "\n";
  write_report(dir.path());
  EXPECT_EQ(data_of(bytes_of(dir.path() / "report.html"))["as_meant"], false);
  fs::remove(dir.path() / "events.jsonl");
  write_report(dir.path());
  EXPECT_TRUE(data_of(bytes_of(dir.path() / "report.html"))["as_meant"].is_null()) << "nobody knows";
}

TEST(Report, OfATeamSumsItUpAndHasAnEndingOfEachRobot) {
  TemporaryDirectory dir;
  test::FakeRunOptions small;
  small.length_m = 12;
  small.map_resolution_m = 0.5;
  for (const char* robot : {"robot_1", "robot_2"}) test::write_fake_run(dir.path() / robot, small);
  dir.write("team.jsonl", R"({"t":0,"kind":"team","robots":2}
{"t":0,"kind":"start","robot":1}
{"t":20,"kind":"start","robot":2}
)");
  dir.write("metrics.json",
            R"({"policy": "lateral", "explored_volume_m3": 99.7, "robots": [{}, {}], "duration_s": 32})");
  write_team_report(dir.path());
  const json well = data_of(bytes_of(dir.path() / "report.html"));
  EXPECT_EQ(well["as_meant"], true);
  EXPECT_EQ(well["summary"],
            "a team of 2 with lateral explored 100 m³ in 32 s; all 2 robots flew as planned");
  EXPECT_EQ(well["robots"][1]["ending"], well["robots"][0]["ending"]) << "times count from its own take-off";
  EXPECT_EQ(well["robots"][0]["ending"].get<std::string>().find("home after "), 0u);
  std::ofstream(dir.path() / "robot_2" / "events.jsonl", std::ios::app)
      << R"({"t": 3, "kind": "safety", "action": "home", "reason": "no sensor sees the cave any more"})"
      << "\n";
  write_team_report(dir.path());
  const json other = data_of(bytes_of(dir.path() / "report.html"));
  EXPECT_EQ(other["as_meant"], false);
  EXPECT_NE(other["summary"].get<std::string>().find("; robot 2: home after "), std::string::npos);
}

TEST(Report, UsesTheMetricsThatWereWritten) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  dir.write("metrics.json", R"({"policy": "as written", "outcome": "landed"})");
  write_report(dir.path());
  EXPECT_EQ(data_of(bytes_of(dir.path() / "report.html"))["metrics"]["policy"], "as written");
}

TEST(Report, IsNotBrokenByTextFromAPolicy) {
  TemporaryDirectory dir;
  dir.write("events.jsonl",
            "{\"t\": 1, \"kind\": \"log\", \"text\": \"</script><script>alert(1)</script> <!-- \xff\"}\n");
  dir.write("mission.info", "policy\n{\nname \"</script><b>@scripts@\"\n}\n");
  write_report(dir.path());
  const std::string page = bytes_of(dir.path() / "report.html");
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(data_of(page)["metrics"]["policy"], "</script><b>@scripts@");
}

TEST(Report, OfARunCutShortAnywhereShowsWhatThereIs) {
  TemporaryDirectory whole;
  test::FakeRunOptions small;
  small.length_m = 12;
  small.map_resolution_m = 0.5;
  test::write_fake_run(whole.path(), small);
  for (const auto& entry : fs::directory_iterator(whole.path())) {
    const std::string name = entry.path().filename().string();
    const std::string bytes = bytes_of(entry.path());
    for (const double fraction : {0.0, 0.001, 0.3337, 0.77}) {
      TemporaryDirectory cut;
      for (const auto& other : fs::directory_iterator(whole.path()))
        fs::copy_file(other.path(), cut.path() / other.path().filename());
      cut.write(name,
                bytes.substr(0, static_cast<std::size_t>(fraction * static_cast<double>(bytes.size())) | 3));
      ASSERT_NO_THROW(write_report(cut.path())) << name << " cut at " << fraction;
      const json d = data_of(bytes_of(cut.path() / "report.html"));
      const bool cut_in_a_line = fraction == 0.3337 && name != "timing.json" && name != "mission.info";
      EXPECT_TRUE(!cut_in_a_line || mentions(d["problems"], name)) << name;
    }
    TemporaryDirectory without;
    for (const auto& other : fs::directory_iterator(whole.path()))
      if (other.path() != entry.path()) fs::copy_file(other.path(), without.path() / other.path().filename());
    ASSERT_NO_THROW(write_report(without.path())) << "without " << name;
  }
}

TEST(Report, OfDamagedFilesNamesThem) {
  TemporaryDirectory dir;
  dir.write("mission.info", "a { b\n");
  dir.write("events.jsonl", "nonsense\n{\"t\": \"x\", \"kind\": \"goal\"}\n[1]\n");
  dir.write("timing.json", "{");
  dir.write("map.bt", "not a map");
  std::vector<std::string> problems;
  evaluate_run(dir.path(), {}, &problems);
  for (const char* name : {"mission.info", "events.jsonl: line 1", "timing.json", "map.bt"})
    EXPECT_TRUE(mentions(problems, name)) << name;
  EXPECT_NO_THROW(write_report(dir.path()));
}

// As it was: a crash for want of stack.
TEST(Report, OfAnEventAHundredThousandLevelsDeepLeavesOutItsDepth) {
  TemporaryDirectory dir;
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  dir.write("events.jsonl", R"({"t": 1, "kind": "phase", "phase": "explore", "more": )" + deep + "}\n");
  dir.write("timing.json", deep);
  dir.write("metrics.json", "{\"a\": " + deep + "}");
  write_report(dir.path());
  const std::string page = bytes_of(dir.path() / "report.html");
  EXPECT_NE(page.find("\"phase\":\"explore\""), std::string::npos);
  EXPECT_EQ(page.find(std::string(200, '[')), std::string::npos);
}

TEST(Report, OfEmptyFilesOrDirectoriesInTheirPlaceNamesThem) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  const auto problems = [&dir] {
    std::vector<std::string> all;
    evaluate_run(dir.path(), {}, &all);
    return all;
  };
  const auto text = {"telemetry.csv", "events.jsonl", "truth.csv", "trajectory.tum", "ground_truth.tum"};
  for (const char* name : text) dir.write(name, "");
  for (const char* name : text) EXPECT_TRUE(mentions(problems(), std::string(name) + ": is empty")) << name;
  const auto all = {"telemetry.csv", "events.jsonl", "map_growth.bin",
                    "map.bt",        "timing.json",  "mission.info"};
  for (const char* name : all) {
    fs::remove(dir.path() / name);
    fs::create_directories(dir.path() / name);
  }
  for (const char* name : all)
    EXPECT_TRUE(mentions(problems(), std::string(name) + ": is a directory")) << name;
}

TEST(Report, ToleratesEventsWithWrongFields) {
  TemporaryDirectory dir;
  std::string events;
  for (const char* kind :
       {"phase", "goal", "decision", "plan", "drawing", "log", "frontiers", "homing", "outcome"})
    for (const char* value : {"null", "\"x\"", "3", "[1]", "[[1, 2]]", "[[\"a\", 2, 3]]", "{}"})
      events += std::string("{\"t\": 1, \"kind\": \"") + kind + "\", \"phase\": " + value +
                ", \"state\": \"accepted\"" + ", \"position\": " + value + ", \"points\": " + value +
                ", \"clusters\": " + value + ", \"rgb\": " + value + ", \"outcome\": " + value +
                ", \"text\": " + value + ", \"why\": " + value + "}\n";
  dir.write("events.jsonl", events);
  EXPECT_NO_THROW(write_report(dir.path()));
}

TEST(Report, IsRefusedForWhatIsNoRunDirectory) {
  EXPECT_THROW(write_report("/nowhere/at/all"), core::InputError);
}

json goals_of(const std::string& events) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", events);
  return goal_spans(read_run(dir.path()));
}
std::string goal_line(double t, double x, const std::string& state) {
  return json({{"t", t}, {"kind", "goal"}, {"position", {x, 0, 0}}, {"state", state}, {"reason", "r"}})
             .dump() +
         "\n";
}

TEST(Goals, OfTwoOpenAtOnceTheEarlierEndsFirst) {
  const json g = goals_of(goal_line(1, 10, "accepted") + goal_line(3, 20, "accepted") +
                          goal_line(5, 10, "reached") + goal_line(9, 20, "unreachable"));
  ASSERT_EQ(g.size(), 2u);
  EXPECT_EQ(g[0]["until"], 5.0);
  EXPECT_EQ(g[0]["fate"], "reached");
  EXPECT_EQ(g[1]["until"], 9.0);
  EXPECT_EQ(g[1]["fate_reason"], "r");
}

TEST(Goals, AreSupersededInWhicheverOrderTheEventsCome) {
  for (const std::string& events :
       {goal_line(1, 10, "accepted") + goal_line(3, 20, "accepted") + goal_line(3, 10, "superseded"),
        goal_line(1, 10, "accepted") + goal_line(3, 10, "superseded") + goal_line(3, 20, "accepted")}) {
    const json g = goals_of(events);
    ASSERT_EQ(g.size(), 2u);
    EXPECT_EQ(g[0]["fate"], "superseded");
    EXPECT_EQ(g[0]["until"], 3.0);
    EXPECT_TRUE(g[1]["until"].is_null());
  }
}

TEST(Goals, AreNotEndedByTheEndOfAnother) {
  const json g = goals_of(goal_line(1, 10, "accepted") + goal_line(2, 20, "accepted") +
                          goal_line(3, 30, "accepted") + goal_line(4, 20, "reached"));
  ASSERT_EQ(g.size(), 3u);
  EXPECT_EQ(g[1]["until"], 3.0);  // the third took its place behind the first
  EXPECT_TRUE(g[0]["until"].is_null());
  EXPECT_TRUE(g[2]["until"].is_null());
}

TEST(Goals, AcceptedAgainAtTheSamePlaceArePlannedAnew) {
  const json g =
      goals_of(goal_line(1, 10, "accepted") + goal_line(2, 10.2, "accepted") + goal_line(5, 10.2, "reached"));
  ASSERT_EQ(g.size(), 2u);
  EXPECT_EQ(g[0]["fate"], "planned anew");
  EXPECT_EQ(g[0]["until"], 2.0);
  EXPECT_EQ(g[1]["fate"], "reached");
}

TEST(Goals, EndWithTheExploration) {
  const json g =
      goals_of(goal_line(1, 10, "accepted") + "{\"t\": 4, \"kind\": \"phase\", \"phase\": \"home\"}\n");
  EXPECT_EQ(g[0]["until"], 4.0);
}

}  // namespace
}  // namespace karst::evaluation
