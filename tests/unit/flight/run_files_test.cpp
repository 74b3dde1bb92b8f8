#include "sdk/flight/run_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core_stack/common/error.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;
using test::TemporaryDirectory;

TEST(RunClaim, TakesAwayWhatWasWrittenUnlessItIsKept) {
  const TemporaryDirectory dir;
  const fs::path run = dir.path() / "run";
  {
    RunClaim claim(run);
    std::ofstream(run / "events.jsonl") << "{}\n";
  }
  EXPECT_FALSE(fs::exists(run));
  {
    RunClaim claim(run);
    std::ofstream(run / "events.jsonl") << "{}\n";
    claim.keep();
  }
  EXPECT_TRUE(fs::exists(run / "events.jsonl"));
  EXPECT_EQ(std::distance(fs::directory_iterator(run), {}), 1) << "the lock stayed";
  EXPECT_THROW(RunClaim again(run), core::InputError);
  EXPECT_TRUE(fs::exists(run / "events.jsonl"));
}

// Two that began together both looked before either wrote; the one refused later took the other's files away.
TEST(RunClaim, OfTwoAtOneTimeTheSecondIsRefusedAndTakesNothing) {
  const TemporaryDirectory dir;
  RunClaim first(dir.path());
  EXPECT_THROW(RunClaim second(dir.path()), core::InputError);
  std::ofstream(dir.path() / "events.jsonl") << "{}\n";
  EXPECT_THROW(RunClaim third(dir.path()), core::InputError);
  EXPECT_TRUE(fs::exists(dir.path() / "events.jsonl"));
  first.keep();
}

// --out missing/../run was looked at before `missing` was made, seemed free, and its run was taken away.
TEST(RunClaim, APathThroughAFolderThatIsNotThereIsTheSameRun) {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", "{}\n");
  const fs::path around = run_dir_of((dir.path() / "missing" / "..").string() + "/");
  EXPECT_THROW(RunClaim claim(around), core::InputError);
  EXPECT_TRUE(fs::exists(dir.path() / "events.jsonl"));
}

constexpr const char* kMissionOfKarst = "seed 1\nkarst { version 0.1.0 }\n";

std::string refusal_to_replace(const fs::path& run) {
  try {
    RunClaim claim(run, OldRun::replaced);
    claim.keep();
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(RunClaim, ATakenDirectoryIsRefusedInPlainWords) {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", "{}\n");
  try {
    RunClaim claim(dir.path());
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_EQ(std::string(e.what()), dir.path().string() +
                                         ": has files of a run already (events.jsonl); choose another --out, "
                                         "or remove that folder (karst fly "
                                         "--force replaces it)");
  }
}

TEST(RunClaim, ReplacesAFlightAndLeavesWhatIsNoneOfItsFiles) {
  const TemporaryDirectory dir;
  dir.write("mission.info", kMissionOfKarst);
  dir.write("events.jsonl", "{}\n");
  dir.write("notes.txt", "precious\n");
  for (const char* robot : {"robot_1", "robot_2"}) {
    fs::create_directories(dir.path() / robot);
    std::ofstream(dir.path() / robot / "mission.info") << kMissionOfKarst;
    std::ofstream(dir.path() / robot / "events.jsonl") << "{}\n";
  }
  std::ofstream(dir.path() / "robot_2" / "notes.txt") << "precious\n";
  EXPECT_EQ(refusal_to_replace(dir.path()), "");
  EXPECT_TRUE(fs::exists(dir.path() / "notes.txt"));
  for (const char* gone : {"mission.info", "events.jsonl", "robot_1", "robot_2/events.jsonl", "run.lock"})
    EXPECT_FALSE(fs::exists(dir.path() / gone)) << gone;
  EXPECT_TRUE(fs::exists(dir.path() / "robot_2" / "notes.txt"));
}

TEST(RunClaim, ReplacesNothingElse) {
  const TemporaryDirectory none, own, broken, campaign, locked, fresh;
  none.write("events.jsonl", "{}\n");
  own.write("mission.info", "seed 1\n");
  broken.write("mission.info", "precious {\n");
  campaign.write("mission.info", kMissionOfKarst);
  campaign.write("campaign.sqlite", "");
  for (const TemporaryDirectory* dir : {&none, &own, &broken, &campaign}) {
    const std::string e = refusal_to_replace(dir->path());
    EXPECT_NE(e.find("--force: replaces a run directory only"), std::string::npos) << e;
  }
  EXPECT_TRUE(fs::exists(none.path() / "events.jsonl"));
  EXPECT_TRUE(fs::exists(own.path() / "mission.info"));
  EXPECT_TRUE(fs::exists(broken.path() / "mission.info"));
  EXPECT_TRUE(fs::exists(campaign.path() / "campaign.sqlite"));
  locked.write("mission.info", kMissionOfKarst);
  locked.write("run.lock", "");
  EXPECT_NE(refusal_to_replace(locked.path()).find("another karst writes there"), std::string::npos);
  EXPECT_TRUE(fs::exists(locked.path() / "mission.info"));
  EXPECT_EQ(refusal_to_replace(fresh.path() / "new"), "");
}

TEST(RunClaim, NoFlightGoesIntoACampaignAndNoCampaignIntoAFlight) {
  const TemporaryDirectory campaign, flight, team;
  campaign.write("campaign.sqlite", "");
  flight.write("events.jsonl", "");
  team.write("team.jsonl", "");
  EXPECT_THROW(RunClaim claim(campaign.path()), core::InputError);
  EXPECT_TRUE(fs::exists(campaign.path() / "campaign.sqlite"));
  EXPECT_THROW(refuse_run(flight.path()), core::InputError);
  EXPECT_THROW(refuse_run(team.path()), core::InputError);
  EXPECT_NO_THROW(refuse_run(campaign.path()));
}

}  // namespace
}  // namespace karst::flight
