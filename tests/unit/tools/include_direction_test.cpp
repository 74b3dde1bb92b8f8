// The architecture's one-way dependencies, read from the sources themselves (docs/architecture.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file, target;
};

std::vector<Include> includes_below(const std::string& folder) {
  std::vector<Include> found;
  const fs::path root = KARST_SOURCE_DIR;
  const std::regex line(R"re(^\s*#\s*include\s*["<]([^">]+)[">])re");
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".h" && extension != ".hpp" && extension != ".cpp" && extension != ".c") continue;
    std::ifstream in(entry.path());
    std::string text;
    for (std::smatch m; std::getline(in, text);)
      if (std::regex_search(text, m, line))
        found.push_back({fs::relative(entry.path(), root).string(), m[1]});
  }
  return found;
}

void expect_none(const std::string& folder, const std::vector<std::string>& forbidden) {
  const std::vector<Include> all = includes_below(folder);
  EXPECT_FALSE(all.empty()) << folder << " holds no sources: the test looks at nothing";
  for (const Include& i : all)
    for (const std::string& start : forbidden)
      EXPECT_FALSE(i.target.starts_with(start)) << i.file << " includes " << i.target;
}

TEST(IncludeDirection, ThePolicyKnowsTheSdkOnly) {
  expect_none("policies", {"core_stack/", "plugins/", "sdk/", "Eigen", "octomap", "boost"});
}
TEST(IncludeDirection, TheAbiIsPlainC) {
  expect_none("sdk/abi", {"core_stack/", "plugins/", "Eigen", "octomap", "boost"});
}
TEST(IncludeDirection, TheCppFaceKnowsTheAbiOnly) {
  expect_none("sdk/include", {"core_stack/", "plugins/", "sdk/", "Eigen", "octomap", "boost"});
}
TEST(IncludeDirection, PythonKnowsTheSdkAndTheReaderOfMapFiles) {
  expect_none("sdk/python", {"plugins/", "policies/", "sdk/host", "sdk/tools", "sdk/evaluation",
                             "core_stack/mission", "core_stack/planning"});
}
TEST(IncludeDirection, TheCoreKnowsNeitherAbiNorSimulatorNorPolicies) {
  expect_none("core_stack", {"sdk/", "plugins/", "policies/", "karst"});
}
TEST(IncludeDirection, TheHostKnowsNoSimulator) {
  expect_none("sdk/host", {"plugins/", "policies/", "sdk/tools", "sdk/evaluation"});
}
TEST(IncludeDirection, TheCheckKnowsTheHostOnly) {
  expect_none("sdk/check", {"plugins/", "policies/", "sdk/tools", "sdk/evaluation", "sdk/campaign"});
  expect_none("sdk/host", {"sdk/check"});
}
// A flight can be followed: it does not know by whom, and the core knows no sockets.
TEST(IncludeDirection, WhatServesAFlightKnowsItsRecordOnly) {
  expect_none("sdk/live", {"plugins/", "sdk/host", "sdk/campaign", "sdk/selection", "sdk/tuning",
                           "sdk/flight", "sdk/tools", "CLI/"});
  expect_none("sdk/flight", {"sdk/live"});
  expect_none("core_stack", {"boost/asio", "boost/beast"});
}
// Loops are closed offline, above the maps: nothing that flies knows of them.
TEST(IncludeDirection, NothingThatFliesKnowsOfLoops) {
  expect_none("core_stack/loops", {"core_stack/planning", "core_stack/control", "core_stack/objects",
                                   "core_stack/homing", "core_stack/team", "core_stack/mission"});
  for (const char* flies : {"common", "vehicle", "perception", "localization", "mapping", "planning",
                            "control", "objects", "homing", "team", "mission"})
    expect_none(std::string("core_stack/") + flies, {"core_stack/loops"});
}
// Maps are merged offline: nobody but a command asks for it.
TEST(IncludeDirection, MapMergingKnowsNothingOfCampaignsAndFlights) {
  expect_none("sdk/map_merge",
              {"sdk/host", "sdk/campaign", "sdk/selection", "sdk/tuning", "sdk/flight", "sdk/tools"});
}
// So are caves made of clouds.
TEST(IncludeDirection, CavesFromCloudsKnowNothingOfCampaignsAndFlights) {
  expect_none("sdk/cave_from_cloud", {"sdk/host", "sdk/map_merge", "sdk/campaign", "sdk/selection",
                                      "sdk/tuning", "sdk/flight", "sdk/tools", "CLI/"});
}
// Surveys are read without a cave, and know nothing of what is made of them.
TEST(IncludeDirection, SurveysKnowTheCoreAndProcessesOnly) {
  for (const Include& i : includes_below("sdk/survey"))
    EXPECT_TRUE(!i.target.starts_with("sdk/") || i.target.starts_with("sdk/survey/") ||
                i.target == "sdk/host/isolation/process.h")
        << i.file << " includes " << i.target;
  expect_none("sdk/survey", {"plugins/", "policies/", "CLI/", "core_stack/mapping", "core_stack/mission"});
}
TEST(IncludeDirection, PriorsOfSurveysKnowTheSurveyAndTheMapsOnly) {
  for (const Include& i : includes_below("sdk/survey_prior"))
    EXPECT_TRUE(!i.target.starts_with("sdk/") || i.target.starts_with("sdk/survey/") ||
                i.target.starts_with("sdk/survey_prior/"))
        << i.file << " includes " << i.target;
  expect_none("sdk/survey_prior", {"plugins/", "policies/", "CLI/", "core_stack/mission"});
}
TEST(IncludeDirection, CavesFromSurveysKnowTheSurveyAndTheSimulatorsCavesOnly) {
  expect_none("sdk/survey_cave",
              {"sdk/host", "sdk/evaluation", "sdk/cave_from_cloud", "sdk/map_merge", "sdk/campaign",
               "sdk/selection", "sdk/tuning", "sdk/flight", "sdk/tools", "plugins/replay", "CLI/"});
}
TEST(IncludeDirection, SurveysOfFlightsKnowTheRecordTheSurveyAndMeshFilesOnly) {
  expect_none("sdk/survey_export", {"sdk/host", "sdk/survey_cave", "sdk/cave_from_cloud", "sdk/map_merge",
                                    "sdk/campaign", "sdk/selection", "sdk/tuning", "sdk/flight", "sdk/tools",
                                    "plugins/replay", "plugins/simulator/sensors", "CLI/"});
}
TEST(IncludeDirection, FilesOfFlightsForOtherProgramsKnowTheRecordAndRecordingsOnly) {
  expect_none("sdk/mcap_export",
              {"sdk/host", "sdk/survey", "sdk/survey_export", "sdk/campaign", "sdk/selection", "sdk/tuning",
               "sdk/flight", "sdk/tools", "plugins/simulator", "CLI/"});
  for (const char* below : {"sdk/evaluation", "sdk/host", "sdk/flight"})
    expect_none(below, {"sdk/mcap_export"});
}
// Drawings are made of maps and surveys, whose missing dimensions are those of caves made of them: nothing
// below knows of them.
TEST(IncludeDirection, DrawingsKnowTheRecordTheSurveyAndItsPassagesOnly) {
  expect_none("sdk/cave_drawing",
              {"sdk/host", "sdk/survey_export", "sdk/map_merge", "sdk/campaign", "sdk/selection",
               "sdk/tuning", "sdk/flight", "sdk/tools", "plugins/", "CLI/"});
  for (const char* below : {"sdk/evaluation", "sdk/survey", "sdk/survey_cave", "sdk/host"})
    expect_none(below, {"sdk/cave_drawing"});
}
// evaluation <- campaign <- selection <- flight <- tools; tuning <- tools
TEST(IncludeDirection, EvaluationAndCampaignsKnowNothingOfWhatReadsThem) {
  expect_none("sdk/evaluation",
              {"sdk/map_merge", "sdk/campaign", "sdk/selection", "sdk/tuning", "sdk/tools"});
  expect_none("sdk/campaign", {"sdk/selection", "sdk/tuning", "sdk/tools"});
}
TEST(IncludeDirection, SelectionAndTuningKnowNoCommandAndNotEachOther) {
  expect_none("sdk/selection",
              {"sdk/tuning", "sdk/tools", "sdk/host", "plugins/replay", "plugins/simulator/cave_generator"});
  expect_none("sdk/tuning", {"sdk/selection", "sdk/tools", "plugins/"});
}
TEST(IncludeDirection, TheFlightKnowsNoCommandAndNobodyBelowKnowsTheFlight) {
  expect_none("sdk/flight", {"sdk/tools", "sdk/tuning", "sdk/check", "sdk/campaign", "policies/", "CLI/"});
  for (const char* below : {"sdk/host", "sdk/check", "sdk/evaluation", "sdk/campaign", "sdk/selection",
                            "sdk/tuning", "sdk/replay"})
    expect_none(below, {"sdk/flight", "sdk/tools", "CLI/"});
  expect_none("sdk/terminal", {"sdk/tools", "sdk/flight", "sdk/host", "plugins/", "CLI/"});
}
TEST(IncludeDirection, ThePreflightKnowsNoCommandAndNobodyBelowKnowsThePreflight) {
  expect_none("sdk/preflight", {"sdk/tools", "sdk/tuning", "sdk/check", "policies/", "CLI/"});
  for (const char* below : {"sdk/host", "sdk/evaluation", "sdk/campaign", "sdk/selection", "sdk/flight"})
    expect_none(below, {"sdk/preflight"});
}
// Of the simulator the flight knows the world's interface and the cave: what flies it loads by name.
TEST(IncludeDirection, TheFlightKnowsOfTheSimulatorOnlyItsInterface) {
  for (const Include& i : includes_below("sdk/flight"))
    if (i.target.starts_with("plugins/")) {
      EXPECT_TRUE(i.target == "plugins/simulator/simulated_world.h" ||
                  i.target.starts_with("plugins/simulator/cave/"))
          << i.file << " includes " << i.target;
    }
}
TEST(IncludeDirection, TheSimulatorKnowsNoPolicyAndNoHost) {
  expect_none("plugins",
              {"sdk/", "policies/", "core_stack/mapping", "core_stack/planning", "core_stack/mission"});
}
// Drivers of real sensors know their formats and the core's messages only.
TEST(IncludeDirection, LidarDriversKnowTheCoresMessagesOnly) {
  expect_none("plugins/lidar_drivers", {"plugins/simulator", "plugins/replay", "core_stack/localization",
                                        "core_stack/perception", "core_stack/team"});
}

// A real vehicle knows no simulator.
TEST(IncludeDirection, AVehicleByMavlinkKnowsTheCoresMessagesAndTheLidarsDriversOnly) {
  expect_none("plugins/mavlink", {"plugins/simulator", "plugins/simulated_autopilot", "plugins/replay",
                                  "plugins/socket", "core_stack/localization", "core_stack/mission"});
}

// A vehicle behind a socket is any vehicle; what is simulated is put behind it elsewhere.
TEST(IncludeDirection, TheSocketKnowsNoOtherPluginAndTheServerNoCommand) {
  for (const Include& i : includes_below("plugins/socket"))
    EXPECT_TRUE(!i.target.starts_with("plugins/") || i.target.starts_with("plugins/socket/"))
        << i.file << " includes " << i.target;
  expect_none("sdk/vehicle_server", {"sdk/tools", "sdk/campaign", "sdk/check", "plugins/simulator", "CLI/"});
  for (const char* below : {"plugins", "sdk/host", "sdk/evaluation", "sdk/flight"})
    expect_none(below, {"sdk/vehicle_server"});
}

// A file that includes PCL takes a quarter of a minute and a gigabyte to compile.
TEST(IncludeDirection, FewSourcesAndNoHeaderIncludePcl) {
  std::set<std::string> files;
  for (const char* folder : {"core_stack", "plugins", "sdk", "policies", "tests"})
    for (const Include& i : includes_below(folder))
      if (i.target.starts_with("pcl/")) files.insert(i.file);
  EXPECT_LE(files.size(), 4u);
  EXPECT_FALSE(files.empty()) << "nothing is looked at";
  for (const std::string& f : files) EXPECT_TRUE(f.ends_with(".cpp")) << f;
}

TEST(IncludeDirection, CoreModulesUseOnlyThoseAboveThem) {
  const std::vector<std::string> order = {"common",  "vehicle",  "perception", "localization",
                                          "mapping", "planning", "control",    "objects",
                                          "homing",  "team",     "mission"};
  std::map<std::string, std::size_t> rank;
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
  for (const std::string& module : order)
    for (const Include& i : includes_below("core_stack/" + module)) {
      if (!i.target.starts_with("core_stack/")) continue;
      const std::string used = i.target.substr(11, i.target.find('/', 11) - 11);
      ASSERT_TRUE(rank.contains(used)) << i.file << " includes " << i.target;
      EXPECT_LE(rank[used], rank[module]) << i.file << " includes " << i.target;
    }
}

/// For each folder below `module` ("." is the module's own) those whose headers its sources include.
std::map<std::string, std::set<std::string>> includes_between_folders(const std::string& module) {
  const auto folder_of = [&](const std::string& file) {
    const fs::path folder = fs::path(file).parent_path().lexically_relative(module);
    return folder.begin()->string();
  };
  std::map<std::string, std::set<std::string>> used;
  for (const Include& i : includes_below(module)) {
    std::set<std::string>& by_folder = used[folder_of(i.file)];
    if (i.target.starts_with(module + "/")) by_folder.insert(folder_of(i.target));
  }
  return used;
}

/// What is left when folders are taken away that include none of the others, or that none includes: cycles.
std::map<std::string, std::set<std::string>> cycles_of(std::map<std::string, std::set<std::string>> folders) {
  const auto includes = [&](const std::string& folder, const std::string& other) {
    return folder != other && folders.at(folder).contains(other);
  };
  const auto is_outermost = [&](const auto& folder) {
    const auto above = [&](const auto& other) { return includes(other.first, folder.first); };
    const auto below = [&](const auto& other) { return includes(folder.first, other.first); };
    return std::none_of(folders.begin(), folders.end(), above) ||
           std::none_of(folders.begin(), folders.end(), below);
  };
  for (;;) {
    const auto outermost = std::find_if(folders.begin(), folders.end(), is_outermost);
    if (outermost == folders.end()) return folders;
    folders.erase(outermost);
  }
}

// Whoever reads a folder needs to know those it includes, and they never lead back to it.
TEST(IncludeDirection, FoldersOfAModuleIncludeOneAnotherInOneDirection) {
  std::vector<std::string> modules{"core_stack", "sdk", "plugins"};
  for (std::size_t i = 0; i < 3; ++i)
    for (const auto& entry : fs::directory_iterator(fs::path(KARST_SOURCE_DIR) / modules[i]))
      if (entry.is_directory()) modules.push_back(modules[i] + "/" + entry.path().filename().string());
  EXPECT_GT(modules.size(), 25u);
  for (const std::string& module : modules) {
    const auto cycles = cycles_of(includes_between_folders(module));
    for (const auto& [folder, used] : cycles)
      for (const std::string& other : used)
        EXPECT_TRUE(other == folder || !cycles.contains(other))
            << "in " << module << ", " << folder << " and " << other << " are parts of a cycle of includes";
  }
}

}  // namespace
