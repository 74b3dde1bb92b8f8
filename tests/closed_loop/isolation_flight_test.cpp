// Missions with the policy in a process of its own: the same flight where the policy behaves, and always a
// landing where it does not.
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

constexpr const char* kInChild =
    " --set policy.isolation=process --set policy.cpu_limit=1s --set policy.hang_limit=10s "
    "--set policy.memory_limit_mib=512";

/// `said`: gets what was printed, if given.
std::filesystem::path fly(const std::string& name, const std::string& arguments, int flight_s,
                          std::string* said = nullptr) {
  const auto run = fresh_folder("isolation_" + name) / "run";
  const Output out = run_karst("fly --cave " + generated_cave("small", 7) + " " + arguments +
                               " --set mission.max_flight_time=" + std::to_string(flight_s) +
                               "s --quiet --no-report --out " + run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  if (said) *said = out.text;
  return run;
}

class SameFlight : public ::testing::TestWithParam<const char*> {};

TEST_P(SameFlight, ByteForByteInAProcessOfItsOwn) {
  const std::string policy = GetParam();
  const auto here = fly(policy + "_here", "--policy " + policy, 70);
  const auto there = fly(policy + "_there", "--policy " + policy + kInChild, 70);
  for (const char* file : {"events.jsonl", "metrics.json", "trajectory.tum", "ground_truth.tum",
                           "telemetry.csv", "map.bt", "map.ot"}) {
    const std::string bytes = bytes_of(here / file);
    EXPECT_GT(bytes.size(), 0u) << file;
    EXPECT_TRUE(bytes == bytes_of(there / file)) << file;
  }
  EXPECT_NE(bytes_of(there / "mission.info").find("isolation process"), std::string::npos);
}
INSTANTIATE_TEST_SUITE_P(Policies, SameFlight, ::testing::Values("nearest_frontier", "unknown_ratio"));

TEST(CrashInFlight, CostsThePolicyAndTheVehicleLands) {
  std::string said;
  const auto run = fly(
      "crash_later",
      std::string("--policy plain --plugin ") + KARST_BINARY_DIR + "/tests/plugins/crash_later.so" + kInChild,
      70, &said);
  const auto m = nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false);
  ASSERT_TRUE(m.is_object());
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_EQ(m["contacts"], 0);
  EXPECT_GT(m["path_length_m"].get<double>(), 20) << "the fallback goes on exploring";
  const std::string events = bytes_of(run / "events.jsonl");
  EXPECT_NE(events.find("plain broke, and was started once more"), std::string::npos);
  EXPECT_NE(events.find("the policy failed: plain: its process ended in decide()"), std::string::npos);
  EXPECT_NE(events.find(", request 4 at "), std::string::npos) << "it answers two, and breaks from then on";
  EXPECT_NE(said.find("karst: the policy failed at "), std::string::npos) << said;
  EXPECT_NE(said.find("and the fallback took over: plain: its process ended in decide()"), std::string::npos)
      << said;
  EXPECT_NE(said.find("plain, and after it failed the fallback, explored"), std::string::npos) << said;
}

/// Every way a plugin of the drawer misbehaves once it is loaded.
class DrawerFlight : public ::testing::TestWithParam<const char*> {};

TEST_P(DrawerFlight, Lands) {
  const std::string name = GetParam();
  const std::string policy = name == "memory_hog" ? name : "plain";
  const auto run = fly(
      name,
      "--policy " + policy + " --plugin " + KARST_BINARY_DIR + "/tests/plugins/" + name + ".so" + kInChild,
      25);
  const auto m = nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false);
  ASSERT_TRUE(m.is_object());
  EXPECT_EQ(m["outcome"], "landed") << m["reason"];
  EXPECT_EQ(m["contacts"], 0);
}
INSTANTIATE_TEST_SUITE_P(Drawer, DrawerFlight,
                         ::testing::Values("throwing", "nan_goal", "only_nan_goals", "million_goals",
                                           "ignores_refusal", "no_outcome", "failing", "endless_loop",
                                           "spinning", "segfault", "aborting", "exiting", "memory_hog",
                                           "memory_flood", "thread_bomb", "forking", "talkative",
                                           "flooding_stdout", "locale_changer", "reaching_out", "babbling",
                                           "writes_request", "stack_overflow", "stops_itself", "scribbling",
                                           "crash_in_event", "outliving", "other_architecture"),
                         [](const auto& i) { return std::string(i.param); });

/// Long enough for the policy to be asked tens of times.
std::filesystem::path fly_hostile(const std::string& name) {
  return fly(name,
             "--policy plain --plugin " + std::string(KARST_BINARY_DIR) + "/tests/plugins/" + name + ".so" +
                 kInChild,
             60);
}

void expect_landed_after_exploring(const std::filesystem::path& run) {
  const auto m = nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false);
  ASSERT_TRUE(m.is_object());
  EXPECT_EQ(m["outcome"], "landed") << m["reason"];
  EXPECT_EQ(m["contacts"], 0);
  EXPECT_GT(m["path_length_m"].get<double>(), 15);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// The first such goal that was accepted had the control thread sample a trajectory until memory was gone.
TEST(HostileFlight, GoalsToBeFlownToInAYearAreRefusedAndTheFallbackFlies) {
  const auto run = fly_hostile("crawling");
  expect_landed_after_exploring(run);
  const std::string events = bytes_of(run / "events.jsonl");
  EXPECT_GT(count(events, "its speed limit of 0.1 m/s is below motion.min_speed"), 0u);
  EXPECT_GT(count(events, "its speed limit is below 0.05 m/s"), 0u);
  EXPECT_GT(count(events, R"("policy":"fallback")"), 0u);
}

/// One such question held the map lane for minutes, and the vehicle hovered without a map.
TEST(HostileFlight, QuestionsForPathsFromAnywhereToThousandsOfPlacesHoldNobodyUp) {
  expect_landed_after_exploring(fly_hostile("asking_far"));
}

/// 325 MB in 29 decisions.
TEST(HostileFlight, DrawingsAndLogsWithoutEndFillNoDiskAndAreSaidToBeLeftOutOnce) {
  const auto run = fly_hostile("drawing_much");
  expect_landed_after_exploring(run);
  const std::string events = bytes_of(run / "events.jsonl");
  EXPECT_LT(events.size(), 12'000'000u);
  EXPECT_EQ(count(events, "has drawn all that a flight may"), 1u);
  EXPECT_EQ(count(events, "has logged all that a flight may"), 1u);
}

}  // namespace
}  // namespace karst
