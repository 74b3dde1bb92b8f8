// Objects of interest: found in flight, and known at the base in the end, from one vehicle and from a team.
#include <map>
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"

namespace karst {
namespace {

using nlohmann::json;

/// A passage of 90 m with a bend and a chamber half way, 4 m wide; six objects on its floor.
std::string passage(const std::filesystem::path& folder) {
  const std::string cave = draw_cave(folder,
                                     {{{-4, -4, 0}, {4, 4, 3}},
                                      {{3, -2, 0}, {40, 2, 3}},
                                      {{32, -5, 0}, {42, 5, 4}},
                                      {{36, 4, 0}, {40, 50, 3}}},
                                     {0, 0, 1});
  std::ofstream(cave, std::ios::app) << "object { kind backpack position \"8 0.5 0.15\" }\n"
                                        "object { kind rope position \"15 -0.4 0.15\" }\n"
                                        "object { kind helmet position \"22 0 0.15\" }\n"
                                        "object { kind person position \"29 0.3 0.15\" }\n"
                                        "object { kind lamp position \"38 12 0.15\" }\n"
                                        "object { kind drill position \"38.3 24 0.15\" }\n";
  return cave;
}

const std::string kSettings =
    " --policy nearest_frontier --set simulator.pose.fitted=always --set localization.source=pose_sensor"
    " --set motion.trajectory=sampled";  // flights that happen to look at half of the objects

std::vector<json> lines_of(const std::filesystem::path& file) {
  std::vector<json> out;
  std::istringstream in(bytes_of(file));
  for (std::string line; std::getline(in, line);) out.push_back(json::parse(line));
  return out;
}

json fly(const std::string& cave, const std::filesystem::path& run, const std::string& settings) {
  const Output out =
      run_karst("fly --cave " + cave + kSettings + settings + " --quiet --no-report --out " + run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  return json::parse(bytes_of(run / "metrics.json"), nullptr, false);
}

/// What must hold wherever vehicles came home: what was seen is known, where it is.
void expect_known(const json& m, int placed, double max_off_m) {
  ASSERT_TRUE(m.is_object());
  EXPECT_EQ(m["objects_placed"], placed);
  EXPECT_GE(m["objects_seen"], placed / 2) << "or the flight says little";
  EXPECT_EQ(m["objects_reported_share"], 1) << m;
  EXPECT_EQ(m["objects_reported"], m["objects_found"]);
  EXPECT_EQ(m["objects_false"], 0);
  EXPECT_GT(m["object_report_time_s"], 0);
  EXPECT_LT(m["object_error_m"], max_off_m);
}

TEST(Objects, AreFoundAndReportedAtTheStart) {
  const auto folder = fresh_folder("objects_alone");
  const std::string cave = passage(folder);
  // At 2 m/s it passes three of the eight in fewer than six images.
  const std::string settings =
      " --set simulator.objects.count=2 --set simulator.battery_minutes=2.5min --set motion.max_speed=1 "
      "--seed "
      "5";
  const json m = fly(cave, folder / "one", settings + " --threads 1");
  expect_known(m, 8, 0.3);
  EXPECT_EQ(m["outcome"], "landed");
  const json written = json::parse(bytes_of(folder / "one" / "objects.json"), nullptr, false);
  EXPECT_GE(written["found"].size(), m["objects_found"].get<std::size_t>());

  fly(cave, folder / "two", settings + " --threads 2");
  for (const char* file : {"events.jsonl", "objects.json", "truth_objects.jsonl", "metrics.json", "map.bt"})
    EXPECT_EQ(bytes_of(folder / "one" / file), bytes_of(folder / "two" / file)) << file;
}

TEST(Objects, SeenByTheColourCameraAloneAreFoundFromItsBearings) {
  const auto folder = fresh_folder("objects_rgb");
  // No depth cameras: ranges by the objects' size, off by 15 %.
  const json m = fly(passage(folder), folder / "run",
                     " --set simulator.vehicle=lidar_only_uav --set simulator.rgb.fitted=true"
                     " --set simulator.rgb.rate=10Hz --set simulator.rgb.pitch=-30deg"
                     " --set simulator.battery_minutes=3min --seed 6");
  ASSERT_TRUE(m.is_object());
  EXPECT_GE(m["objects_seen"], 3) << m;
  EXPECT_EQ(m["objects_reported_share"], 1) << m;
  EXPECT_LT(m["object_error_m"], 1.0);
}

TEST(Objects, OfATeamAreKnownAtTheBaseInTheEnd) {
  const auto folder = fresh_folder("objects_team");
  const auto run = folder / "run";
  const json m = fly(passage(folder), run,
                     " --set simulator.objects.count=2 --seed 3 --set team.robots=3 --set team.stagger=25s"
                     " --set team.linger=20s --set simulator.battery_minutes=1.2min"
                     " --set radio.propagation=distance --set radio.range=15m"
                     " --set homing.landing.link.range=15m --set homing.landing.link.rock_loss=0"
                     " --set homing.landing.link.spare=1");
  expect_known(m, 8, 0.3);
  std::map<std::pair<int, int>, double> told, known;
  for (const json& e : lines_of(run / "team.jsonl")) {
    if (e["kind"] != "object" && e["kind"] != "object_known") continue;
    (e["kind"] == "object" ? told : known).try_emplace({e["robot"], e["number"]}, e["t"].get<double>());
  }
  EXPECT_FALSE(told.empty());
  for (const auto& [key, t] : told) {
    ASSERT_TRUE(known.contains(key)) << "robot " << key.first << ", object " << key.second;
    EXPECT_GE(known[key], t) << "nobody knows what was not told";
  }
  // The same objects for all.
  EXPECT_EQ(lines_of(run / "robot_1" / "truth_objects.jsonl").at(7)["position"],
            lines_of(run / "robot_3" / "truth_objects.jsonl").at(7)["position"]);
  for (const char* robot : {"robot_1", "robot_2", "robot_3"}) {
    EXPECT_TRUE(std::filesystem::exists(run / robot / "objects.json")) << robot;
    std::map<int, int> reported;  // it was told again with every revision
    for (const json& e : lines_of(run / robot / "events.jsonl"))
      if (e["kind"] == "object" && e["state"] == "reported") {
        EXPECT_EQ(++reported[e["number"]], 1) << robot;
      }
  }
}

TEST(Objects, WhereThereAreNoneLeaveNoTrace) {
  const auto folder = fresh_folder("objects_none");
  const std::string cave = draw_cave(folder, {{{-4, -4, 0}, {4, 4, 3}}}, {0, 0, 1});
  const json m = fly(cave, folder / "run", "");
  for (const char* file : {"objects.json", "truth_objects.jsonl"})
    EXPECT_FALSE(std::filesystem::exists(folder / "run" / file)) << file;
  EXPECT_TRUE(m["objects_placed"].is_null());
  EXPECT_TRUE(m["objects_found"].is_null());
}

TEST(Objects, ThatCannotBeLaidOutAreRefusedBeforeAnythingIsWritten) {
  const auto folder = fresh_folder("objects_refused");
  const std::string cave = draw_cave(folder, {{{-4, -4, 0}, {4, 4, 3}}}, {0, 0, 1});
  const auto run = folder / "run";
  const auto refused = [&](const std::string& what) {
    const Output out = run_karst("fly --cave " + cave + kSettings + what + " --out " + run.string());
    EXPECT_EQ(out.code, 1) << out.text;
    EXPECT_FALSE(std::filesystem::exists(run));
    return out;
  };
  EXPECT_TRUE(refused(" --set simulator.objects.count=150").says("room for"));
  EXPECT_TRUE(refused(" --set simulator.objects.count=-1").says("simulator.objects.count"));
  // Longer than the vehicle remembers where it was: objects came to lie metres off.
  EXPECT_TRUE(refused(" --set simulator.objects.delay=3s").says("simulator.objects.delay"));
  std::ofstream(cave, std::ios::app) << "object { kind unicorn position \"1 1 0.2\" }\n";
  EXPECT_TRUE(refused("").says("object.kind"));
}

}  // namespace
}  // namespace karst
