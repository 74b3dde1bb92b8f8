#include "core_stack/common/rounded.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/common/json_point.h"

namespace karst::core {
namespace {

TEST(Rounded, IsTheNearestMultiple) {
  EXPECT_EQ(to_hundredths(1.237), 1.24);
  EXPECT_EQ(to_thousandths(-1.2371), -1.237);
  EXPECT_EQ(to_millionths(1e-6 / 3), 0);
  EXPECT_EQ(rounded(7.3, 2), 7.5);
}

TEST(Rounded, ZeroHasNoSign) {
  for (const double v : {-0.0, -1e-9}) {
    EXPECT_FALSE(std::signbit(to_hundredths(v)));
    EXPECT_FALSE(std::signbit(to_thousandths(v)));
    EXPECT_FALSE(std::signbit(to_millionths(v)));
  }
}

TEST(JsonPoint, HoldsTheCoordinatesAndNoNegativeZero) {
  EXPECT_EQ(list(Vec3(1.25, -0.0, -3)).dump(), "[1.25,0.0,-3.0]");
  EXPECT_EQ(list(std::vector<Vec3>{{-0.0, 1, 2}, {3, 4, -0.0}}).dump(), "[[0.0,1.0,2.0],[3.0,4.0,0.0]]");
  EXPECT_EQ(rounded_list(Vec3(-1e-5, 0.12345, -0.0)).dump(), "[0.0,0.123,0.0]");
}

}  // namespace
}  // namespace karst::core
