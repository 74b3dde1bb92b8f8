#include "sdk/campaign/report/campaign_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core_stack/common/error.h"
#include "sdk/campaign/store/store.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;

/// A folder with a store that holds these results.
void store(const CampaignResults& results, const fs::path& folder) {
  StoreHead head;
  head.name = results.name;
  head.horizon_s = results.horizon_s;
  head.contestants = results.contestants;
  head.caves = results.caves;
  head.seeds = {1, 2};
  Store to = Store::create(store_file(folder), head);
  for (const TrialResult& t : results.trials) {
    StoredTrial trial;
    trial.result = t;
    to.add(trial);
  }
}

TEST(CampaignPage, IsWrittenBesideTheStore) {
  test::TemporaryDirectory dir;
  EXPECT_FALSE(is_campaign(dir.path()));
  store(test::fake_campaign(2, 2, 2), dir.path());
  EXPECT_TRUE(is_campaign(dir.path()));
  EXPECT_TRUE(is_campaign(store_file(dir.path())));
  const fs::path page = write_campaign_page(dir.path(), "coverage");
  EXPECT_EQ(page, dir.path() / "report.html");
  std::ostringstream text;
  text << std::ifstream(page).rdbuf();
  EXPECT_NE(text.str().find("\"contestants\":[{\"name\":\"policy_1\""), std::string::npos);
  EXPECT_EQ(write_campaign_page(store_file(dir.path()), "coverage"), page);
}

TEST(CampaignPage, OfAFigureThatIsNoneSaysSo) {
  test::TemporaryDirectory dir;
  store(test::fake_campaign(2, 1, 2), dir.path());
  EXPECT_THROW(write_campaign_page(dir.path(), "beauty"), core::InputError);
  EXPECT_FALSE(fs::exists(dir.path() / "report.html"));
}

TEST(CampaignPage, ARunDirectoryIsNoCampaign) {
  test::TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  EXPECT_FALSE(is_campaign(dir.path()));
  EXPECT_FALSE(is_campaign(dir.path() / "nothing"));
}

}  // namespace
}  // namespace karst::campaign
