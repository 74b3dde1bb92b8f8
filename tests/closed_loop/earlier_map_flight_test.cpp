// The map of an earlier flight as what is known before this one, by the commands alone.
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Whether the flight kept its own place: the simulator's flights all have the frame of the cave.
constexpr double kPlace_m = 0.05, kTurn_rad = 0.01;

json metrics_of(const fs::path& run) { return json::parse(bytes_of(run / "metrics.json"), nullptr, false); }

std::vector<json> events_of(const fs::path& run, const std::string& kind) {
  std::vector<json> events;
  std::ifstream in(run / "events.jsonl");
  for (std::string line; std::getline(in, line);)
    if (const json e = json::parse(line, nullptr, false); e.is_object() && e["kind"] == kind)
      events.push_back(e);
  return events;
}

Output fly(const std::string& cave, const fs::path& run, const std::string& more) {
  return run_karst("fly --cave " + cave + " --policy nearest_frontier --quiet --no-report --out " +
                   run.string() + " " + more);
}

/// A flight of a few goals, once for all tests of this program.
fs::path first_flight(const std::string& cave) {
  const fs::path folder = fs::path(KARST_BINARY_DIR) / "test_runs" / "earlier_map";
  fs::create_directories(folder);
  const fs::path run = folder / ("first_" + fs::path(cave).stem().string());
  if (metrics_of(run).is_object()) return run;
  // Several tests may want it at once: each flies its own, and the rename decides.
  const fs::path own = run.string() + "." + std::to_string(getpid());
  const Output out = fly(cave, own, "--seed 1 --time 55s --force");
  EXPECT_EQ(out.code, 0) << out.text;
  if (out.code != 0) return own;
  std::error_code other_was_first;
  fs::rename(own, run, other_was_first);
  return other_was_first && !metrics_of(run).is_object() ? own : run;
}

/// A start some metres along the way of a flight, turned: "x y z heading".
std::string start_beside(const fs::path& run, double away_m) {
  std::ifstream in(run / "trajectory.tum");
  std::optional<std::array<double, 3>> first;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    double t = 0, x = 0, y = 0, z = 0;
    if (!(words >> t >> x >> y >> z)) continue;
    if (!first) first = {x, y, z};
    if (std::hypot(x - (*first)[0], y - (*first)[1]) < away_m) continue;
    return std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " 140";
  }
  ADD_FAILURE() << "it did not fly " << away_m << " m";
  return "";
}

TEST(EarlierMapFlight, ExploresWhatTheEarlierFlightLeft) {
  const std::string cave = generated_cave("small", 3);
  const fs::path first = first_flight(cave), folder = fresh_folder("earlier_map_second");
  const std::string second =
      " --start \"" + start_beside(first, 3) + "\" --seed 5 --time 85s --set map.start=" + first.string();
  const Output out = fly(cave, folder / "with", second);
  EXPECT_EQ(out.code, 0) << out.text;
  const auto found = events_of(folder / "with", "earlier_map");
  ASSERT_EQ(found.size(), 1u) << "not by the first search\n" << out.text;
  ASSERT_EQ(found.back()["state"], "found") << found.back().dump();
  const json& at = found.back()["position"];
  EXPECT_LT(std::hypot(at[0].get<double>(), at[1].get<double>(), at[2].get<double>()), kPlace_m) << at;
  EXPECT_LT(std::abs(found.back()["heading"].get<double>()), kTurn_rad);

  const json m = metrics_of(folder / "with"), before = metrics_of(first);
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_EQ(m["contacts"], 0);
  EXPECT_EQ(m["earlier_map_found"], 1);
  const double earlier_m3 = before["explored_volume_m3"].get<double>();
  EXPECT_NEAR(m["earlier_volume_m3"].get<double>(), earlier_m3, 0.02 * earlier_m3);
  EXPECT_GT(m["added_volume_m3"].get<double>(), 20);
  EXPECT_GT(m["coverage"].get<double>(), before["coverage"].get<double>());
  EXPECT_TRUE(out.says("not in the earlier map")) << out.text;

  const std::string mission = bytes_of(folder / "with" / "mission.info");
  const std::string digest = run_command("sha256sum " + (first / "map.ot").string()).text.substr(0, 64);
  EXPECT_NE(mission.find("start_digest " + digest), std::string::npos) << mission;

  // The recorded mission flies the same again, with more threads.
  const Output again = run_karst("fly " + (folder / "with" / "mission.info").string() +
                                 " --threads 4 --quiet --no-report --out " + (folder / "again").string());
  EXPECT_EQ(again.code, 0) << again.text;
  for (const char* file : {"events.jsonl", "map.ot", "trajectory.tum", "map_growth.bin"})
    EXPECT_TRUE(bytes_of(folder / "with" / file) == bytes_of(folder / "again" / file)) << file;
}

TEST(EarlierMapFlight, TheMapOfAnotherCaveIsRefusedAndTheFlightGoesOn) {
  const std::string cave = generated_cave("small", 4);
  const fs::path first = first_flight(generated_cave("small", 3)), folder = fresh_folder("earlier_map_wrong");
  const Output out = fly(cave, folder / "on", "--seed 5 --time 45s --set map.start=" + first.string());
  EXPECT_EQ(out.code, 0) << out.text;
  const auto events = events_of(folder / "on", "earlier_map");
  ASSERT_FALSE(events.empty());
  for (const json& e : events) EXPECT_NE(e["state"], "found") << e.dump();
  const json m = metrics_of(folder / "on");
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_EQ(m["earlier_map_found"], 0);
  EXPECT_TRUE(m["added_volume_m3"].is_null());
  EXPECT_GT(m["explored_volume_m3"].get<double>(), 100);

  // It hovers for a second search, 5 s after the first answer; a third would begin too late.
  const Output required = fly(cave, folder / "required",
                              "--seed 5 --time 60s --set map.required=true --set map.search_time=15s "
                              "--set map.start=" +
                                  first.string());
  EXPECT_EQ(required.code, 2) << required.text;
  EXPECT_TRUE(required.says("could not find its place in the earlier map")) << required.text;
  const json landed = metrics_of(folder / "required");
  EXPECT_EQ(landed["outcome"], "landed");
  EXPECT_EQ(landed["contacts"], 0);
  for (const json& phase : events_of(folder / "required", "phase")) EXPECT_NE(phase["phase"], "explore");
  const auto searches = events_of(folder / "required", "earlier_map");
  ASSERT_EQ(searches.size(), 3u) << required.text;
  EXPECT_EQ(searches[1]["state"], "not found");
  EXPECT_EQ(searches[1]["attempt"], 2);
  EXPECT_EQ(searches[2]["state"], "given up");

  // The time allowed ends the search, too.
  const Output short_of_time =
      fly(cave, folder / "short",
          "--seed 5 --time 34s --set map.required=true --set map.start=" + first.string());
  EXPECT_EQ(short_of_time.code, 2) << short_of_time.text;
  EXPECT_EQ(metrics_of(folder / "short")["outcome"], "landed");
  EXPECT_LT(metrics_of(folder / "short")["flight_time_s"], 34);
}

TEST(EarlierMapFlight, BadMapsAreErrorsBeforeTheFlight) {
  const std::string cave = generated_cave("small", 3);
  const fs::path folder = fresh_folder("earlier_map_bad");
  const auto refused = [&](const std::string& set, const std::string& words) {
    const Output out = fly(cave, folder / "run", set);
    EXPECT_EQ(out.code, 1) << out.text;
    EXPECT_TRUE(out.says(words)) << words << "\n" << out.text;
    EXPECT_FALSE(fs::exists(folder / "run" / "events.jsonl"));
  };
  const auto start = [&](const std::string& file) {
    return "--set map.start=" + (folder / file).string() + " ";
  };
  refused(start("nowhere"), "map.start: " + (folder / "nowhere").string() + " is not there");
  fs::create_directories(folder / "empty");
  refused(start("empty"), "holds no map.ot or map.bt");
  std::ofstream(folder / "text.bt") << "no map\n";
  refused(start("text.bt"), "text.bt: line 1: is no OctoMap .bt or .ot file");
  std::ofstream(folder / "rock.bt") << "# Octomap OcTree binary file\nid OcTree\nsize 0\nres 0.2\ndata\n";
  refused(start("rock.bt"), "rock.bt: holds no rock");
  refused("--set map.required=true", "map.required: is of no use without map.start");

  const fs::path first = first_flight(cave);
  const std::string good = "--set map.start=" + first.string() + " ";
  refused(good + "--set map.start_digest=12ab", "the map is another one");
  refused(good + "--set map.resolution=0.25", "has cells of 0.200 m, and map.resolution is 0.250 m");
  refused(good + "--set simulator.vehicle=camera_uav", "has no LiDAR");
  refused(good + "--set team.robots=2", "is for a single vehicle");
  const std::string map = bytes_of(first / "map.ot");
  std::ofstream(folder / "cut.ot", std::ios::binary) << map.substr(0, map.size() / 2);
  refused(start("cut.ot"), "ends within its tree");
}

}  // namespace
}  // namespace karst
