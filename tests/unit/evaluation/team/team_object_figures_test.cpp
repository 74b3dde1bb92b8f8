#include "sdk/evaluation/team/team_object_figures.h"

#include <gtest/gtest.h>

#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using test::TemporaryDirectory;

constexpr const char* kTruth =
    R"({"time_s": 0.000, "event": "placed", "number": 1, "what": "rope", "position": [1, 0, 0]}
{"time_s": 0.000, "event": "placed", "number": 2, "what": "drill", "position": [9, 0, 0]}
{"time_s": 4.000, "event": "in view", "number": 1, "what": "rope", "position": [1, 0, 0]}
{"time_s": 5.000, "event": "seen", "number": 1, "what": "rope", "position": [1, 0, 0]}
)";

TEST(TeamObjectFigures, CountWhatAnyRobotSawAndWhatTheBaseKnows) {
  TemporaryDirectory dir;
  for (const char* robot : {"robot_1", "robot_2"}) std::filesystem::create_directories(dir.path() / robot);
  dir.write("robot_1/truth_objects.jsonl", kTruth);
  dir.write("robot_2/truth_objects.jsonl",
            R"({"time_s": 0, "event": "placed", "number": 1, "what": "rope", "position": [1, 0, 0]}
{"time_s": 0, "event": "placed", "number": 2, "what": "drill", "position": [9, 0, 0]}
{"time_s": 7, "event": "seen", "number": 2, "what": "drill", "position": [9, 0, 0]}
this line is damaged
)");
  dir.write(
      "team.jsonl",
      R"({"t": 6, "kind": "object", "robot": 1, "number": 1, "state": "found", "what": "rope", "position": [1, 0, 0]}
{"t": 30, "kind": "object", "robot": 2, "number": 1, "state": "found", "what": "drill", "position": [9, 0, 0]}
{"t": 31, "kind": "object", "robot": 2, "number": 2, "state": "found", "what": "rope", "position": [1, 0.4, 0]}
{"t": 40, "kind": "object_known", "robot": 2, "number": 2, "state": "found", "what": "rope", "position": [1, 0.4, 0]}
{"t": 50, "kind": "object_known", "robot": 1, "number": 1, "state": "found", "what": "rope", "position": [1, 0, 0]}
{"t": 90, "kind": "objects", "known": [{"what": "rope", "position": [1, 0.2, 0], "told_by": [[1, 1], [2, 2]]}]}
)");
  std::vector<std::string> problems;
  const ObjectFigures f = team_object_figures(read_team(dir.path()), problems);
  EXPECT_TRUE(problems.empty()) << problems.front();
  EXPECT_EQ(f.placed, 2);
  EXPECT_EQ(f.seen, 2);
  EXPECT_EQ(f.found, 2);
  EXPECT_EQ(f.reported, 1);
  EXPECT_EQ(f.reported_fraction, 0.5);
  EXPECT_EQ(f.wrong, 0);
  EXPECT_EQ(f.report_time_s, 40) << "when the first of both reports had come";
  EXPECT_NEAR(*f.error_m, 0.2, 1e-12);
}

TEST(TeamObjectFigures, SayOnceThatReportsAreDamaged) {
  TemporaryDirectory dir;
  std::filesystem::create_directories(dir.path() / "robot_1");
  dir.write("robot_1/truth_objects.jsonl", kTruth);
  dir.write(
      "team.jsonl",
      R"({"t": 6, "kind": "object", "robot": 1, "number": 1, "state": "found", "what": "rope", "position": [1, 0, 0]}
{"t": 7, "kind": "object", "robot": 1e300, "number": 2, "state": "found", "what": "drill", "position": [9, 0, 0]}
{"t": 8, "kind": "object", "robot": 1, "number": -1e300, "state": "found", "what": "drill", "position": [9, 0, 0]}
{"t": 9, "kind": "object_known", "robot": 1, "number": 1, "state": "found", "what": "rope", "position": [1e300, 0, 0]}
{"t": 90, "kind": "objects", "known": [{"what": "rope", "position": "here"}]}
)");
  const TeamRecord team = read_team(dir.path());
  std::vector<std::string> problems;
  const ObjectFigures f = team_object_figures(team, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0], "team.jsonl: 4 reports of objects are damaged; left out");
  EXPECT_EQ(f.found, 1);
  EXPECT_EQ(f.reported, 0);
}

}  // namespace
}  // namespace karst::evaluation
