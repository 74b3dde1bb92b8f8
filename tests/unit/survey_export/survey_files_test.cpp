// There and back: what is written for Survex and Therion is read again by their programs, and by ours.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "sdk/host/isolation/process.h"
#include "sdk/survey/cavern.h"
#include "sdk/survey/dump3d.h"
#include "sdk/survey/read_survey.h"
#include "sdk/survey_export/svx_file.h"
#include "sdk/survey_export/therion_file.h"
#include "tests/unit/replay/folder.h"
#include "tests/unit/survey_export/carved_map.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

bool has_therion() { return std::system("command -v therion > /dev/null 2>&1") == 0; }

/// A junction, an unflown branch, an open end and unknown floor.
core::VoxelMap cave_map() {
  const auto cave = test::any_of({test::tunnel(), test::box({13.4, 1, 0}, {16.4, 15, 3})});
  return test::carved(
      cave, {-1, -3, -1}, {31, 16, 4},
      test::any_of({test::box({26, -10, -10}, {50, 10, 10}), test::box({2, -10, -10}, {12, 10, 0})}));
}
FlownSurvey cave_survey(const core::VoxelMap& map) {
  return test::surveyed(map, test::way({{1, 0, 1.5}, {24, 0, 1.5}}));
}

const survey::Station& station(const survey::Survey& s, const std::string& name) {
  for (const survey::Station& at : s.stations)
    if (at.name == name) return at;
  throw std::runtime_error("no station " + name);
}

class SurveyFiles : public testing::Test {
 protected:
  const test::Folder folder_;
  const core::VoxelMap map_ = cave_map();
  const FlownSurvey flown_ = cave_survey(map_);

  void SetUp() override {
    if (!survey::has_survex()) GTEST_SKIP() << "skipped: no survex/therion";
  }
  survey::Survey read_svx(const Placing& placing) const {
    return survey::read_survey(folder_.write("cave.svx", svx_text(flown_, placing)));
  }
  survey::Survey read_th(const Placing& placing) const {
    return survey::read_survey(folder_.write("cave.th", therion_text(flown_, placing)));
  }
  void expect_positions(const survey::Survey& read, const Placing& placing) const {
    ASSERT_EQ(read.stations.size(), flown_.survey.stations.size());
    for (const survey::Station& s : flown_.survey.stations)
      EXPECT_LT(
          (station(read, s.name).position_m - placed(placing, flown_, s.position_m)).cwiseAbs().maxCoeff(),
          0.0101)
          << s.name;
  }
};

TEST_F(SurveyFiles, CavernTakesTheSurveyWithoutAWarningAndHasItsStationsToTheCentimetre) {
  const survey::CavernRun run =
      survey::run_cavern(folder_.write("cave.svx", svx_text(flown_, {})), folder_.path());
  EXPECT_TRUE(run.closed);
  for (const survey::CavernMessage& m : run.messages) ADD_FAILURE() << m.line << ": " << m.text;
  const survey::Survey read = read_svx({});
  expect_positions(read, {});
  EXPECT_TRUE(station(read, "cave.1").entrance && station(read, "cave.1").fixed);
  EXPECT_NEAR(survey::length_m(read), survey::length_m(flown_.survey), 0.05);
  std::size_t measured = 0;
  for (const survey::Section& s : flown_.survey.sections) measured += s.dimensions.any() ? 1u : 0u;
  EXPECT_EQ(read.sections.size(), measured);
}

TEST_F(SurveyFiles, TheTherionReaderGivesTheSameSurvey) {
  const survey::Survey read = read_th({});
  expect_positions(read, {});
  ASSERT_EQ(read.legs.size(), flown_.survey.legs.size());
  std::size_t approximate = 0;
  for (std::size_t i = 0; i < read.legs.size(); ++i) {
    const survey::Leg &a = read.legs[i], &b = flown_.survey.legs[i];
    EXPECT_EQ(read.stations[a.from].name, flown_.survey.stations[b.from].name);
    EXPECT_EQ(read.stations[a.to].name, flown_.survey.stations[b.to].name);
    EXPECT_EQ(a.approximate, b.approximate) << i;
    EXPECT_FALSE(a.surface || a.duplicate);
    EXPECT_NEAR(*a.length_m, *b.length_m, 1e-4);
    approximate += a.approximate ? 1u : 0u;
  }
  EXPECT_GT(approximate, 0u);
  std::size_t continuations = 0;
  for (const survey::Station& s : flown_.survey.stations) {
    const survey::Station& r = station(read, s.name);
    EXPECT_EQ(r.entrance, s.entrance);
    EXPECT_EQ(r.continuation, s.continuation) << s.name;
    EXPECT_EQ(r.comment, s.comment);
    continuations += s.continuation ? 1u : 0u;
  }
  EXPECT_GT(continuations, 0u);
  std::map<std::string, survey::Dimensions> first;  // of each station, as Therion keeps them
  for (const survey::Section& s : flown_.survey.sections)
    first.try_emplace(flown_.survey.stations[s.station].name, s.dimensions);
  ASSERT_EQ(read.sections.size(), first.size());
  bool unseen = false;
  const auto same = [&](const std::optional<double>& a, const std::optional<double>& b) {
    EXPECT_EQ(a.has_value(), b.has_value());
    if (a && b) {
      EXPECT_NEAR(*a, *b, 0.0051);
    }
    unseen = unseen || !b;
  };
  for (const survey::Section& s : read.sections) {
    const survey::Dimensions& d = first.at(read.stations[s.station].name);
    same(s.dimensions.left_m, d.left_m);
    same(s.dimensions.right_m, d.right_m);
    same(s.dimensions.up_m, d.up_m);
    same(s.dimensions.down_m, d.down_m);
  }
  EXPECT_TRUE(unseen);
  for (const survey::Note& n : read.notes) ADD_FAILURE() << n.text;
}

TEST_F(SurveyFiles, ADeclinationTurnsTheSurveyAboutItsStart) {
  Placing placing;
  placing.start_m = Vec3(100, 200, 300);
  placing.declination_deg = 90;  // the map's y axis points east, its x axis south
  for (const survey::Survey& read : {read_svx(placing), read_th(placing)}) {
    expect_positions(read, placing);
    for (const survey::Station& s : flown_.survey.stations) {
      const Vec3 p = s.position_m - flown_.start;
      EXPECT_LT((station(read, s.name).position_m - Vec3(100 + p.y(), 200 - p.x(), 300 + p.z())).norm(),
                0.02);
    }
  }
}

TEST_F(SurveyFiles, InACoordinateSystemBothCountFromTheGridsNorth) {
  Placing placing;
  placing.start_m = Vec3(700000, 5000000, 300);  // the meridians converge by 1.8 degrees here
  placing.system = "UTM33N";
  placing.declination_deg = 2;
  expect_positions(read_svx(placing), placing);
  expect_positions(read_th(placing), placing);
}

TEST_F(SurveyFiles, TherionTakesTheSurveyWithoutAWarning) {
  if (!has_therion()) GTEST_SKIP() << "skipped: no survex/therion";
  Placing placing;
  placing.start_m = Vec3(700000, 5000000, 300);
  placing.system = "UTM33N";
  for (const Placing& at : {Placing{}, placing}) {
    folder_.write("cave.th", therion_text(flown_, at));
    folder_.write("cave.thconfig", thconfig_text("cave", at));
    const host::ProcessOutput said = host::run_process(
        {"/bin/sh", "-c", "cd '" + folder_.path().string() + "' && LC_ALL=C therion cave.thconfig"}, 120);
    EXPECT_EQ(said.end.exit_code, 0) << said.out;
    EXPECT_EQ(said.out.find("warning"), std::string::npos) << said.out;
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "cave.lox"));
    expect_positions(survey::read_survey((folder_.path() / "cave_therion.3d").string()), at);
    std::filesystem::remove(folder_.path() / "cave.lox");
  }
}

TEST(SurveyText, TheEntranceIsFixedInTheCoordinatesOfTheMissionsSurveyUnlessAPlaceIsGiven) {
  const core::VoxelMap map = cave_map();
  FlownSurvey flown = cave_survey(map);
  flown.offset_m = Vec3(451000, 5078000, 800);
  const Vec3 p = flown.survey.stations[0].position_m;
  EXPECT_LT((placed({}, flown, p) - (p + flown.offset_m)).norm(), 1e-6);
  Placing placing;
  placing.start_m = Vec3(1, 2, 3);
  EXPECT_LT((placed(placing, flown, flown.start) - Vec3(1, 2, 3)).norm(), 1e-9);
}

TEST(SurveyText, NoStationIsFixedIfAskedFor) {
  const core::VoxelMap map = cave_map();
  const FlownSurvey flown = cave_survey(map);
  Placing placing;
  EXPECT_NE(svx_text(flown, placing).find("\n*fix 1 "), std::string::npos);
  EXPECT_NE(therion_text(flown, placing).find("    fix 1 "), std::string::npos);
  placing.fixed = false;
  EXPECT_EQ(svx_text(flown, placing).find("*fix"), std::string::npos);
  EXPECT_EQ(therion_text(flown, placing).find("    fix "), std::string::npos);
}

TEST(SurveyText, TheScanTiesTheMeshToStationsOfTheCentreline) {
  const core::VoxelMap map = cave_map();
  const FlownSurvey flown = cave_survey(map);
  const std::string text = scan_text(flown, "out");
  EXPECT_NE(text.find("input \"out.th\"\nscan\n  file \"out.stl\"\n  units metres\n  1@cave "),
            std::string::npos)
      << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '@'), static_cast<long>(flown.survey.stations.size()));
  EXPECT_TRUE(text.ends_with("endscan\n"));
}

TEST(SurveyText, TitlesCannotBreakTheFiles) {
  const core::VoxelMap map = cave_map();
  FlownSurvey flown = cave_survey(map);
  flown.survey.title = "a \"b\"\n*fix 1 0 0 0";
  EXPECT_NE(svx_text(flown, {}).find("*title \"a  b  *fix 1 0 0 0\"\n"), std::string::npos);
  EXPECT_NE(therion_text(flown, {}).find("survey cave -title \"a  b  *fix 1 0 0 0\"\n"), std::string::npos);
  flown.survey.title = "run \xff";  // Therion: invalid UTF-8 string
  EXPECT_NE(therion_text(flown, {}).find("-title \"run ?\"\n"), std::string::npos);
}

}  // namespace
}  // namespace karst::survey_export
