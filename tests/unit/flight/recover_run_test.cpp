#include "sdk/flight/recover_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "core_stack/mapping/octomap/octomap_io.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

/// A flight that came to its end, with all that is made of it.
void write_whole_run(const fs::path& run) {
  test::write_fake_run(run, {.length_m = 12});
  core::VoxelMap map({});
  map.assign({1, 2, 3}, 1, 1.0f);
  core::write_octomap(map, (run / "map").string());
  core::write_ply(map, (run / "map.ply").string());
  std::ofstream(run / "metrics.json") << "{}";
}

// It wrote metrics and report of it anew.
TEST(RecoverRun, AWholeFlightIsWholeUntilSomethingIsMissing) {
  const test::TemporaryDirectory dir;
  const fs::path run = dir.path() / "run";
  write_whole_run(run);
  EXPECT_TRUE(is_whole(run));
  for (const char* file : {"map.bt", "map.ot", "map.ply", "metrics.json", "timing.json", "mission.info",
                           "telemetry.csv", "events.jsonl"}) {
    fs::rename(run / file, run / "away");
    EXPECT_FALSE(is_whole(run)) << file;
    fs::rename(run / "away", run / file);
  }
  for (const char* file : {"map.bt", "metrics.json"}) {
    fs::copy_file(run / file, run / "away", fs::copy_options::overwrite_existing);
    std::ofstream(run / file) << "# Oc";
    EXPECT_FALSE(is_whole(run)) << file;
    fs::rename(run / "away", run / file);
  }
  EXPECT_TRUE(is_whole(run));
}

TEST(RecoverRun, AMissingTimingIsNamed) {
  const test::TemporaryDirectory dir;
  const fs::path run = dir.path() / "run";
  write_whole_run(run);
  fs::remove(run / "timing.json");
  const std::vector<std::string> notes = recover_map(run).notes;
  EXPECT_NE(std::find(notes.begin(), notes.end(), "timing.json: is not there"), notes.end());
}

}  // namespace
}  // namespace karst::flight
