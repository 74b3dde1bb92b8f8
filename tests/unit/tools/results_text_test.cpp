// The table of a campaign on the terminal.
#include "sdk/tools/results_text.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "tests/unit/campaign/fake_campaign.h"

namespace karst::tools {
namespace {

std::string printed(const campaign::CampaignResults& results, const PairSentences& pairs = {}) {
  testing::internal::CaptureStdout();
  print_results(results, "", pairs);
  return testing::internal::GetCapturedStdout();
}

TEST(ResultsText, SaysWhichTimesNoFlightReached) {
  campaign::CampaignResults results = test::fake_campaign(2, 2, 3);
  EXPECT_EQ(printed(results).find("> 300"), std::string::npos);
  const auto t90 = static_cast<std::size_t>(evaluation::metric_index("restricted_t90_s"));
  for (campaign::TrialResult& t : results.trials)
    if (t.contestant == 1) t.figures[t90] = results.horizon_s;
  const std::string text = printed(results);
  const std::size_t row = text.find("| policy_2 |");
  ASSERT_NE(row, std::string::npos) << text;
  EXPECT_NE(text.substr(row, text.find('\n', row) - row).find("| > 300.0 |"), std::string::npos) << text;
  const std::size_t other = text.find("| policy_1 |");
  EXPECT_EQ(text.substr(other, text.find('\n', other) - other).find('>'), std::string::npos) << text;
  EXPECT_NE(text.find("> 300: no flight reached this coverage before the horizon of 300 s."),
            std::string::npos)
      << text;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(ResultsText, OfManyContestantsBeginsWithTheRankingAndTheMatrix) {
  const std::string three = printed(test::fake_campaign(3, 2, 6)),
                    five = printed(test::fake_campaign(5, 2, 6));
  EXPECT_EQ(three.find("row less column"), std::string::npos) << three;
  EXPECT_EQ(occurrences(three, "95 % CI"), 4u) << "each pair in a sentence, and the verdict";
  const std::size_t ranking = five.find("by place"), matrix = five.find("row less column"),
                    table = five.find("| place |");
  ASSERT_NE(matrix, std::string::npos) << five;
  EXPECT_LT(ranking, matrix);
  EXPECT_LT(matrix, table);
  EXPECT_LE(occurrences(five, "95 % CI"), 1u) << "the campaign's verdict alone";
  EXPECT_NE(five.find("--pairs"), std::string::npos);
}

TEST(ResultsText, SentencesOfPairsAreThereOnDemand) {
  const campaign::CampaignResults results = test::fake_campaign(5, 2, 6);
  const std::size_t before = occurrences(printed(results), "95 % CI");
  EXPECT_EQ(occurrences(printed(results, {true, ""}), "95 % CI"), before + 10);
  EXPECT_EQ(occurrences(printed(results, {false, "policy_2"}), "95 % CI"), before + 4);
  try {
    print_results(results, "", {false, "polici_2"});
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean policy_2?"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace karst::tools
