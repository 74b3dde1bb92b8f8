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
