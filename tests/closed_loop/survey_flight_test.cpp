// From a survey to a cave to a flight, by the commands alone.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sdk/survey/read_survey.h"
#include "tests/closed_loop/command.h"
#include "tests/unit/survey/skip_without_survex.h"

namespace karst {
namespace {

TEST(SurveyFlight, ACaveMadeOfASurveyIsFlownAndLandedIn) {
  SKIP_WITHOUT_SURVEX();
  const auto folder = fresh_folder("survey_flight");
  std::ofstream(folder / "cave.th")
      << "survey cave\n  centreline\n    station 0 \"\" entrance\n"
         "    data normal from to tape compass clino left right up down\n"
         "    0 1 8 90 0 2 2 2 1\n    1 2 8 60 0 2 2 2 1\n    2 3 8 90 5 2 2 2 1\n"
         "    3 4 4 90 0 2 2 2 1\n"
         "  endcentreline\nendsurvey\n";
  const std::string out = (folder / "cave").string();
  const Output made = run_karst("cave from-survey " + out + ".th --out " + out);
  ASSERT_EQ(made.code, 0) << made.text;
  const Output info = run_karst("cave info " + out + ".info");
  EXPECT_EQ(info.code, 0) << info.text;
  EXPECT_TRUE(info.says("closed             yes")) << info.text;
  const Output flown = run_karst("fly --cave " + out +
                                 ".info --policy nearest_frontier --seed 1 --quiet "
                                 "--no-report --set mission.max_flight_time=60s --out " +
                                 (folder / "run").string());
  const auto m = nlohmann::json::parse(bytes_of(folder / "run" / "metrics.json"), nullptr, false);
  ASSERT_TRUE(m.is_object()) << flown.text;
  EXPECT_EQ(m["outcome"], "landed") << flown.text;
  EXPECT_EQ(m["contacts"], 0);
}

/// Bends of 30 to 60 degrees, a loop of four legs, and a branch; 4 m wide, 3 m high, stations in the middle.
const char* const kLoopCave =
    "survey cave\n  centreline\n    fix 0 0 0 0\n    station 0 \"\" entrance\n"
    "    data normal from to tape compass clino left right up down\n"
    "    0 1 9 90 0 2 2 1.5 1.5\n    1 2 9 50 4 2 2 1.5 1.5\n    2 3 10 90 0 2 2 1.5 1.5\n"
    "    3 4 12 20 0 2 2 1.5 1.5\n    4 5 14 110 0 2 2 1.5 1.5\n    5 6 12 200 0 2 2 1.5 1.5\n"
    "    6 3 14 290 0 2 2 1.5 1.5\n    3 7 9 180 -3 2 2 1.5 1.5\n    7 8 8 215 0 2 2 1.5 1.5\n"
    "  endcentreline\nendsurvey\n";

double distance_m(const core::Vec3& p, const survey::Survey& s, const survey::Leg& leg) {
  const core::Vec3 &a = s.stations[leg.from].position_m, &b = s.stations[leg.to].position_m;
  const double part = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - part * (b - a)).norm();
}
double distance_m(const core::Vec3& p, const survey::Survey& s) {
  double least_m = 1e9;
  for (const survey::Leg& leg : s.legs) least_m = std::min(least_m, distance_m(p, s, leg));
  return least_m;
}
/// Half metres of all legs, but for the last 2 m of passages that end.
std::vector<core::Vec3> places_on(const survey::Survey& s) {
  std::vector<int> legs_at(s.stations.size());
  for (const survey::Leg& leg : s.legs) {
    ++legs_at[leg.from];
    ++legs_at[leg.to];
  }
  std::vector<core::Vec3> places;
  for (const survey::Leg& leg : s.legs) {
    const core::Vec3 &a = s.stations[leg.from].position_m, &b = s.stations[leg.to].position_m;
    const double length_m = (b - a).norm();
    for (double at_m = 0; at_m <= length_m; at_m += 0.5)
      if ((legs_at[leg.from] > 1 || at_m > 2) && (legs_at[leg.to] > 1 || length_m - at_m > 2))
        places.emplace_back(a + at_m / length_m * (b - a));
  }
  return places;
}

/// Cosine of the angle between a section's facing and the level direction of a leg at its station: left and
/// right are measured across the bisector of a bend, and there the passage is wider than across a leg.
double along_leg(const survey::Survey& s, const survey::Section& section) {
  double most = 0;
  for (const survey::Leg& leg : s.legs) {
    if (leg.from != section.station && leg.to != section.station) continue;
    core::Vec3 along = s.stations[leg.to].position_m - s.stations[leg.from].position_m;
    along.z() = 0;
    most = std::max(most, std::abs(along.normalized().dot(section.facing)));
  }
  return most;
}

TEST(SurveyFlight, ThereAndBackTheSurveyIsTheSame) {
  SKIP_WITHOUT_SURVEX();
  const auto folder = fresh_folder("survey_there_and_back");
  std::ofstream(folder / "cave.th") << kLoopCave;
  const std::string cave = (folder / "cave").string(), run = (folder / "run").string();
  const Output made = run_karst("cave from-survey " + cave + ".th --out " + cave);
  ASSERT_EQ(made.code, 0) << made.text;
  const Output flown = run_karst("fly --cave " + cave +
                                 ".info --policy information_gain --seed 1 --quiet "
                                 "--no-report --set mission.max_flight_time=200s --out " +
                                 run);
  const auto m = nlohmann::json::parse(bytes_of(folder / "run" / "metrics.json"), nullptr, false);
  ASSERT_TRUE(m.is_object()) << flown.text;
  ASSERT_EQ(m["outcome"], "landed") << flown.text;
  ASSERT_EQ(m["contacts"], 0);
  const Output exported = run_karst("export " + run + " --survey " + (folder / "back").string());
  ASSERT_EQ(exported.code, 0) << exported.text;

  const survey::Survey source = survey::read_survey(cave + ".th"),
                       back = survey::read_survey((folder / "back.svx").string());
  EXPECT_EQ(back.loops.count, 1u);
  std::vector<double> off_m;
  for (const core::Vec3& p : places_on(source)) off_m.push_back(distance_m(p, back));
  for (const core::Vec3& p : places_on(back)) off_m.push_back(distance_m(p, source));
  std::sort(off_m.begin(), off_m.end());
  EXPECT_LT(off_m[off_m.size() / 2], 0.12) << exported.text;
  EXPECT_LT(off_m[off_m.size() * 95 / 100], 0.3);
  EXPECT_LT(off_m.back(), 0.7);

  double squares_m2 = 0;
  std::size_t measured = 0;
  for (const survey::Section& s : back.sections) {
    const survey::Dimensions& d = s.dimensions;
    const auto add = [&](double expected_m, const std::optional<double>& a, const std::optional<double>& b) {
      if (!a || !b) return;
      squares_m2 += (*a + *b - expected_m) * (*a + *b - expected_m);
      ++measured;
    };
    add(4 / along_leg(back, s), d.left_m, d.right_m);
    add(3, d.up_m, d.down_m);
  }
  EXPECT_GT(measured, 20u);
  EXPECT_LT(std::sqrt(squares_m2 / static_cast<double>(measured)), 0.4);
}

}  // namespace
}  // namespace karst
