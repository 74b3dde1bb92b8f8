// The tables of a paper against the store's numbers, which SQL works out without karst.
#include "sdk/campaign/paper/result_tables.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "sdk/campaign/paper/latex.h"
#include "sdk/campaign/store/store.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/campaign/paper/quick_verdict.h"
#include "tests/unit/campaign/stored_campaign.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::campaign {
namespace {

using test::quick_verdict;
using test::TemporaryDirectory;

double answer_of(const std::filesystem::path& store, const std::string& sql) {
  sqlite3* db = nullptr;
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_open_v2(store.c_str(), &db, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  EXPECT_EQ(sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  EXPECT_EQ(sqlite3_step(statement), SQLITE_ROW) << sql;
  const double answer = sqlite3_column_double(statement, 0);
  sqlite3_finalize(statement);
  sqlite3_close(db);
  return answer;
}

/// The mean over caves of the means over a cave's flights, of those of which the condition holds.
double mean_by_sql(const std::filesystem::path& store, const std::string& contestant,
                   const std::string& figure, const std::string& condition = "1") {
  return answer_of(store, "SELECT avg(m) FROM (SELECT avg(" + figure +
                              ") AS m FROM result WHERE contestant = '" + contestant + "' AND " + condition +
                              " GROUP BY cave)");
}

std::size_t place_of_heading(const PaperTable& table, const std::string& heading) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].heading == heading) return c;
  ADD_FAILURE() << "no column " << heading;
  return 0;
}

const PaperCell& cell_of(const PaperTable& table, std::size_t row, const std::string& heading) {
  return table.rows.at(row).at(place_of_heading(table, heading));
}

std::string with_hyphens(std::string text) {
  const std::string minus = "\u2212";
  for (std::size_t at = text.find(minus); at != std::string::npos; at = text.find(minus))
    text.replace(at, minus.size(), "-");
  return text;
}

/// The number of a cell is this one, rounded to its decimals.
void expect_rounded(const std::string& cell, double v) {
  const std::string text = with_hyphens(cell);
  const std::size_t point = text.find('.');
  const double decimals = point == std::string::npos ? 0 : static_cast<double>(text.size() - point - 1);
  EXPECT_NEAR(std::strtod(text.c_str(), nullptr), v, 0.5000001 * std::pow(10.0, -decimals)) << cell;
}

constexpr const char* kPrimary = "Coverage averaged over the flight";

TEST(RankingTable, HasTheMeansThatTheStoreHas) {
  TemporaryDirectory dir;
  test::store_campaign(test::fake_campaign(3, 2, 6), dir.path());
  const auto store = store_file(dir.path());
  const CampaignResults results = read_results(dir.path());
  const Verdicts verdicts = compare_all(results, quick_verdict());
  const PaperTable table = ranking_table(results, verdicts, quick_verdict());
  ASSERT_EQ(table.rows.size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    ASSERT_EQ(table.rows[row].size(), table.columns.size());
    const std::string name = cell_of(table, row, "Contestant").text;
    EXPECT_EQ(name, "policy_" + std::to_string(row + 1)) << "the first explores fastest";
    expect_rounded(cell_of(table, row, kPrimary).text, 100 * mean_by_sql(store, name, "coverage_auc"));
    expect_rounded(cell_of(table, row, "Final coverage").text, 100 * mean_by_sql(store, name, "coverage"));
    expect_rounded(cell_of(table, row, "Path length").text, mean_by_sql(store, name, "path_length_m"));
    EXPECT_EQ(cell_of(table, row, "Flights").text, "12");
    EXPECT_EQ(cell_of(table, row, "Failed").text, "0");
    EXPECT_EQ(cell_of(table, row, kPrimary).bold, row == 0);
    EXPECT_FALSE(cell_of(table, row, "Path length").bold) << "neither more nor less of it is better";
  }
  EXPECT_EQ(table.columns[place_of_heading(table, kPrimary)].unit, "%");
  EXPECT_EQ(table.columns[place_of_heading(table, "Path length")].unit, "m");
  EXPECT_EQ(table.columns[place_of_heading(table, "Time to 90 % coverage")].unit, "s");
  for (const char* said : {"made up", "coverage_auc", "2 caves", "12 flights of each contestant", "95 % CI",
                           "400 resamples", "Wilcoxon", "Holm", "p < 0.05"})
    EXPECT_NE(table.caption.find(said), std::string::npos) << said << " in: " << table.caption;
}

TEST(RankingTable, NumbersOfAColumnHaveTheSameDecimals) {
  const CampaignResults results = test::fake_campaign(4, 3, 5);
  const PaperTable table = ranking_table(results, compare_all(results, quick_verdict()), quick_verdict());
  const auto decimals = [](const std::string& text) {
    const std::size_t point = text.find('.');
    return point == std::string::npos ? 0 : text.size() - point;
  };
  for (std::size_t c = place_of_heading(table, kPrimary); c < table.columns.size(); ++c) {
    EXPECT_EQ(table.columns[c].aligned, Aligned::right);
    for (const auto& row : table.rows)
      EXPECT_EQ(decimals(row[c].text), decimals(table.rows.front()[c].text)) << table.columns[c].heading;
  }
}

// A failed flight without a figure counts as nothing covered, and caves and seeds that only some have flown
// do not count.
TEST(RankingTable, OfACampaignUnderWayIsOfTheFlightsThatAllHaveFlown) {
  TemporaryDirectory dir;
  CampaignResults results = test::fake_campaign(2, 2, 4);
  TrialResult& failed = results.trials[1];
  failed.failed = true, failed.outcome = "";
  failed.figures.assign(failed.figures.size(), std::numeric_limits<double>::quiet_NaN());
  results.trials.pop_back();
  test::store_campaign(results, dir.path());
  results = read_results(dir.path());
  const PaperTable table = ranking_table(results, compare_all(results, quick_verdict()), quick_verdict());
  const std::string by_both =
      "(cave, seed) IN (SELECT cave, seed FROM result GROUP BY cave, seed HAVING count(*) = 2)";
  for (std::size_t row = 0; row < 2; ++row)
    expect_rounded(cell_of(table, row, kPrimary).text,
                   100 * mean_by_sql(store_file(dir.path()), cell_of(table, row, "Contestant").text,
                                     "coalesce(coverage_auc, 0)", by_both));
  const std::size_t first = cell_of(table, 0, "Contestant").text == "policy_1" ? 0 : 1;
  EXPECT_EQ(cell_of(table, first, "Flights").text, "8");
  EXPECT_EQ(cell_of(table, first, "Failed").text, "1");
  EXPECT_EQ(cell_of(table, 1 - first, "Flights").text, "7");
  EXPECT_NE(table.caption.find("of 7 flights of each"), std::string::npos) << table.caption;
}

double& time_of(TrialResult& t, const char* name) {
  return t.figures[static_cast<std::size_t>(evaluation::metric_index(name))];
}

bool is_said(const PaperTable& table, const std::string& text) {
  return table.caption.find(text) != std::string::npos;
}

TEST(RankingTable, SaysWhatRestrictedTimesAre) {
  CampaignResults results = test::fake_campaign(2, 2, 3);
  for (TrialResult& t : results.trials)
    for (const char* name : {"restricted_t50_s", "restricted_t90_s"}) time_of(t, name) = 100;
  const PaperTable table = ranking_table(results, compare_all(results, quick_verdict()), quick_verdict());
  EXPECT_TRUE(
      is_said(table,
              "Time to 50 % coverage and time to 90 % coverage are restricted mean times: a flight that "
              "did not reach the coverage counts with the horizon (300 s)."))
      << table.caption;
  EXPECT_FALSE(is_said(table, "no flight reached it")) << table.caption;
  EXPECT_FALSE(is_said(table, "\u2021")) << table.caption;
}

TEST(RankingTable, MarksTimesThatNoFlightOrOnlySomeReached) {
  CampaignResults results = test::fake_campaign(3, 2, 3);
  for (TrialResult& t : results.trials) {
    time_of(t, "restricted_t90_s") = results.horizon_s;
    time_of(t, "restricted_t50_s") = t.contestant == 0 && t.seed == 1 ? 30 : results.horizon_s;
  }
  const PaperTable table = ranking_table(results, compare_all(results, quick_verdict()), quick_verdict());
  for (std::size_t row = 0; row < 3; ++row) {
    const PaperCell &t50 = cell_of(table, row, "Time to 50 % coverage"),
                    &t90 = cell_of(table, row, "Time to 90 % coverage");
    const bool first = cell_of(table, row, "Contestant").text == "policy_1";
    EXPECT_EQ(t50.text, first ? "210 \u2021" : "> 300");
    EXPECT_EQ(t50.bold, first);
    EXPECT_EQ(t90.text, "> 300");
    EXPECT_FALSE(t90.bold) << "nobody reached it";
  }
  EXPECT_TRUE(is_said(table, ">: no flight reached it.")) << table.caption;
  EXPECT_TRUE(
      is_said(table, "\u2021: only some flights reached it (time to 50 % coverage: policy_1 2 of 6)."))
      << table.caption;
}

TEST(RankingTable, HasNoBoldTies) {
  CampaignResults results = test::fake_campaign(3, 2, 3);
  for (TrialResult& t : results.trials) time_of(t, "contacts") = t.contestant == 2 ? 1 : 0;
  const PaperTable table = ranking_table(results, compare_all(results, quick_verdict()), quick_verdict());
  for (std::size_t row = 0; row < 3; ++row) EXPECT_FALSE(cell_of(table, row, "Contacts").bold);
  EXPECT_TRUE(is_said(table, "Bold: the best mean of a column, if one contestant alone has it."));
}

TEST(RankingTable, HeadingsBeginWithACapital) {
  const CampaignResults results = test::fake_campaign(2, 1, 3);
  const PaperTable table = ranking_table(results, compare_all(results, quick_verdict()), quick_verdict());
  for (const PaperColumn& c : table.columns)
    EXPECT_FALSE(c.heading.front() >= 'a' && c.heading.front() <= 'z') << c.heading;
}

TEST(ComparisonsTable, OfRestrictedTimesSaysWhatTheyAreAndMarksThoseNeverReached) {
  CampaignResults results = test::fake_campaign(2, 2, 3);
  for (TrialResult& t : results.trials)
    time_of(t, "restricted_t50_s") =
        t.contestant == 0 ? 100 + static_cast<double>(t.seed) : results.horizon_s;
  VerdictOptions options = quick_verdict();
  options.metric = "restricted_t50_s";
  const PaperTable table = comparisons_table(results, compare_all(results, options), options);
  const bool first_is_a = cell_of(table, 0, "A").text == "policy_1";
  EXPECT_EQ(cell_of(table, 0, first_is_a ? "Mean of B" : "Mean of A").text.substr(0, 5), "> 300");
  EXPECT_EQ(cell_of(table, 0, first_is_a ? "Mean of A" : "Mean of B").text.substr(0, 3), "102");
  EXPECT_TRUE(is_said(table, "Time to 50 % coverage is a restricted mean time")) << table.caption;
  EXPECT_TRUE(is_said(table, ">: no flight reached it.")) << table.caption;
}

TEST(ComparisonsTable, HasTheDifferencesThatTheStoreHasAndTheVerdictsIntervalAndTest) {
  TemporaryDirectory dir;
  test::store_campaign(test::fake_campaign(3, 2, 6), dir.path());
  const CampaignResults results = read_results(dir.path());
  const Verdicts verdicts = compare_all(results, quick_verdict());
  const PaperTable table = comparisons_table(results, verdicts, quick_verdict());
  ASSERT_EQ(table.rows.size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    const std::string a = cell_of(table, row, "A").text, b = cell_of(table, row, "B").text;
    expect_rounded(cell_of(table, row, "A \u2212 B").text,
                   100 * answer_of(store_file(dir.path()),
                                   "SELECT avg(d) FROM (SELECT avg(a.coverage_auc - b.coverage_auc) AS d FROM"
                                   " result a JOIN result b ON a.cave = b.cave AND a.seed = b.seed"
                                   " WHERE a.contestant = '" +
                                       a + "' AND b.contestant = '" + b + "' GROUP BY a.cave)"));
    expect_rounded(cell_of(table, row, "Mean of A").text,
                   100 * mean_by_sql(store_file(dir.path()), a, "coverage_auc"));
    EXPECT_EQ(cell_of(table, row, "Pairs").text, "12");

    const auto index = [](const std::string& name) { return static_cast<std::size_t>(name.back() - '1'); };
    const Comparison& c = *verdicts.find(index(a), index(b), verdicts.metric);
    const std::string interval = with_hyphens(cell_of(table, row, "95 % CI").text);
    const std::size_t comma = interval.find(", ");
    expect_rounded(interval.substr(1, comma - 1), 100 * c.interval.low);
    expect_rounded(interval.substr(comma + 2, interval.size() - comma - 3), 100 * c.interval.high);
    if (c.p_corrected < 0.001)
      EXPECT_EQ(cell_of(table, row, "p").text, "< 0.001");
    else
      expect_rounded(cell_of(table, row, "p").text, c.p_corrected);
    expect_rounded(cell_of(table, row, "Rank-biserial correlation").text, c.rank_biserial);
    const std::string shown = c.shown == Shown::a_better ? a : c.shown == Shown::b_better ? b : "\u2013";
    EXPECT_EQ(cell_of(table, row, "Shown better").text, shown);
    EXPECT_EQ(cell_of(table, row, "A").bold, shown == a);
    EXPECT_EQ(cell_of(table, row, "B").bold, shown == b);
  }
  EXPECT_EQ(table.columns[place_of_heading(table, "A \u2212 B")].unit, "percentage points");
  for (const char* said : {"made up", "coverage_auc", "2 caves", "12 pairs of flights", "95 % CI",
                           "400 resamples", "Wilcoxon", "3 pairs of contestants with Holm"})
    EXPECT_NE(table.caption.find(said), std::string::npos) << said << " in: " << table.caption;
}

TEST(ComparisonsTable, MarksIntervalsOverCavesForWantOfSeeds) {
  const CampaignResults results = test::fake_campaign(2, 4, 1);
  const Verdicts verdicts = compare_all(results, quick_verdict());
  const PaperTable comparisons = comparisons_table(results, verdicts, quick_verdict()),
                   ranking = ranking_table(results, verdicts, quick_verdict());
  EXPECT_NE(cell_of(comparisons, 0, "95 % CI").text.find("\u2020"), std::string::npos);
  EXPECT_NE(cell_of(ranking, 0, "95 % CI").text.find("\u2020"), std::string::npos);
  EXPECT_NE(comparisons.caption.find("\u2020: over caves"), std::string::npos);
}

TEST(ResultTables, OfOneContestantCompareNothing) {
  const CampaignResults results = test::fake_campaign(1, 2, 3);
  const Verdicts verdicts = compare_all(results, quick_verdict());
  EXPECT_TRUE(comparisons_table(results, verdicts, quick_verdict()).rows.empty());
  const PaperTable ranking = ranking_table(results, verdicts, quick_verdict());
  ASSERT_EQ(ranking.rows.size(), 1u);
  EXPECT_FALSE(cell_of(ranking, 0, kPrimary).bold);
  EXPECT_EQ(ranking.caption.find("Wilcoxon"), std::string::npos);
}

TEST(ResultTables, EscapeNames) {
  CampaignResults results = test::fake_campaign(2, 1, 3);
  results.contestants[0].name = "near_a%&";
  const Verdicts verdicts = compare_all(results, quick_verdict());
  for (const PaperTable& table : {ranking_table(results, verdicts, quick_verdict()),
                                  comparisons_table(results, verdicts, quick_verdict())})
    EXPECT_NE(latex_table(table).find("near\\_a\\%\\&"), std::string::npos);
}

TEST(ResultTables, OfTrialsThatAllFailedHaveDashes) {
  CampaignResults results = test::fake_campaign(2, 2, 2);
  for (TrialResult& t : results.trials) {
    t.failed = true;
    t.figures.assign(t.figures.size(), std::numeric_limits<double>::quiet_NaN());
  }
  const PaperTable table = ranking_table(results, compare_all(results, quick_verdict()), quick_verdict());
  EXPECT_EQ(cell_of(table, 0, "Path length").text, "\u2013");
  EXPECT_EQ(cell_of(table, 0, kPrimary).text, "0");
  EXPECT_EQ(latex_table(table).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace karst::campaign
