// Missions with the policy in a process of its own, which is the default: the same flight where the policy
// behaves, always a landing where it does not, and what it prints in a file.
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

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

class SameFlight : public ::testing::TestWithParam<const char*> {};

TEST_P(SameFlight, ByteForByteInAProcessOfItsOwn) {
  const std::string policy = GetParam();
  const auto here = fly(policy + "_here", "--in-process --policy " + policy, 45);
  const auto there = fly(policy + "_there", "--policy " + policy, 45);
  for (const char* file : {"events.jsonl", "metrics.json", "trajectory.tum", "ground_truth.tum",
                           "telemetry.csv", "map.bt", "map.ot"}) {
    const std::string bytes = bytes_of(here / file);
    EXPECT_GT(bytes.size(), 0u) << file;
    EXPECT_TRUE(bytes == bytes_of(there / file)) << file;
  }
  EXPECT_NE(bytes_of(here / "mission.info").find("isolation in_process"), std::string::npos);
  EXPECT_NE(bytes_of(there / "mission.info").find("isolation process"), std::string::npos) << "the default";
  EXPECT_FALSE(std::filesystem::exists(there / "policy_output.txt")) << "it printed nothing";
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

// Only events.jsonl said so.
TEST(CrashInFlight, IsSaidOnTheTerminalAlthoughThePolicyFliesOn) {
  const std::string plugin = std::string(KARST_BINARY_DIR) + "/tests/plugins/remembering.so";
  std::string said;
  const auto run =
      fly("remembering_said", "--policy plain --record-requests --plugin " + plugin + kInChild, 45, &said);
  EXPECT_NE(said.find("karst: plain crashed at "), std::string::npos) << said;
  EXPECT_NE(said.find(" s in decide(), request 3 (SIGSEGV), and was started once more\n"), std::string::npos)
      << said;
  EXPECT_NE(said.find("`gdb --args karst policy replay " + run.string() + " --plugin " + plugin + "`"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("; the policy crashed and was started once more\n"), std::string::npos) << said;
  const Output table = run_karst("table " + run.string());
  EXPECT_NE(table.text.find("the policy crashed and was started once more"), std::string::npos) << table.text;
  fly("remembering_unrecorded", "--policy plain --plugin " + plugin + kInChild, 45, &said);
  EXPECT_NE(said.find("karst: to repeat this in a debugger, fly with --record-requests\n"), std::string::npos)
      << said;
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
  if (name == "flooding_stdout") {
    const std::string printed = bytes_of(run / "policy_output.txt");
    EXPECT_LT(printed.size(), (1u << 20) + 100);
    EXPECT_EQ(count(printed, "[karst: the rest is left out"), 1u);
  }
}
INSTANTIATE_TEST_SUITE_P(Drawer, DrawerFlight,
                         ::testing::Values("throwing", "nan_goal", "only_nan_goals", "million_goals",
                                           "ignores_refusal", "no_outcome", "failing", "endless_loop",
                                           "spinning", "segfault", "aborting", "exiting", "memory_hog",
                                           "memory_flood", "thread_bomb", "forking", "talkative",
                                           "flooding_stdout", "locale_changer", "reaching_out", "babbling",
                                           "writes_request", "stack_overflow", "stops_itself", "scribbling",
                                           "crash_in_event", "outliving", "other_architecture",
                                           "closes_stdout"),
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

std::string plain_of(const std::string& plugin) {
  return "--policy plain --plugin " + std::string(KARST_BINARY_DIR) + "/tests/plugins/" + plugin + ".so";
}

// As it was: what a policy printed in a process of its own went to /dev/null.
TEST(PrintedInFlight, IsKeptAndItsLastLinesAreShownAfterACrash) {
  std::string said;
  const auto run = fly("last_words", plain_of("last_words"), 40, &said);
  const std::string printed = bytes_of(run / "policy_output.txt");
  EXPECT_EQ(printed.find("?[31mrequest 1?[0m\n?[31mrequest 2?[0m\n?[31mrequest 3?[0m\nabout to crash\n"), 0u)
      << printed;
  EXPECT_EQ(count(printed, "about to crash"), 2u) << "both processes";
  EXPECT_NE(said.find((run / "policy_output.txt").string() + "   what the policy printed"), std::string::npos)
      << said;
  EXPECT_NE(said.find("karst: what the policy plain printed last:\n  | ?[31mrequest 1"), std::string::npos)
      << said;
  EXPECT_NE(said.find("\n  | about to crash\n"), std::string::npos) << said;
  EXPECT_EQ(said.find('\x1b'), std::string::npos) << "a terminal would obey it";
}

TEST(PrintedInFlight, WithoutACrashIsKeptAndNotShown) {
  std::string said;
  const auto run = fly("talkative_kept", plain_of("talkative"), 25, &said);
  EXPECT_EQ(bytes_of(run / "policy_output.txt").find("{\"policies\": \"mine!\"}\n"), 0u);
  EXPECT_EQ(said.find("mine!"), std::string::npos) << said;
}

TEST(PrintedInFlight, IsShownOfAPolicyThatIsRefused) {
  const auto run = fresh_folder("isolation_refused") / "run";
  const Output out = run_karst("fly --cave " + generated_cave("small", 7) + " " + plain_of("talkative") +
                               " --set policy.parameters.nonsense=1 --quiet --out " + run.string());
  EXPECT_EQ(out.code, 1) << out.text;
  EXPECT_TRUE(out.says("karst: what the policy plain printed last:\n  | {\"policies\": \"mine!\"}\n"))
      << out.text;
  EXPECT_TRUE(out.says("nonsense")) << out.text;
  EXPECT_FALSE(std::filesystem::exists(run));
}

/// On a machine that filters no system calls.
Output fly_without_seccomp(const std::string& arguments) {
  return run_command(
      "LD_PRELOAD=" KARST_BINARY_DIR "/lib/no_seccomp.so " KARST_BINARY_DIR
      "/bin/karst fly --policy nearest_frontier --set mission.max_flight_time=15s --no-report --cave " +
      generated_cave("small", 7) + " " + arguments);
}

TEST(NoConfinement, ThePolicyFliesInProcessAndThatIsSaidOnceAndRecorded) {
  const auto run = fresh_folder("isolation_impossible") / "run";
  const Output out = fly_without_seccomp("--out " + run.string());
  EXPECT_TRUE(out.code == 0 || out.code == 2) << out.text;
  EXPECT_TRUE(out.says("system calls cannot be filtered on this machine")) << out.text;
  EXPECT_EQ(count(out.text, "nearest_frontier flies in karst's own process"), 1u) << out.text;
  EXPECT_NE(bytes_of(run / "mission.info").find("isolation in_process"), std::string::npos);
}

TEST(NoConfinement, EndsAFlightThatInsistsOnAProcess) {
  const auto run = fresh_folder("isolation_insisted") / "run";
  const Output out = fly_without_seccomp("--set policy.isolation=process --out " + run.string());
  EXPECT_EQ(out.code, 1) << out.text;
  EXPECT_TRUE(out.says("karst: policy.isolation: process: this machine cannot confine a policy: "))
      << out.text;
  EXPECT_TRUE(out.says("; karst fly --in-process does without")) << out.text;
  EXPECT_FALSE(std::filesystem::exists(run));
}

TEST(CheckedMission, LeavesToTheMachineThatFliesItWhatWasLeftToIt) {
  const auto file = fresh_folder("isolation_checked") / "resolved.info";
  const Output out = run_karst("fly --cave " + generated_cave("small", 7) + " --check " + file.string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_NE(bytes_of(file).find("isolation where_possible"), std::string::npos);
}

}  // namespace
}  // namespace karst
