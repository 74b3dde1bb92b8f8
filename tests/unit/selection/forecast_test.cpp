#include "sdk/selection/forecast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "sdk/selection/select_words.h"
#include "tests/unit/selection/experiences.h"

namespace {

using namespace karst::selection;

/// One cave of 200 m in which one contestant flew 300 s at 1.5 m/s with 270 W.
Experience one_cave() {
  Experience e;
  e.conditions = {karst::test::condition()};
  e.conditions[0].mission = {{"motion.max_speed", "2 m/s"}};
  e.contestants.push_back({"near", "near", "1.0.0", {}});
  e.caves.push_back({"known", karst::test::cave_figures(0, 0.1)});
  e.caves[0].figures.length_m = 200;
  lay_out(e, all_sites(e));
  const std::vector<std::pair<std::string, double>> figures{
      {"coverage", 0.8},      {"restricted_t50_s", 100},    {"restricted_t90_s", 300},
      {"path_length_m", 450}, {"exploring_speed_mps", 1.5}, {"energy_wh", 22.5}};
  for (const auto& [name, value] : figures)
    e.at(0, 0,
         static_cast<std::size_t>(std::find(e.metrics.begin(), e.metrics.end(), name) -
                                  e.metrics.begin())) = {6, value, 0};
  return e;
}

Selected by_that_cave() {
  Selected s;
  s.near.push_back({0, {}, 1});
  s.weights = {{1}, {1}};
  return s;
}

CaveFigures cave_of(double length_m) {
  CaveFigures f;
  f.length_m = length_m;
  return f;
}

/// 40 s of it for the way home and the reserve.
FlightTime flight_of(double endurance_s) { return {endurance_s, endurance_s - 40, endurance_s - 25, 5, 2}; }

Forecast forecast_of(double length_m, double endurance_s) {
  return forecast(one_cave(), cave_of(length_m), by_that_cave(), 0, flight_of(endurance_s));
}

TEST(Forecast, OfTheSameFlightInTheSameCaveIsWhatWasFound) {
  const Forecast f = forecast_of(200, 300);
  EXPECT_NEAR(f.coverage, 0.8, 1e-12);
  EXPECT_NEAR(f.flight_s, 275, 1e-12);
  EXPECT_NEAR(f.path_m, 1.5 * 270, 1e-9);
  EXPECT_NEAR(f.energy_wh, 22.5 * 275 / 300, 1e-9);
}

TEST(Forecast, HalfTheCaveTakesHalfTheTime) {
  EXPECT_NEAR(forecast_of(100, 90).coverage, 0.5, 1e-12) << "50 s, as 100 s in the known one";
  EXPECT_NEAR(forecast_of(200, 90).coverage, 0.25, 1e-12);
  EXPECT_NEAR(forecast_of(400, 240).coverage, 0.5, 1e-12);
}

// 398 m and 21 Wh were expected of every flight.
TEST(Forecast, NoFlightIsLongerThanItsTime) {
  const Forecast f = forecast_of(200, 60);
  EXPECT_NEAR(f.flight_s, 35, 1e-12);
  EXPECT_LE(f.path_m, 2 * 35);
  EXPECT_NEAR(f.energy_wh, 22.5 * 35 / 300, 1e-9);
  EXPECT_LT(f.coverage, 0.2);
}

TEST(Forecast, OfASmallCaveTheFlightEndsWhenItIsCovered) {
  const Forecast f = forecast_of(20, 600);
  EXPECT_GT(f.coverage, 0.99);
  EXPECT_LT(f.flight_s, 120);
  EXPECT_LT(f.energy_wh, 10);
}

TEST(Forecast, GrowsWithTheTimeAndShrinksWithTheCave) {
  double last = 0;
  for (const double time_s : {60, 120, 240, 300, 600, 1200}) {
    const double coverage = forecast_of(300, time_s).coverage;
    EXPECT_GT(coverage, last);
    EXPECT_LE(coverage, 1);
    EXPECT_LT(forecast_of(600, time_s).coverage, coverage);
    last = coverage;
  }
}

TEST(Forecast, ASlowerVehicleTakesLonger) {
  FlightTime slow = flight_of(140);
  slow.max_speed_mps = 1;
  const Forecast f = forecast(one_cave(), cave_of(200), by_that_cave(), 0, slow);
  EXPECT_NEAR(f.coverage, 0.25, 1e-12) << "100 s, as 50 s of the known flights";
  EXPECT_NEAR(f.path_m, 0.75 * 110, 1e-9);
}

TEST(Forecast, WithoutFlightsNothingIsExpected) {
  Experience e = one_cave();
  for (Fared& f : e.fared) f = {};
  EXPECT_TRUE(std::isnan(forecast(e, cave_of(200), by_that_cave(), 0, flight_of(300)).coverage));
}

// "confidence 100 %" stood beside intervals that overlapped.
TEST(SelectWords, ConfidenceIsSaidWithCaution) {
  const Experience e = karst::test::experience(6, 0.3, 0.02, 1);
  Selected s;
  s.ranking = {{0, 0.7, 0.4, 1.0, 6}, {1, 0.6, 0.3, 0.9, 6}};
  s.confidence = 1;
  EXPECT_EQ(
      confidence_in_words(e, s),
      "first in >99 % of 1000 resamplings of the earlier flights; its interval overlaps that of level, so "
      "either may do better in this cave");
  s.ranking = {{0, 0.7, 0.65, 0.75, 6}, {1, 0.6, 0.55, 0.62, 6}};
  s.confidence = 0.8;
  EXPECT_EQ(confidence_in_words(e, s), "first in 80 % of 1000 resamplings of the earlier flights");
}

TEST(SelectWords, TheReasonSaysThatLikenessToldNothing) {
  Experience e = karst::test::experience(6, 0.3, 0.02, 1);
  Selected s = select(e, karst::test::cave_figures(0, 0.4), {}, "cave");
  s.refused = false;
  s.fit.kernel.bandwidth = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(likeness_tells_nothing(s));
  EXPECT_NE(why_first(e, s, {}).find("did not foretell which policy is best"), std::string::npos);
  EXPECT_EQ(why_first(e, s, {}).find("confidence"), std::string::npos);
}

}  // namespace
