// `karst policy check` judged from outside: what comes with karst passes, and what is spoiled on purpose
// fails the very test that is meant for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "sdk/check/run_check.h"
#include "sdk/host/isolation/process.h"

namespace karst::check {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kKarst = std::string(KARST_BINARY_DIR) + "/bin/karst";

std::string drawer(const std::string& name) {
  return std::string(KARST_BINARY_DIR) + "/tests/plugins/" + name + ".so";
}

struct Checked {
  int exit_code = 0;
  json said;  // with --json
  std::string text;

  std::set<std::string> tests(const std::string& outcome) const {
    std::set<std::string> out;
    for (const json& t : said.at("tests"))
      if (t.at("outcome") == outcome) out.insert(t.at("name"));
    return out;
  }
};

Checked check(std::vector<std::string> words) {
  words.insert(words.begin(), {kKarst, "policy", "check", "--json"});
  const host::ProcessOutput output = host::run_process(words, 1800);
  Checked c{output.end.exit_code, json::parse(output.out, nullptr, false), output.out};
  if (!c.said.is_object()) c.said = {{"tests", json::array()}};
  return c;
}

using Names = std::set<std::string>;

// What comes with karst

class Shipped : public ::testing::TestWithParam<const char*> {};

TEST_P(Shipped, PassesEveryTest) {
  const std::string file = std::string(KARST_BINARY_DIR) + "/lib/karst/policies/" + GetParam() + ".so";
  const Checked c = check({file, "--level", "pedantic"});
  EXPECT_EQ(c.exit_code, 0) << c.text;
  EXPECT_EQ(c.tests("failed"), Names{});
  EXPECT_EQ(c.tests("not run"), Names{});
  EXPECT_EQ(c.tests("not applicable"), Names{"parameters.texts"}) << "none has a parameter of free text";
}

INSTANTIATE_TEST_SUITE_P(Policies, Shipped,
                         ::testing::Values("nearest_frontier", "lateral_frontier", "highest_frontier",
                                           "unknown_ratio"));

TEST(Examples, PassEveryTestToo) {
  for (const char* name : {"right_hand", "deepest"}) {
    const Checked c = check({drawer(name), "--level", "pedantic"});
    EXPECT_EQ(c.tests("failed"), Names{}) << name << ": " << c.text;
    EXPECT_EQ(c.tests("not run"), Names{}) << name;
    EXPECT_EQ(c.exit_code, 0) << name;
  }
}

TEST(GoodPolicy, PassesEveryTestThereIs) {
  const Checked c = check({drawer("spoiled"), "--policy", "good", "--level", "pedantic"});
  EXPECT_EQ(c.tests("passed").size(), all_tests().size()) << c.text;
  EXPECT_EQ(c.exit_code, 0);
}

// What is spoiled

struct Spoiled {
  const char* policy;
  const char* test;
};
class SpoiledPolicy : public ::testing::TestWithParam<Spoiled> {};

TEST_P(SpoiledPolicy, FailsTheTestMeantForIt) {
  const std::string policy = GetParam().policy;
  const Checked c = check({drawer("spoiled"), "--policy", policy, "--test", GetParam().test, "--hang-limit",
                           policy == "deaf" ? "5" : "100"});  // only that one is to be ended by it
  EXPECT_EQ(c.tests("failed"), Names{GetParam().test}) << c.text;
  EXPECT_EQ(c.exit_code, 2);
}

INSTANTIATE_TEST_SUITE_P(
    Drawer, SpoiledPolicy,
    ::testing::Values(
        Spoiled{"crashes_in_destroy", "lifecycle.destroy"}, Spoiled{"activates_once", "lifecycle.reactivate"},
        Spoiled{"afraid_of_news", "lifecycle.events"}, Spoiled{"shares_memory", "lifecycle.two_objects"},
        Spoiled{"breaks_at_bound", "parameters.bounds"}, Spoiled{"breaks_on_text", "parameters.texts"},
        Spoiled{"needs_frontier", "requests.no_frontier"}, Spoiled{"needs_two", "requests.one_frontier"},
        Spoiled{"needs_few", "requests.thousands"}, Spoiled{"needs_map", "requests.empty_map"},
        Spoiled{"needs_time", "requests.extremes"}, Spoiled{"seldom_fails", "requests.fuzzed"},
        Spoiled{"no_tolerance", "goals.well_formed"}, Spoiled{"into_the_rock", "goals.inside"},
        Spoiled{"unranked", "goals.ranked"}, Spoiled{"mute", "goals.reasons"},
        Spoiled{"knows_everything", "state.extensions"}, Spoiled{"forgets", "state.same_answers"},
        Spoiled{"trusts_bytes", "state.damage"}, Spoiled{"bloated", "state.size"},
        Spoiled{"reads_the_clock", "determinism.repeat"},
        Spoiled{"reads_addresses", "determinism.fresh_process"},
        Spoiled{"loses_patience", "determinism.slow_host"}, Spoiled{"slow", "deadlines.small"},
        Spoiled{"very_slow", "deadlines.large"}, Spoiled{"deaf", "deadlines.should_stop"},
        Spoiled{"on_another_thread", "services.rules"}, Spoiled{"resentful", "services.fail"},
        Spoiled{"needs_gain", "services.absent"}, Spoiled{"leaves_thread", "threads.end"},
        Spoiled{"leaks", "memory.growth"}, Spoiled{"leaks_objects", "memory.returned"},
        Spoiled{"hog", "memory.peak"}, Spoiled{"talks", "process.output"},
        Spoiled{"changes_locale", "process.locale_and_arithmetic"},
        Spoiled{"takes_signal", "process.signals"}, Spoiled{"leaves_file", "process.leftovers"}),
    [](const auto& p) { return std::string(p.param.policy); });

// Printing is what the documentation invites an author to while a policy is developed.
TEST(Talking, IsANoteBelowPedanticUnlessItIsAskedFor) {
  const std::string reason =
      "bytes were written to stdout: use request.log(); printing is fine while you develop";
  const auto checked = [](std::vector<std::string> more) {
    std::vector<std::string> words{drawer("spoiled"), "--policy", "talks"};
    words.insert(words.end(), more.begin(), more.end());
    return check(words);
  };
  const Checked c = checked({"--level", "basic"});
  EXPECT_EQ(c.exit_code, 0) << c.text;
  EXPECT_EQ(c.tests("note"), Names{"process.output"});
  EXPECT_EQ(c.tests("failed"), Names{});
  EXPECT_THAT(c.text, HasSubstr(reason));
  EXPECT_EQ(checked({"--test", "process.output"}).exit_code, 2);
  EXPECT_EQ(checked({"--test", "process", "--level", "pedantic"}).tests("failed"), Names{"process.output"});
}

class BrokenFile : public ::testing::TestWithParam<Spoiled> {};  // policy: the file

TEST_P(BrokenFile, FailsTheTestMeantForItAndTheRestIsNotRun) {
  const Checked c = check({drawer(GetParam().policy), "--level", "basic", "--hang-limit", "3"});
  EXPECT_EQ(c.tests("failed"), Names{GetParam().test}) << c.text;
  EXPECT_GT(c.tests("not run").size(), 10u);
  EXPECT_EQ(c.exit_code, 2);
}

INSTANTIATE_TEST_SUITE_P(
    Drawer, BrokenFile,
    ::testing::Values(Spoiled{"no_entry", "entry.opens"}, Spoiled{"crash_at_load", "entry.opens"},
                      Spoiled{"exit_at_load", "entry.opens"}, Spoiled{"hang_at_load", "entry.opens"},
                      Spoiled{"wrong_major", "entry.handshake"}, Spoiled{"newer_minor", "entry.handshake"},
                      Spoiled{"missing_slot", "entry.tables"}, Spoiled{"short_table", "entry.tables"},
                      Spoiled{"newer_host_wanted", "entry.descriptor"},
                      Spoiled{"bad_default", "entry.parameters"}, Spoiled{"throwing", "lifecycle.order"},
                      Spoiled{"failing", "lifecycle.order"}, Spoiled{"endless_loop", "lifecycle.order"},
                      Spoiled{"slow_but_polite", "lifecycle.order"}),
    [](const auto& p) { return std::string(p.param.policy); });

TEST(BadFile, OfTheFileAsAWhole) {
  EXPECT_EQ(check({drawer("exports_more"), "--test", "entry", "--level", "pedantic"}).tests("failed"),
            (Names{"entry.exports", "entry.described"}));
  EXPECT_EQ(check({drawer("talkative"), "--test", "entry.quiet"}).tests("failed"), Names{"entry.quiet"});
  EXPECT_EQ(check({drawer("changes_process_at_load"), "--test", "entry.quiet"}).tests("failed"),
            Names{"entry.quiet"});
  for (const char* file : {"nan_goal", "million_goals", "ignores_refusal", "no_outcome", "only_nan_goals"})
    EXPECT_EQ(check({drawer(file), "--test", "goals.well_formed"}).tests("failed"),
              Names{"goals.well_formed"})
        << file;
}

// Every test there is has somebody who fails it: a check that cannot fail checks nothing.
TEST(Drawer, HoldsSomebodyForEveryTest) {
  std::ifstream in(std::string(KARST_SOURCE_DIR) + "/tests/check/policy_check_test.cpp");
  const std::string source{std::istreambuf_iterator<char>(in), {}};
  for (const auto& t : all_tests()) EXPECT_THAT(source, HasSubstr("\"" + std::string(t.name) + "\""));
}

// What it says

TEST(Failure, SaysWhereAndHowToRepeatIt) {
  const Checked c = check(
      {drawer("spoiled"), "--policy", "crashes_in_destroy", "--seed", "42", "--test", "lifecycle.destroy"});
  ASSERT_EQ(c.said.at("tests").size(), 1u) << c.text;
  const json& t = c.said.at("tests")[0];
  EXPECT_THAT(t.at("reason").get<std::string>(), HasSubstr("killed by signal 6"));
  EXPECT_THAT(t.at("reason").get<std::string>(), HasSubstr("in destroy()"));
  const std::string repeat = t.at("repeat");
  EXPECT_THAT(repeat,
              HasSubstr("--policy crashes_in_destroy --seed 42 --level strict --test lifecycle.destroy"));
  const host::ProcessOutput again = host::run_process(
      {"/bin/sh", "-c", "PATH=" + std::string(KARST_BINARY_DIR) + "/bin:$PATH; " + repeat}, 600);
  EXPECT_EQ(again.end.exit_code, 2);
  EXPECT_THAT(again.out, HasSubstr("FAILED   lifecycle.destroy"));
}

TEST(Failure, HangNamesTheCallAndTheLimit) {
  const Checked c = check({drawer("endless_loop"), "--test", "lifecycle.order", "--hang-limit", "1"});
  ASSERT_EQ(c.said.at("tests").size(), 1u) << c.text;
  EXPECT_EQ(c.said.at("tests")[0].at("reason"), "decide(), request 1 did not return within 1 s");
}

TEST(BadUsage, IsAnErrorAndNotAFailedTest) {
  EXPECT_EQ(check({"/no/such/file.so"}).exit_code, 1);
  EXPECT_EQ(check({drawer("spoiled"), "--policy", "nobody"}).exit_code, 1);
  const Checked misspelt = check({drawer("spoiled"), "--policy", "good", "--test", "lifecycle.oder"});
  EXPECT_EQ(misspelt.exit_code, 1);
  EXPECT_THAT(misspelt.text, HasSubstr("did you mean lifecycle.order?"));
  EXPECT_EQ(check({drawer("spoiled"), "--level", "severe"}).exit_code, 1);
  EXPECT_EQ(check({}).exit_code, 1);
}

TEST(BadUsage, HangLimitThatIsNoNumberIsRefused) {
  const Checked c = check({drawer("spoiled"), "--policy", "good", "--test", "goals", "--hang-limit", "nan"});
  EXPECT_EQ(c.exit_code, 1);
  EXPECT_THAT(c.text, HasSubstr("expected a number in 0.1 to 600, got \"nan\""));
}

TEST(BadUsage, ChosenTestsOfABrokenFileDoNotPassUnseen) {
  const Checked c = check({drawer("no_entry"), "--test", "goals"});
  EXPECT_EQ(c.exit_code, 1);
  EXPECT_THAT(c.text, HasSubstr("no_entry.so: exports no karst_plugin_entry"));
}

TEST(Stopped, LeavesNothingBehind) {
  const auto folder = std::filesystem::path(KARST_BINARY_DIR) / "test_runs/check_stopped";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::string run = "TMPDIR=" + folder.string() + " " + kKarst + " policy check " +
                          drawer("endless_loop") + " --test lifecycle.order --hang-limit 600 & child=$!; " +
                          "while [ -z \"$(ls " + folder.string() + ")\" ]; do sleep 0.02; done; " +
                          "sleep 0.2; kill -TERM $child; wait $child";
  const host::ProcessOutput out = host::run_process({"/bin/sh", "-c", run}, 300);
  EXPECT_EQ(out.end.exit_code, 130) << out.out;
  EXPECT_THAT(out.out, HasSubstr("stopped after 0 tests"));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

// The page lists what there is.
TEST(Documentation, ListsEveryTestAsTheCommandDoes) {
  std::ifstream in(std::string(KARST_SOURCE_DIR) + "/docs/policy_check.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  std::size_t rows = 0;
  for (std::size_t at = page.find("\n| `"); at != std::string::npos; at = page.find("\n| `", at + 1)) ++rows;
  EXPECT_EQ(rows, all_tests().size());
  for (const auto& t : all_tests())
    EXPECT_THAT(page, HasSubstr("| `" + std::string(t.name) + "` | " + core::name_of(t.level) + " | " +
                                t.description + " |"));
}

}  // namespace
}  // namespace karst::check
