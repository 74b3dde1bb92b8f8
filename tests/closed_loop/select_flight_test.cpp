// `policy auto` and `karst tune` as a user has them: short flights through a small cave.
#include <gtest/gtest.h>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

std::string small_cave(const fs::path& dir, int seed) {
  const std::string stem = (dir / ("cave" + std::to_string(seed))).string();
  const Output made = run_karst("cave generate --set volume=500 --set \"grid=0.4 m\" --seed " +
                                std::to_string(seed) + " --out " + stem);
  EXPECT_EQ(made.code, 0) << made.text;
  return stem + ".info";
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

/// Four caves that differ in their slope; unknown_ratio is the better one in steep ones, nearest_frontier in
/// level ones.
std::string experience(const std::string& endurance) {
  std::string text =
      std::string("schema karst.experience/3\nflown { profile campaign }\ncondition { name q horizon \"") +
      endurance + "\" endurance \"" + endurance +
      "\" }\ncontestant { name near policy nearest_frontier }\n"
      "contestant { name ratio policy unknown_ratio parameters { goals 4 } }\n";
  for (int c = 0; c < 6; ++c) {
    const std::string name = "c" + std::to_string(c), steep = std::to_string(0.1 + 0.12 * c);
    text += "cave { name " + name + " figures { width \"3 m\" verticality " + steep + " } }\n";
    text += "result { contestant near cave " + name + " condition q coverage_auc \"" +
            std::to_string(0.6 - 0.05 * c) + " 5 0.01\" }\n";
    text += "result { contestant ratio cave " + name + " condition q coverage_auc \"" +
            std::to_string(0.4 + 0.05 * c) + " 5 0.01\" }\n";
  }
  return text;
}

/// The mission.info and events.jsonl of a flight of `dir`/mission.info, which is flown again from its run
/// directory, without the experience: the run stands by itself.
struct FlownTwice {
  explicit FlownTwice(const fs::path& dir) {
    fly(dir / "mission.info", dir / "first");
    mission = bytes_of(dir / "first" / "mission.info"), events = bytes_of(dir / "first" / "events.jsonl");
    fs::remove(dir / "experience.info");
    fly(dir / "first" / "mission.info", dir / "second");
    EXPECT_EQ(bytes_of(dir / "second" / "mission.info"), mission);
    EXPECT_EQ(bytes_of(dir / "second" / "events.jsonl"), events);
  }
  static void fly(const fs::path& mission_file, const fs::path& run) {
    const Output flown =
        run_karst("fly " + mission_file.string() + " --threads 1 --no-report --quiet --out " + run.string());
    EXPECT_NE(flown.code, 1) << flown.text;
  }
  std::string mission, events;
};

TEST(PolicyAuto, IsSettledBeforeTakeOffRecordedAndReplayedWithoutIt) {
  const fs::path dir = fresh_folder("policy_auto");
  small_cave(dir, 3);
  write(dir / "experience.info", experience("10 s"));
  write(dir / "known.info", "verticality 0.65\nwidth \"3.1 m\"\n");
  write(dir / "mission.info",
        "cave { file cave3.info }\npolicy {\n name auto\n auto {\n description known.info\n results "
        "experience.info\n } }\nmission { max_flight_time \"10 s\" }\n");
  const FlownTwice run(dir);
  EXPECT_NE(run.mission.find("name unknown_ratio"), std::string::npos);
  EXPECT_NE(run.mission.find("goals 4"), std::string::npos);
  EXPECT_EQ(run.mission.find("name auto"), std::string::npos);
  EXPECT_NE(run.events.find("\"kind\":\"selection\""), std::string::npos);
  EXPECT_NE(run.events.find("ratio did best in coverage averaged over the flight (coverage_auc)"),
            std::string::npos);
}

TEST(PolicyAuto, TheMissionsTableWinsAndNothingElseIsAsked) {
  const fs::path dir = fresh_folder("policy_auto_table");
  small_cave(dir, 3);
  write(dir / "tuned.info", "policy { name nearest_frontier parameters { goals 3 } }\n");
  write(dir / "mission.info",
        "cave { file cave3.info }\npolicy { name auto\n auto {\n results none.info\n cave { name other "
        "policy unknown_ratio }\n cave { name cave3 preset tuned.info }\n } }\n");
  const std::string resolved = (dir / "resolved.info").string();
  const Output out = run_karst("fly " + (dir / "mission.info").string() + " --check " + resolved);
  ASSERT_EQ(out.code, 0) << out.text;
  const std::string mission = bytes_of(resolved);
  EXPECT_NE(mission.find("name nearest_frontier"), std::string::npos);
  EXPECT_NE(mission.find("goals 3"), std::string::npos);
  EXPECT_NE(mission.find("the mission's table says so"), std::string::npos);
}

// What the command line says of a later policy was forgotten where it named another policy, too.
TEST(PolicyLater, OfTheCommandLineStaysWithAnotherPolicyAndThatOfTheFileGoes) {
  const fs::path dir = fresh_folder("policy_later");
  small_cave(dir, 3);
  write(
      dir / "mission.info",
      "cave { file cave3.info }\npolicy { name nearest_frontier later { name deep_cave after \"9 s\" } }\n");
  const std::string fly = "fly " + (dir / "mission.info").string() + " --policy highest_frontier --check ",
                    of_file = (dir / "file.info").string(), of_line = (dir / "line.info").string();
  EXPECT_EQ(run_karst(fly + of_file).code, 0);
  EXPECT_EQ(bytes_of(of_file).find("after \"9 s\""), std::string::npos);
  EXPECT_EQ(run_karst(fly + of_line + " --set policy.later.after=\"8 s\"").code, 0);
  EXPECT_NE(bytes_of(of_line).find("after \"8 s\""), std::string::npos);
}

// A flight that changed its policy was not to be repeated: the block that it wrote was not read.
TEST(PolicyAuto, ChangesItsMindOnceByTheMapAndIsRepeatedWithoutTheExperience) {
  const fs::path dir = fresh_folder("policy_auto_reconsidered");
  small_cave(dir, 3);
  write(dir / "experience.info", experience("60 s"));
  write(dir / "mission.info",
        "cave { file cave3.info }\npolicy {\n name auto\n auto {\n reconsider \"8 s\"  otherwise "
        "lateral_frontier\n results experience.info\n } }\nmission { max_flight_time \"60 s\" }\n");
  const FlownTwice run(dir);
  EXPECT_NE(run.events.find("from here on, after lateral_frontier: "), std::string::npos) << run.events;
  EXPECT_NE(run.mission.find("after \"8 s\""), std::string::npos) << run.mission;
  const std::string fly = "fly " + (dir / "first/mission.info").string();
  EXPECT_TRUE(run_karst(fly + " --set policy.later.after=soon").says("policy.later: after: expected"));
  EXPECT_TRUE(run_karst(fly + " --set policy.later.name=no_such").says("no_such"));
  EXPECT_TRUE(run_karst(fly + " --set policy.later.parameters.nope=1").says("policy.later")) << "the place";
  EXPECT_TRUE(run_karst(fly + " --record-requests").says("--record-requests"));
  EXPECT_TRUE(run_karst("fly " + (dir / "mission.info").string() + " --set policy.auto.otherwise=")
                  .says("names the policy until policy.auto.reconsider"));
}

// It said nothing: one had to open mission.info.
TEST(PolicyAuto, SaysOnTheTerminalWhatItChoseAndWhy) {
  const fs::path dir = fresh_folder("policy_auto_said");
  const std::string cave = small_cave(dir, 3);
  write(dir / "experience.info", experience("600 s"));
  write(dir / "known.info", "verticality 0.65\nwidth \"3.1 m\"\n");
  const std::string fly = "fly --cave " + cave +
                          " --policy auto --set policy.auto.results=" + (dir / "experience.info").string() +
                          " --set policy.auto.description=" + (dir / "known.info").string() + " --check ";
  const std::string resolved = (dir / "resolved.info").string();
  const Output said = run_karst(fly + resolved);
  ASSERT_EQ(said.code, 0) << said.text;
  EXPECT_TRUE(
      said.says("policy auto: unknown_ratio with goals=4\n  ratio did best in coverage averaged over "
                "the flight (coverage_auc)"))
      << said.text;
  for (const char* without : {" --quiet", " --json"}) {
    const Output silent = run_karst(fly + (dir / "again.info").string() + without);
    EXPECT_EQ(silent.code, 0) << silent.text;
    EXPECT_FALSE(silent.says("policy auto")) << silent.text;
    fs::remove(dir / "again.info");
  }
  const Output named = run_karst("fly " + resolved + " --check " + (dir / "named.info").string());
  EXPECT_EQ(named.code, 0) << named.text;
  EXPECT_FALSE(named.says("policy auto")) << "nothing was chosen: " << named.text;
}

TEST(PolicyAuto, WithoutKnowledgeOfTheCaveNothingFlies) {
  const fs::path dir = fresh_folder("policy_auto_refused");
  const std::string cave = small_cave(dir, 3), out = " --out " + (dir / "run").string();
  write(dir / "experience.info", experience("600 s"));
  write(dir / "wide.info", "width \"80 m\"\n");
  const std::string fly =
      "fly --cave " + cave + " --policy auto --set policy.auto.results=" + (dir / "experience.info").string();
  const Output nothing = run_karst(fly + out);
  EXPECT_EQ(nothing.code, 1);
  EXPECT_TRUE(nothing.says("nothing is known of the cave")) << nothing.text;
  const std::string own_mesh = " --set policy.auto.survey=" + cave + " --set policy.auto.otherwise=deep_cave";
  EXPECT_TRUE(nothing.says("to use the cave's own mesh:" + own_mesh)) << nothing.text;
  const Output as_said = run_karst(fly + own_mesh + " --check " + (dir / "as_said.info").string());
  EXPECT_EQ(as_said.code, 0) << as_said.text;
  const Output no_block = run_karst(fly + out + " --set policy.auto.cave=" + cave);
  EXPECT_EQ(no_block.code, 1);
  EXPECT_TRUE(
      no_block.says("policy.auto.cave: expected a block { name CAVE  policy POLICY }; "
                    "policy.auto.survey or policy.auto.description names a file"))
      << no_block.text;
  const Output peeking = run_karst(fly + out + " --set policy.auto.description=" + cave);
  EXPECT_EQ(peeking.code, 1);
  EXPECT_TRUE(peeking.says("give it as policy.auto.survey")) << peeking.text;
  const Output wide = run_karst(fly + out + " --set policy.auto.description=" + (dir / "wide.info").string());
  EXPECT_EQ(wide.code, 1);
  EXPECT_TRUE(wide.says("most unlike is its width: 80 m")) << wide.text;
  EXPECT_TRUE(wide.says("policy.auto.otherwise can name a policy: --set policy.auto.otherwise=unknown_ratio"))
      << wide.text;
  EXPECT_FALSE(fs::exists(dir / "run"));
  const Output otherwise =
      run_karst(fly + " --set policy.auto.otherwise=nearest_frontier --set policy.auto.description=" +
                (dir / "wide.info").string() + " --check " + (dir / "resolved.info").string());
  EXPECT_EQ(otherwise.code, 0) << otherwise.text;
  const Output survey =
      run_karst(fly + " --set policy.auto.survey=" + cave + " --check " + (dir / "surveyed.info").string());
  EXPECT_EQ(survey.code, 0) << survey.text;
}

// As it was: the flights of the whole search came first, and then the error.
TEST(Tune, ACaveHeldOutThatIsNotThereIsSaidBeforeAnythingFlies) {
  const fs::path dir = fresh_folder("tune_held_out");
  const Output out = run_karst("tune nearest_frontier --caves " + small_cave(dir, 3) + " --held-out " +
                               (dir / "nothing.info").string() +
                               " --parameter min_distance --seeds 1 --flights 6 --time \"10 s\" --out " +
                               (dir / "out").string());
  EXPECT_EQ(out.code, 1);
  EXPECT_TRUE(out.says("nothing.info")) << out.text;
  EXPECT_FALSE(fs::exists(dir / "out" / "candidate000"));
}

TEST(Tune, WritesAPresetThatFliesAndGoesOnWithoutFlyingAgain) {
  const fs::path dir = fresh_folder("tune");
  const std::string a = small_cave(dir, 3), b = small_cave(dir, 4), out = (dir / "out").string();
  const std::string tune = "tune nearest_frontier --caves " + a + " --held-out " + b +
                           " --parameter min_distance --seeds 1 --flights 6 --time \"10 s\" --jobs 1 --out " +
                           out;
  const Output first = run_karst(tune);
  ASSERT_EQ(first.code, 0) << first.text;
  EXPECT_TRUE(first.says("4 candidates through 1 cave with 1 seed")) << first.text;
  const std::string table = bytes_of(dir / "out" / "tune.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5) << table;
  const auto stored = fs::last_write_time(dir / "out" / "candidate001" / "campaign.sqlite");
  const Output again = run_karst(tune);
  ASSERT_EQ(again.code, 0) << again.text;
  EXPECT_EQ(bytes_of(dir / "out" / "tune.csv"), table);
  EXPECT_EQ(fs::last_write_time(dir / "out" / "candidate001" / "campaign.sqlite"), stored);
  if (!fs::exists(dir / "out" / "preset.info")) {
    EXPECT_TRUE(first.says("None of 3 candidates did better")) << first.text;
    return;
  }
  EXPECT_TRUE(first.says("On caves held out: ")) << first.text;
  const Output flown =
      run_karst("fly --preset " + out + "/preset.info --cave " + b + " --check " + (dir / "r.info").string());
  EXPECT_EQ(flown.code, 0) << flown.text;
  const Output both = run_karst("fly --preset " + out + "/preset.info --policy unknown_ratio --cave " + b);
  EXPECT_EQ(both.code, 1);
}

}  // namespace
}  // namespace karst
