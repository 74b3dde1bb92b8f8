// A flight with record.scans: the same flight, and a recording of it that replays and is exported.
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

std::string flight(const fs::path& run, const std::string& options, const char* time = "40s") {
  return "fly --cave " + generated_cave("small", 7) + " --quiet --no-report --time " + time + " --out " +
         run.string() + " " + options;
}

std::size_t scans_in(const fs::path& folder) {
  std::size_t scans = 0;
  for (const auto& entry : fs::directory_iterator(folder))
    scans += entry.path().extension() == ".pcd" ? 1 : 0;
  return scans;
}

Output replay(const fs::path& recording, const fs::path& run) {
  return run_karst("replay " + recording.string() + " --quiet --no-report --out " + run.string());
}

/// "points N used, M left out": the same only with the same limits of range.
std::string points_line(const Output& replayed) {
  const std::size_t begin = replayed.text.find("  points  ");
  return begin == std::string::npos ? ""
                                    : replayed.text.substr(begin, replayed.text.find('\n', begin) - begin);
}

/// Root mean square of the distance between two trajectories, after alignment.
double distance_m(const fs::path& replayed, const fs::path& trajectory) {
  const Output errors = run_karst("evaluate " + replayed.string() + " --truth " + trajectory.string());
  EXPECT_EQ(errors.code, 0) << errors.text;
  return nlohmann::json::parse(bytes_of(replayed / "evaluation.json"))
      .at("trajectory")
      .at("ape")
      .at("translation_m")
      .at("rmse")
      .get<double>();
}

/// The recording gives the trajectory of the flight, within the drift of its odometry, and the exported file
/// gives that of the recording.
void expect_replays(const fs::path& run) {
  const fs::path replayed = run.string() + "_replayed", file = run.string() + ".mcap",
                 again = run.string() + "_from_mcap";
  const Output from_folder = replay(run / "scans", replayed);
  ASSERT_EQ(from_folder.code, 0) << from_folder.text;
  EXPECT_LT(distance_m(replayed, run / "ground_truth.tum"), 0.05);
  EXPECT_LT(distance_m(replayed, run / "trajectory.tum"), 0.05);

  const Output exported = run_karst("export " + run.string() + " --json --mcap " + file.string());
  ASSERT_EQ(exported.code, 0) << exported.text;
  std::size_t points = 0;
  const auto summary = nlohmann::json::parse(exported.text);
  for (const auto& topic : summary.at("topics"))
    if (topic.at("topic") == "/points") points = topic.at("messages");
  EXPECT_EQ(points, scans_in(run / "scans"));

  const Output from_file = replay(file, again);
  ASSERT_EQ(from_file.code, 0) << from_file.text;
  EXPECT_GT(bytes_of(again / "trajectory.tum").size(), 80 * points);
  EXPECT_NE(points_line(from_file), "");
  EXPECT_EQ(points_line(from_file), points_line(from_folder));
  EXPECT_EQ(bytes_of(again / "trajectory.tum"), bytes_of(replayed / "trajectory.tum"));
}

TEST(RecordedScans, AreTheSameOnAnyThreadsAndLeaveTheFlightAsItIs) {
  const fs::path folder = fresh_folder("recorded_scans");
  const std::string record = "--set record.scans=true ";
  ASSERT_EQ(run_karst(flight(folder / "one", record + "--threads 1")).code, 0);
  ASSERT_EQ(run_karst(flight(folder / "more", record + "--threads 4")).code, 0);
  ASSERT_EQ(run_karst(flight(folder / "none", "")).code, 0);
  for (const char* same : {"events.jsonl", "trajectory.tum", "telemetry.csv", "localization.csv",
                           "map_growth.bin", "map.ot", "ground_truth.tum", "truth.csv"})
    EXPECT_EQ(bytes_of(folder / "one" / same), bytes_of(folder / "none" / same)) << same;
  EXPECT_FALSE(fs::exists(folder / "none" / "scans"));
  EXPECT_GT(scans_in(folder / "one" / "scans"), 80u);
  EXPECT_EQ(scans_in(folder / "one" / "scans"), scans_in(folder / "more" / "scans"));
  for (const auto& entry : fs::directory_iterator(folder / "one" / "scans"))
    EXPECT_EQ(bytes_of(entry.path()), bytes_of(folder / "more" / "scans" / entry.path().filename()))
        << entry.path();

  expect_replays(folder / "one");
}

TEST(RecordedScans, OfALidarWithoutRingsReplayAndAreExported) {
  const fs::path folder = fresh_folder("recorded_scans_without_rings");
  ASSERT_EQ(
      run_karst(flight(folder / "mid360", "--set record.scans=true --set simulator.lidar.unit=mid360", "30s"))
          .code,
      0);
  EXPECT_GT(scans_in(folder / "mid360" / "scans"), 80u);
  expect_replays(folder / "mid360");
}

}  // namespace
}  // namespace karst
