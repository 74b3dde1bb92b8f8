// The campaign's page in a real browser.
#include <gtest/gtest.h>

#include "sdk/campaign/report/report.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/evaluation/fake_run.h"
#include "tests/unit/evaluation/report/browser.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using test::fake_campaign;
using test::TemporaryDirectory;

/// The page's body up to the data.
std::string show(const CampaignResults& results, const fs::path& dir, const std::string& hash = "") {
  write_campaign_report(dir / "report.html", results);
  return test::show_page(dir / "report.html", hash).body;
}
/// The same of a campaign without recorded flights: there is nothing to be drawn in 3D.
std::string show_texts(const CampaignResults& results, const fs::path& dir) {
  write_campaign_report(dir / "report.html", results);
  return test::show_texts(dir / "report.html").body;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(CampaignReportInBrowser, DrawsEverySectionWithoutAnError) {
  TemporaryDirectory dir;
  CampaignResults results = fake_campaign(3, 2, 4);
  test::FakeRunOptions small;
  small.length_m = 24;
  small.map_resolution_m = 0.5;
  for (TrialResult& t : results.trials) {
    t.run_dir = (dir.path() /
                 (std::to_string(t.contestant) + "-" + std::to_string(t.cave) + "-" + std::to_string(t.seed)))
                    .string();
    test::write_fake_run(t.run_dir, small);
  }
  results.trials[1].failed = true;
  const std::string shown = show(results, dir.path(), "t=12&view=top&theme=dark");
  EXPECT_EQ(count(shown, "<canvas"), 2u);  // two views in 3D
  EXPECT_NE(shown.find("0:12 / "), std::string::npos);
  EXPECT_EQ(count(shown, "class=\"band\""), 9u);  // three contestants over all and in two caves
  EXPECT_EQ(count(shown, "class=\"box\""), 6u);   // and their spread in two caves
  EXPECT_NE(shown.find("policy_1 better"), std::string::npos);
  EXPECT_NE(shown.find("karst report '0-0-2'"), std::string::npos);  // the failed trial
  EXPECT_EQ(shown.find("NaN"), std::string::npos);
  EXPECT_EQ(shown.find("undefined"), std::string::npos);
  EXPECT_NE(shown.find("<b>5:00&nbsp;min</b><span>at most explored for</span>"), std::string::npos);
  EXPECT_EQ(shown.find("m^3"), std::string::npos);
  EXPECT_EQ(test::cut_on_desktop(dir.path() / "report.html"), "");
}

TEST(CampaignReportInBrowser, HasANorthArrowInBothViewsAndFitsAPhone) {
  TemporaryDirectory dir;
  CampaignResults results = fake_campaign(2, 1, 2);
  test::FakeRunOptions small;
  small.length_m = 24;
  small.map_resolution_m = 0.5;
  for (TrialResult& t : results.trials) {
    t.run_dir = (dir.path() / (std::to_string(t.contestant) + "-" + std::to_string(t.seed))).string();
    test::write_fake_run(t.run_dir, small);
  }
  const std::string shown = show(results, dir.path(), "view=top");
  EXPECT_EQ(count(shown, "class=\"north\""), 2u);
  EXPECT_EQ(count(shown, "<g transform=\"rotate(0)\"><path d=\"M0 -11"), 2u) << "both turn alike";
  const test::PhoneLayout phone = test::lay_out_on_phone(dir.path() / "report.html");
  EXPECT_EQ(phone.too_wide, "");
  EXPECT_EQ(phone.too_small, "");
  EXPECT_EQ(phone.open.find("replay-choices"), std::string::npos);
}

// Three means of 0.208 stood side by side, one of them bold.
TEST(CampaignReportInBrowser, HasNoBoldMeanByCaveWhereTheBestArePrintedAlike) {
  const auto table_of = [](double advantage) {
    const TemporaryDirectory dir;
    const std::string shown = show_texts(fake_campaign(2, 2, 3, advantage, 0), dir.path());
    const std::size_t begin = shown.find("id=\"figure-table\"");
    return begin == std::string::npos ? "" : shown.substr(begin, shown.find("</table>", begin) - begin);
  };
  EXPECT_EQ(count(table_of(0.1), "<b>"), 3u) << "two caves, and all caves";
  EXPECT_EQ(count(table_of(2e-5), "<b>"), 0u);
}

TEST(CampaignReportInBrowser, OfNextToNothingSaysWhatThereIs) {
  for (const auto& [contestants, caves, seeds] : {std::tuple{0, 0, 0}, {2, 1, 0}, {1, 1, 1}, {2, 2, 1}}) {
    TemporaryDirectory dir;
    const std::string shown = show_texts(fake_campaign(contestants, caves, seeds), dir.path());
    EXPECT_EQ(shown.find("NaN"), std::string::npos) << contestants << caves << seeds;
    EXPECT_EQ(shown.find("Infinity"), std::string::npos) << contestants << caves << seeds;
    EXPECT_EQ(shown.find("undefined"), std::string::npos) << contestants << caves << seeds;
    EXPECT_NE(shown.find("No recorded flights are embedded"), std::string::npos);
  }
}

TEST(CampaignReportInBrowser, OfTrialsThatAllFailedShowsThem) {
  TemporaryDirectory dir;
  CampaignResults results = fake_campaign(2, 2, 2);
  for (TrialResult& t : results.trials) {
    t.failed = true, t.outcome = "", t.reason = "killed by signal 11", t.curve.clear();
    t.figures.assign(t.figures.size(), std::numeric_limits<double>::quiet_NaN());
  }
  const std::string shown = show_texts(results, dir.path());
  EXPECT_GE(count(shown, "killed by signal 11"), 8u);
  EXPECT_EQ(shown.find("NaN"), std::string::npos);
}

TEST(CampaignReportInBrowser, ShowsHostileNamesAsText) {
  TemporaryDirectory dir;
  const std::string hostile = "<img src=x onerror=alert(1)></script><script>throw 1</script>";
  CampaignResults results = fake_campaign(2, 1, 3);
  results.name = results.contestants[0].name = results.caves[0].name = hostile;
  results.trials[0].outcome = results.trials[0].reason = hostile;
  const std::string shown = show_texts(results, dir.path());
  EXPECT_EQ(shown.find("<img"), std::string::npos);
  EXPECT_NE(shown.find("&lt;img src=x onerror=alert(1)&gt;"), std::string::npos);
}

}  // namespace
}  // namespace karst::campaign
