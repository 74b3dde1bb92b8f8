#include "sdk/tools/mission_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"

namespace karst::tools {
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

TEST(MissionFile, AnUnknownKeyNamesFileKeyAndTheNearestOne) {
  const std::string e = error_of("unknown_key.info", "motion { max_sped \"1 m/s\" }\n");
  EXPECT_TRUE(holds(e, "unknown_key.info") && holds(e, "motion.max_sped") &&
              holds(e, "did you mean motion.max_speed"))
      << e;
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

TEST(MissionFile, ASettingWithoutEqualsSignIsExplained) {
  MissionOverrides o;
  o.settings = {"motion.max_speed"};
  EXPECT_TRUE(holds(error_of("set.info", "seed 1\n", o), "expected key=value"));
}

TEST(MissionFile, WhatIsWrittenAsResolvedReadsBackTheSame) {
  const Mission m = read_mission(written("a.info", "motion { max_speed \"1.25 m/s\" }\nseed 77\n"), {});
  EXPECT_EQ(m.resolved.get<std::string>("motion.max_speed"), "1.25 m/s");
  EXPECT_EQ(m.resolved.get<std::string>("seed"), "77");
}

}  // namespace
}  // namespace karst::tools
