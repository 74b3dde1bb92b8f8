#include "sdk/campaign/report/campaign_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core_stack/common/error.h"
#include "sdk/campaign/store/store.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/campaign/stored_campaign.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;

TEST(CampaignPage, IsWrittenBesideTheStore) {
  test::TemporaryDirectory dir;
  EXPECT_FALSE(is_campaign(dir.path()));
  test::store_campaign(test::fake_campaign(2, 2, 2), dir.path());
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
  test::store_campaign(test::fake_campaign(2, 1, 2), dir.path());
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
