// A flight in real time that is killed, and whose files then look as a power cut leaves them: whatever is
// lost, what is there is read, and what is missing is said.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "core_stack/common/random.h"
#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kRecord{"events.jsonl",     "telemetry.csv",     "trajectory.tum",
                                       "localization.csv", "decisions.csv",     "map_growth.bin",
                                       "map_cells.bin",    "mission.info",      "truth.csv",
                                       "ground_truth.tum", "truth_events.jsonl"};

nlohmann::json metrics_of(const fs::path& run) {
  return nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false);
}

/// A run directory that SIGKILL left behind, after it had explored for some seconds.
const fs::path& killed_run() {
  static const fs::path run = [] {
    const fs::path killed = fresh_folder("power_cut") / "killed";
    const std::string karst = std::string(KARST_BINARY_DIR) + "/bin/karst", cave = generated_cave("small", 7);
    const pid_t child = fork();
    if (child == 0) {
      execl(karst.c_str(), "karst", "fly", "--real-time", "--cave", cave.c_str(), "--quiet", "--out",
            killed.c_str(), nullptr);
      _exit(127);
    }
    std::error_code none;
    const auto explores = [&] {
      return bytes_of(killed / "events.jsonl").find("\"accepted\"") != std::string::npos &&
             fs::file_size(killed / "map_cells.bin", none) > 200'000;
    };
    while (!explores() && waitpid(child, nullptr, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    return killed;
  }();
  return run;
}

fs::path copy_of_killed(const std::string& name) {
  const fs::path run = fresh_folder("power_cut_" + name) / "run";
  fs::copy(killed_run(), run, fs::copy_options::recursive);
  return run;
}

TEST(PowerCut, AKilledFlightIsRecoveredWithItsMap) {
  const fs::path run = copy_of_killed("whole");
  EXPECT_TRUE(fs::exists(run / "run.lock"));
  EXPECT_FALSE(fs::exists(run / "map.bt"));
  std::map<std::string, std::string> before;
  for (const std::string& name : kRecord) before[name] = bytes_of(run / name);
  const Output out = run_karst("recover " + run.string());
  EXPECT_EQ(out.code, 0) << out.text;
  for (const char* name : {"map.bt", "map.ot", "map.ply", "metrics.json", "report.html"})
    EXPECT_GT(fs::file_size(run / name), 0u) << name;
  EXPECT_FALSE(fs::exists(run / "run.lock"));
  for (const std::string& name : kRecord) EXPECT_EQ(bytes_of(run / name), before[name]) << name;
  const nlohmann::json m = metrics_of(run);
  EXPECT_EQ(m["outcome"], "aborted");
  EXPECT_EQ(m["reason"], "the record ends without an outcome");
  // The map that was recovered holds what the flight itself said that it had explored, up to the last second.
  const std::string telemetry = bytes_of(run / "telemetry.csv");
  const auto last = telemetry.substr(telemetry.rfind('\n', telemetry.size() - 2) + 1);
  std::istringstream cells(last);
  std::string cell;
  for (int i = 0; i < 15; ++i) std::getline(cells, cell, ',');
  EXPECT_GT(std::stod(cell), 20) << last;
  EXPECT_NEAR(m["explored_volume_m3"].get<double>(), std::stod(cell), 0.25 * std::stod(cell));
  // Again: it is all there already. Killed after map.ot, it lacks map.ply alone.
  const std::string ply = bytes_of(run / "map.ply");
  fs::remove(run / "map.ply");
  EXPECT_EQ(run_karst("recover " + run.string()).code, 0);
  EXPECT_EQ(bytes_of(run / "map.ply"), ply);
  // It is read; whether so small a map can be registered is another question (exit code 2).
  const Output merged =
      run_karst("map merge " + run.string() + " " + run.string() + " --out " + (run / "merged").string());
  EXPECT_FALSE(merged.says("holds no map") || merged.says("map.ot: ")) << merged.text;
}

/// One way in which a file system may leave a file that was being written.
std::string damaged(const std::string& bytes, core::Random& random) {
  const auto cut = static_cast<std::size_t>(random.uniform(0, static_cast<double>(bytes.size()) + 0.999));
  const auto kind = static_cast<int>(random.uniform(0, 4.999));
  if (kind == 0) return bytes.substr(0, cut);
  if (kind == 1) return bytes.substr(0, cut) + std::string(bytes.size() - cut, '\0');  // length, but no data
  if (kind == 2) return bytes.substr(0, cut) + std::string(4096, '\0');                // preallocated
  if (kind == 3) {  // a page that did not reach the disk, while later ones did
    std::string torn = bytes;
    const std::size_t page = cut / 4096 * 4096;
    std::fill(torn.begin() + static_cast<std::ptrdiff_t>(std::min(page, torn.size())),
              torn.begin() + static_cast<std::ptrdiff_t>(std::min(page + 4096, torn.size())), '\0');
    return torn;
  }
  return "";  // made, and nothing written
}

// Not one case: files are missing, cut off at any byte, or filled with zeros from any byte on, in many
// mixtures.
TEST(PowerCut, WhateverIsLostWhatIsThereIsReadAndWhatIsMissingIsSaid) {
  core::Random random(5);
  const int trials = std::max(12, 6 * seeds());
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    const fs::path run = copy_of_killed("damaged");
    std::vector<std::string> touched;
    for (const std::string& name : kRecord) {
      const double fate = random.uniform();
      if (fate < 0.15) {
        fs::remove(run / name);
      } else if (fate < 0.75) {
        const std::string whole = bytes_of(run / name), left = damaged(whole, random);
        std::ofstream(run / name, std::ios::binary | std::ios::trunc) << left;
        // Cut at the end of a line or record, or with nothing lost, nothing is to be seen of it.
        const bool shows = left.find('\0') != std::string::npos && !name.ends_with(".bin");
        if (shows && name != "mission.info") touched.push_back(name);
      }
    }
    if (trial % 3 == 0)
      std::ofstream(run / "map.bt", std::ios::binary) << "# Octomap OcTree binary file\nid Oc";
    const Output recovered = run_karst("recover --no-report " + run.string());
    if (recovered.says("holds nothing of a flight")) continue;
    ASSERT_EQ(recovered.code, 0) << recovered.text;
    for (const std::string& name : touched)
      EXPECT_TRUE(recovered.says(name)) << name << "\n" << recovered.text;
    ASSERT_TRUE(metrics_of(run).is_object());
    const Output report = run_karst("report " + run.string());
    if (fs::exists(run / "mission.info") || fs::exists(run / "events.jsonl")) {
      ASSERT_EQ(report.code, 0) << report.text;
      EXPECT_GT(fs::file_size(run / "report.html"), 1000u);
    }
    EXPECT_EQ(run_karst("table " + run.string()).code, 0);
  }
}

TEST(PowerCut, AFolderWithoutAFlightAndAFlightInTheAirAreRefused) {
  const fs::path empty = fresh_folder("power_cut_empty");
  const Output nothing = run_karst("recover " + empty.string());
  EXPECT_EQ(nothing.code, 1);
  EXPECT_TRUE(nothing.says("holds nothing of a flight")) << nothing.text;
  const Output missing = run_karst("recover " + (empty / "no").string());
  EXPECT_EQ(missing.code, 1);
  EXPECT_TRUE(missing.says("is not a directory")) << missing.text;
}

}  // namespace
}  // namespace karst
