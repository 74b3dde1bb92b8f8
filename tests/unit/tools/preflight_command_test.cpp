#include "sdk/tools/preflight_command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/shell_word.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/selection/describe.h"
#include "sdk/selection/load_experience.h"
#include "tests/unit/evaluation/reachable/boxes.h"
#include "tests/unit/selection/experiences.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

struct Said {
  int code = 0;
  std::string text;
};

/// What the command writes to standard output, and its exit code. Throws InputError as the command does.
Said run(std::vector<std::string> words) {
  CLI::App app{"karst", "karst"};
  app.require_subcommand(1);
  add_preflight_command(app);
  words.insert(words.begin(), "preflight");
  words.emplace_back("--quiet");
  std::reverse(words.begin(), words.end());
  Said said;
  ::testing::internal::CaptureStdout();
  try {
    app.parse(words);
  } catch (const CLI::RuntimeError& e) {
    said.code = e.get_exit_code();
  } catch (...) {
    ::testing::internal::GetCapturedStdout();
    throw;
  }
  said.text = ::testing::internal::GetCapturedStdout();
  return said;
}

nlohmann::json json_of(const Said& said) { return nlohmann::json::parse(said.text); }

std::string error_of(const std::vector<std::string>& words) {
  try {
    run(words);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// With the words of each line on one line.
std::string unwrapped(const std::string& text) {
  std::istringstream words(text);
  std::string all;
  for (std::string word; words >> word;) all += (all.empty() ? "" : " ") + word;
  return all;
}

fs::path own_folder() {
  const fs::path folder = fs::path(KARST_BINARY_DIR) / "test_runs" / "preflight" /
                          ::testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::create_directories(folder);
  return folder;
}

/// Two rooms of 6 x 8 x 3 m and a corridor of 2 m between them.
std::string rooms() {
  std::set<std::array<int, 3>> cells;
  test::fill(cells, {0, 0, 0}, {6, 8, 3});
  test::fill(cells, {6, 2, 0}, {14, 4, 2});
  test::fill(cells, {14, 0, 0}, {20, 8, 3});
  const std::string file = (own_folder() / "rooms.ply").string();
  cave::write_mesh(file, test::lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05}));
  return file;
}

constexpr const char* kStart = "3 3 1";

/// An experience in which this very cave was flown, and "quick" did better there than "slow".
std::string experience_of(const std::string& cave) {
  selection::Experience e = test::experience(6, 0.3, 0.02, 1);
  e.contestants = {{"quick", "nearest_frontier", "1.0.0", {}},
                   {"slow", "lateral_frontier", "1.0.0", {}},
                   {"other", "highest_frontier", "1.0.0", {}}};
  e.caves[0].figures = selection::describe_file(cave, kStart).figures;
  for (std::size_t contestant = 0; contestant < 3; ++contestant) {
    const double worse = 0.1 * static_cast<double>(contestant);
    e.at(contestant, 0, 0) = {10, 0.8 - worse, 0.01};
    e.at(contestant, 0, 1) = {10, 0.85 - worse, 0.01};
  }
  const std::string file = (own_folder() / "experience.info").string();
  std::ofstream(file) << selection::to_info(e);
  return file;
}

TEST(PreflightCommand, OfAKnownCaveIsGoWithThePolicyThatDidBestThere) {
  const std::string cave = rooms(), experience = experience_of(cave);
  const Said said = run({cave, "--start", kStart, "--results", experience, "--battery", "5 min", "--json"});
  EXPECT_EQ(said.code, 0) << said.text;
  const nlohmann::json j = json_of(said);
  EXPECT_EQ(j["schema"], "karst.preflight/1");
  EXPECT_EQ(j["verdict"], "go");
  EXPECT_EQ(j["policy"]["name"], "nearest_frontier");
  EXPECT_TRUE(j["policy"]["selected"]);
  EXPECT_EQ(j["policy"]["ranking"][1]["contestant"], "slow");
  EXPECT_NEAR(j["policy"]["expected"]["coverage"].get<double>(), 0.85, 0.01);
  EXPECT_EQ(j["time"]["battery_s"], 300);
  EXPECT_GT(j["time"]["return_s"], 250);
  EXPECT_LE(j["time"]["return_s"], 280) << "the reserve is kept";
  EXPECT_NEAR(j["time"]["farthest_m"].get<double>(), 18, 4) << "the far corner of the other room";
  EXPECT_EQ(j["vehicle"]["name"], "lidar_uav");
  EXPECT_GT(j["cave"]["reachable_volume_m3"], 150);
  const Said in_words = run({cave, "--start", kStart, "--results", experience, "--battery", "5 min"});
  EXPECT_TRUE(in_words.text.starts_with("GO")) << in_words.text;
  EXPECT_TRUE(contains(in_words.text, "time of return")) << in_words.text;
}

std::string last_line(const std::string& text) {
  EXPECT_TRUE(text.ends_with('\n'));
  const std::string lines = text.substr(0, text.size() - 1);
  return lines.substr(lines.rfind('\n') + 1);
}

// How to fly what was judged, a reader had to find out.
TEST(PreflightCommand, EndsWithTheCommandThatFliesWhatWasJudged) {
  const std::string cave = rooms(), file = (own_folder() / "experience.info").string();
  experience_of(cave);
  selection::Experience e = selection::load_experience({file}, [](const std::string&) {});
  e.contestants[0].parameters.put("goals", "3");
  e.contestants[0].parameters.put("horizon", "30 m");  // the default
  std::ofstream(file) << selection::to_info(e);
  const std::string begin = "  karst fly --cave " + core::shell_word(cave) + " --start '3 3 1' --policy ";
  EXPECT_EQ(last_line(run({cave, "--start", kStart, "--results", file, "--battery", "5 min", "--set",
                           "motion.max_speed=1 m/s"})
                          .text),
            begin +
                "nearest_frontier --set 'simulator.battery_minutes=5 min' --set 'motion.max_speed=1 m/s' "
                "--set policy.parameters.goals=3");
  EXPECT_EQ(
      last_line(run({cave, "--start", kStart, "--results", file, "--set", "policy.parameters.goals=5"}).text),
      begin + "nearest_frontier --set policy.parameters.goals=5")
      << "what is given takes precedence";
  EXPECT_EQ(last_line(run({cave, "--start", kStart, "--results", file, "--policy", "lateral_frontier",
                           "--vehicle", "lidar_only_uav", "--unit", "m"})
                          .text),
            "  karst fly --cave " + core::shell_word(cave) +
                " --start '3 3 1' --unit m --policy lateral_frontier --set simulator.vehicle=lidar_only_uav");
  const Said refused = run({cave, "--start", kStart, "--policy", "nearest_frontier", "--battery", "20 s"});
  EXPECT_FALSE(contains(refused.text, "karst fly --cave")) << refused.text;
}

TEST(PreflightCommand, AMissionFileNamesCavePolicyAndTime) {
  const std::string mission = (own_folder() / "mission.info").string();
  std::ofstream(mission) << "cave { file \"" << rooms() << "\" start \"" << kStart << "\" }\n"
                         << "mission { max_flight_time \"90 s\" }\npolicy { name lateral_frontier }\n";
  const Said said = run({mission, "--json"});
  EXPECT_EQ(said.code, 0) << said.text;
  const nlohmann::json j = json_of(said);
  EXPECT_EQ(j["policy"]["name"], "lateral_frontier");
  EXPECT_LE(j["time"]["return_s"], 90);
  EXPECT_EQ(json_of(run({mission, "--policy", "highest_frontier", "--json"}))["policy"]["name"],
            "highest_frontier");
  EXPECT_TRUE(contains(run({mission}).text, "karst fly " + mission + " --policy lateral_frontier"));
}

TEST(PreflightCommand, AMissionFileNamesTheVehicleThatIsListenedTo) {
  const std::string mission = (own_folder() / "mission.info").string();
  std::ofstream(mission) << "vehicle no_such_vehicle\n";
  EXPECT_TRUE(contains(error_of({mission}), "no_such_vehicle")) << error_of({mission});
}

TEST(PreflightCommand, ABatteryThatIsTooSmallIsNoGo) {
  const std::string cave = rooms();
  const Said said = run({cave, "--start", kStart, "--policy", "nearest_frontier", "--battery", "20 s"});
  EXPECT_EQ(said.code, 3) << said.text;
  EXPECT_TRUE(said.text.starts_with("NO-GO")) << said.text;
  EXPECT_TRUE(contains(unwrapped(said.text), "no time is left to explore")) << said.text;
}

TEST(PreflightCommand, AStartInRockIsNoGoWithTheReason) {
  const Said said = run({rooms(), "--start", "10 5 1", "--policy", "nearest_frontier", "--json"});
  EXPECT_EQ(said.code, 3);
  const nlohmann::json j = json_of(said);
  EXPECT_EQ(j["verdict"], "no_go");
  ASSERT_EQ(j["findings"].size(), 1u);
  EXPECT_EQ(j["findings"][0]["severity"], "no_go");
  EXPECT_TRUE(contains(j["findings"][0]["text"].get<std::string>(), "start"));
  EXPECT_TRUE(j["policy"].is_null());
}

// It was no-go.
TEST(PreflightCommand, InACaveUnlikeAllFlownThePolicyIsTheNearestFrontier) {
  const std::string cave = rooms();
  selection::Experience e = test::experience(6, 0.3, 0.02, 1);
  for (selection::KnownCave& k : e.caves) {
    k.figures.volume_m3 *= 1000;
    k.figures.length_m *= 100;
    k.figures.width_m *= 8;
  }
  const std::string experience = (own_folder() / "experience.info").string();
  std::ofstream(experience) << selection::to_info(e);
  const Said chosen = run({cave, "--start", kStart, "--results", experience});
  EXPECT_EQ(chosen.code, 0) << chosen.text;
  EXPECT_TRUE(contains(unwrapped(chosen.text), "no policy could be selected, so it is nearest_frontier"));
  EXPECT_TRUE(contains(unwrapped(chosen.text), "nothing like this cave was flown")) << chosen.text;
  const Said named = run({cave, "--start", kStart, "--results", experience, "--policy", "nearest_frontier"});
  EXPECT_EQ(named.code, 0) << named.text;
  EXPECT_TRUE(contains(unwrapped(named.text), "nothing can be said of what it will explore")) << named.text;
}

// What was expected did not depend on the time: more than such a flight can do.
TEST(PreflightCommand, TheTimeBoundsWhatIsExpected) {
  const std::string cave = rooms(), experience = experience_of(cave);
  const auto expected = [&](const char* time) {
    return json_of(run({cave, "--start", kStart, "--results", experience, "--set",
                        std::string("mission.max_flight_time=") + time, "--json"}))["policy"]["expected"];
  };
  const nlohmann::json little = expected("60 s"), much = expected("300 s");
  EXPECT_LT(little["coverage"].get<double>(), much["coverage"].get<double>() / 2);
  EXPECT_LE(little["flight_time_s"].get<double>(), 40);
  const Said too_little =
      run({cave, "--start", kStart, "--results", experience, "--set", "mission.max_flight_time=30 s"});
  EXPECT_EQ(too_little.code, 3) << too_little.text;
}

TEST(PreflightCommand, LinesOfAFileAreNotLongerThanAHundredColumns) {
  const std::string cave = rooms(),
                    text = run({cave, "--start", kStart, "--results", experience_of(cave)}).text;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!contains(line, cave)) {
      EXPECT_LE(line.size(), 104u) << line;  // m³ has a byte more than characters
    }
}

TEST(PreflightCommand, WritesThePage) {
  const std::string cave = rooms(), page = (own_folder() / "page.html").string();
  run({cave, "--start", kStart, "--policy", "nearest_frontier", "--page", page});
  std::ifstream in(page);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_TRUE(text.starts_with("<!doctype html>"));
  EXPECT_TRUE(contains(text, "<svg ") && contains(text, "rooms.ply"));
}

TEST(PreflightCommand, TheVehicleDecidesWhatIsSeen) {
  const std::string cave = rooms();
  const auto looks_up_rad = [&](const char* vehicle) {
    const Said said =
        run({cave, "--start", kStart, "--policy", "nearest_frontier", "--vehicle", vehicle, "--json"});
    return json_of(said)["vehicle"]["looks_up_rad"].get<double>();
  };
  EXPECT_GT(looks_up_rad("lidar_uav"), 1.5) << "a camera faces up";
  EXPECT_LT(looks_up_rad("lidar_only_uav"), 1.5);
}

/// A mission in the two rooms, for the preflight of a vehicle.
std::string mission_file() {
  const std::string file = (own_folder() / "mission.info").string();
  std::ofstream(file) << "seed 3\ncave { file " << rooms() << " start \"" << kStart << "\" }\n";
  return file;
}

const nlohmann::json* check_of(const nlohmann::json& j, const std::string& what) {
  for (const nlohmann::json& c : j["checks"])
    if (c["what"] == what) return &c;
  return nullptr;
}

TEST(PreflightCommand, OfAVehiclePluginListensToTheVehicle) {
  const Said said = run({"--vehicle", "simulator", mission_file(), "--seconds", "3", "--json"});
  EXPECT_EQ(said.code, 0) << said.text;
  const nlohmann::json j = json_of(said);
  EXPECT_EQ(j["schema"], "karst.vehicle_preflight/1");
  EXPECT_EQ(j["vehicle"], "lidar_uav");
  EXPECT_EQ(j["rest_s"], 3);
  EXPECT_TRUE(j["motion"].is_null());
  const nlohmann::json* mounting = check_of(j, "mounting and delay");
  ASSERT_NE(mounting, nullptr);
  EXPECT_EQ((*mounting)["outcome"], "watch") << "nobody turned it";
  for (const nlohmann::json& c : j["checks"])
    if (&c != mounting) {
      EXPECT_EQ(c["outcome"], "pass") << c;
    }
}

TEST(PreflightCommand, OfAVehicleTakesSettingsAndWritesTheChecklist) {
  const std::string page = (own_folder() / "checklist.html").string();
  const Said said = run({"--vehicle", "simulator", mission_file(), "--seconds", "3", "--page", page, "--set",
                         "simulator.lidar.rate=5 Hz", "--policy", "nowhere"});
  EXPECT_EQ(said.code, 3) << said.text;
  EXPECT_TRUE(said.text.starts_with("NO-GO, for 2 reasons")) << said.text;
  const std::string text = unwrapped(said.text);
  EXPECT_TRUE(contains(text, "LiDAR, rate: 5.0 Hz (required: 10 Hz, at least 9 Hz)")) << said.text;
  EXPECT_TRUE(contains(text, "policy, loads: nowhere")) << said.text;
  std::ifstream in(page);
  const std::string html{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_TRUE(contains(html, "NO-GO, for 2 reasons") && contains(html, "class=\"box\""));
}

TEST(PreflightCommand, OfAVehicleHasTheErrorsOfAMission) {
  EXPECT_TRUE(contains(error_of({"--vehicle", "submarine"}), "no vehicle \"submarine\" here; there is:"));
  EXPECT_TRUE(contains(error_of({"--vehicle", "simulator", "nowhere.info"}), "nowhere.info"));
  EXPECT_TRUE(contains(error_of({"--vehicle", "simulator", mission_file(), "--set", "team.robots=2"}),
                       "for one vehicle, not for a team"));
  const std::string without_cave = (own_folder() / "without_cave.info").string();
  std::ofstream(without_cave) << "seed 3\n";
  EXPECT_TRUE(contains(error_of({"--vehicle", "simulator", without_cave}), "--set cave.file=FILE"));
  EXPECT_TRUE(contains(error_of({}), "argument cave is missing, or --vehicle"));
}

TEST(PreflightCommand, BadInputIsAnError) {
  const std::string cave = rooms();
  const auto error_with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {cave, "--start", kStart});
    return error_of(more);
  };
  EXPECT_TRUE(contains(error_of({"nowhere.ply", "--start", kStart}), "nowhere.ply"));
  EXPECT_TRUE(contains(error_of({cave, "--policy", "nearest_frontier"}), "start: missing"));
  EXPECT_TRUE(contains(error_with({"--policy", "nearest_frontie"}), "nearest_frontier"));
  EXPECT_TRUE(contains(error_with({"--battery", "8 m"}), "simulator.battery_minutes"));
  EXPECT_TRUE(contains(error_with({"--battery", "8 min", "--set", "simulator.battery_minutes=9 min"}),
                       "is given by --battery as well"));
  EXPECT_TRUE(contains(error_with({"--vehicle", "submarine"}), "no vehicle \"submarine\" here; there is:"));
  EXPECT_TRUE(contains(error_with({"--vehicle", "submarine"}), "camera_uav"));
  EXPECT_TRUE(contains(error_with({"--vehicle", "submarine"}), "simulator"));
  EXPECT_TRUE(contains(error_with({"--set", "team.robots=3"}), "for one vehicle, not for a team"));
  EXPECT_TRUE(contains(error_with({"--set", "policy.auto.metric=coverage"}), "policy.auto"));
  EXPECT_TRUE(contains(error_with({"--results", "nowhere.info"}), "nowhere.info"));
}

}  // namespace
}  // namespace karst::tools
