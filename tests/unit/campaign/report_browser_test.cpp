// The campaign's page in a real browser.
#include <gtest/gtest.h>

#include "sdk/campaign/report.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/evaluation/browser.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using test::fake_campaign;
using test::TemporaryDirectory;

struct Shown {
  std::string root, body;  // the root element's tag, and the body up to the data
};

/// Fails if the page had an error or did not come to its end; empty without a browser.
Shown show(const CampaignResults& results, const fs::path& dir, const std::string& hash = "") {
  write_campaign_report(dir / "report.html", results);
  const std::string dom = test::dom_in_browser(dir / "report.html", hash);
  if (dom.empty()) return {};
  const Shown shown{dom.substr(0, dom.find("<head>")),
                    dom.substr(dom.find("<body>"), dom.find("id=\"data\"") - dom.find("<body>"))};
  EXPECT_NE(shown.root.find("data-ready=\"yes\""), std::string::npos) << shown.root;
  EXPECT_EQ(shown.root.find("data-errors"), std::string::npos) << shown.root;
  return shown;
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
  const Shown shown = show(results, dir.path(), "t=12&view=top&theme=dark");
  if (shown.body.empty()) GTEST_SKIP() << "skipped: no chromium";
  EXPECT_EQ(count(shown.body, "<canvas"), 2u);  // two views in 3D
  EXPECT_NE(shown.body.find("0:12 / "), std::string::npos);
  EXPECT_EQ(count(shown.body, "class=\"band\""), 9u);  // three contestants over all and in two caves
  EXPECT_EQ(count(shown.body, "class=\"box\""), 6u);   // and their spread in two caves
  EXPECT_NE(shown.body.find("policy_1 better"), std::string::npos);
  EXPECT_NE(shown.body.find("karst report '0-0-2'"), std::string::npos);  // the failed trial
  EXPECT_EQ(shown.body.find("NaN"), std::string::npos);
  EXPECT_EQ(shown.body.find("undefined"), std::string::npos);
}

TEST(CampaignReportInBrowser, OfNextToNothingSaysWhatThereIs) {
  for (const auto& [contestants, caves, seeds] : {std::tuple{0, 0, 0}, {2, 1, 0}, {1, 1, 1}, {2, 2, 1}}) {
    TemporaryDirectory dir;
    const Shown shown = show(fake_campaign(contestants, caves, seeds), dir.path());
    if (shown.body.empty()) GTEST_SKIP() << "skipped: no chromium";
    EXPECT_EQ(shown.body.find("NaN"), std::string::npos) << contestants << caves << seeds;
    EXPECT_EQ(shown.body.find("Infinity"), std::string::npos) << contestants << caves << seeds;
    EXPECT_EQ(shown.body.find("undefined"), std::string::npos) << contestants << caves << seeds;
    EXPECT_NE(shown.body.find("No recorded flights are embedded"), std::string::npos);
  }
}

TEST(CampaignReportInBrowser, OfTrialsThatAllFailedShowsThem) {
  TemporaryDirectory dir;
  CampaignResults results = fake_campaign(2, 2, 2);
  for (TrialResult& t : results.trials) {
    t.failed = true, t.outcome = "", t.reason = "killed by signal 11", t.curve.clear();
    t.figures.assign(t.figures.size(), std::numeric_limits<double>::quiet_NaN());
  }
  const Shown shown = show(results, dir.path());
  if (shown.body.empty()) GTEST_SKIP() << "skipped: no chromium";
  EXPECT_GE(count(shown.body, "killed by signal 11"), 8u);
  EXPECT_EQ(shown.body.find("NaN"), std::string::npos);
}

TEST(CampaignReportInBrowser, ShowsHostileNamesAsText) {
  TemporaryDirectory dir;
  const std::string hostile = "<img src=x onerror=alert(1)></script><script>throw 1</script>";
  CampaignResults results = fake_campaign(2, 1, 3);
  results.name = results.contestants[0].name = results.caves[0].name = hostile;
  results.trials[0].outcome = results.trials[0].reason = hostile;
  const Shown shown = show(results, dir.path());
  if (shown.body.empty()) GTEST_SKIP() << "skipped: no chromium";
  EXPECT_EQ(shown.body.find("<img"), std::string::npos);
  EXPECT_NE(shown.body.find("&lt;img src=x onerror=alert(1)&gt;"), std::string::npos);
}

}  // namespace
}  // namespace karst::campaign
