// Flights in dust and droplets: what the filters remove and what they lose, and a cloud that has to be flown
// through.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/perception/intensity_filter.h"
#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"
#include "tests/closed_loop/labelled_scans.h"

namespace karst {
namespace {

using test::BadAir;
using test::FilterFigures;

BadAir haze(const char* name, double extinction_1pm, double reflectivity = 0.5) {
  BadAir b{name, {}, 0, reflectivity};
  b.air.haze_1pm = extinction_1pm;
  return b;
}
BadAir mist(const char* name, double extinction_1pm) {
  BadAir b{name, {}, 0, 0.5};
  b.air.mist_1pm = extinction_1pm;
  b.air.mist_radius_m = 1.5;
  return b;
}

/// Bounds for the rule that is the default: least share of the false returns removed, greatest share of the
/// true ones lost.
struct Case {
  BadAir air;
  double removed, lost;
};

std::vector<Case> cases() {
  BadAir stirred{"stirred 1/m", {}, 0, 0.5};
  stirred.air.stirred_1pm = 1;
  return {{{"clear air", {}, 0, 0.5}, 0, 0.08},
          {haze("haze 0.03/m", 0.03), 0.97, 0.08},
          {haze("haze 0.1/m", 0.1), 0.97, 0.08},
          {haze("haze 0.3/m", 0.3), 0.97, 0.12},
          {haze("haze 0.1/m, dark rock", 0.1, 0.08), 0.97, 0.12},
          {mist("mist 0.1/m", 0.1), 0.97, 0.1},
          {mist("mist 0.4/m", 0.4), 0.97, 0.2},
          {stirred, 0.95, 0.08},
          {{"clouds 0.2/m", {}, 0.2, 0.5}, 0.97, 0.08},
          {{"clouds 0.6/m", {}, 0.6, 0.5}, 0.95, 0.1},
          {{"clouds 0.3/m, dark rock", {}, 0.3, 0.08}, 0.95, 0.1}};
}

/// The rule and its defaults were chosen on flights through small7; these caves are others.
class DustFilter : public ::testing::TestWithParam<const char*> {};

TEST_P(DustFilter, RemovesWhatIsFalseAndKeepsWhatIsTrueOnFlightsItWasNotTunedOn) {
  sim::LidarOptions unit;
  unit.unit = GetParam();
  unit.columns = unit.unit == "os1_64" ? 1024 : 512;
  const sim::Lidar lidar(unit);
  std::vector<std::pair<cave::Cave, std::vector<core::Pose>>> flights;
  for (const auto& [preset, seed] : {std::pair{"small", 9}, std::pair{"tight", 5}, std::pair{"maze", 2}}) {
    const std::string cave = generated_cave(preset, seed);
    const auto run = fresh_folder(std::string("dust_") + GetParam() + "_" + preset) / "run";
    const Output out =
        run_karst("fly --cave " + cave + " --set mission.max_flight_time=60s --quiet --no-report --out " +
                  run.string());
    ASSERT_EQ(out.code, 0) << out.text;
    flights.emplace_back(cave::load_cave(cave, ""), test::poses_of(run.string(), 4));
    ASSERT_GT(flights.back().second.size(), 5u);
  }
  std::printf("%-24s false returns |  percentile 1.5 m   |   percentile 15 m   |       lonely\n", GetParam());
  std::printf("%-24s  %% of returns |  removed    rock lost |  removed   rock lost |  removed   rock lost\n",
              "");
  for (const Case& c : cases()) {
    std::vector<test::LabelledScan> scans;
    for (const auto& [cave, poses] : flights) {
      const auto more = test::scans_in(c.air, cave, lidar, poses);
      scans.insert(scans.end(), more.begin(), more.end());
    }
    const FilterFigures paper = test::judge(
                            scans, [](core::LidarScan&s) { core::drop_weakest_returns(s, 10, 1.5); }),
                        wide = test::judge(scans,
                                           [](core::LidarScan&s) { core::drop_weakest_returns(s, 10, 15); }),
                        lonely =
                            test::judge(scans, [](core::LidarScan&s) { core::filter_low_intensity(s, {}); });
    std::printf("%-24s %13.2f | %8.1f %10.2f | %8.1f %10.2f | %8.1f %10.2f\n", c.air.name.c_str(),
                100 * paper.dust_fraction, 100 * paper.removed, 100 * paper.rock_lost, 100 * wide.removed,
                100 * wide.rock_lost, 100 * lonely.removed, 100 * lonely.rock_lost);
    EXPECT_GE(lonely.removed, c.removed) << c.air.name;
    EXPECT_LE(lonely.rock_lost, c.lost) << c.air.name;
    if (c.air.name == "clear air") continue;
    EXPECT_GT(paper.dust_fraction, 0.001) << c.air.name << " holds no dust to speak of";
    EXPECT_GE(lonely.removed, paper.removed - 0.01) << c.air.name;
  }
}
INSTANTIATE_TEST_SUITE_P(Units, DustFilter, ::testing::Values("os0_32", "os1_64"));

/// Two rooms, and a cloud of droplets in the corridor between them. Visibility in it is 15 m.
class DenseCloud : public ::testing::Test {
 protected:
  /// How far east the vehicle came; the far room begins at 20 m.
  double fly(const std::string& rule) {
    const auto folder = fresh_folder("flight_cloud_" + rule);
    const std::string cave = draw_cave(
        folder, {{{-4, -4, 0}, {4, 4, 4}}, {{4, -1.6, 0}, {20, 1.6, 3.2}}, {{20, -5, 0}, {30, 5, 5}}},
        {0, 0, 1});
    std::ofstream(cave, std::ios::app)
        << "cloud { position \"11 0 1.5\" radius \"2 m\" extinction \"0.2 1/m\" of droplets }\n";
    const auto run = folder / "run";
    const Output out =
        run_karst("fly --cave " + cave + " --set perception.rule=" + rule +
                  " --set mission.max_flight_time=90s --quiet --no-report --out " + run.string());
    const auto metrics = nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false);
    EXPECT_TRUE(metrics.is_object()) << out.text;
    EXPECT_EQ(metrics["outcome"], "landed");
    EXPECT_EQ(metrics["contacts"], 0);
    coverage = metrics["coverage"].get<double>();
    double farthest_m = 0;
    for (const core::Pose& p : test::poses_of(run.string(), 0.2))
      farthest_m = std::max(farthest_m, p.position.x());
    std::printf("rule %-10s: came as far as x = %.1f m, coverage %.2f\n", rule.c_str(), farthest_m, coverage);
    return farthest_m;
  }
  double coverage = 0;
};

TEST_F(DenseCloud, WithoutAFilterItIsAWall) {
  EXPECT_LT(fly("none"), 9) << "the cloud begins there";
  EXPECT_LT(coverage, 0.7);
}
TEST_F(DenseCloud, WithTheFilterTheVehicleFliesThroughIt) {
  EXPECT_GT(fly("lonely"), 21) << "the far room begins at 20 m";
  EXPECT_GT(coverage, 0.9);
}

}  // namespace
}  // namespace karst
