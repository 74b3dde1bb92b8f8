// The same flight on every x86-64 processor: digests of short flights of all kinds, kept in the tree.
//
//   KARST_ACCEPT=1 build/bin/same_flight_test     writes them anew, where flights are meant to change
#include <cstdlib>
#include <fstream>
#include <map>

#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

struct Flight {
  const char* name;
  std::string (*command)(const fs::path& folder);  // without --out; the folder is for a cave of its own
};

std::string corridor_cave(const fs::path& folder) {
  return draw_cave(folder,
                   {{{-3, -3, 0}, {3, 3, 3}},
                    {{3, -0.55, 0}, {9, 0.55, 1.6}},
                    {{7.9, -0.55, 0}, {9, 3, 1.6}},
                    {{7.9, 3, 0.4}, {9, 6, 2}},
                    {{4.9, 6, 0.4}, {12, 12, 3.4}}},
                   {0, 0, 1});
}

/// A cave file with `lines` added.
std::string with(const std::string& cave, const std::string& lines) {
  std::ofstream(cave, std::ios::app) << lines;
  return cave;
}

std::string small_cave(const fs::path& folder, const std::string& lines) {
  const fs::path plain = generated_cave("small", 7), own = folder / "cave.info";
  fs::copy_file(plain, own);
  for (const auto& entry : fs::directory_iterator(plain.parent_path()))  // its mesh lies beside it
    if (entry.path().stem() == plain.stem() && entry.path() != plain)
      fs::copy_file(entry.path(), folder / entry.path().filename());
  return with(own.string(), lines);
}

std::string alone(const std::string& cave, const std::string& policy, const std::string& settings) {
  return "fly --cave " + cave + " --policy " + policy + " --set mission.max_flight_time=60s " + settings;
}

constexpr const char* kTeam =
    " --policy nearest_frontier --set team.stagger=20s --set team.linger=10s --set "
    "simulator.battery_minutes=1min"
    " --set simulator.pose.fitted=always --set localization.source=pose_sensor --set radio.range=15m"
    " --set homing.landing.link.range=15m";

std::string team(const std::string& cave, const std::string& settings) {
  return "fly --cave " + cave + kTeam + settings;
}

const Flight kFlights[] = {
    {"nearest_frontier",
     [](const fs::path&) { return alone(generated_cave("small", 7), "nearest_frontier", ""); }},
    {"lateral_frontier_in_dust_and_ore",
     [](const fs::path& folder) {
       return alone(small_cave(folder,
                               "patch { position \"0 0 3\" radius \"2.5 m\" reflectivity 0.05 }\n"
                               "ore { position \"4 -6 -2\" moment \"0 0 4000\" }\n"),
                    "lateral_frontier",
                    "--set simulator.air.haze=\"0.05 1/m\" --set simulator.air.stirred=\"1 1/m\""
                    " --set simulator.gust=\"3 m/s\"");
     }},
    {"highest_frontier_with_lidar_colour_camera_and_objects",
     [](const fs::path&) {
       return alone(generated_cave("small", 7), "highest_frontier",
                    "--set simulator.vehicle=lidar_only_uav --set simulator.rgb.fitted=true"
                    " --set simulator.objects.count=3");
     }},
    {"unknown_ratio_before_a_rockfall",
     [](const fs::path& folder) {
       return alone(with(passage_cave(folder),
                         "boulder { position \"11 0 1.5\" radius \"2.35 m\" within \"5.3 m\" }\n"),
                    "unknown_ratio", "");
     }},
    {"information_gain_by_camera_alone",
     [](const fs::path&) {
       return alone(generated_cave("small", 7), "information_gain",
                    "--set simulator.vehicle=camera_uav --set motion.trajectory=sampled");
     }},
    {"information_gain_by_camera_with_a_receding_horizon",
     [](const fs::path&) {
       return alone(generated_cave("small", 7), "information_gain", "--set simulator.vehicle=camera_uav");
     }},
    {"deep_cave_at_six_metres_a_second",
     [](const fs::path&) {
       return alone(generated_cave("small", 7), "deep_cave",
                    "--set motion.max_speed=6m/s --set motion.max_acceleration=\"4 m/s^2\"");
     }},
    {"viewpoint_tour_through_a_narrow_passage",
     [](const fs::path& folder) {
       return alone(corridor_cave(folder), "viewpoint_tour", "--set planning.narrow_margin=\"0.08 m\"");
     }},
    {"deep_cave_with_polynomials",
     [](const fs::path&) {
       return alone(generated_cave("small", 3), "deep_cave", "--set motion.trajectory=polynomial");
     }},
    {"surface_coverage_with_pictures",
     [](const fs::path&) {
       return alone(generated_cave("small", 7), "surface_coverage", "--set simulator.rgb.fitted=true");
     }},
    {"ompl_through_failing_sensors",
     [](const fs::path& folder) {
       return alone(small_cave(folder,
                               "fault { sensor lidar kind lost after \"20 s\" for \"1 s\" }\n"
                               "fault { sensor imu kind lost after \"30 s\" for \"0.3 s\" }\n"),
                    "nearest_frontier",
                    "--set planning.planner=rrt_connect --set simulator.lidar.unit=vlp16");
     }},
    {"a_policy_that_breaks_in_a_process_of_its_own",
     [](const fs::path&) {
       return alone(generated_cave("small", 7), "plain",
                    std::string("--set policy.isolation=process --plugin ") + KARST_BINARY_DIR +
                        "/tests/plugins/crash_later.so");
     }},
    {"a_team_by_distance",
     [](const fs::path& folder) {
       return team(passage_cave(folder),
                   " --set team.robots=2 --set radio.propagation=distance"
                   " --set homing.landing.link.rock_loss=0 --set homing.landing.link.spare=1");
     }},
    {"a_team_through_rock_with_dropped_nodes",
     [](const fs::path& folder) {
       return team(passage_cave(folder), " --set team.robots=2 --set team.nodes=2");
     }},
    {"a_team_whose_relay_falls_silent",
     [](const fs::path& folder) {
       return team(passage_cave(folder),
                   " --set team.robots=2 --set radio.propagation=distance"
                   " --set homing.landing.link.rock_loss=0 --set team.silent_relay=1"
                   " --set team.silent_after=5s");
     }},
    {"replay_of_real_scans",
     [](const fs::path&) {
       return std::string("replay ") + KARST_SOURCE_DIR + "/../shared/data/scans/kitti00 --info " +
              KARST_SOURCE_DIR + "/examples/recordings/kitti.info";
     }},
};

bool is_there(const Flight& flight) {
  return std::string(flight.name) != "replay_of_real_scans" ||
         fs::exists(std::string(KARST_SOURCE_DIR) + "/../shared/data/scans/kitti00");
}

/// Every file of a run that does not tell of wall-clock times or of where the run lies.
std::string digest_of(const fs::path& run) {
  const Output all = run_command(
      "cd " + run.string() +
      " && find . -type f ! -name timing.json ! -name decisions.csv ! -name mission.info "
      "! -name run.lock ! -name '*.html' | LC_ALL=C sort | xargs sha256sum | sha256sum | cut -c1-32");
  return all.text.substr(0, 32);
}

const fs::path kDigests = fs::path(KARST_SOURCE_DIR) / "tests/closed_loop/flight_digests.txt";

std::map<std::string, std::string> kept_digests() {
  std::map<std::string, std::string> all;
  std::ifstream in(kDigests);
  for (std::string name, digest; in >> name >> digest;) all[name] = digest;
  return all;
}

/// Flies it as `environment karst ...`.
std::string flown_digest(const Flight& flight, const std::string& name, const std::string& environment = "") {
  const fs::path folder = fresh_folder("same_flight_" + name);
  const Output out =
      run_command(environment + " " + KARST_BINARY_DIR + "/bin/karst " + flight.command(folder) +
                  " --quiet --no-report --out " + (folder / "run").string());
  EXPECT_TRUE(out.code == 0 || out.code == 2) << out.text;
  EXPECT_TRUE(fs::exists(folder / "run" / "metrics.json")) << out.text;
  return digest_of(folder / "run");
}

class SameFlight : public ::testing::TestWithParam<Flight> {};

TEST_P(SameFlight, HasItsDigestOnThisProcessor) {
  const Flight& flight = GetParam();
  if (!is_there(flight)) GTEST_SKIP() << "skipped: no ../shared";
  const std::string digest = flown_digest(flight, flight.name);
  if (std::getenv("KARST_ACCEPT")) {
    auto all = kept_digests();
    all[flight.name] = digest;
    std::ofstream out(kDigests);
    for (const auto& [name, kept] : all) out << name << ' ' << kept << '\n';
  }
  EXPECT_EQ(digest, kept_digests()[flight.name])
      << "KARST_ACCEPT=1 keeps the new one, if flights are meant to change";
}
INSTANTIATE_TEST_SUITE_P(Kinds, SameFlight, ::testing::ValuesIn(kFlights),
                         [](const auto& kind) { return std::string(kind.param.name); });

/// What elementary_functions.list names is ours in every program and plugin, not the C library's.
TEST(Programs, TakeNoElementaryFunctionFromTheCLibrary) {
  std::string names;
  std::ifstream list(std::string(KARST_SOURCE_DIR) + "/core_stack/common/elementary_functions.list");
  for (std::string word; list >> word;)
    if (word.back() == ';' && word.size() > 2)
      names += (names.empty() ? "" : "|") + word.substr(0, word.size() - 1);
  ASSERT_NE(names.find("sin|"), std::string::npos);
  for (const char* program :
       {"bin/karst", "lib/karst/karst-policy-child", "lib/karst/vehicles/libkarst_vehicle_simulator.so"}) {
    const std::string file = std::string(KARST_BINARY_DIR) + "/" + program;
    ASSERT_EQ(run_command("nm -D --defined-only " + file).code, 0);
    EXPECT_EQ(run_command("nm -D --undefined-only " + file + " | grep -E ' (" + names + ")@'").text, "")
        << program;
  }
}

/// A processor with other instructions, as far as one can be played: the ray caster's instruction set is
/// chosen, and the C library told that there are no fused multiply-adds and no AVX2.
class OtherProcessor : public ::testing::TestWithParam<const char*> {};

TEST_P(OtherProcessor, FliesTheSame) {
  const std::string set = GetParam();
  const std::string environment =
      "env GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX,-ERMS,-SSE4_2 KARST_TEST_EMBREE_ISA=" + set +
      " LD_PRELOAD=" + KARST_BINARY_DIR + "/lib/embree_isa.so";
  const Flight& flight = kFlights[1];
  const Output probe = run_command(environment + " " + KARST_BINARY_DIR + "/bin/karst cave info " +
                                   generated_cave("small", 7));
  ASSERT_TRUE(probe.says("ray caster made with isa=" + set)) << "the instruction set was not forced\n"
                                                             << probe.text;
  EXPECT_EQ(flown_digest(flight, "on_" + set, environment), kept_digests()[flight.name]);
}
INSTANTIATE_TEST_SUITE_P(InstructionSets, OtherProcessor, ::testing::Values("sse2", "avx2"));

}  // namespace
}  // namespace karst
