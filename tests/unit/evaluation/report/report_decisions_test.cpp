// The ranked goals of each decision on the page, out of a record of requests written by the host itself.
#include "sdk/evaluation/report/report_decisions.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <utility>

#include "core_stack/common/time.h"
#include "sdk/evaluation/report/report_scene.h"
#include "sdk/evaluation/report/report_units.h"
#include "sdk/host/serialization/request_log.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TemporaryDirectory;

constexpr const char* kEvents = R"({"t":5.0,"kind":"phase","phase":"explore","reason":""}
{"t":10.3,"kind":"decision","goals":3,"outcome":"goals","policy":"mine"}
{"t":10.3,"kind":"frontiers","clusters":[[7,4,0,1,120],[9,-3,1,1,40]]}
{"t":10.3,"kind":"goal","frontier":9,"position":[-2,1,1],"reason":"it lies in unknown space","score":9.5,"state":"rejected","why":"largest"}
{"t":10.3,"kind":"goal","frontier":7,"position":[3,0,1],"reason":"","score":7.25,"state":"accepted","why":"nearest"}
{"t":14.6,"kind":"decision","goals":0,"outcome":"hold","policy":"mine"}
{"t":16.7,"kind":"decision","goals":0,"outcome":"explored","policy":"mine"}
)";

core::Goal goal(const core::Vec3& position, std::uint32_t frontier, double score, const std::string& why) {
  core::Goal g;
  g.position = position;
  g.frontier_id = frontier;
  g.score = score;
  g.why = why;
  return g;
}

/// Answers with a goals list; fails without one.
class Scripted final : public core::PolicyPort {
 public:
  std::string name() const override { return "mine"; }
  core::Decision decide(const core::DecisionRequest&) override {
    if (!goals) throw core::PolicyFailure("it hangs");
    core::Decision d;
    d.outcome = core::Outcome::goals;
    d.goals = *goals;
    return d;
  }
  void notify(const core::PolicyEvent&) override {}
  std::optional<std::vector<core::Goal>> goals;
};

using Asked = std::pair<double, std::optional<std::vector<core::Goal>>>;  // when, and the answer

void record_requests(const fs::path& run_dir, const std::vector<Asked>& all) {
  Scripted policy;
  host::RecordingPolicy recording(policy, run_dir / host::kRequestLogName, {"mine", "1.0.0", 1, {}});
  core::DecisionRequest request;
  for (const auto& [stamp_s, goals] : all) {
    ++request.sequence;
    request.stamp = core::from_seconds(stamp_s);
    policy.goals = goals;
    try {
      recording.decide(request);
    } catch (const core::PolicyFailure&) {
      EXPECT_FALSE(goals);
    }
  }
}

std::vector<core::Goal> three_goals() {
  std::vector<core::Goal> goals{goal({-2, 1, 1}, 9, 9.5, "largest"), goal({3, 0, 1}, 7, 7.25, "nearest"),
                                goal({5, 5, 1}, 0, 1.0, "last")};
  goals[2].max_speed_mps = 0.5;
  return goals;
}

json choices_of(const fs::path& run_dir, std::vector<std::string>& problems) {
  return decision_choices(read_run(run_dir), problems);
}

TEST(DecisionChoices, SayWhyTheFallbackDecidedAndThatTheTimeEndedIt) {
  const TemporaryDirectory dir;
  dir.write(
      "events.jsonl",
      std::string(kEvents) +
          R"({"t":20.0,"kind":"decision","goals":1,"outcome":"explored","policy":"fallback","reason":"what is left is too far for the time allowed"}
{"t":20.0,"kind":"goal","frontier":7,"position":[3,0,1],"reason":"too far","score":2,"state":"rejected","why":"nearest"}
)");
  std::vector<std::string> problems;
  const json choices = choices_of(dir.path(), problems);
  ASSERT_EQ(choices.size(), 4u);
  EXPECT_EQ(choices[3]["by"], "the fallback, because all goals of mine were refused");
  EXPECT_EQ(choices[3]["result"], "nothing within reach in the time left");
  EXPECT_FALSE(choices[2].contains("by")) << "the event has it";
  EXPECT_FALSE(choices[2].contains("result"));
}

TEST(DecisionChoices, HaveTheWholeRankedListWhereRequestsWereRecorded) {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", kEvents);
  record_requests(dir.path(), {{10.0, three_goals()}, {14.3, std::nullopt}});
  std::vector<std::string> problems;
  const json choices = choices_of(dir.path(), problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(choices.size(), 3u);
  EXPECT_EQ(choices[0]["t"], 10.3);
  EXPECT_EQ(choices[0]["recorded"], true);
  ASSERT_EQ(choices[0]["answers"].size(), 1u);
  const json& answer = choices[0]["answers"][0];
  EXPECT_EQ(answer["request"], 1);
  EXPECT_EQ(answer["left_out"], 0);
  ASSERT_EQ(answer["goals"].size(), 3u);
  EXPECT_EQ(answer["goals"][0]["score"], 9.5);
  EXPECT_EQ(answer["goals"][0]["frontier"], 9);
  EXPECT_EQ(answer["goals"][0]["why"], "largest");
  EXPECT_EQ(answer["goals"][0]["fate"], "refused: it lies in unknown space");
  EXPECT_FALSE(answer["goals"][0].contains("max_speed")) << "the mission's";
  EXPECT_EQ(answer["goals"][1]["fate"], "accepted");
  EXPECT_EQ(answer["goals"][2]["fate"], "not tried");
  EXPECT_EQ(answer["goals"][2]["max_speed"], 0.5);
  EXPECT_EQ(answer["goals"][2]["position"], json({5.0, 5.0, 1.0}));
}

TEST(DecisionChoices, SayThatThePolicyFailedOrWasNotAsked) {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", kEvents);
  record_requests(dir.path(), {{10.0, three_goals()}, {14.3, std::nullopt}});
  std::vector<std::string> problems;
  const json choices = choices_of(dir.path(), problems);
  ASSERT_EQ(choices.size(), 3u);
  EXPECT_EQ(choices[1]["answers"][0]["failure"], "it hangs");
  EXPECT_FALSE(choices[1]["answers"][0].contains("goals"));
  EXPECT_EQ(choices[2]["recorded"], false);
  EXPECT_TRUE(choices[2]["answers"][0]["goals"].empty());
}

TEST(DecisionChoices, WithoutRequestsAreTheGoalsThatHaveEvents) {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", kEvents);
  std::vector<std::string> problems;
  const json choices = choices_of(dir.path(), problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(choices.size(), 3u);
  EXPECT_EQ(choices[0]["recorded"], false);
  const json& goals = choices[0]["answers"][0]["goals"];
  ASSERT_EQ(goals.size(), 2u);
  EXPECT_EQ(goals[0]["fate"], "refused: it lies in unknown space");
  EXPECT_EQ(goals[0]["score"], 9.5);
  EXPECT_EQ(goals[1]["fate"], "accepted");
  EXPECT_EQ(goals[1]["why"], "nearest");
}

TEST(DecisionChoices, OfADamagedRecordAreThoseBeforeTheDamage) {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", kEvents);
  record_requests(dir.path(), {{10.0, three_goals()}});
  std::ofstream(dir.path() / host::kRequestLogName, std::ios::binary | std::ios::app)
      << std::string(100, 'x');
  std::vector<std::string> problems;
  EXPECT_EQ(choices_of(dir.path(), problems)[0]["answers"][0]["goals"].size(), 3u);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("requests.bin"), std::string::npos) << problems[0];

  dir.write(host::kRequestLogName, "nonsense");
  problems.clear();
  EXPECT_EQ(choices_of(dir.path(), problems)[0]["recorded"], false);
  EXPECT_EQ(problems.size(), 1u);
}

TEST(DecisionChoices, OfVeryManyGoalsAreCutAndSaySo) {
  const TemporaryDirectory dir;
  std::string events;
  for (int t_s = 1; t_s <= 10; ++t_s)
    events += "{\"t\":" + std::to_string(t_s) + ",\"kind\":\"decision\",\"outcome\":\"goals\"}\n";
  dir.write("events.jsonl", events);
  record_requests(dir.path(), {{0.5, std::vector<core::Goal>(4000, goal({1, 2, 3}, 1, 1, ""))}});
  std::vector<std::string> problems;
  const json choices = choices_of(dir.path(), problems);
  ASSERT_EQ(choices.size(), 10u);
  EXPECT_EQ(choices[0]["answers"][0]["goals"].size(), 3000u);
  EXPECT_EQ(choices[0]["answers"][0]["left_out"], 1000);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("the first 3000 goals"), std::string::npos) << problems[0];
}

TEST(SceneFrontiers, CarryTheIdByWhichTheirGoalIsFound) {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", kEvents);
  std::vector<std::string> problems;
  const json frontiers = scene_frontiers(read_run(dir.path()), problems);
  ASSERT_EQ(frontiers.size(), 1u);
  ASSERT_EQ(frontiers[0][1].size(), 2u);
  EXPECT_EQ(frontiers[0][1][0], json({4.0, 0.0, 1.0, 120, 7}));
  EXPECT_EQ(frontiers[0][1][1], json({-3.0, 1.0, 1.0, 40, 9}));
}

TEST(MetricUnits, AreThoseOfTheFiguresThatHaveOne) {
  const json units = metric_units();
  EXPECT_EQ(units["path_length_m"], "m");
  EXPECT_EQ(units["mean_speed_mps"], "m/s");
  EXPECT_EQ(units["explored_volume_m3"], "m^3");
  EXPECT_FALSE(units.contains("contacts")) << "a count";
  EXPECT_FALSE(units.contains("coverage")) << "a fraction";
}

}  // namespace
}  // namespace karst::evaluation
