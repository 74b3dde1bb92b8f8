#include "sdk/survey/therion_units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace karst::survey {
namespace {

TEST(TherionUnits, NumbersAreReadWithTheirSpecialValues) {
  EXPECT_EQ(number_of("12.5"), 12.5);
  EXPECT_EQ(number_of("+.5"), 0.5);
  EXPECT_EQ(number_of("-3"), -3);
  EXPECT_TRUE(std::isnan(*number_of("-")));
  EXPECT_TRUE(std::isnan(*number_of(".")));
  EXPECT_EQ(number_of("up"), kUp);
  EXPECT_EQ(number_of("Down"), -kUp);
  for (const char* none : {"", "1e", "12m", "1,5", "0x10", "--1", "1e999"})
    EXPECT_FALSE(number_of(none)) << none;
}

TEST(TherionUnits, DegreesMayHaveMinutesAndSeconds) {
  EXPECT_DOUBLE_EQ(*degrees_of("46:6:16.3"), 46 + 6 / 60.0 + 16.3 / 3600);
  EXPECT_DOUBLE_EQ(*degrees_of("-0:30"), -0.5);
  EXPECT_DOUBLE_EQ(*degrees_of("12.25"), 12.25);
  for (const char* none : {"1:2:3:4", "1:-2", "a:1"}) EXPECT_FALSE(degrees_of(none)) << none;
}

TEST(TherionUnits, UnitsHaveTheirLengths) {
  EXPECT_DOUBLE_EQ(*metres_of_unit("feet"), 0.3048);
  EXPECT_DOUBLE_EQ(*metres_of_unit("inches") * 12, 0.3048);
  EXPECT_DOUBLE_EQ(*metres_of_unit("yd"), 0.9144);
  EXPECT_DOUBLE_EQ(*metres_of_unit("centimetres"), 0.01);
  EXPECT_FALSE(metres_of_unit("furlongs"));
}

TEST(TherionUnits, AQuarterTurnInEachUnitOfAngle) {
  EXPECT_DOUBLE_EQ(AngleScale{*angle_unit("grads")}.degrees(100), 90);
  EXPECT_DOUBLE_EQ(AngleScale{*angle_unit("mils")}.degrees(1600), 90);
  EXPECT_DOUBLE_EQ(AngleScale{*angle_unit("minutes")}.degrees(5400), 90);
  EXPECT_DOUBLE_EQ(AngleScale{*angle_unit("percent")}.degrees(100), 45);
  EXPECT_FALSE(angle_unit("turns"));
}

TEST(TherionUnits, ACalibrationIsAZeroErrorAScaleOrATable) {
  EXPECT_DOUBLE_EQ(calibration_of({"0.5"}, 0).calibration.corrected(10), 9.5);
  EXPECT_DOUBLE_EQ(calibration_of({"0.5", "2"}, 0).calibration.corrected(10), 19);
  const Calibration table = calibration_of({"0", "1", "10", "21"}, 0).calibration;
  EXPECT_DOUBLE_EQ(table.corrected(5), 11);
  EXPECT_DOUBLE_EQ(table.corrected(-3), 1);
  EXPECT_DOUBLE_EQ(table.corrected(99), 21);
  EXPECT_FALSE(calibration_of({"1", "0"}, 0).error.empty());
  EXPECT_FALSE(calibration_of({"1", "2", "3"}, 0).error.empty());
  EXPECT_FALSE(calibration_of({"x"}, 0).error.empty());
}

TEST(TherionUnits, DatesAreYearsWithAFraction) {
  EXPECT_DOUBLE_EQ(years_of({"1975"}, 0)->middle(), 1975.5);
  EXPECT_NEAR(years_of({"1975.08.08"}, 0)->middle(), 1975 + 219 / 365.25, 1e-9);
  EXPECT_NEAR(years_of({"1975.08.08@10:30"}, 0)->middle(), 1975 + 219 / 365.25, 1e-9);
  EXPECT_NEAR(years_of({"2000", "-", "2002"}, 0)->middle(), 2001.5, 1e-9);
  for (const char* none : {"75.13.1", "soon", "1975.8.32", "2002-2000"})
    EXPECT_FALSE(years_of({none}, 0)) << none;
}

}  // namespace
}  // namespace karst::survey
