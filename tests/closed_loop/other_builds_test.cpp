// Plugins of other compilers, standard libraries, standards and levels, and of released ABIs, flown by this
// host: one mission, the same bytes.
#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecords[] = {"trajectory.tum", "events.jsonl", "telemetry.csv", "map.bt"};

/// The folder of a flight of half a minute.
fs::path flown(const std::string& policy, const std::string& plugin, const std::string& folder) {
  const fs::path run = fresh_folder(folder) / "run";
  const Output out =
      run_karst("fly --cave " + generated_cave("small", 7) + " --policy " + policy + " --plugin " + plugin +
                " --set mission.max_flight_time=40s --quiet --no-report --out " + run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  return run;
}

void expect_same_flight(const fs::path& a, const fs::path& b) {
  for (const char* file : kRecords) {
    EXPECT_GT(bytes_of(a / file).size(), 1000u) << file;
    EXPECT_TRUE(bytes_of(a / file) == bytes_of(b / file)) << file << " differs";
  }
}

std::string built(const std::string& name) { return KARST_BINARY_DIR "/tests/plugins/" + name + ".so"; }
std::string kept(const std::string& name) { return KARST_SOURCE_DIR "/tests/abi/kept/1.0/" + name + ".so"; }

/// The flight of the build that the others are compared with, flown once.
const fs::path& reference(const std::string& policy) {
  // Tests run side by side: each flies its own.
  const std::string mine = ::testing::UnitTest::GetInstance()->current_test_suite()->name();
  static const fs::path nearest = flown(
      "nearest_frontier", KARST_BINARY_DIR "/lib/karst/policies/nearest_frontier.so", mine + "_nearest");
  static const fs::path deepest = flown("deepest", built("deepest_gcc_c11"), mine + "_deepest");
  return policy == "deepest" ? deepest : nearest;
}

TEST(OtherBuilds, FlyAsTheTreesOwn) {
  int flights = 0;
  for (const std::string name : {KARST_OTHER_BUILDS}) {
    SCOPED_TRACE(name);
    if (!fs::exists(built(name))) continue;  // this machine has no such compiler
    const std::string policy = name.starts_with("deepest") ? "deepest" : "nearest_frontier";
    expect_same_flight(reference(policy), flown(policy, built(name), "other_builds_" + name));
    ++flights;
  }
  EXPECT_GE(flights, 5) << "too few compilers on this machine to prove anything";
}

TEST(KeptPlugins, FlyAsIfBuiltToday) {
#ifndef __x86_64__
  GTEST_SKIP() << "skipped: the kept plugins are for x86-64";
#endif
  expect_same_flight(flown("right_hand", built("kept_right_hand"), "kept_right_hand_today"),
                     flown("right_hand", kept("right_hand"), "kept_right_hand"));
  expect_same_flight(reference("deepest"), flown("deepest", kept("deepest"), "kept_deepest"));
}

}  // namespace
}  // namespace karst
