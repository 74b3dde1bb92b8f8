// The table of a campaign on the terminal.
#include "sdk/tools/results_text.h"

#include <gtest/gtest.h>

#include "sdk/evaluation/metrics/metric_definitions.h"
#include "tests/unit/campaign/fake_campaign.h"

namespace karst::tools {
namespace {

std::string printed(const campaign::CampaignResults& results) {
  testing::internal::CaptureStdout();
  print_results(results, "");
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

}  // namespace
}  // namespace karst::tools
