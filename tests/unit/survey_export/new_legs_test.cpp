// What of a flight's survey is new against the one that its mission had.
#include "sdk/survey_export/new_legs.h"

#include <gtest/gtest.h>

#include <string>

#include "core_stack/common/error.h"
#include "sdk/survey/cavern.h"
#include "sdk/survey_export/svx_file.h"
#include "sdk/survey_export/therion_file.h"
#include "tests/unit/replay/folder.h"
#include "tests/unit/survey_export/carved_map.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

/// The tunnel's first `length_m` metres, 2 m wide to both sides.
core::SurveyedPassages first_metres(double length_m) {
  const core::PassageSize size{2, 2, 1.5, 1.5};
  return core::SurveyedPassages({{{0, 0, 1.5}, {length_m, 0, 1.5}}, {{0, 1, size, size}}, {}});
}

FlownSurvey against(const core::VoxelMap& map, const core::SurveyedPassages& known) {
  FlownSurvey flown = test::surveyed(map, test::tunnel_flight());
  flown.leg_is_new = new_legs(flown.survey, known);
  return flown;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

TEST(NewLegs, AreThoseOfWhichHalfIsBeyondTheSurvey) {
  const core::VoxelMap map = test::tunnel_map();
  const FlownSurvey flown = against(map, first_metres(15));
  ASSERT_EQ(flown.leg_is_new.size(), flown.survey.legs.size());
  double new_m = 0;
  for (std::size_t i = 0; i < flown.survey.legs.size(); ++i) {
    const survey::Leg& leg = flown.survey.legs[i];
    const double middle =
        0.5 * (flown.survey.stations[leg.from].position_m.x() + flown.survey.stations[leg.to].position_m.x());
    EXPECT_EQ(is_new(flown, i), middle > 15 + core::kBeyondSurvey_m) << middle;
    if (is_new(flown, i)) new_m += leg.length_m.value();
  }
  EXPECT_GT(new_sum(flown).legs, 0u);
  EXPECT_LT(new_sum(flown).legs, flown.survey.legs.size());
  EXPECT_DOUBLE_EQ(new_sum(flown).length_m, new_m);
}

TEST(NewLegs, AreMarkedInBothFilesAndSummedUpInTheirHeads) {
  const core::VoxelMap map = test::tunnel_map();
  const FlownSurvey flown = against(map, first_metres(15));
  const std::string words = new_words(flown);
  EXPECT_EQ(words.rfind("new: ", 0), 0u) << words;
  EXPECT_NE(words.find(" m beyond the survey"), std::string::npos) << words;
  const std::string svx = svx_text(flown, {}), th = therion_text(flown, {});
  EXPECT_EQ(count(svx, " ; new\n"), new_sum(flown).legs) << svx;
  EXPECT_EQ(count(th, "  # new\n"), new_sum(flown).legs) << th;
  EXPECT_EQ(count(svx, "; " + words + "\n"), 1u);
  EXPECT_EQ(count(th, "# " + words + "\n"), 1u);
}

TEST(NewLegs, NothingIsNewWhereAllWasKnownAndNothingIsSaidWithoutASurvey) {
  const core::VoxelMap map = test::tunnel_map();
  EXPECT_EQ(new_words(against(map, first_metres(30))), "new: 0 legs, 0.0 m beyond the survey");
  const FlownSurvey alone = test::surveyed(map, test::tunnel_flight());
  EXPECT_EQ(new_words(alone), "");
  EXPECT_EQ(count(svx_text(alone, {}), "new"), 0u);
  EXPECT_EQ(count(therion_text(alone, {}), "new"), 0u);
}

TEST(NewLegs, TheSurveyIsTheOneOfTheRunsMission) {
  const test::Folder run;
  EXPECT_FALSE(survey_before(run.path())) << "a run without a mission";
  run.write("mission.info", "seed 1\n");
  EXPECT_FALSE(survey_before(run.path()));
  run.write("mission.info", "survey { file \"/nonexistent/cave.svx\" offset \"1 2 3\" }\n");
  EXPECT_THROW(survey_before(run.path()), core::InputError);
  EXPECT_FALSE(survey_before(run.path(), std::filesystem::path())) << "none was asked for";
  if (!survey::has_survex()) GTEST_SKIP() << "skipped: no survex/therion";
  const std::string svx = run.write("cave.svx",
                                    "*begin cave\n*fix 1 100 0 0\n*data normal from to tape compass clino\n"
                                    "1 2 10 90 0\n*end cave\n");
  run.write("mission.info", "survey { file \"" + svx + "\" offset \"100 0 0\" }\n");
  const auto known = survey_before(run.path());
  ASSERT_TRUE(known);
  EXPECT_NEAR(known->passages.distance_m({14, 0, 0}), 4, 0.02);
  EXPECT_NEAR((known->offset_m - Vec3(100, 0, 0)).norm(), 0, 1e-9);
  run.write("mission.info", "survey { file \"/nonexistent/cave.svx\" offset \"100 0 0\" }\n");
  const auto other = survey_before(run.path(), std::filesystem::path(svx));
  ASSERT_TRUE(other);
  EXPECT_EQ(other->file, svx);
  EXPECT_NEAR(other->passages.distance_m({14, 0, 0}), 4, 0.02) << "at the offset of the mission";
}

TEST(NewLegs, WithoutASurveyOfTheMissionTheStationsOfTheCaveSayWhereAnotherOneLies) {
  if (!survey::has_survex()) GTEST_SKIP() << "skipped: no survex/therion";
  const test::Folder run;
  const std::string svx =
      run.write("old.svx",
                "*begin cave\n*fix 1 451000 5078000 800\n*data normal from to tape compass "
                "clino\n1 2 10 90 0\n*end cave\n");
  run.write("made.stations.csv", "name,x,y,z,flags\ncave.1,0,0,0,\ncave.2,10,0,0,\n");
  run.write("mission.info", "cave { file \"" + (run.path() / "made.info").string() + "\" }\n");
  const auto known = survey_before(run.path(), std::filesystem::path(svx));
  ASSERT_TRUE(known);
  EXPECT_NEAR((known->offset_m - Vec3(451000, 5078000, 800)).norm(), 0, 0.02);
}

TEST(NewLegs, ASurveyThatWasMovedIsNamedWithTheMissionFileAndTheOptionThatHelps) {
  const test::Folder run;
  const std::string mission = run.write("mission.info", "survey { file \"/nonexistent/cave.svx\" }\n");
  try {
    survey_before(run.path());
    FAIL();
  } catch (const core::InputError& e) {
    const std::string said = e.what();
    EXPECT_EQ(said.rfind(mission + ": survey.file: /nonexistent/cave.svx: ", 0), 0u) << said;
    EXPECT_NE(said.find("--prior FILE; --prior none"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace karst::survey_export
