// From the key of a mission to what the core knows of the cave before the flight.
#include "sdk/flight/known_survey.h"

#include <gtest/gtest.h>

#include <string>

#include "core_stack/common/error.h"
#include "sdk/survey/cavern.h"
#include "tests/unit/replay/folder.h"

namespace karst::flight {
namespace {

class KnownSurveyTest : public testing::Test {
 protected:
  const test::Folder folder_;
  Mission mission_;

  void SetUp() override {
    if (!survey::has_survex()) GTEST_SKIP() << "skipped: no survex/therion";
    mission_.file = "mission.info";
    mission_.survey.file =
        folder_.write("cave.svx",
                      "*begin cave\n*fix 1 100 200 30\n*entrance 1\n"
                      "*data normal from to tape compass clino\n1 2 10 90 0\n2 3 5 0 0\n"
                      "*data passage station left right up down\n1 2 1 3 1\n2 2 1 3 1\n3 1 1 1 1\n"
                      "*end cave\n");
  }
  std::string error() const {
    try {
      with_survey(mission_);
    } catch (const core::InputError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(KnownSurveyTest, LiesWhereTheMissionSays) {
  mission_.survey.offset = "100 200 30";
  const Mission read = with_survey(mission_);
  ASSERT_TRUE(read.core.survey.passages);
  const core::SurveyPrior& prior = read.core.survey.passages->prior();
  ASSERT_EQ(prior.legs.size(), 2u);
  EXPECT_LT((prior.stations[prior.legs[1].to] - core::Vec3(10, 5, 0)).norm(), 0.02);
  ASSERT_EQ(prior.leads.size(), 1u) << "the other end is the entrance";
  EXPECT_LT(read.core.survey.passages->distance_m({5, 1.9, 2.9}), 0);
  EXPECT_GT(read.core.survey.passages->distance_m({5, -1.1, 0}), 0);
  EXPECT_TRUE(read.core.survey.told_to_policy);
  mission_.survey.hints = false;
  EXPECT_FALSE(with_survey(mission_).core.survey.told_to_policy);
}

TEST_F(KnownSurveyTest, LiesInACaveOfASurveyByItsStationsAndTheMissionRecordsHow) {
  mission_.cave = folder_.write("cave.info", "mesh cave.ply\n");
  EXPECT_EQ(with_survey(mission_).survey.offset, "0.000 0.000 0.000") << "made of no survey";
  folder_.write("cave.stations.csv", "name,x,y,z,flags\ncave.2,10.000,0.000,1.000,\n");
  EXPECT_EQ(with_survey(mission_).survey.offset, "100.000 200.000 29.000");
  mission_.survey.offset = "1 2 3";
  EXPECT_EQ(with_survey(mission_).survey.offset, "1.000 2.000 3.000") << "what is given counts";
}

TEST_F(KnownSurveyTest, NotesSayHowItLiesInTheCave) {
  const auto notes = [this] {
    std::string all;
    with_survey(mission_, [&](const std::string& note) { all += note + "\n"; });
    return all;
  };
  const auto expect_note = [&](const std::string& part) {
    const std::string all = notes();
    EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
  };
  mission_.cave = folder_.write("cave.info", "mesh cave.ply\nstart \"0 0 1\"\n");
  folder_.write("cave.ply", "");
  expect_note("cave.svx: lies in the cave with the offset 0.000 0.000 0.000: as no table of stations");
  expect_note("the start is 2");  // 225 m
  folder_.write("cave.stations.csv", "name,x,y,z,flags\ncave.1,0,0,1,\ncave.2,10.000,0.000,1.000,\n");
  expect_note(
      "offset 100.000 200.000 29.000: 2 of its stations have names of the cave's; they lie 0.00 m "
      "(median) and at most 0.00 m");
  EXPECT_EQ(notes().find("the start is"), std::string::npos) << "it is in the survey";
  mission_.survey.offset = "5000 5000 0";
  expect_note("survey.offset contradicts the names");
  expect_note("m from its nearest leg: does survey.offset fit the cave?");
}

TEST_F(KnownSurveyTest, OneThatContradictsTheCaveIsRefused) {
  mission_.cave = folder_.write("cave.info", "mesh cave.ply\n");
  folder_.write("cave.stations.csv", "name,x,y,z,flags\ncave.1,0,0,0,\ncave.2,0,80,0,\ncave.3,50,0,0,\n");
  EXPECT_NE(error().find("cave.svx: contradicts the cave"), std::string::npos) << error();
}

TEST_F(KnownSurveyTest, BadInputIsNamed) {
  mission_.survey.offset = "1 2";
  EXPECT_NE(error().find("mission.info: survey.offset: expected \"x y z\""), std::string::npos) << error();
  mission_.survey.offset = "";
  mission_.survey.file = (folder_.path() / "nowhere.svx").string();
  EXPECT_NE(error().find("nowhere.svx"), std::string::npos) << error();
  mission_.survey.file = folder_.write("surface.svx",
                                       "*begin cave\n*fix 1 0 0 0\n*flags surface\n"
                                       "*data normal from to tape compass clino\n1 2 10 90 0\n*end cave\n");
  EXPECT_NE(error().find("surface.svx: has no leg underground"), std::string::npos) << error();
}

TEST(KnownSurvey, AMissionWithoutASurveyIsTheSame) {
  const Mission read = with_survey({});
  EXPECT_FALSE(read.core.survey.passages);
  EXPECT_EQ(read.survey.offset, "");
}

}  // namespace
}  // namespace karst::flight
