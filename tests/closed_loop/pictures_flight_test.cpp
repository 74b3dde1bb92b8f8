// Flights with the colour camera: pictures, the account of them, and the policy that is after them.
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"

namespace karst {
namespace {

std::string flight(const std::filesystem::path& run, const std::string& options) {
  return "fly --cave " + generated_cave("small", 7) + " --set simulator.rgb.fitted=true --quiet --out " +
         run.string() + " " + options;
}

TEST(Pictures, AreTheSameOnAnyThreadsAndLeaveTheFlightAsItIs) {
  const auto folder = fresh_folder("pictures_threads");
  const std::string common = "--no-report --set mission.max_flight_time=25s ";
  ASSERT_EQ(run_karst(flight(folder / "one", common + "--threads 1 --set simulator.rgb.pictures=true")).code,
            0);
  ASSERT_EQ(run_karst(flight(folder / "more", common + "--threads 4 --set simulator.rgb.pictures=true")).code,
            0);
  ASSERT_EQ(run_karst(flight(folder / "none", common)).code, 0);
  std::size_t pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "one" / "frames")) {
    ++pictures;
    EXPECT_EQ(bytes_of(entry.path()), bytes_of(folder / "more" / "frames" / entry.path().filename()))
        << entry.path();
  }
  EXPECT_GT(pictures, 8u);
  EXPECT_EQ(bytes_of(folder / "one" / "frames.csv"), bytes_of(folder / "more" / "frames.csv"));
  for (const char* same : {"trajectory.tum", "ground_truth.tum", "ground_truth_frames.csv", "events.jsonl"})
    EXPECT_EQ(bytes_of(folder / "one" / same), bytes_of(folder / "none" / same)) << same;
  EXPECT_FALSE(std::filesystem::exists(folder / "none" / "frames"));
}

TEST(Pictures, TheirPosesAreTheCoresAndTheReportShowsThem) {
  const auto run = fresh_folder("pictures_report") / "run";
  ASSERT_EQ(
      run_karst(flight(run, "--set mission.max_flight_time=40s --set simulator.rgb.pictures=true")).code, 0);
  std::istringstream frames(bytes_of(run / "frames.csv")), truth(bytes_of(run / "ground_truth_frames.csv"));
  std::string line;
  std::getline(frames, line), std::getline(truth, line);
  std::map<std::string, std::array<double, 3>> true_place;
  while (std::getline(truth, line)) {
    std::array<double, 3> p{};
    const auto comma = line.find(',');
    std::sscanf(line.c_str() + comma + 1, "%lf,%lf,%lf", &p[0], &p[1], &p[2]);
    true_place[line.substr(0, comma)] = p;
  }
  std::size_t rows = 0;
  double off = 0;
  bool exact = true;
  while (std::getline(frames, line)) {
    const auto comma = line.find(','), second = line.find(',', comma + 1);
    const std::string stamp = line.substr(0, comma), file = line.substr(comma + 1, second - comma - 1);
    EXPECT_TRUE(std::filesystem::exists(run / file)) << file;
    std::array<double, 3> p{};
    std::sscanf(line.c_str() + second + 1, "%lf,%lf,%lf", &p[0], &p[1], &p[2]);
    ASSERT_TRUE(true_place.count(stamp)) << stamp;
    const auto& t = true_place[stamp];
    const double d = std::hypot(p[0] - t[0], p[1] - t[1], p[2] - t[2]);
    off = std::max(off, d);
    exact &= d < 1e-4;
    ++rows;
  }
  EXPECT_GT(rows, 25u);  // two a second
  EXPECT_LT(off, 0.5) << "the estimate is near the truth";
  EXPECT_FALSE(exact) << "and is not the truth";
  const std::string page = bytes_of(run / "report.html");
  EXPECT_NE(page.find("\"pictures\":{\"taken\""), std::string::npos);
  EXPECT_LT(page.size(), 12u << 20);
  const auto m = nlohmann::json::parse(bytes_of(run / "metrics.json"));
  EXPECT_GT(m["surface_imaged"].get<double>(), 0.02);
  EXPECT_LE(m["surface_imaged"].get<double>(), 1.0);
}

/// Halls of which a LiDAR knows all long before a camera does.
TEST(SurfaceCoverage, SeesMoreOfTwoHallsThanTheNearestFrontierDoes) {
  const auto folder = fresh_folder("surface_coverage");
  const std::string cave = draw_cave(
      folder, {{{-5, -5, 0}, {5, 5, 5}}, {{5, -2, 0}, {11, 2, 3}}, {{11, -5, 0}, {19, 5, 5}}}, {0, 0, 1});
  std::map<std::string, double> imaged;
  for (const char* policy : {"nearest_frontier", "surface_coverage"}) {
    const auto run = folder / policy;
    const Output out = run_karst("fly --cave " + cave +
                                 " --set simulator.rgb.fitted=true --set simulator.pose.fitted=always"
                                 " --set localization.source=pose_sensor --set mission.max_flight_time=80s"
                                 " --quiet --no-report --out " +
                                 run.string() + " --policy " + policy);
    EXPECT_EQ(out.code, 0) << out.text;
    const auto m = nlohmann::json::parse(bytes_of(run / "metrics.json"));
    EXPECT_EQ(m["outcome"], "landed");
    EXPECT_EQ(m["contacts"], 0);
    imaged[policy] = m["surface_imaged"].get<double>();
  }
  EXPECT_GT(imaged["surface_coverage"], imaged["nearest_frontier"] + 0.2);
}

}  // namespace
}  // namespace karst
