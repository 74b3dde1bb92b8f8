#include "sdk/campaign/plan/campaign.h"

#include <gtest/gtest.h>

#include "tests/unit/campaign/store/store_fixture.h"

namespace karst::campaign {
namespace {

/// A campaign file beside two caves.
fs::path written(const std::string& text) {
  const fs::path dir = fresh_folder("files");
  for (const char* cave : {"a.ply", "b.ply"}) std::ofstream(dir / cave) << "ply\n";
  std::ofstream(dir / "c.info") << text;
  return dir / "c.info";
}
std::string complaint(const std::string& text) {
  return error_of([&] { read_campaign(written(text).string()); });
}

const std::string kCave = "cave { file a.ply }\n", kSeeds = "seeds 3\n",
                  kWho = "contestant { policy near }\n";

TEST(CampaignFile, ReadsEverythingWithPathsRelativeToIt) {
  const fs::path file = written(
      "name deeper\nmission base.info\nprofile full\nmetric depth_m\nflight_time 5min\ntrial_timeout "
      "1h\nseed_list \"7 3 "
      "5\"\n"
      "settings { motion { max_speed \"1 m/s\" } }\n"
      "contestant { policy near }\n"
      "contestant { policy near parameters { max_distance \"50 m\" } settings { policy { stream 2 } } }\n"
      "contestant { name best policy near }\n"
      "cave { file a.ply start \"1 2 3\" }\ncave { name again file a.ply }\n");
  const Campaign c = read_campaign(file.string());
  EXPECT_EQ(c.name, "deeper");
  EXPECT_EQ(c.mission, (file.parent_path() / "base.info").string());
  EXPECT_EQ(c.metric, "depth_m");
  EXPECT_EQ(c.flight_time_s, 300);
  EXPECT_EQ(c.trial_timeout_s, 3600);
  EXPECT_EQ(c.seeds, (std::vector<std::int64_t>{7, 3, 5}));
  EXPECT_EQ(c.settings, (Settings{{"motion.max_speed", "1 m/s"}}));
  ASSERT_EQ(c.contestants.size(), 3u);
  EXPECT_EQ(c.contestants[1].name, "near+max_distance=50m+stream=2");
  EXPECT_EQ(c.contestants[1].settings, (Settings{{"policy.stream", "2"}}));
  EXPECT_EQ(c.contestants[2].name, "best");
  ASSERT_EQ(c.caves.size(), 2u);
  EXPECT_EQ(c.caves[0].name, "a");
  EXPECT_EQ(c.caves[0].start, "1 2 3");
  EXPECT_EQ(c.caves[1].file, (file.parent_path() / "a.ply").string());
}

TEST(CampaignFile, CountsSeedsFromOneAndTakesItsNameFromTheFile) {
  const Campaign c = read_campaign(written(kWho + kCave + kSeeds).string());
  EXPECT_EQ(c.seeds, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(c.name, "c");
  EXPECT_EQ(c.flight_time_s, 300);
}

struct Bad {
  const char* name;
  std::string text;
  std::vector<std::string> parts;
};
class BadCampaign : public testing::TestWithParam<Bad> {};
TEST_P(BadCampaign, IsAnErrorThatNamesThePlace) {
  const std::string e = complaint(GetParam().text);
  EXPECT_TRUE(says(e, "c.info")) << e;
  for (const std::string& part : GetParam().parts)
    EXPECT_TRUE(says(e, part)) << "expected \"" << part << "\" in: " << e;
}
INSTANTIATE_TEST_SUITE_P(
    Drawer, BadCampaign,
    testing::Values(
        Bad{"NoContestant", kCave + kSeeds, {"contestant", "none"}},
        Bad{"NoCave", kWho + kSeeds, {"cave", "none"}}, Bad{"NoSeeds", kWho + kCave, {"seeds", "none"}},
        Bad{"UnknownKey",
            kWho + kCave + kSeeds + "flight_tim 3\n",
            {"flight_tim", "did you mean flight_time"}},
        Bad{"SettingsOutsideOfTheirBlock",
            kWho + kCave + kSeeds + "simulator { gust \"3 m/s\" }\n",
            {"simulator.gust", "go into settings { }"}},
        Bad{"UnknownKeyOfContestant",
            kCave + kSeeds + "contestant { polcy near }\n",
            {"contestant.polcy", "did you mean contestant.policy"}},
        Bad{"UnknownKeyOfCave",
            kWho + kSeeds + "cave { fil a.ply }\n",
            {"cave.fil", "did you mean cave.file"}},
        Bad{"TwoOfAName", kWho + kWho + kCave + kSeeds, {"contestant near", "two of this name"}},
        Bad{"TwoCavesOfAName", kWho + kCave + kCave + kSeeds, {"cave a", "two of this name"}},
        Bad{"AMissingCave", kWho + kSeeds + "cave { file nowhere.ply }\n", {"nowhere.ply is not there"}},
        Bad{"AMissingPlugin",
            kCave + kSeeds + "contestant { policy x plugin x.so }\n",
            {"contestant x: plugin: ", "x.so is not there"}},
        Bad{"ABlockOfAContestantWithAnotherName",
            kCave + kSeeds + "contestant { policy x paramters { horizon 3 } }\n",
            {"contestant.paramters", "did you mean contestant.parameters?"}},
        Bad{"ABlockWithAnotherName",
            kCave + kSeeds + "contestants { policy x }\n",
            {"contestants: no such block; did you mean contestant?"}},
        Bad{"NoPolicy", kCave + kSeeds + "contestant { name x }\n", {"contestant.policy", "missing"}},
        Bad{"NoCaveFile", kWho + kSeeds + "cave { name x }\n", {"cave.file", "missing"}},
        Bad{"ANameThatLeavesTheFolder", kCave + kSeeds + "contestant { policy x name \"../x\" }\n", {"../x"}},
        Bad{"AHiddenName", kCave + kSeeds + "contestant { policy x name .x }\n", {".x"}},
        Bad{"ACampaignsNameWithASlash", "name a/b\n" + kWho + kCave + kSeeds, {"name", "a/b"}},
        Bad{"AProfileNobodyKnows",
            "profile campain\n" + kWho + kCave + kSeeds,
            {"profile", "did you mean campaign"}},
        Bad{"AMetricNobodyKnows",
            "metric coverage_acu\n" + kWho + kCave + kSeeds,
            {"metric", "did you mean coverage_auc"}},
        Bad{"TooShortAFlight", "flight_time 1s\n" + kWho + kCave + kSeeds, {"flight_time", "10 to 86400 s"}},
        Bad{"AWrongUnit", "flight_time 3kg\n" + kWho + kCave + kSeeds, {"flight_time", "kg"}},
        Bad{"SeedsThatAreNone", "seeds many\n" + kWho + kCave, {"seeds", "many"}},
        Bad{"NegativeSeeds", "seeds -3\n" + kWho + kCave, {"seeds", "-3"}},
        Bad{"ASeedTwice", "seed_list \"3 4 3\"\n" + kWho + kCave, {"seed_list", "3 twice"}},
        Bad{"ASeedThatIsNone", "seed_list \"3 x\"\n" + kWho + kCave, {"seed_list", "\"x\""}},
        Bad{"SeedsAndAList", "seed_list \"3 4\"\n" + kWho + kCave + kSeeds, {"seed_list", "beside seeds"}},
        Bad{"ASeedAmongSettings",
            kWho + kCave + kSeeds + "settings { seed 4 }\n",
            {"seed", "seeds or seed_list"}},
        Bad{"ACaveAmongSettings", kWho + kCave + kSeeds + "settings { cave { file x } }\n", {"cave.file"}},
        Bad{"ParametersAmongSettings",
            kCave + kSeeds + "contestant { policy x settings { policy { parameters { a 1 } } } }\n",
            {"policy.parameters.a", "contestant.parameters"}},
        Bad{"TheTimeAmongSettings",
            kWho + kCave + kSeeds + "settings { mission { max_flight_time 9s } }\n",
            {"mission.max_flight_time", "flight_time"}},
        Bad{"SettingsTwice",
            kWho + kCave + kSeeds + "settings { a 1 }\nsettings { b 1 }\n",
            {"settings", "twice"}},
        Bad{"ASettingTwice", kWho + kCave + kSeeds + "settings { a 1 a 2 }\n", {"settings.a", "twice"}},
        Bad{"SettingsThatAreNoBlock", kWho + kCave + kSeeds + "settings 4\n", {"settings", "block"}},
        Bad{"AKeyTwice", "name a\nname b\n" + kWho + kCave + kSeeds, {"name", "twice"}},
        Bad{"ASyntaxError", kWho + kCave + kSeeds + "cave {\n", {"line"}}),
    [](const auto& bad) { return bad.param.name; });

TEST(CampaignFile, ThatIsNotThereIsNamed) {
  EXPECT_TRUE(says(error_of([] { read_campaign("/nowhere/c.info"); }), "/nowhere/c.info"));
}

TEST(Campaign, OfTheCommandLineNamesTheOptionOfAMissingFile) {
  Campaign c;
  c.contestants = {parse_contestant("near")};
  c.caves = {parse_cave("nowhere.ply")};
  c.seeds = {1};
  EXPECT_TRUE(says(error_of([&] { complete(c); }), "command line: --caves: nowhere.ply is not there"));
  c.contestants[0].plugin = "x.so";
  EXPECT_TRUE(says(error_of([&] { complete(c); }), "command line: --plugin: x.so is not there"));
}

TEST(Contestant, OfTheCommandLineHasParameters) {
  const ContestantSpec c = parse_contestant("near:max_distance=50 m,goals=3");
  EXPECT_EQ(c.policy, "near");
  EXPECT_EQ(c.parameters, (Settings{{"max_distance", "50 m"}, {"goals", "3"}}));
  EXPECT_TRUE(parse_contestant("near").parameters.empty());
  for (const char* bad : {"", ":a=1", "near:a", "near:=3"})
    EXPECT_NE(error_of([&] { parse_contestant(bad); }), "") << bad;
}

}  // namespace
}  // namespace karst::campaign
