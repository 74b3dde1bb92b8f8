#include <gtest/gtest.h>

#include <karst/testing/bench.h>

#include <cmath>

namespace {

using karst::testing::Bench;
using karst::testing::DrawnMap;

// North is up: flying east from s, e is ahead, n to the left, o to the right, w behind.
DrawnMap crossing() {
  return {1.0, {R"(
    ....n....
    .........
    .........
    .........
    w...s...e
    .........
    .........
    .........
    ....o....)"}};
}

std::uint32_t choice(const std::string& side, const karst::Vec3& flight) {
  const DrawnMap map = crossing();
  Bench bench(karst_plugin_entry(), map, {{"side", side}});
  bench.position = map.place('s');
  bench.direction_of_flight = flight;
  for (const char c : {'n', 'e', 'o', 'w'})
    bench.offer(static_cast<std::uint32_t>(c), map.place(c), map.place(c));
  return bench.decide().goals.at(0).frontier_id;
}

TEST(LateralFrontier, AheadKeepsTheHorizontalDirection) {
  EXPECT_EQ(choice("ahead", {1, 0, 0}), std::uint32_t{'e'});
  EXPECT_EQ(choice("ahead", {0, 1, 0}), std::uint32_t{'n'});
  EXPECT_EQ(choice("ahead", {-1, 0, 0}), std::uint32_t{'w'});
}

TEST(LateralFrontier, TheVerticalPartOfTheFlightDoesNotCount) {
  EXPECT_EQ(choice("ahead", {0.1, 0, 0.995}), std::uint32_t{'e'});
}

TEST(LateralFrontier, LeftAndRightAreAcrossTheFlight) {
  EXPECT_EQ(choice("left", {1, 0, 0}), std::uint32_t{'n'});
  EXPECT_EQ(choice("right", {1, 0, 0}), std::uint32_t{'o'});
  EXPECT_EQ(choice("left", {0, 1, 0}), std::uint32_t{'w'});
  EXPECT_EQ(choice("right", {0, 1, 0}), std::uint32_t{'e'});
}

TEST(LateralFrontier, SidewaysTakesEitherSideAndNotAheadOrBehind) {
  const std::uint32_t id = choice("sideways", {1, 0, 0});
  EXPECT_TRUE(id == 'n' || id == 'o') << id;
}

TEST(LateralFrontier, TurnsBackWhenNothingElseIsLeft) {
  const DrawnMap map = crossing();
  Bench bench(karst_plugin_entry(), map);
  bench.position = map.place('s');
  bench.offer(1, map.place('w'), map.place('w'));
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 1u);
}

TEST(LateralFrontier, RotatingTheWorldRotatesTheChoice) {
  // The angle to a frontier d off the flight is d, wherever the flight goes.
  const DrawnMap map = crossing();
  for (int k = 0; k < 16; ++k) {
    const double flight = 0.3925 * k;
    Bench bench(karst_plugin_entry(), map, {{"path_weight", "0"}, {"horizon", "1000"}});
    bench.position = map.place('s');
    bench.direction_of_flight = {std::cos(flight), std::sin(flight), 0};
    for (int i = 0; i < 7; ++i) {
      const double bearing = flight + 0.2 + 0.4 * i;
      bench.offer(static_cast<std::uint32_t>(i + 1), map.place('e'),
                  bench.position + karst::Vec3(3 * std::cos(bearing), 3 * std::sin(bearing), 0));
    }
    const karst::Decision d = bench.decide();
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(d.goals.at(i).frontier_id, i + 1) << "flight " << flight;
  }
}

}  // namespace
