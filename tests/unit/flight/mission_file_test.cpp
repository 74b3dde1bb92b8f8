#include "sdk/flight/mission_file.h"

#include <gtest/gtest.h>

#include <boost/property_tree/info_parser.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core_stack/common/error.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

std::string written(const std::string& name, const std::string& text) {
  const fs::path file = fs::path(KARST_BINARY_DIR) / "test_runs" / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
  return file.string();
}

std::string error_of(const std::string& name, const std::string& text,
                     const MissionOverrides& overrides = {}) {
  try {
    read_mission(written(name, text), overrides);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "accepted";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(MissionFile, ReadsEverySectionWithUnits) {
  const std::string file = written("good.info",
                                   "seed 9\ncave { file a/b.ply start \"1 2 3 90\" }\n"
                                   "policy { name highest_frontier parameters { climb_weight 2 } }\n"
                                   "motion { max_speed \"5.4 km/h\" }\n");
  const Mission m = read_mission(file, {});
  EXPECT_EQ(m.seed, 9);
  EXPECT_EQ(m.cave, (fs::path(file).parent_path() / "a/b.ply").string());
  EXPECT_EQ(m.start, "1 2 3 90");
  EXPECT_EQ(m.policy, "highest_frontier");
  EXPECT_EQ(m.policy_parameters.get<std::string>("climb_weight"), "2");
  EXPECT_NEAR(m.core.motion.max_speed_mps, 1.5, 1e-12);
}

TEST(MissionFile, APolicysStreamGivesItAnotherSeedAndLeavesTheMissions) {
  const Mission plain = read_mission(written("stream0.info", "seed 9\n"), {});
  const Mission other = read_mission(written("stream1.info", "seed 9\npolicy { stream 1 }\n"), {});
  const Mission third = read_mission(written("stream2.info", "seed 9\npolicy { stream 2 }\n"), {});
  EXPECT_EQ(policy_seed(plain), 9u) << "stream 0 is what it always was";
  EXPECT_EQ(other.seed, 9);
  EXPECT_NE(policy_seed(other), policy_seed(plain));
  EXPECT_NE(policy_seed(other), policy_seed(third));
}

TEST(MissionFile, WhereThePolicyRunsIsLeftToTheMachineUnlessItIsSaid) {
  EXPECT_EQ(read_mission(written("home0.info", "seed 9\n"), {}).policy_isolation,
            PolicyIsolation::where_possible);
  EXPECT_EQ(read_mission(written("home1.info", "policy { isolation process }\n"), {}).policy_isolation,
            PolicyIsolation::process);
  MissionOverrides o;
  o.values = {{"policy.isolation", "in_process"}};
  const Mission m = read_mission(written("home2.info", "policy { isolation process }\n"), o);
  EXPECT_EQ(m.policy_isolation, PolicyIsolation::in_process);
  EXPECT_EQ(recorded_mission(m, {}, "").get<std::string>("policy.isolation"), "in_process");
  const std::string e = error_of("home3.info", "policy { isolation thread }\n");
  EXPECT_TRUE(holds(e, "one of where_possible process in_process")) << e;
}

TEST(MissionFile, ASurveyStandsBesideTheMissionAndNoMissionWithoutOneTellsOfIt) {
  const std::string file = written("surveyed.info", "survey { file old/cave.svx hints false }\n");
  const Mission m = read_mission(file, {});
  const std::string survey = (fs::path(file).parent_path() / "old/cave.svx").string();
  EXPECT_EQ(m.survey.file, survey);
  EXPECT_FALSE(m.survey.hints);
  const auto recorded = recorded_mission(m, {}, "");
  EXPECT_EQ(recorded.get<std::string>("survey.file"), fs::absolute(survey).lexically_normal().string());
  EXPECT_EQ(recorded.get<std::string>("survey.hints"), "false");
  EXPECT_TRUE(read_mission(written("surveyed2.info", "survey { file a.svx }\n"), {}).survey.hints);
  const auto plain = recorded_mission(read_mission(written("unsurveyed.info", "seed 9\n"), {}), {}, "");
  EXPECT_FALSE(plain.get_child_optional("survey"));
  const std::string e = error_of("no_survey.info", "survey { offset \"1 2 3\" }\n");
  EXPECT_TRUE(holds(e, "no_survey.info: survey.offset: is of no use without survey.file")) << e;
}

TEST(MissionFile, ACaveFileIsRefusedWithTheOptionForIt) {
  const std::string e = error_of("a_cave.info", "mesh a_cave.ply\nstart \"0 0 1\"\n");
  EXPECT_TRUE(holds(e, "a_cave.info: is a cave file; fly it with karst fly --cave ")) << e;
}

TEST(MissionFile, AnUnknownKeyNamesFileKeyAndTheNearestOne) {
  const std::string e = error_of("unknown_key.info", "motion { max_sped \"1 m/s\" }\n");
  EXPECT_TRUE(holds(e, "unknown_key.info") && holds(e, "motion.max_sped") &&
              holds(e, "did you mean motion.max_speed"))
      << e;
}

TEST(MissionFile, ALongSectionBringsNoKeyNearer) {
  const std::string e = error_of("far_key.info", "simulator { magnetometer { hysteresis 1 } }\n");
  EXPECT_TRUE(holds(e, "no such key") && !holds(e, "did you mean")) << e;
}

TEST(MissionFile, AWrongUnitNamesWhatWasExpected) {
  const std::string e = error_of("wrong_unit.info", "motion { max_speed \"1 kg\" }\n");
  EXPECT_TRUE(holds(e, "motion.max_speed") && holds(e, "m/s") && holds(e, "\"kg\"")) << e;
}

TEST(MissionFile, AValueOutOfRangeNamesTheRange) {
  const std::string e = error_of("range.info", "map { resolution \"30 m\" }\n");
  EXPECT_TRUE(holds(e, "map.resolution") && holds(e, "0.02 to 2 m")) << e;
}

TEST(MissionFile, ASyntaxErrorNamesTheLine) {
  const std::string e = error_of("syntax.info", "seed 1\nmotion { max_speed 1\n");
  EXPECT_TRUE(holds(e, "syntax.info") && holds(e, "line")) << e;
}

TEST(MissionFile, AMissingFileAndAMissingVehicleAreNamed) {
  EXPECT_THROW(read_mission("/nowhere/mission.info", {}), core::InputError);
  const std::string e = error_of("vehicle.info", "vehicle submarine\n");
  EXPECT_TRUE(holds(e, "submarine") && holds(e, "simulator")) << e;
}

TEST(MissionFile, TheCommandLineWins) {
  MissionOverrides o;
  o.cave = "other.ply";
  o.policy = "unknown_ratio";
  o.settings = {"motion.max_speed=1 m/s", "policy.parameters.a=3"};
  const Mission m = read_mission(
      written("overridden.info",
              "cave { file a.ply start \"0 0 0\" }\npolicy { name highest_frontier parameters { b 1 } }\n"),
      o);
  EXPECT_EQ(m.cave, "other.ply");
  EXPECT_EQ(m.start, "") << "another cave, another start";
  EXPECT_EQ(m.policy, "unknown_ratio");
  EXPECT_EQ(m.policy_parameters.size(), 1u) << "another policy, other parameters";
  EXPECT_EQ(m.core.motion.max_speed_mps, 1.0);
}

TEST(MissionFile, HowABareMeshIsReadIsRecordedAndGoesWithItsCave) {
  const std::string file = written(
      "mesh_keys.info", "cave { file a.ply unit mm up y scale 2 offset \"1 2 3\" start \"0 0 0\" }\n");
  const core::MeshKeys keys{2, core::MeshUnit::mm, core::UpAxis::y, "1 2 3"};
  EXPECT_EQ(read_mission(file, {}).mesh, keys);
  EXPECT_EQ(recorded_mission(read_mission(file, {}), {}, "").get<std::string>("cave.offset"), "1 2 3");
  MissionOverrides o;
  o.cave = "other.ply";
  EXPECT_EQ(read_mission(file, o).mesh, core::MeshKeys{}) << "another cave, another mesh";
  o.values = {{"cave.unit", "cm"}};
  EXPECT_EQ(read_mission(file, o).mesh.unit, core::MeshUnit::cm);
  EXPECT_TRUE(holds(error_of("unit.info", "cave { file a.ply unit furlong }\n"),
                    "cave.unit: expected one of m cm mm ft"));
}

TEST(MissionFile, ASettingIsHonouredOrRefusedBesideItsOption) {
  MissionOverrides o;
  o.cave = "other.ply";
  o.settings = {"cave.start=4 5 6"};
  EXPECT_EQ(read_mission(written("start_set.info", "cave { file a.ply start \"0 0 0\" }\n"), o).start,
            "4 5 6");
  o.settings = {"cave.file=a.ply"};
  EXPECT_TRUE(holds(error_of("file_set.info", "seed 1\n", o), "cave.file: is given by --cave as well"));
}

TEST(MissionFile, ParametersThatAreNoBlockAreRefused) {
  const std::string e = error_of("no_block.info", "policy { parameters 7 }\n");
  EXPECT_TRUE(holds(e, "policy.parameters") && holds(e, "{ ... }")) << e;
}

TEST(MissionFile, AnIncludedFileLiesBesideTheFileThatIncludesIt) {
  written("parts/inner.info", "seed 12\n");
  written("parts/part.info", "#include \"inner.info\"\nmotion { max_speed\n");
  written("parts/good.info", "#include \"inner.info\"\n");
  EXPECT_EQ(read_mission(written("includes.info", "; a comment\n#include \"parts/good.info\"\n"), {}).seed,
            12);
  const std::string cut = error_of("cut_part.info", "seed 1\n#include \"parts/part.info\"\n");
  EXPECT_TRUE(holds(cut, "parts/part.info: line 2")) << cut;
  const std::string absent = error_of("absent_part.info", "seed 1\n#include \"none.info\"\n");
  EXPECT_TRUE(holds(absent, "absent_part.info: line 2") && holds(absent, "none.info")) << absent;
  const std::string round = error_of("round.info", "#include \"round.info\"\n");
  EXPECT_TRUE(holds(round, "include each other")) << round;
}

TEST(MissionFile, AByteOrderMarkAndADirectoryAreNamed) {
  EXPECT_TRUE(holds(error_of("bom.info", "\xEF\xBB\xBFseed 1\n"), "byte order mark"));
  try {
    read_mission(KARST_BINARY_DIR, {});
    ADD_FAILURE() << "a directory was read";
  } catch (const core::InputError& e) {
    EXPECT_TRUE(holds(e.what(), "is a directory")) << e.what();
  }
}

TEST(MissionFile, BracesInWordsQuotesAndCommentsAreNoDepth) {
  std::string text = "; ";
  for (int i = 0; i < 300; ++i) text += "{ ";
  text += "\ncave { file \"";
  for (int i = 0; i < 300; ++i) text += "{ ";
  EXPECT_EQ(error_of("braces.info", text + "\\\" {\" }\n"), "accepted");
}

TEST(MissionFile, ASettingWithoutEqualsSignIsExplained) {
  MissionOverrides o;
  o.settings = {"motion.max_speed"};
  EXPECT_TRUE(holds(error_of("set.info", "seed 1\n", o), "expected key=value"));
}

/// As `karst fly` writes it into a run directory.
std::string recorded(const std::string& name, const Mission& m) {
  const std::string file = written(name, "");
  boost::property_tree::write_info(file, recorded_mission(m, m.policy_parameters, "1.2.3"));
  return file;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(MissionFile, WhatARunRecordsIsFlownAgainAsItIs) {
  const char* const settings =
      "seed 8999999999999999\n"
      "cave { file \"caves/a cave; \\\"the {deep} one\\\".ply\" start \"1 -2.5 1e-3 90\" }\n"
      "policy { name highest_frontier parameters { horizon \"25 m\" climb_weight 2 } }\n"
      "motion { max_speed \"5.4 km/h\" }\n"
      "map { resolution 0.30000000000000004 }\n"
      "mission { takeoff_height \"123 cm\" }\n"
      "simulator { vehicle camera_uav gust \"2.9 m/s\" pose { angle_noise \"0.7 deg\" } }\n";
  const Mission flown = read_mission(written("flown.info", settings), {});
  const std::string first = recorded("first_run.info", flown);
  read_mission("", {});  // another mission in between: the vehicle's plugin keeps nothing of one for the next
  const Mission again = read_mission(first, {});
  EXPECT_EQ(again.seed, 8999999999999999);
  EXPECT_EQ(again.cave, fs::absolute(flown.cave).lexically_normal());
  EXPECT_EQ(again.start, "1 -2.5 1e-3 90");
  EXPECT_EQ(again.policy, "highest_frontier");
  EXPECT_EQ(again.core.motion.max_speed_mps, flown.core.motion.max_speed_mps);
  EXPECT_EQ(again.core.map.resolution_m, 0.1 + 0.2);
  EXPECT_EQ(again.resolved.get<std::string>("mission.takeoff_height"), "1.23 m");
  EXPECT_EQ(again.resolved.get<std::string>("simulator.vehicle"), "camera_uav");
  EXPECT_EQ(again.resolved.get<std::string>("simulator.gust"), "2.9 m/s");
  EXPECT_EQ(again.policy_parameters, flown.policy_parameters);
  EXPECT_EQ(text_of(recorded("second_run.info", again)), text_of(first)) << "every key";
}

TEST(MissionFile, FactsOfARunAreRecordedAndCannotBeSet) {
  const std::string file = recorded("facts.info", read_mission(written("plain.info", "seed 3\n"), {}));
  const boost::property_tree::ptree tree = core::read_info(file);
  EXPECT_EQ(tree.get<std::string>("policy.version"), "1.2.3");
  EXPECT_EQ(tree.get<std::string>("vehicle"), "simulator");
  EXPECT_FALSE(tree.get<std::string>("karst.version").empty());
  MissionOverrides o;
  o.settings = {"karst.version=9"};
  EXPECT_TRUE(holds(error_of("set_fact.info", "seed 1\n", o), "no such key"));
}

TEST(MissionFile, TheHelpsExampleIsAccepted) {
  MissionOverrides o;
  o.settings = {"motion.max_speed=1 m/s", "simulator.gust=2 m/s"};
  EXPECT_EQ(error_of("help.info", "seed 1\n", o), "accepted");
}

// One had to read the sources.
MissionOverrides with_setting(const std::string& setting) {
  MissionOverrides overrides;
  overrides.settings = {setting};
  return overrides;
}

// It was silently ignored.
TEST(MissionFile, ASectionOfAnotherVehicleIsRefusedWhereThisOneHasItsOwn) {
  const std::string text = "vehicle simulated_autopilot\nsimulator { battery_minutes \"8 min\" }\n";
  const std::string error = error_of("autopilot.info", text);
  EXPECT_TRUE(holds(error, "autopilot.info: simulator: ")) << error;
  EXPECT_TRUE(holds(error, "simulated_autopilot.simulator")) << error;
  EXPECT_EQ(error_of("autopilot.info",
                     "vehicle simulated_autopilot\nsimulated_autopilot { simulator { "
                     "battery_minutes \"8 min\" } }\n"),
            "accepted");
  // A file for another vehicle may still be flown with this one.
  EXPECT_EQ(error_of("other.info", "simulator { battery_minutes \"8 min\" }\n",
                     with_setting("vehicle=simulated_autopilot")),
            "accepted");
  EXPECT_EQ(error_of("other.info", "vehicle simulator\nmavlink { link udp:14540 }\n"), "accepted");
}

TEST(MissionHelp, IsOfTheVehicleThatTheMissionNames) {
  const std::string file = written("mavlink.info", "vehicle mavlink\n");
  EXPECT_EQ(named_vehicle("", {}), "simulator");
  EXPECT_EQ(named_vehicle(file, {}), "mavlink");
  EXPECT_EQ(named_vehicle(file, with_setting("vehicle=simulated_autopilot")), "simulated_autopilot");
  EXPECT_TRUE(holds(mission_help("mavlink"), "mavlink.link"));
  EXPECT_FALSE(holds(mission_help("mavlink"), "simulator.battery_minutes"));
}

TEST(MissionHelp, ListsTheKeysOfPolicyAuto) {
  const std::string help = mission_help("simulator");
  for (const char* key : {"description", "survey", "survey_start", "results", "metric = coverage_auc",
                          "otherwise", "cave.name", "cave.policy", "cave.preset"})
    EXPECT_TRUE(holds(help, std::string("\n  policy.auto.") + key)) << key;
}

TEST(MissionFile, KeysOfPolicyAutoAreNotRecorded) {
  const Mission m = read_mission(written("not_auto.info", "policy { name nearest_frontier }\n"), {});
  EXPECT_EQ(m.resolved.count("policy"), 1u);
  EXPECT_EQ(m.resolved.get_child("policy").count("auto"), 0u);
}

}  // namespace
}  // namespace karst::flight
