// Surveys with their loops closed, against closed forms, against cavern on an equivalent .svx, and against
// Therion.
#include "sdk/survey/adjust.h"

#include <cmath>
#include <numbers>

#include "sdk/host/isolation/process.h"
#include "sdk/survey/read_survey.h"
#include "tests/unit/survey/adjusted_surveys.h"

namespace karst::survey {
namespace {

using core::Vec3;
using test::adjusted;
using test::adjusted_lines;
using test::adjustment_refusal;
using test::expect_at;
using test::Folder;
using test::kNormal;
using test::notes_say;
using test::place;
using test::says;
using test::station;

TEST(Adjust, AnOpenTraverseEndsWhereItsLegsLead) {
  SKIP_WITHOUT_SURVEX();
  const Survey s =
      adjusted_lines("fix 1 100 200 50\ndeclination 10 degrees\n" + kNormal + "1 2 10 80 30\n2 3 5 - down\n");
  expect_at(place(s, "s.1"), {100, 200, 50});
  expect_at(place(s, "s.2"), {100 + 10 * std::sqrt(0.75), 200, 55});
  expect_at(place(s, "s.3"), {100 + 10 * std::sqrt(0.75), 200, 50});
  EXPECT_TRUE(station(s, "s.1").fixed && !station(s, "s.2").fixed);
  EXPECT_NEAR(*s.legs[0].bearing_rad, std::numbers::pi / 2, 1e-9);
  EXPECT_FALSE(s.legs[1].bearing_rad);
  EXPECT_NEAR(length_m(s), 15, 0.02);
  EXPECT_EQ(s.loops.count, 0u);
  EXPECT_EQ(place_of(s, s.legs[1].source).substr(place_of(s, s.legs[1].source).rfind('/')), "/s.th: line 7");
}

// Around a square with good angles: the last leg is 0.4 m short, and shares that with the one opposite.
TEST(Adjust, AMisclosureIsSharedByTheLegsThatCanHaveCausedIt) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines("fix 1 0 0 0\nsd length 2 metres\nsd compass clino 0.0001 degrees\n" +
                                  kNormal + "1 2 10 0 0\n2 3 10 90 0\n3 4 10 180 0\n4 1 9.6 270 0\n");
  expect_at(place(s, "s.2"), {0, 10, 0});
  expect_at(place(s, "s.3"), {9.8, 10, 0});
  expect_at(place(s, "s.4"), {9.8, 0, 0});
  EXPECT_EQ(s.loops.count, 1u);
  ASSERT_EQ(s.loops.traverses.size(), 1u);
  EXPECT_EQ(s.loops.traverses[0].from, "s.1");
  EXPECT_EQ(s.loops.traverses[0].legs, 4u);
  EXPECT_NEAR(s.loops.traverses[0].error_m, 0.4, 0.011);
}

TEST(Adjust, StationsThatAreEquatedAreOne) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted("survey a\nsurvey b\ncentreline\n" + kNormal +
                            "1 2 10 0 0\nendcentreline\nendsurvey\n"
                            "survey c\ncentreline\n" +
                            kNormal +
                            "1 2 10 90 0\nstation 1 \"\" entrance\nendcentreline\n"
                            "endsurvey\nequate 2@b 1@c\nendsurvey\n");
  ASSERT_EQ(s.stations.size(), 3u);
  EXPECT_EQ(s.legs[0].to, s.legs[1].from);
  EXPECT_EQ(station(s, "a.c.1").name, "a.b.2");
  EXPECT_TRUE(station(s, "a.b.2").entrance);
  expect_at(place(s, "a.c.2"), {10, 10, 0});
}

TEST(Adjust, WhatNothingTiesToAFixedStationIsLeftOutWithANote) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines("fix 1 0 0 0\n" + kNormal + "1 2 10 0 0\n3 4 10 0 0\n4 5 10 0 0\n");
  EXPECT_EQ(s.stations.size(), 2u);
  EXPECT_TRUE(notes_say(s.notes, "2 legs from here on are tied to no fixed station"));
  EXPECT_EQ(s.left_out.parts, 1u);
  EXPECT_EQ(s.left_out.legs, 2u);
  EXPECT_GT(s.left_out.legs_m, 0);
  const Survey loose = adjusted_lines(kNormal + "1 2 10 0 0\n3 4 10 0 0\n4 5 10 0 0\n");
  EXPECT_EQ(loose.stations.size(), 3u) << "the larger part";
  EXPECT_TRUE(notes_say(loose.notes, "no station of the survey is fixed"));
}

TEST(Adjust, ContradictoryFixesAreRefusedWithBothLines) {
  const std::string said =
      adjustment_refusal("fix 1 0 0 0\nfix 2 5 0 0\n" + kNormal + "1 3 10 0 0\nequate 1 2\n");
  EXPECT_TRUE(says(said, "s.th: line 4: the station s.2 is fixed elsewhere")) << said;
  EXPECT_TRUE(says(said, "line 3")) << said;
}

TEST(Adjust, AnEquateThatContradictsALegIsRefused) {
  const std::string said = adjustment_refusal(kNormal + "1 2 10 0 0\n2 3 4 0 0\nequate 2 3\n");
  EXPECT_TRUE(says(said,
                   "s.th: line 5: this leg of 4.00 m contradicts an equate, which makes its ends s.2 and "
                   "s.3 one station"))
      << said;
}

TEST(Adjust, AShortLegBetweenEquatedStationsIsNoted) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines(kNormal + "1 2 10 0 0\n2 3 0.3 0 0\nequate 2 3\n");
  EXPECT_EQ(s.legs.size(), 1u);
  EXPECT_TRUE(notes_say(s.notes, "a leg of 0.30 m whose ends are equated"));
}

TEST(Adjust, ASurveyWithoutLegsIsRefused) {
  EXPECT_TRUE(says(adjustment_refusal("fix 1 0 0 0\n"), "holds no leg"));
  EXPECT_TRUE(says(adjustment_refusal(""), "holds no leg"));
}

TEST(Adjust, SplaysStartAtTheirStationsAndMakeNone) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines(kNormal + "1 2 10 0 0\n2 . 3 90 0\n- 2 3 90 0\nflags splay\n1 w 2 - up\n");
  EXPECT_EQ(s.stations.size(), 2u);
  ASSERT_EQ(s.splays.size(), 3u);
  expect_at(s.splays[0].end_m, {3, 10, 0});
  expect_at(s.splays[1].end_m, {-3, 10, 0});
  expect_at(s.splays[2].end_m, {0, 0, 2});
  EXPECT_NEAR(length_m(s), 10, 0.02);
}

TEST(Adjust, StationsOfSurfaceLegsAloneAreOnTheSurface) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines(kNormal + "flags surface\n1 2 10 0 0\nflags not surface\n2 3 10 0 0\n");
  EXPECT_TRUE(station(s, "s.1").surface && !station(s, "s.2").surface && !station(s, "s.3").surface);
  EXPECT_NEAR(length_m(s), 10, 0.02);
}

TEST(Adjust, SectionsFaceAlongTheirRun) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines(
      "data normal from to length compass clino left right up down\n"
      "1 2 10 0 0 1 1 1 1\n2 3 10 90 0 2 2 2 2\n3 4 10 - down 3 3 3 3\n4 5 10 - down 4 4 4 4\nbreak\n"
      "2 6 10 180 0 5 5 5 5\n");
  ASSERT_EQ(s.sections.size(), 5u);
  expect_at(s.sections[0].facing, Vec3(1, 1, 0).normalized());
  expect_at(s.sections[1].facing, {1, 0, 0});
  expect_at(s.sections[2].facing, {1, 0, 0});
  expect_at(s.sections[3].facing, {1, 0, 0});
  expect_at(s.sections[4].facing, {0, -1, 0});
  EXPECT_EQ(s.sections[3].run, s.sections[0].run);
  EXPECT_NE(s.sections[4].run, s.sections[0].run);
  EXPECT_EQ(s.sections[1].leg, 1u);
}

TEST(Adjust, DimensionsOfStationsJoinTheRunThatLeadsThere) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines(
      kNormal + "1 2 10 90 0\n2 3 10 90 0\ndata dimensions station left right\n3 1 2\n1 3 4\n2 5 -\n");
  ASSERT_EQ(s.sections.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(s.stations[s.sections[i].station].name, "s." + std::to_string(i + 1));
    expect_at(s.sections[i].facing, {1, 0, 0});
  }
  EXPECT_EQ(s.sections[1].dimensions.left_m, 5);
  EXPECT_FALSE(s.sections[1].dimensions.right_m);
}

// The same survey in both languages, with a loop, other units, other styles and other standard deviations.
const char* const kTherion =
    "survey s\ncentreline\nfix 0 10 20 30\nsd length 0.05 metres\nsd compass clino 0.5 degrees\n"
    "units length feet\nunits compass clino grads\ndata normal from to length compass clino\n"
    "0 1 30 10 5\n1 2 40 120 -20\n2 3 35.5 210 10\n3 0 33 305 9\n"
    "data diving from to length compass depthchange\n2 4 30 250 -6\n"
    "data cylpolar from to length compass depthchange\n4 5 30 150 2\n"
    "data cartesian from to easting northing altitude\n5 0 -30.5 21.25 2.5\nendcentreline\nendsurvey\n";
const char* const kSurvex =
    "*fix 0 10 20 30\n*sd tape 0.05 metres\n*sd compass clino 0.5 degrees\n*units tape feet\n*units compass "
    "clino grads\n"
    "*data normal from to tape compass clino\n0 1 30 10 5\n1 2 40 120 -20\n2 3 35.5 210 10\n3 0 33 305 "
    "9\n"
    "*data diving from to tape compass depthchange\n2 4 30 250 -6\n"
    "*data cylpolar from to tape compass depthchange\n4 5 30 150 2\n"
    "*data cartesian from to easting northing altitude\n5 0 -30.5 21.25 2.5\n";

TEST(Adjust, LoopsCloseAsThoseOfTheSameSurveyInSurvex) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const Survey therion = read_survey(folder.write("s.th", kTherion));
  const Survey survex = read_survey(folder.write("s.svx", kSurvex));
  ASSERT_EQ(therion.stations.size(), 6u);
  ASSERT_EQ(survex.stations.size(), 6u);
  for (const char* name : {"0", "1", "2", "3", "4", "5"})
    EXPECT_LT((place(therion, std::string("s.") + name) - place(survex, name)).norm(), 0.0175) << name;
  EXPECT_EQ(therion.loops.count, 2u);
  EXPECT_EQ(survex.loops.count, 2u);
  ASSERT_FALSE(therion.loops.traverses.empty());
  EXPECT_NEAR(therion.loops.traverses[0].error_m, survex.loops.traverses.at(0).error_m, 0.011);
}

std::string program(const std::string& name) {
  const std::string path = "/usr/bin/" + name;
  return std::filesystem::exists(path) ? path : "";
}

/// Positions of a survey's stations as Therion exports them.
Survey by_therion(const Folder& folder, const std::string& text) {
  const std::string file = folder.write("s.th", text);
  const std::string config =
      folder.write("thconfig", "source \"" + file + "\"\nexport model -fmt survex -o \"" +
                                   (folder.path() / "t.3d").string() + "\"\n");
  host::run_process({"/usr/bin/env", "-C", folder.path().string(), program("therion"), config}, 120);
  return read_survey((folder.path() / "t.3d").string());
}

TEST(Adjust, OpenTraversesAreWhereTherionPutsThem) {
  SKIP_WITHOUT_SURVEX();
  if (program("therion").empty()) GTEST_SKIP() << "skipped: no therion";
  const std::string text =
      "survey a -declination [2 degrees]\nsurvey b\ncentreline\nfix 0 100 200 300\nunits compass clino "
      "grads\n"
      "units length 2 feet\ncalibrate compass 1.5\ncalibrate length 0.1 1.01\n"
      "data normal from to backclino length compass backcompass clino\n0 1 -5 30 10 208 7\n1 2 20 40 120 - "
      "-20\n"
      "flags splay\n1 . 0 3 0 - 0\nflags not splay\nunits clino percent\ndata normal from to length compass "
      "clino\n"
      "2 3 12 10 50\nendcentreline\nendsurvey\nsurvey c\ncentreline\ndeclination -3 degrees\nunits counter "
      "cm\n"
      "calibrate counter 0 0.5\ndata topofil from to fromcount tocount compass clino\n0 1 100 2100 90 10\n"
      "data diving from to length compass fromdepth todepth\n1 2 20 45 -1 -5\n"
      "data cylpolar from to length compass depthchange\n2 3 20 300 -4\n"
      "data cartesian from to northing easting altitude\n3 4 3 4 5\n"
      "data normal station newline direction length compass clino\n4\nb 10 0 10\n5\nf 7 100 -80\n6\n"
      "endcentreline\nendsurvey\nequate 3@b 0@c\nendsurvey\n";
  const Folder folder;
  const Survey therion = by_therion(folder, text);
  const Survey ours = read_survey((folder.path() / "s.th").string());
  for (const char* name : {"b.0", "b.1", "b.2", "b.3", "c.0", "c.1", "c.2", "c.3", "c.4", "c.5", "c.6"})
    EXPECT_LT((place(ours, std::string("a.") + name) - place(therion, std::string("a.") + name)).norm(),
              0.0175)
        << name << ": " << place(ours, std::string("a.") + name).transpose() << " and "
        << place(therion, std::string("a.") + name).transpose();
}

// Therion computes the declination itself, by another implementation of the reference field.
TEST(Adjust, CoordinateSystemsAndDatesTurnBearingsAsInTherion) {
  SKIP_WITHOUT_SURVEX();
  if (program("therion").empty()) GTEST_SKIP() << "skipped: no therion";
  const std::string text = "survey a\ncentreline\ncs lat-long\nfix 0 46.1 6.79 2000\ndate 1985.07.20\n" +
                           kNormal + "0 1 1000 0 0\n1 2 1000 90 0\nendcentreline\ncentreline\n" + kNormal +
                           "2 3 500 45 0\nendcentreline\n"
                           "centreline\ndeclination 1 degrees\ncs UTM32\nfix 9 329000 5107000 1000\n" +
                           kNormal + "9 10 1000 180 0\nendcentreline\nendsurvey\n";
  const Folder folder;
  const Survey therion = by_therion(folder, text);
  const Survey ours = read_survey((folder.path() / "s.th").string());
  for (const char* name : {"a.0", "a.9"})
    EXPECT_LT((place(ours, name) - place(therion, name)).norm(), 0.0175) << name;
  EXPECT_LT((place(ours, "a.10") - place(therion, "a.10")).norm(), 0.0175);
  constexpr double kField_rad = 0.01 * std::numbers::pi / 180;
  for (const char* name : {"a.1", "a.2", "a.3"})
    EXPECT_LT((place(ours, name) - place(therion, name)).norm(), 1500 * kField_rad) << name;
  EXPECT_TRUE(notes_say(ours.notes, "readings without a date have the declination of 1985.07.2"));
}

// cavern takes the declination of such a year as zero, with no more than a warning.
TEST(Adjust, DatesBeyondTheReferenceFieldAreRefusedUnlessThereIsADeclination) {
  SKIP_WITHOUT_SURVEX();
  const std::string leg = "cs UTM33\nfix 1 400000 5000000 0\n" + kNormal + "1 2 10 0 0\n";
  for (const char* year : {"1850", "2150"}) {
    const std::string said = adjustment_refusal(std::string("date ") + year + ".06.01\n" + leg);
    EXPECT_TRUE(says(said, "s.th: line 7: the reference field is not known in " + std::string(year))) << said;
  }
  EXPECT_EQ(adjustment_refusal("date 1850.06.01\ndeclination 12 degrees\n" + leg), "");
  EXPECT_EQ(adjustment_refusal("date 1900.06.01\n" + leg), "");
}

// A scale error of 1 / cos(latitude) at the equator is none: the stations are where the legs lead.
TEST(Adjust, AStationMayBeFixedAtTheOriginOfACoordinateSystem) {
  SKIP_WITHOUT_SURVEX();
  const Survey s =
      adjusted_lines("cs EPSG:3857\nfix 1 0 0 0\ndeclination 0 degrees\n" + kNormal + "1 2 10 90 0\n");
  expect_at(place(s, "s.2"), {10, 0, 0});
}

// JTSK counts to the west and to the south, and cavern writes no such coordinates.
TEST(Adjust, CoordinatesToTheWestAndSouthBecomeThoseToTheEastAndNorth) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines("cs JTSK\nfix 1 400000 1197000 500\ndeclination 0 degrees\n" + kNormal +
                                  "1 2 10 - up\n");
  expect_at(place(s, "s.1"), {-400'000, -1'197'000, 500});
  expect_at(place(s, "s.2"), {-400'000, -1'197'000, 510});
}

TEST(Adjust, ADiveStraightDownNeedsNoCompass) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines("data diving from to length compass depthchange\n1 2 10 - -10\n");
  expect_at(place(s, "s.2"), {0, 0, -10});
  EXPECT_FALSE(s.legs.at(0).bearing_rad);
}

TEST(Adjust, ADeclinationOfSeveralTurnsIsOneWithinATurn) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = adjusted_lines("declination -990 degrees\n" + kNormal + "1 2 10 0 0\n");
  expect_at(place(s, "s.2"), {10, 0, 0});
}

TEST(Adjust, CoordinatesThatCannotBeConvertedAreRefusedWithTheirLine) {
  SKIP_WITHOUT_SURVEX();
  const std::string said = adjustment_refusal("cs EPSG:1\nfix 1 0 0 0\n" + kNormal + "1 2 10 0 0\n");
  EXPECT_TRUE(says(said, "s.th: line 4: the coordinates in EPSG:1 cannot be converted")) << said;
  EXPECT_TRUE(says(adjustment_refusal("cs \"UTM33 *include x\"\nfix 1 0 0 0\n" + kNormal + "1 2 10 0 0\n"),
                   "is no coordinate system"));
  EXPECT_TRUE(says(adjustment_refusal("fix 3 0 0 0\ncs UTM33\nfix 1 400000 5000000 0\n" + kNormal +
                                      "1 2 10 0 0\n2 3 10 0 0\n"),
                   "line 3: is fixed in local coordinates"));
}

}  // namespace
}  // namespace karst::survey
