// A survey as what is known before the flight, by the commands alone: one branch of a fork is surveyed.
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"
#include "tests/unit/survey/skip_without_survex.h"

namespace karst {
namespace {

/// The fork is at station 3. The main passage goes on to 9, wide and in zigzag, so that from each bend much
/// is to be seen at the next; the branch is low, and bends as well.
const char* const kMain =
    "    data normal from to tape compass clino left right up down\n"
    "    0 1 6 90 0 2 2 2 1\n    1 2 6 90 0 2 2 2 1\n    2 3 6 90 0 2 2 2 1\n    3 4 10 45 0 3 3 3 1\n"
    "    4 5 10 135 0 3 3 3 1\n    5 6 10 45 0 3 3 3 1\n    6 7 10 135 0 3 3 3 1\n    7 8 10 45 0 3 3 3 1\n"
    "    8 9 10 135 0 3 3 3 1\n";
const char* const kBranch =
    "    data normal from to tape compass clino left right up down\n"
    "    3 21 6 190 0 1.2 1.2 1.2 1\n    21 22 6 235 0 1.2 1.2 1.2 1\n    22 23 8 235 0 1.2 1.2 1.2 1\n"
    "    23 24 8 190 0 1.5 1.5 1.5 1\n    24 25 8 190 0 1.5 1.5 1.5 1\n";

std::string survey(const std::string& legs) {
  return "survey cave\n  centreline\n    fix 0 0 0 0\n    station 0 \"\" entrance\n" + legs +
         "  endcentreline\nendsurvey\n";
}

/// A cave with a branch, and a survey of its main passage alone.
std::filesystem::path folder_with_a_fork(const std::string& name) {
  const auto folder = fresh_folder(name);
  std::ofstream(folder / "cave.th") << survey(std::string(kMain) + kBranch);
  std::ofstream(folder / "known.th") << survey(kMain);
  const Output made =
      run_karst("cave from-survey " + (folder / "cave.th").string() + " --out " + (folder / "cave").string());
  EXPECT_EQ(made.code, 0) << made.text;
  return folder;
}

struct Flown {
  nlohmann::json metrics;
  std::string text;
};

Flown fly(const std::filesystem::path& folder, const std::string& name, const std::string& more,
          const std::string& time = "110s") {
  const std::filesystem::path run = folder / name;
  const Output out = run_karst("fly --cave " + (folder / "cave.info").string() +
                               " --policy beyond_survey --seed 1 --quiet --no-report"
                               " --set mission.max_flight_time=" +
                               time + " --out " + run.string() + more);
  return {nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false), out.text};
}

TEST(KnownSurveyFlight, WithItTheFlightIsSoonerInWhatTheSurveyLacks) {
  SKIP_WITHOUT_SURVEX();
  const auto folder = folder_with_a_fork("known_survey_flight");
  const std::string known = " --set survey.file=" + (folder / "known.th").string();
  const Flown with = fly(folder, "with", known),
              without = fly(folder, "without", known + " --set survey.hints=false");
  ASSERT_TRUE(with.metrics.is_object()) << with.text;
  ASSERT_TRUE(without.metrics.is_object()) << without.text;
  for (const Flown* f : {&with, &without}) {
    EXPECT_EQ(f->metrics["outcome"], "landed") << f->text;
    EXPECT_EQ(f->metrics["contacts"], 0);
  }
  ASSERT_TRUE(with.metrics["time_to_unsurveyed_50_s"].is_number()) << with.metrics.dump(2);
  EXPECT_GE(with.metrics["unsurveyed_volume_m3"].get<double>(), 50);
  const double with_s = with.metrics["time_to_unsurveyed_50_s"].get<double>();
  const nlohmann::json& other = without.metrics["time_to_unsurveyed_50_s"];
  EXPECT_LT(with_s, other.is_number() ? other.get<double>() : 1e9);

  const std::string mission = bytes_of(folder / "with" / "mission.info");
  EXPECT_NE(mission.find("known.th"), std::string::npos) << mission;
  const Output exported =
      run_karst("export " + (folder / "with").string() + " --survey " + (folder / "found").string());
  EXPECT_EQ(exported.code, 0) << exported.text;
  EXPECT_TRUE(exported.says(" m beyond the survey")) << exported.text;
  EXPECT_NE(bytes_of(folder / "found.svx").find("; new\n"), std::string::npos);
}

TEST(KnownSurveyFlight, InProcessAndInAProcessOfItsOwnThePolicyKnowsTheSame) {
  SKIP_WITHOUT_SURVEX();
  const auto folder = folder_with_a_fork("known_survey_isolation");
  const std::string known = " --set survey.file=" + (folder / "known.th").string();
  fly(folder, "own", known + " --set policy.isolation=process --record-requests", "70s");
  fly(folder, "same", known + " --set policy.isolation=in_process", "70s");
  const std::string events = bytes_of(folder / "own" / "events.jsonl");
  EXPECT_NE(events.find("beyond the survey"), std::string::npos);
  EXPECT_EQ(events, bytes_of(folder / "same" / "events.jsonl"));
  const Output replayed = run_karst("policy replay " + (folder / "own").string() + " --expect-same");
  EXPECT_EQ(replayed.code, 0) << replayed.text;
}

}  // namespace
}  // namespace karst
