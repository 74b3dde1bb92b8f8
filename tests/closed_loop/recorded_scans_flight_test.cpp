// A flight with record.scans: the same flight, and a recording of it that replays and is exported.
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

std::string flight(const fs::path& run, const std::string& options) {
  return "fly --cave " + generated_cave("small", 7) +
         " --quiet --no-report --set mission.max_flight_time=40s --out " + run.string() + " " + options;
}

std::size_t scans_in(const fs::path& folder) {
  std::size_t scans = 0;
  for (const auto& entry : fs::directory_iterator(folder))
    scans += entry.path().extension() == ".pcd" ? 1 : 0;
  return scans;
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

  // The recording, replayed, gives the trajectory of the flight, within the drift of its odometry.
  const Output replayed =
      run_karst("replay " + (folder / "one" / "scans").string() + " --out " + (folder / "replayed").string());
  ASSERT_EQ(replayed.code, 0) << replayed.text;
  const Output errors = run_karst("evaluate " + (folder / "replayed").string() + " --truth " +
                                  (folder / "one" / "ground_truth.tum").string());
  ASSERT_EQ(errors.code, 0) << errors.text;
  const auto evaluation = nlohmann::json::parse(bytes_of(folder / "replayed" / "evaluation.json"));
  EXPECT_LT(evaluation.at("trajectory").at("ape").at("translation_m").at("rmse").get<double>(), 0.05)
      << evaluation.dump(1);

  // Exported, each scan is a message.
  const Output exported =
      run_karst("export " + (folder / "one").string() + " --json --mcap " + (folder / "one.mcap").string());
  ASSERT_EQ(exported.code, 0) << exported.text;
  std::size_t points = 0;
  const auto summary = nlohmann::json::parse(exported.text);
  for (const auto& topic : summary.at("topics"))
    if (topic.at("topic") == "/points") points = topic.at("messages");
  EXPECT_EQ(points, scans_in(folder / "one" / "scans"));
}

}  // namespace
}  // namespace karst
