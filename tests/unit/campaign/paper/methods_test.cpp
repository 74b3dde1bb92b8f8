// What is said of how a campaign was flown.
#include "sdk/campaign/paper/methods.h"

#include <gtest/gtest.h>

#include <limits>

#include "sdk/campaign/paper/contestant_text.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/campaign/paper/quick_verdict.h"

namespace karst::campaign {
namespace {

using test::fake_campaign;
using test::quick_verdict;

std::string methods_of(const CampaignResults& results, const std::vector<std::string>& versions,
                       const VerdictOptions& options = quick_verdict()) {
  ResultsWithExtras all{results, {}};
  for (const std::string& version : versions) {
    all.extras.emplace_back();
    all.extras.back().binary_version = version;
  }
  std::string text;
  for (const std::string& s : methods_sentences(all, compare_all(results, options), options))
    text += s + "\n";
  return text;
}

void expect_said(const std::string& text, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "expected \"" << part << "\" in:\n" << text;
}

TEST(Methods, SayWhatWasFlownAndHowItWasJudged) {
  CampaignResults results = fake_campaign(3, 2, 4);
  results.profile = "campaign";
  results.flight_time = "240 s";
  results.shared = {{"mission.home_reserve", "20 s"}};
  const std::string text = methods_of(results, {"0.1.0+aaa.b", "0.1.0+aaa.b", "0.1.0+aaa.c"});
  expect_said(
      text,
      {"3 contestants in 2 caves: 24 flights", "versions 0.1.0+aaa.b and 0.1.0+aaa.c",
       "policy_1 (lateral 1.0; gain = 0), policy_2 (lateral 1.0; gain = 1)",
       "The caves were cave_1 and cave_2.", "4 seeds were flown in each cave (1 to 4)",
       "The flight time was 240 s (this includes the way home and a reserve of 20 s), and the "
       "horizon",
       "300 s; the profile was campaign (poses come from a sensor", "coverage_auc",
       "declared before the first flight", "95 % confidence intervals", "400 resamples",
       "Wilcoxon's signed-rank test", "Holm's method over 3 pairs", "p is below 0.05", "No flight failed.",
       "Time to 50 % coverage and time to 90 % coverage are restricted mean times: a flight that "
       "did not reach the coverage counts with the horizon (300 s)."});
  EXPECT_EQ(text.find("left out"), std::string::npos);
}

TEST(Methods, SayWhatFailedAndWhatWasLeftOut) {
  CampaignResults results = fake_campaign(2, 2, 3);
  results.trials[0].failed = results.trials[2].failed = true;
  results.trials.pop_back();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  results.trials[3].figures.assign(results.trials[3].figures.size(), unknown);
  expect_said(
      methods_of(results, {}),
      {"11 flights", "could not start): 2 of policy_1; they count with what they had reached",
       "1 flight without a partner and 1 pair of flights of which the figure is not known were left out",
       "The version of karst was not recorded.", "The flight time was not recorded"});
}

TEST(Methods, SayThatAnotherFigureWasDeclared) {
  VerdictOptions options = quick_verdict();
  options.metric = "path_length_m";
  expect_said(
      methods_of(fake_campaign(2, 1, 2), {}, options),
      {"in path length (path_length_m:", "although coverage_auc was declared before the first flight"});
}

TEST(Methods, NameSeedsThatAreNotInARow) {
  CampaignResults results = fake_campaign(1, 1, 3);
  results.trials[2].seed = 9;
  const std::string text = methods_of(results, {});
  expect_said(text, {"3 seeds were flown in each cave (1, 2 and 9)", "1 contestant in 1 cave: 3 flights"});
  EXPECT_EQ(text.find("Wilcoxon"), std::string::npos) << "nothing is compared";
}

TEST(ContestantText, NamesTheParametersInWhichThoseOfOnePolicyDiffer) {
  CampaignResults results = fake_campaign(3, 1, 1);
  results.contestants[0] = {"near", "nearest_frontier", "1.0.0", R"({"horizon": "60 m", "min_cells": "3"})",
                            "{}"};
  results.contestants[1] = {"far", "nearest_frontier", "1.0.0", R"({"horizon": "90 m", "min_cells": "3"})",
                            R"({"policy.stream": "1"})"};
  results.contestants[2] = {"lateral", "lateral", "2.1.0", R"({"horizon": "70 m"})", "{}"};
  EXPECT_EQ(contestant_text(results, 0), "near (nearest_frontier 1.0.0; horizon = 60 m)");
  EXPECT_EQ(contestant_text(results, 1), "far (nearest_frontier 1.0.0; horizon = 90 m, policy.stream = 1)");
  EXPECT_EQ(contestant_text(results, 2), "lateral (2.1.0)") << "of another policy";
}

TEST(ContestantText, OfADamagedStoreIsStillOne) {
  CampaignResults results = fake_campaign(2, 1, 1);
  results.contestants[0].parameters = "no JSON";
  results.contestants[1].parameters = R"({"gain": 2.5})";
  EXPECT_EQ(contestant_text(results, 0), "policy_1 (lateral 1.0)");
  EXPECT_EQ(contestant_text(results, 1), "policy_2 (lateral 1.0; gain = 2.5)");
}

TEST(Conditions, HaveTheFlightTimeOfADefinition) {
  CampaignResults results;
  read_conditions(
      "profile full\ncontestant\n{\n  settings \"{\\\"policy.stream\\\":\\\"1\\\"}\"\n  mission\n  {\n    "
      "mission\n"
      "    {\n      max_flight_time \"240 s\"\n    }\n  }\n}\n",
      "store", results);
  EXPECT_EQ(results.flight_time, "240 s");
  EXPECT_EQ(results.profile, "full");
  EXPECT_TRUE(results.shared.empty()) << "of a contestant with settings of its own";
}

}  // namespace
}  // namespace karst::campaign
