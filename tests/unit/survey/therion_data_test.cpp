// Rows of readings against closed forms.
#include <cmath>
#include <numbers>

#include "tests/unit/survey/survey_files.h"

namespace karst::survey {
namespace {

using core::Vec3;
using test::readings_of;
using test::refusal_of;
using test::says;

Vec3 only_leg(const std::string& lines) {
  const Readings readings = readings_of(lines);
  EXPECT_EQ(readings.legs.size(), 1u);
  return readings.legs.at(0).vector_m();
}
void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-9) << a.transpose() << " and " << b.transpose();
}

TEST(TherionData, ALegOfTapeCompassAndClino) {
  expect_near(only_leg("data normal from to length compass clino\n1 2 10 90 30\n"),
              {10 * std::sqrt(0.75), 0, 5});
}

TEST(TherionData, ABearingBeyondTheCircleIsTakenAroundItWithANote) {
  const std::string data = "data normal from to length compass clino\n";
  const Readings beyond = readings_of(data + "1 2 10 400 0\n");
  EXPECT_NEAR(beyond.legs.at(0).bearing_deg, 40, 1e-9);
  EXPECT_TRUE(test::notes_say(beyond.log.notes, "a bearing out of range, 400: taken as 40 deg"));
  for (const char* full : {"1 2 10 360 0\n", "units compass grads\n1 2 10 400 0\n"})
    EXPECT_FALSE(test::notes_say(readings_of(data + full).log.notes, "out of range")) << full;
}

TEST(TherionData, ColumnsStandInAnyOrderAndOthersAreIgnored) {
  expect_near(only_leg("data normal to clino ignore from compass tape ignoreall\n2 30 x 1 90 10 and more\n"),
              {10 * std::sqrt(0.75), 0, 5});
}

TEST(TherionData, UnitsHaveFactors) {
  expect_near(only_leg("units length 2 feet\nunits compass grads\nunits clino percent\n"
                       "data normal from to length compass clino\n1 2 10 100 100\n"),
              {20 * 0.3048 * std::sqrt(0.5), 0, 20 * 0.3048 * std::sqrt(0.5)});
}

TEST(TherionData, CalibrationsComeBeforeUnits) {
  expect_near(only_leg("units length feet\ncalibrate length 1 2\ncalibrate compass 10\n"
                       "data normal from to length compass clino\n1 2 11 100 0\n"),
              {20 * 0.3048, 0, 0});
}

TEST(TherionData, BacksightsAreAveragedAndADisagreementIsNoted) {
  expect_near(only_leg("data normal from to tape backtape compass backcompass clino backclino\n"
                       "1 2 10 12 358 182 10 -10\n"),
              Vec3(0, 11 * std::cos(std::numbers::pi / 18), 11 * std::sin(std::numbers::pi / 18)));
  expect_near(only_leg("data normal from to length backcompass backclino\n1 2 10 270 -90\n"), {0, 0, 10});
  expect_near(only_leg("data normal from to length compass backcompass clino\n1 2 10 - 270 0\n"), {10, 0, 0});
  const Readings off = readings_of("data normal from to length compass backcompass clino\n1 2 10 80 280 0\n");
  EXPECT_TRUE(test::notes_say(off.log.notes, "differ by 20.0 deg"));
  EXPECT_NEAR(off.legs.at(0).bearing_deg, 90, 1e-9);
}

TEST(TherionData, PlumbedLegsNeedNoCompass) {
  expect_near(only_leg("data normal from to length compass clino\n1 2 10 - down\n"), {0, 0, -10});
  expect_near(only_leg("data normal from to length compass clino\n1 2 10 - 90\n"), {0, 0, 10});
  EXPECT_TRUE(says(refusal_of("data normal from to length compass clino\n1 2 10 - 10\n"),
                   "line 4: the bearing is missing"));
}

TEST(TherionData, ADirectionTurnsALeg) {
  expect_near(only_leg("data normal from to direction length compass clino\n1 2 b 10 90 30\n"),
              {-10 * std::sqrt(0.75), 0, -5});
}

// 100 cm on the counter from 250 to 1250, and half a metre too long.
TEST(TherionData, ATopofilGivesTheDifferenceOfItsCounters) {
  const std::string lines =
      "units counter centimetres\ndata topofil from to fromcount tocount compass clino\n1 2 250 1250 0 0\n";
  expect_near(only_leg(lines), {0, 10, 0});
  EXPECT_EQ(readings_of(lines).legs.at(0).style, Style::topofil);
  expect_near(only_leg("calibrate counter 0 0.5\n" + lines), {0, 5, 0});
  EXPECT_TRUE(says(refusal_of("data topofil from to fromcount tocount compass clino\n1 2 9 8 0 0\n"),
                   "runs backwards"));
}

TEST(TherionData, InterleavedReadingsJoinStations) {
  const Readings r = readings_of(
      "data topofil station count left newline compass clino\n"
      "1 100 1\n 0 0\n2 110 2\n 90 0\n3 130 3\nbreak\n4 0 4\n 0 0\n5 7 5\n");
  ASSERT_EQ(r.legs.size(), 3u);
  expect_near(r.legs[0].vector_m(), {0, 10, 0});
  expect_near(r.legs[1].vector_m(), {20, 0, 0});
  expect_near(r.legs[2].vector_m(), {0, 7, 0});
  EXPECT_EQ(r.legs[0].run, r.legs[1].run);
  EXPECT_NE(r.legs[1].run, r.legs[2].run);
  EXPECT_EQ(r.stations.at(r.legs[2].to).name, "s.5");
  ASSERT_EQ(r.dimensions.size(), 6u);  // at both ends of each leg
  EXPECT_EQ(r.dimensions[1].dimensions.left_m, 2);
}

TEST(TherionData, ADiversTapeRunsAlongTheSlope) {
  expect_near(only_leg("data diving from to length compass depthchange\n1 2 5 0 -3\n"), {0, 4, -3});
  expect_near(only_leg("data diving from to length compass fromdepth todepth\n1 2 5 0 -3 -6\n"), {0, 4, -3});
  const Readings r = readings_of("data diving station depth newline length compass\n1 -3\n5 0\n2 -6\n");
  expect_near(r.legs.at(0).vector_m(), {0, 4, -3});
}

TEST(TherionData, CylindricalPolarTapesAreLevel) {
  expect_near(only_leg("data cylpolar from to length compass depthchange\n1 2 4 90 -3\n"), {4, 0, -3});
}

TEST(TherionData, CartesianLegs) {
  expect_near(only_leg("units dz feet\ndata cartesian from to northing easting altitude\n1 2 3 4 10\n"),
              {4, 3, 3.048});
}

TEST(TherionData, SplaysAreToPointsWithoutAName) {
  const Readings r = readings_of(
      "data normal from to length compass clino\n1 2 10 0 0\n1 . 2 90 0\n- 2 3 0 0\n"
      "flags splay\n2 w 1 0 0\nflags not splay\n2 3 1 0 0\n");
  ASSERT_EQ(r.legs.size(), 5u);
  for (const std::size_t i : {1u, 2u, 3u}) EXPECT_TRUE(r.legs[i].splay) << i;
  for (const std::size_t i : {0u, 4u}) EXPECT_FALSE(r.legs[i].splay) << i;
  EXPECT_EQ(r.legs[0].run, r.legs[4].run) << "splays between them do not end a run";
  EXPECT_TRUE(says(refusal_of("data normal from to length compass clino\n. - 1 0 0\n"), "line 4"));
}

TEST(TherionData, FlagsHoldUntilTheyAreTakenBack) {
  const Readings r = readings_of(
      "data normal from to length compass clino\nflags surface duplicate approximate\n1 2 10 0 0\n"
      "flags not surface duplicate\n2 3 10 0 0\n");
  EXPECT_TRUE(r.legs[0].surface && r.legs[0].duplicate && r.legs[0].approximate);
  EXPECT_TRUE(!r.legs[1].surface && r.legs[1].duplicate && r.legs[1].approximate);
  EXPECT_TRUE(says(refusal_of("flags not\n"), "line 3"));
  EXPECT_TRUE(says(refusal_of("flags deep\n"), "no flag of a leg: 'deep'"));
}

TEST(TherionData, DimensionsStandAtTheSecondStationOrAtBoth) {
  const Readings r = readings_of(
      "units left right feet\ndata normal from to length compass clino left right up down\n"
      "1 2 10 0 0 1 [2 3] - 4\n");
  ASSERT_EQ(r.dimensions.size(), 2u);
  EXPECT_FALSE(r.dimensions[0].at_end);
  EXPECT_DOUBLE_EQ(*r.dimensions[0].dimensions.right_m, 2 * 0.3048);
  EXPECT_FALSE(r.dimensions[0].dimensions.left_m);
  EXPECT_TRUE(r.dimensions[1].at_end);
  EXPECT_DOUBLE_EQ(*r.dimensions[1].dimensions.left_m, 0.3048);
  EXPECT_DOUBLE_EQ(*r.dimensions[1].dimensions.right_m, 3 * 0.3048);
  EXPECT_FALSE(r.dimensions[1].dimensions.up_m);
  EXPECT_EQ(r.dimensions[1].dimensions.down_m, 4);
  EXPECT_TRUE(
      says(refusal_of("data normal from to length compass clino left\n1 2 1 0 0 -1\n"), "negative distance"));
}

TEST(TherionData, GroupsGiveBackWhatTheySet) {
  const Readings r = readings_of(
      "data normal from to length compass clino\ngroup\nunits length feet\n1 2 10 0 0\nendgroup\n2 3 10 0 "
      "0\n");
  EXPECT_DOUBLE_EQ(r.legs[0].length_m, 3.048);
  EXPECT_DOUBLE_EQ(r.legs[1].length_m, 10);
  EXPECT_TRUE(says(refusal_of("endgroup\n"), "endgroup without group"));
  EXPECT_TRUE(says(refusal_of("group\n"), "a group has no endgroup"));
}

TEST(TherionData, ALegOfNoLengthEquatesIfAsked) {
  const std::string leg = "data normal from to length compass clino\n1 2 0 0 0\n2 3 5 0 0\n";
  EXPECT_EQ(readings_of(leg).legs.size(), 2u);
  const Readings inferred = readings_of("infer equates on\n" + leg);
  EXPECT_EQ(inferred.legs.size(), 1u);
  EXPECT_EQ(inferred.equates.size(), 1u);
}

TEST(TherionData, AnInferredEquateEndsNoRunAndKeepsItsDimensions) {
  const Readings r = readings_of(
      "infer equates on\ndata normal from to length compass clino left right\n"
      "1 2 5 0 0 1 1\n2 3 0 0 0 2 2\n3 4 5 0 0 3 3\n");
  ASSERT_EQ(r.legs.size(), 2u);
  EXPECT_EQ(r.legs[0].run, r.legs[1].run);
  ASSERT_EQ(r.station_dimensions.size(), 1u);
  EXPECT_EQ(r.stations[r.station_dimensions[0].station].name, "s.3");
}

TEST(TherionData, ARowWhoseLinesEndEarlyIsRefused) {
  const std::string said = refusal_of("data normal from to newline length compass clino\n1 2\n10 0 0\n3 4\n");
  EXPECT_TRUE(says(said, "s.th: line 6: not enough readings")) << said;
}

TEST(TherionData, InterleavedReadingsWithoutASecondStationAreNoted) {
  const std::string data = "data normal station newline length compass clino\n1\n10 0 0\n2\n";
  EXPECT_TRUE(readings_of(data).log.notes.empty());
  const Readings r = readings_of(data + "20 0 0\n");
  EXPECT_EQ(r.legs.size(), 1u);
  ASSERT_EQ(r.log.notes.size(), 1u);
  EXPECT_TRUE(says(r.log.notes[0].text, "that no other station follows"));
  EXPECT_EQ(r.log.notes[0].source.line, 6u);
  EXPECT_TRUE(readings_of("data nosurvey station\n1\n2\n").log.notes.empty())
      << "nothing is read behind them";
}

TEST(TherionData, RowsThatDoNotFitAreRefusedWithTheirLine) {
  const std::string data = "data normal from to length compass clino\n";
  for (const auto& [row, why] :
       std::vector<std::pair<std::string, std::string>>{{"1 2 10 0", "not enough readings"},
                                                        {"1 2 10 0 0 7", "more readings than columns"},
                                                        {"1 2 ten 0 0", "is no number: 'ten'"},
                                                        {"1 2 -10 0 0", "a negative length"},
                                                        {"1 2 - 0 0", "the length is missing"},
                                                        {"1 2 10 730 0", "a bearing out of range: 730"},
                                                        {"1 2 10 0 91", "an inclination out of range: 91"},
                                                        {"1 2 10 0 -", "the inclination is missing"},
                                                        {"1 1 10 0 0", "from a station to itself"},
                                                        {"@s 1 10 0 0", "is no name of a station"}}) {
    const std::string said = refusal_of(data + row + "\n");
    EXPECT_TRUE(says(said, "s.th: line 4: ") && says(said, why)) << row << ": " << said;
  }
}

TEST(TherionData, FormatsThatLackReadingsAreRefused) {
  for (const auto& [format, why] : std::vector<std::pair<std::string, std::string>>{
           {"data sideways from to", "is no style of data: 'sideways'"},
           {"data normal from to length compass", "not all readings"},
           {"data normal from to length compass clino depth", "is no reading of this style: 'depth'"},
           {"data normal from to length compass clino tape", "stands twice: 'tape'"},
           {"data normal from to length compass clino wind", "is no reading: 'wind'"},
           {"data normal from to count compass clino", "mixes readings of stations and of legs"},
           {"data normal station length newline compass clino", "readings of stations stand before newline"},
           {"data dimensions station", "not all readings"}}) {
    const std::string said = refusal_of(format + "\n");
    EXPECT_TRUE(says(said, "s.th: line 3: ") && says(said, why)) << format << ": " << said;
  }
}

}  // namespace
}  // namespace karst::survey
