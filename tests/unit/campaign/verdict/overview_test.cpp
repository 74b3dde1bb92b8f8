// The ranking in five lines and the matrix of pairs, of campaigns whose verdict is known.
#include "sdk/campaign/verdict/overview.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/unit/campaign/verdict/drawn_campaign.h"

namespace karst::campaign {
namespace {

/// Contestant A covers 0.8, B and C 0.6 each, and the others less: of B and C seeds decide.
CampaignResults known_campaign(std::size_t contestants) {
  return test::drawn_campaign(
      contestants, 2, 10, [](std::size_t contestant, std::size_t, std::int64_t seed) -> test::Figures {
        const double noise =
            0.001 * static_cast<double>((static_cast<std::size_t>(seed) * 7 + contestant * 3) % 10);
        if (contestant == 0) return {{"coverage_auc", 0.8 + noise}};
        if (contestant <= 2) return {{"coverage_auc", 0.6 + noise}};
        return {{"coverage_auc", 0.5 - 0.05 * static_cast<double>(contestant - 3) + noise}};
      });
}
Verdicts verdicts_of(const CampaignResults& results) {
  VerdictOptions options;
  options.simulations = 0;
  return compare_all(results, options);
}
std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

TEST(Overview, ContestantsThatAreNotToldApartShareALine) {
  const CampaignResults results = known_campaign(4);
  const std::vector<std::string> lines = ranking_lines(verdicts_of(results), results);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].starts_with("1     A 80.")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("2-3   ")) << lines[1];
  EXPECT_NE(lines[1].find("B 60."), std::string::npos);
  EXPECT_NE(lines[1].find("C 60."), std::string::npos);
  EXPECT_TRUE(lines[2].starts_with("4     D 50.")) << lines[2];
}

TEST(Overview, TheLastLineHoldsTheRest) {
  const CampaignResults results = known_campaign(9);
  const std::vector<std::string> lines = ranking_lines(verdicts_of(results), results, 3);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[2].starts_with("4-9   the rest: D 50.")) << lines[2];
  EXPECT_NE(lines[2].find("I 25."), std::string::npos) << lines[2];
}

TEST(Overview, TheMatrixHasEachPairTwiceWithOppositeSigns) {
  const CampaignResults results = known_campaign(4);
  const Verdicts verdicts = verdicts_of(results);
  const std::vector<std::string> lines = matrix_lines(verdicts, results);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(words(lines[0]), (std::vector<std::string>{"1", "2", "3", "4"}));
  std::vector<std::vector<std::string>> cells;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> row = words(lines[i]);
    ASSERT_EQ(row.size(), 6u) << lines[i];
    EXPECT_EQ(row[0], std::to_string(i));
    EXPECT_LE(lines[i].size(), lines[0].size());
    cells.emplace_back(row.begin() + 2, row.end());
  }
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(cells[i][i], ".");
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_EQ(std::stod(cells[i][k]), -std::stod(cells[k][i]));
      EXPECT_EQ(cells[i][k].ends_with('*'), cells[k][i].ends_with('*'));
      const Comparison* c =
          verdicts.find(verdicts.ranking[i].contestant, verdicts.ranking[k].contestant, verdicts.metric);
      EXPECT_EQ(cells[i][k].ends_with('*'), c->shown != Shown::no_difference);
    }
  }
  EXPECT_NEAR(std::stod(cells[0][3]), 30, 0.5) << "percentage points";
  EXPECT_FALSE(cells[1][2].ends_with('*'));
}

TEST(Overview, OfMoreThanTenOnlySignsAreShown) {
  const CampaignResults results = known_campaign(12);
  const Verdicts verdicts = verdicts_of(results);
  const std::vector<std::string> lines = matrix_lines(verdicts, results);
  ASSERT_EQ(lines.size(), 13u);
  const std::vector<std::string> first = words(lines[1]), last = words(lines[12]);
  ASSERT_EQ(first.size(), 13u) << "number, name, and eleven signs";
  for (std::size_t i = 2; i < first.size(); ++i) EXPECT_EQ(first[i], "+");
  for (std::size_t i = 2; i < last.size(); ++i) EXPECT_EQ(last[i], "-");
  EXPECT_NE(matrix_title(verdicts).find("shown better"), std::string::npos);
}

}  // namespace
}  // namespace karst::campaign
