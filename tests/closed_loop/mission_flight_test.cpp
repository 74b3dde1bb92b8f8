// Whole missions in generated caves, with asserted outcomes.
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "core_stack/mission/recording/run_event.h"
#include "tests/closed_loop/command.h"

namespace karst {
namespace {

nlohmann::json metrics_of(const std::filesystem::path& run) {
  return nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false);
}

/// Every line is an event, which is written in the same bytes.
void expect_events(const std::filesystem::path& file) {
  std::istringstream lines(bytes_of(file));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const nlohmann::json parsed = nlohmann::json::parse(line);
    const auto event = core::event::read(parsed);
    ASSERT_TRUE(event) << line;
    EXPECT_EQ(core::event::line_of(core::from_seconds(parsed["t"]), *event), line);
  }
  EXPECT_GT(count, 20u);
}

class EveryPolicy : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryPolicy, ExploresComesHomeAndTouchesNothing) {
  const auto run = fresh_folder(std::string("flight_") + GetParam()) / "run";
  const Output out = run_karst("fly --cave " + generated_cave("small", 7) + " --policy " + GetParam() +
                               " --set mission.max_flight_time=60s --quiet --out " + run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  const nlohmann::json m = metrics_of(run);
  ASSERT_TRUE(m.is_object());
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_EQ(m["contacts"], 0);
  EXPECT_GT(m["min_clearance_m"].get<double>(), 0.0);
  EXPECT_LT(m["landing_error_m"].get<double>(), 1.0);
  EXPECT_GT(m["battery_left"].get<double>(), 0.0);
  EXPECT_GT(m["coverage"].get<double>(), 0.25);
  EXPECT_EQ(m["completed"], 1);
  EXPECT_TRUE(out.says(std::string("landed: ") + GetParam() + " explored ")) << out.text;
  EXPECT_TRUE(out.says("\n  home because ")) << out.text;
  for (const char* file : {"mission.info", "events.jsonl", "trajectory.tum", "ground_truth.tum", "map.bt",
                           "map.ot", "map.ply", "timing.json", "report.html", "telemetry.csv"})
    EXPECT_GT(std::filesystem::file_size(run / file), 0u) << file;
  expect_events(run / "events.jsonl");
}
INSTANTIATE_TEST_SUITE_P(Policies, EveryPolicy,
                         ::testing::Values("nearest_frontier", "lateral_frontier", "highest_frontier",
                                           "unknown_ratio", "information_gain", "viewpoint_tour", "deep_cave",
                                           "beyond_survey"));

// As it was: decisions turned the vehicle in flight faster than the tracker could follow, and it touched
// rock.
TEST(RecedingHorizon, ExploresByCameraAndKeepsItsClearance) {
  const auto folder = fresh_folder("flight_horizon");
  for (int seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const auto run = folder / std::to_string(seed);
    const Output out =
        run_karst("fly --cave " + generated_cave("small", 7) +
                  " --policy information_gain --set simulator.vehicle=camera_uav --seed " +
                  std::to_string(seed) + " --set mission.max_flight_time=100s" +
                  " --set motion.trajectory=horizon --quiet --no-report --out " + run.string());
    EXPECT_EQ(out.code, 0) << out.text;
    const nlohmann::json m = metrics_of(run);
    EXPECT_EQ(m["outcome"], "landed");
    EXPECT_EQ(m["contacts"], 0);
    EXPECT_GT(m["min_clearance_m"].get<double>(), 0.2);
    EXPECT_GT(m["explored_volume_m3"].get<double>(), 200);
  }
}

TEST(RecedingHorizon, ExploresByLidarFasterThanSampledTrajectories) {
  const auto folder = fresh_folder("flight_horizon_lidar");
  std::map<std::string, double> speed_mps;
  for (const std::string trajectory : {"horizon", "sampled"}) {
    SCOPED_TRACE(trajectory);
    const auto run = folder / trajectory;
    const Output out = run_karst(
        "fly --cave " + generated_cave("small", 7) +
        " --policy deep_cave --set mission.max_flight_time=70s --set motion.trajectory=" + trajectory +
        " --quiet --no-report --out " + run.string());
    EXPECT_EQ(out.code, 0) << out.text;
    const nlohmann::json m = metrics_of(run);
    ASSERT_TRUE(m.is_object());
    EXPECT_EQ(m["outcome"], "landed");
    EXPECT_EQ(m["contacts"], 0);
    EXPECT_GT(m["min_clearance_m"].get<double>(), 0.15);
    speed_mps[trajectory] = m["exploring_speed_mps"];
  }
  EXPECT_GT(speed_mps["horizon"], speed_mps["sampled"]);
}

/// What is there to compare with flies as safely, if not as well.
class Alternative : public ::testing::TestWithParam<const char*> {};

TEST_P(Alternative, FliesAndLandsWithoutTouchingAnything) {
  const std::string setting = GetParam();
  const auto run = fresh_folder("flight_" + setting.substr(0, setting.find(' '))) / "run";
  const Output out =
      run_karst("fly --cave " + generated_cave("small", 7) + " --set " + setting +
                " --set mission.max_flight_time=55s --quiet --no-report --out " + run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  const nlohmann::json m = metrics_of(run);
  ASSERT_TRUE(m.is_object());
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_EQ(m["contacts"], 0);
  EXPECT_GT(m["path_length_m"].get<double>(), 20);
  if (setting == "motion.trajectory=polynomial") {
    EXPECT_NE(bytes_of(run / "events.jsonl").find("\"trajectory\":\"polynomial\""), std::string::npos);
  }
}
INSTANTIATE_TEST_SUITE_P(Settings, Alternative,
                         ::testing::Values("planning.planner=rrt_connect",
                                           "planning.planner=bit_star --set planning.planner_iterations=300",
                                           "motion.trajectory=polynomial", "motion.trajectory=sampled",
                                           "mission.append=false --set motion.trajectory=sampled"));

TEST(CameraOnly, ExploresASmallCaveToNinetyPercent) {
  const auto run = fresh_folder("flight_camera") / "run";
  const Output out = run_karst("fly --cave " + generated_cave("small", 7) +
                               " --policy nearest_frontier --set simulator.vehicle=camera_uav"
                               " --set simulator.battery_minutes=15min --quiet --no-report --out " +
                               run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  const nlohmann::json m = metrics_of(run);
  ASSERT_TRUE(m.is_object());
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_GE(m["coverage"].get<double>(), 0.9);
}

/// Whatever the policy does in karst's own process, the core's fallback explores and the vehicle comes home.
class MisbehavingPolicy : public ::testing::TestWithParam<const char*> {};

TEST_P(MisbehavingPolicy, NeverKeepsTheVehicleFromLanding) {
  const std::string plugin = std::string(KARST_BINARY_DIR) + "/tests/plugins/" + GetParam() + ".so";
  ASSERT_TRUE(std::filesystem::exists(plugin)) << plugin;
  const auto run = fresh_folder(std::string("flight_bad_") + GetParam()) / "run";
  const Output out = run_karst(
      "fly --in-process --cave " + generated_cave("small", 7) + " --policy plain --plugin " + plugin +
      " --set policy.hang_limit=4s --set mission.max_flight_time=60s --quiet --no-report --out " +
      run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_EQ(metrics_of(run)["outcome"], "landed") << out.text;
  EXPECT_GT(metrics_of(run)["path_length_m"].get<double>(), 20.0) << "the fallback did not explore";
}
INSTANTIATE_TEST_SUITE_P(Plugins, MisbehavingPolicy,
                         ::testing::Values("endless_loop", "throwing", "only_nan_goals", "million_goals"));

TEST(NarrowPassage, ASqueezeDoesNotEndTheExploration) {
  // As it was: after 77 s the vehicle stood where the whole clearance could not be had, every goal was
  // refused, and it went home with 42.7 % of the cave explored.
  const std::filesystem::path cave =
      std::filesystem::path(KARST_SOURCE_DIR) / "../shared/data/caves/develop/rough_tunnel.stl";
  if (!std::filesystem::exists(cave)) GTEST_SKIP() << "skipped: no ../shared";
  const auto run = fresh_folder("flight_squeeze") / "run";
  const Output out =
      run_karst("fly --cave " + cave.string() +
                " --start '11.1 -0.5 2.1' --policy nearest_frontier --seed 2 --quiet --no-report"
                " --set mission.max_flight_time=130s --out " +
                run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_EQ(bytes_of(run / "events.jsonl").find("\"explored: "), std::string::npos);
  EXPECT_GT(metrics_of(run)["coverage"].get<double>(), 0.25);
}

/// The cave with loose rock in it, as a file in `folder`.
std::string with_boulder(const std::string& cave, const std::filesystem::path& folder,
                         const std::string& boulder) {
  std::string info = bytes_of(cave);
  info.insert(info.find("mesh \"") + 6, std::filesystem::path(cave).parent_path().string() + "/");
  std::ofstream(folder / "cave.info") << info << "\nboulder { " << boulder << " }\n";
  return (folder / "cave.info").string();
}

TEST(TakeOff, ARoofThatCameDownEndsTheClimbBelowItAndHomeIsThere) {
  // As it was: the climb hit it; and where no path led home, the way back ended in the rock at the planned
  // hover.
  const auto folder = fresh_folder("flight_roof");
  const std::string cave =
      with_boulder(generated_cave("small", 7), folder, "position \"0 0 3.4\" radius \"1 m\" after \"1 s\"");
  const Output out = run_karst("fly --cave " + cave +
                               " --set mission.takeoff_height=2.4m --set mission.max_flight_time=60s"
                               " --quiet --no-report --out " +
                               (folder / "run").string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_EQ(metrics_of(folder / "run")["contacts"], 0);
  EXPECT_GT(metrics_of(folder / "run")["path_length_m"].get<double>(), 20);
}

/// As it was, the signal that comes with a file beyond its limit ended the process, and the vehicle fell.
TEST(FileSizeLimit, SendsTheVehicleHomeAndDoesNotEndTheMission) {
  const auto run = fresh_folder("flight_file_size") / "run";
  const Output out = run_command("prlimit --fsize=60000 " KARST_BINARY_DIR "/bin/karst fly --cave " +
                                 generated_cave("small", 7) + " --set simulator.vehicle=camera_uav --quiet" +
                                 " --no-report --out " + run.string());
  EXPECT_EQ(out.code, 2) << "landed, but the record is incomplete: " << out.text;
  EXPECT_TRUE(out.says("record is incomplete")) << out.text;
  const std::string truth = bytes_of(run / "truth_events.jsonl");
  EXPECT_NE(truth.find("landed"), std::string::npos) << truth;
  EXPECT_EQ(truth.find("contact"), std::string::npos) << truth;
}

/// On a file system of its own, which is full after some seconds.
TEST(FullDisk, SendsTheVehicleHomeAndDoesNotEndTheMission) {
  const auto folder = fresh_folder("flight_full_disk");
  std::filesystem::create_directories(folder / "disk");
  const std::string disk = (folder / "disk").string(), mount = "mount -t tmpfs -o size=250k none " + disk;
  if (run_command("unshare -rm " + mount).code != 0) GTEST_SKIP() << "no file system can be mounted here";
  const std::string fly = std::string(KARST_BINARY_DIR "/bin/karst fly --cave ") +
                          generated_cave("small", 7) +
                          " --set simulator.vehicle=camera_uav --quiet --no-report --out " + disk + "/run";
  const Output out = run_command("unshare -rm sh -c '" + mount + " && " + fly + "; code=$?; cp -r " + disk +
                                 "/run " + folder.string() + "; exit $code'");
  EXPECT_EQ(out.code, 2) << "landed, but the record is incomplete: " << out.text;
  EXPECT_TRUE(out.says("record is incomplete")) << out.text;
  EXPECT_TRUE(out.says("No space left on device") || out.says("cannot be written")) << out.text;
}

/// A rock as large as the passage falls five metres ahead, where the same flight came through at full speed.
class Rockfall : public ::testing::TestWithParam<int> {};

TEST_P(Rockfall, ClosesThePassageAheadAndTheVehicleStopsOrTurnsInTime) {
  const std::string cave = generated_cave("small", 7), seed = " --seed " + std::to_string(GetParam());
  const auto folder = fresh_folder("flight_rockfall_" + std::to_string(GetParam()));
  const std::string mission = seed + " --set mission.max_flight_time=70s --quiet --no-report --out ";
  const Output scout = run_karst("fly --cave " + cave + mission + (folder / "scout").string());
  ASSERT_EQ(scout.code, 0) << scout.text;
  std::istringstream poses(bytes_of(folder / "scout" / "trajectory.tum"));
  // Places it came to straight and fast: there the way is likely to lead when the rock falls. What a goal is
  // at that moment depends on the last digits of a machine's arithmetic, so several are tried until one was
  // on the path.
  std::vector<std::string> places;
  std::vector<std::array<double, 4>> flown;
  double from_s = 12 + 4 * GetParam();
  for (std::string line; std::getline(poses, line);) {
    double t = 0, x = 0, y = 0, z = 0;
    std::istringstream(line) >> t >> x >> y >> z;
    flown.push_back({t, x, y, z});
    if (t < from_s || std::hypot(x, y, z) < 8)
      continue;  // at the start a rock would lie on its landing place
    const auto before =
        std::find_if(flown.begin(), flown.end(), [t](const auto& p) { return p[0] >= t - 3.5; });
    if (std::hypot(x - (*before)[1], y - (*before)[2], z - (*before)[3]) <= 5.5) continue;
    places.push_back(std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z));
    from_s = t + 2;
  }
  ASSERT_FALSE(places.empty());
  bool was_on_the_path = false;
  for (std::size_t i = 0; i < places.size() && i < 5 && !was_on_the_path; ++i) {
    SCOPED_TRACE(places[i]);
    const auto run = folder / ("run" + std::to_string(i));
    const std::string rocky = with_boulder(
        cave, folder, "position \"" + places[i] + "\" radius \"1.5 m\" within \"5 m\" after \"10 s\"");
    const Output out = run_karst("fly --cave " + rocky + mission + run.string());
    EXPECT_EQ(out.code, 0) << out.text;
    EXPECT_EQ(metrics_of(run)["contacts"], 0);
    EXPECT_NE(bytes_of(run / "truth_events.jsonl").find("rockfall"), std::string::npos);
    was_on_the_path =
        bytes_of(run / "events.jsonl").find("the map now forbids the path ahead") != std::string::npos;
  }
  EXPECT_TRUE(was_on_the_path);
}
INSTANTIATE_TEST_SUITE_P(Seeds, Rockfall, ::testing::Values(2, 3));

TEST(Payload, OfThirtyPercentIsCarriedWithoutBeingTold) {
  const auto run = fresh_folder("flight_payload") / "run";
  const Output out = run_karst("fly --cave " + generated_cave("small", 7) +
                               " --set simulator.body.payload=0.6kg --set simulator.gust=1m/s"
                               " --set mission.max_flight_time=60s --quiet --no-report --out " +
                               run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_EQ(metrics_of(run)["outcome"], "landed");
  EXPECT_EQ(metrics_of(run)["contacts"], 0);
  EXPECT_LT(metrics_of(run)["tracking_rms_m"].get<double>(), 0.1);
}

TEST(Payload, TooHeavyToLiftOffEndsTheMissionOnTheGround) {
  // As it was: the mission went on without the vehicle, down to 49 m below the ground and for ten minutes.
  const auto run = fresh_folder("flight_too_heavy") / "run";
  const Output out = run_karst("fly --cave " + generated_cave("small", 7) +
                               " --set simulator.body.payload=5kg --quiet --no-report --out " + run.string());
  EXPECT_EQ(out.code, 2) << out.text;
  EXPECT_EQ(metrics_of(run)["outcome"], "stuck");
  EXPECT_TRUE(out.says("it did not lift off (too heavy for its motors?)")) << out.text;
}

TEST(Determinism, ARecordedMissionFliesTheSameBytesUnderLoadAndWithAnotherThreadCount) {
  const auto folder = fresh_folder("flight_twice");
  const std::string quiet = " --quiet --no-report --out " + folder.string();
  ASSERT_EQ(run_karst("fly --cave " + generated_cave("small", 7) +
                      " --policy unknown_ratio --seed 5 --set mission.max_flight_time=55s" + quiet +
                      "/one --threads 1")
                .code,
            0);
  std::atomic<bool> stop{false};
  std::vector<std::thread> load;
  for (int i = 0; i < 3; ++i)
    load.emplace_back([&stop] {
      for (volatile unsigned x = 0; !stop;) x = x + 1;
    });
  const Output second =
      run_karst("fly " + (folder / "one/mission.info").string() + quiet + "/two --threads 4");
  stop = true;
  for (std::thread& t : load) t.join();
  ASSERT_EQ(second.code, 0) << second.text;
  for (const char* file :
       {"mission.info", "metrics.json", "events.jsonl", "trajectory.tum", "ground_truth.tum", "telemetry.csv",
        "map.bt", "map.ot", "map.ply", "map_growth.bin"}) {
    const std::string one = bytes_of(folder / "one" / file);
    EXPECT_FALSE(one.empty()) << file;
    EXPECT_TRUE(one == bytes_of(folder / "two" / file)) << file << " differs between the runs";
  }
}

TEST(Determinism, AnotherSeedIsAnotherFlight) {
  const auto folder = fresh_folder("flight_seeds");
  const std::string mission = "fly --cave " + generated_cave("small", 7) +
                              " --set mission.max_flight_time=30s --quiet --no-report --out " +
                              folder.string();
  ASSERT_EQ(run_karst(mission + "/one --seed 1").code, 0);
  ASSERT_EQ(run_karst(mission + "/two --seed 2").code, 0);
  EXPECT_FALSE(bytes_of(folder / "one" / "trajectory.tum") == bytes_of(folder / "two" / "trajectory.tum"));
}

/// The small cave with a fault of the LiDAR.
std::string small_cave_with(const std::filesystem::path& folder, const std::string& fault) {
  const std::string cave = generated_cave("small", 7);
  std::string info = bytes_of(cave);
  info.insert(info.find("mesh \"") + 6, std::filesystem::path(cave).parent_path().string() + "/");
  std::ofstream(folder / "cave.info") << info << "\nfault { sensor lidar " << fault << " }\n";
  return (folder / "cave.info").string();
}

TEST(LostPose, AVehicleThatHasItAgainOnTheWayDownFliesHome) {
  // As it was: it went on landing where it had lost the pose, though that had no ground to stand on and the
  // pose was back before it came down. It touched a slope of 52 degrees.
  for (const char* fault : {"kind three_points after 20 for 2.7", "kind lost after 20 for 3.5"}) {
    SCOPED_TRACE(fault);
    const auto folder = fresh_folder("flight_pose_found_again");
    const Output out = run_karst("fly --cave " + small_cave_with(folder, fault) +
                                 " --set mission.max_flight_time=60s --set simulator.gust=3 --quiet "
                                 "--no-report --out " +
                                 (folder / "run").string());
    const std::string events = bytes_of(folder / "run/events.jsonl");
    EXPECT_NE(events.find("the state estimate is lost"), std::string::npos);
    EXPECT_NE(events.find("the pose is known again"), std::string::npos);
    // It may have turned back for want of time just before.
    EXPECT_EQ(out.code, metrics_of(folder / "run")["completed"] == 1 ? 0 : 2) << out.text;
    EXPECT_EQ(metrics_of(folder / "run")["outcome"], "landed") << out.text;
    EXPECT_EQ(metrics_of(folder / "run")["contacts"], 0);
  }
}

TEST(LidarClock, SetBackOrAheadForTenSecondsIsFlownThrough) {
  // As it was: set back, its poses contradicted the IMU but for one that just passed the gate and turned the
  // estimate's velocity, and the vehicle met the ground at 1.3 m/s; set ahead, its scans were not used.
  for (const char* kind : {"stamp_back", "stamp_ahead"}) {
    SCOPED_TRACE(kind);
    const auto folder = fresh_folder("flight_lidar_clock");
    const std::string fault = std::string("kind ") + kind + " after 15 for 10";
    const Output out = run_karst("fly --cave " + small_cave_with(folder, fault) +
                                 " --set mission.max_flight_time=60s --quiet --no-report --out " +
                                 (folder / "run").string());
    const std::string events = bytes_of(folder / "run/events.jsonl");
    EXPECT_NE(events.find("the LiDAR's clock was set"), std::string::npos);
    EXPECT_NE(events.find("the LiDAR's clock is right again"), std::string::npos);
    EXPECT_EQ(events.find("the state estimate is"), std::string::npos) << "neither lost nor degraded";
    EXPECT_EQ(metrics_of(folder / "run")["outcome"], "landed") << out.text;
    EXPECT_EQ(metrics_of(folder / "run")["contacts"], 0);
  }
}

TEST(LostPose, AVehicleThatStandsDoesNotTakeOffAgain) {
  // As it was: who lost the pose while taking off and touched down before that was over was not seen to
  // stand. The motors went on, on an estimate that ran away, and carried it into the rock.
  const auto folder = fresh_folder("flight_lost_pose");
  for (const char* after : {"1.2", "1.8", "2.4"}) {
    SCOPED_TRACE(after);
    const std::string cave = small_cave_with(folder, std::string("kind lost after ") + after + " for 600");
    const auto run = folder / after;
    const Output out =
        run_karst("fly --cave " + cave + " --set mission.max_flight_time=60s --quiet --no-report --out " +
                  run.string());
    EXPECT_EQ(metrics_of(run)["contacts"], 0) << out.text;
    EXPECT_EQ(out.code, 2) << "landed at the start, but early: " << out.text;
    EXPECT_TRUE(out.says("\n  home after ") && out.says(" s: the pose was lost (")) << out.text;
    const std::string truth = bytes_of(run / "truth_events.jsonl");
    const auto count = [&truth](const std::string& event) {
      int n = 0;
      for (std::size_t at = 0; (at = truth.find("\"" + event + "\"", at)) != std::string::npos; ++at) ++n;
      return n;
    };
    EXPECT_EQ(count("take-off"), 1);
    EXPECT_EQ(count("landed"), 1);
    EXPECT_LT(metrics_of(run)["flight_time_s"].get<double>(), 30);
  }
}

TEST(Interrupt, AMissionCutShortLandsWhereItIsAndLeavesAWholeRunDirectory) {
  const auto run = fresh_folder("flight_interrupted") / "run";
  const std::string karst = std::string(KARST_BINARY_DIR) + "/bin/karst";
  const std::string line = "timeout -s INT 3 " + karst + " fly --cave " + generated_cave("small", 7) +
                           " --quiet --out " + run.string() + " > /dev/null 2>&1";
  const int status = std::system(line.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  const nlohmann::json m = metrics_of(run);
  ASSERT_TRUE(m.is_object()) << "no metrics after an interrupt";
  EXPECT_EQ(m["outcome"], "aborted");
  EXPECT_EQ(m["contacts"], 0);
  EXPECT_EQ(m["reason"].get<std::string>().find("stopped by the operator: on the ground "), 0u)
      << m["reason"];
  EXPECT_GT(std::filesystem::file_size(run / "map.bt"), 0u);
  EXPECT_GT(std::filesystem::file_size(run / "report.html"), 0u);
}

TEST(Interrupt, ASecondSignalEndsTheProcessAtOnce) {
  const auto run = fresh_folder("flight_interrupted_twice") / "run";
  const pid_t child = fork();
  if (child == 0) {
    const std::string karst = std::string(KARST_BINARY_DIR) + "/bin/karst", cave = generated_cave("small", 7);
    // In real time the landing takes seconds: the second signal comes long before its end.
    execl(karst.c_str(), "karst", "fly", "--real-time", "--cave", cave.c_str(), "--quiet", "--out",
          run.c_str(), nullptr);
    _exit(127);
  }
  const auto flies = [&] { return bytes_of(run / "events.jsonl").find("explore") != std::string::npos; };
  while (!flies() && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  kill(child, SIGTERM);
  const auto lands = [&] { return bytes_of(run / "events.jsonl").find("stopped by") != std::string::npos; };
  while (!lands() && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  kill(child, SIGTERM);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
  EXPECT_EQ(bytes_of(run / "events.jsonl").find("\"kind\":\"outcome\""), std::string::npos);
}

}  // namespace
}  // namespace karst
