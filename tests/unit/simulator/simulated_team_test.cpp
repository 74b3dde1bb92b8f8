#include "plugins/simulator/simulated_team.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "meshes.h"

namespace karst::test {
namespace {

TEST(StartPlaces, AreApartOnTheFloorAndInSight) {
  const cave::Cave c = make_cave(box_mesh({-4, -4, 0}, {4, 4, 3}), {0, 0, 1});
  const auto places = sim::start_places(c, 10, 0.3, 0.7);
  ASSERT_EQ(places.size(), 10u);
  EXPECT_EQ(places[0].position, Vec3(0, 0, 1)) << "robot 1 starts where one alone would";
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_LT(places[i].position.cwiseAbs().head<2>().maxCoeff(), 3.5);
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GE((places[i].position - places[k].position).norm(), 1.5 - 1e-9) << i << ' ' << k;
  }
}

TEST(StartPlaces, WhereThereIsNoRoomSaySo) {
  const cave::Cave c = make_cave(box_mesh({-1, -1, 0}, {1, 1, 3}), {0, 0, 1});
  try {
    sim::start_places(c, 5, 0.3, 0.7);
    FAIL() << "five vehicles in a shaft of two metres";
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("not for 5"), std::string::npos) << e.what();
  }
}

TEST(Fallen, ANodeFliesOnAsItFalls) {
  const cave::Cave c = make_cave(box_mesh({-4, -4, 0}, {4, 4, 3}), {0, 0, 1});
  const auto antenna = sim::fallen(c.scene, {0, 0, 2}, {1.5, 0, 0});
  ASSERT_TRUE(antenna);
  EXPECT_NEAR(antenna->x(), 1.5 * std::sqrt(2 * 2 / 9.81), 0.06);
  EXPECT_NEAR(antenna->y(), 0, 1e-9);
  EXPECT_NEAR(antenna->z(), 0.3, 0.03);
  const auto at_the_wall = sim::fallen(c.scene, {3.8, 0, 2}, {1.5, 0, 0});
  ASSERT_TRUE(at_the_wall);
  EXPECT_LT(at_the_wall->x(), 4);
  EXPECT_FALSE(sim::fallen(c.scene, {0, 0, -1}, {0, 0, 0})) << "below the cave there is nothing";
}

RC_GTEST_PROP(Touched, IsWhatSmallStepsFind, ()) {
  const auto place = [] {
    const auto c = [] { return 0.01 * *rc::gen::inRange(-200, 200); };
    return Vec3(c(), c(), c());
  };
  const Vec3 a0 = place(), a1 = place(), b0 = place(), b1 = place();
  double least = 1e9;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    least = std::min(least, ((a0 + t * (a1 - a0)) - (b0 + t * (b1 - b0))).norm());
  }
  const double step = ((a1 - a0) - (b1 - b0)).norm() / kSteps;  // between samples it gets no nearer than that
  RC_ASSERT(sim::touched(a0, a1, b0, b1, least + 1e-9));
  RC_ASSERT(!sim::touched(a0, a1, b0, b1, least - step - 1e-9));
}

}  // namespace
}  // namespace karst::test
