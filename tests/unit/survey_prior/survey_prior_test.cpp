#include "sdk/survey_prior/survey_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "tests/unit/replay/folder.h"

namespace karst::survey_prior {
namespace {

using core::Vec3;
using survey::Survey;

/// 0 - 1 - 2 to the east, and 1 - 3 to the north.
Survey tee() {
  Survey s;
  for (const Vec3& p : {Vec3(100, 50, 10), Vec3(110, 50, 10), Vec3(120, 50, 10), Vec3(110, 60, 10)}) {
    survey::Station station;
    station.name = "cave." + std::to_string(s.stations.size());
    station.position_m = p;
    s.stations.push_back(station);
  }
  const auto leg = [&s](std::uint32_t from, std::uint32_t to, std::uint32_t run) {
    survey::Leg l;
    l.from = from, l.to = to, l.run = run;
    s.legs.push_back(l);
  };
  leg(0, 1, 0), leg(1, 2, 0), leg(1, 3, 1);
  return s;
}

survey::Section section(std::uint32_t station, const Vec3& facing, const survey::Dimensions& d,
                        std::uint32_t run) {
  survey::Section s;
  s.station = station, s.facing = facing, s.dimensions = d, s.run = run;
  return s;
}

std::vector<std::pair<Vec3, bool>> leads(const Survey& s) {
  const core::SurveyPrior prior = prior_of(s, Vec3::Zero());
  std::vector<std::pair<Vec3, bool>> out;
  for (const core::SurveyLead& l : prior.leads) out.emplace_back(prior.stations[l.station], l.noted);
  return out;
}
using Leads = std::vector<std::pair<Vec3, bool>>;

template <class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(SurveyPrior, IsInTheFrameOfTheFlight) {
  const core::SurveyPrior prior = prior_of(tee(), {100, 50, 0});
  ASSERT_EQ(prior.stations.size(), 4u);
  EXPECT_EQ(prior.stations[0], Vec3(0, 0, 10));
  EXPECT_EQ(prior.stations[3], Vec3(10, 10, 10));
  ASSERT_EQ(prior.legs.size(), 3u);
  EXPECT_EQ(prior.legs[2].from, 1u);
  EXPECT_EQ(prior.legs[2].to, 3u);
  EXPECT_TRUE(core::is_sound(prior));
}

TEST(SurveyPrior, LeadsAreEndsThatAreNoEntrancesAndWhatTheSurveyorMarked) {
  Survey s = tee();
  EXPECT_EQ(leads(s), (Leads{{{100, 50, 10}, false}, {{120, 50, 10}, false}, {{110, 60, 10}, false}}));
  s.stations[0].entrance = true;
  s.stations[1].continuation = true;
  s.stations[3].continuation = true;
  EXPECT_EQ(leads(s), (Leads{{{110, 50, 10}, true}, {{120, 50, 10}, false}, {{110, 60, 10}, true}}));
  s.stations.push_back(s.stations[2]);
  s.stations.back().position_m = {130, 50, 11};
  survey::Leg over_ground;
  over_ground.from = 2, over_ground.to = 4, over_ground.surface = true;
  s.legs.push_back(over_ground);
  EXPECT_EQ(leads(s), (Leads{{{110, 50, 10}, true}, {{110, 60, 10}, true}})) << "one comes out there";
}

TEST(SurveyPrior, DuplicatesAndLegsOverGroundAreNoPassages) {
  Survey s = tee();
  s.legs[1].duplicate = true;
  s.legs[2].surface = true;
  EXPECT_EQ(prior_of(s, Vec3::Zero()).legs.size(), 1u);
}

TEST(SurveyPrior, StationsInTheSamePlaceAreOne) {
  Survey s = tee();
  s.stations.push_back(s.stations[2]);  // 2 and 4, and on from there
  s.stations.push_back(s.stations[2]);
  s.stations.back().position_m = {130, 50, 10};
  for (const auto& [from, to] : {std::pair(2u, 4u), std::pair(4u, 5u)}) {
    survey::Leg l;
    l.from = from, l.to = to;
    s.legs.push_back(l);
  }
  const core::SurveyPrior prior = prior_of(s, Vec3::Zero());
  EXPECT_EQ(prior.stations.size(), 5u);
  EXPECT_EQ(prior.legs.size(), 4u);
  EXPECT_EQ(leads(s), (Leads{{{100, 50, 10}, false}, {{110, 60, 10}, false}, {{130, 50, 10}, false}}));
}

TEST(SurveyPrior, WallsAreSeenAlongTheLeg) {
  Survey s = tee();
  s.sections = {section(0, {-1, 0, 0}, {1.0, 2.0, 3.0, 4.0}, 0),  // its surveyor looked back
                section(1, {1, 0, 0}, {0.5, 0.6, 0.7, {}}, 0),    // of the run to the east
                section(1, {0, 1, 0}, {5.0, 6.0, 7.0, 8.0}, 1)};  // of that to the north
  const core::SurveyPrior prior = prior_of(s, Vec3::Zero());
  EXPECT_EQ(prior.legs[0].from_size.left_m, 2);
  EXPECT_EQ(prior.legs[0].from_size.right_m, 1);
  EXPECT_EQ(prior.legs[0].from_size.up_m, 3);
  EXPECT_EQ(prior.legs[0].to_size.left_m, 0.5);
  EXPECT_EQ(prior.legs[0].to_size.down_m, core::kUnmeasuredWall_m) << "the other section looks across";
  EXPECT_EQ(prior.legs[2].from_size.left_m, 5);
  EXPECT_EQ(prior.legs[2].to_size.left_m, core::kUnmeasuredWall_m);
}

TEST(SurveyPrior, SplaysAcrossThePassageStandInForSections) {
  Survey s = tee();
  const auto splay = [&s](const Vec3& shot) {
    survey::Splay p;
    p.station = 0;
    p.end_m = s.stations[0].position_m + shot;
    s.splays.push_back(p);
  };
  splay({0.2, 2.5, 0.4});
  splay({0, 2.0, 1.0});
  splay({0, -1.2, 0});
  splay({9, 0.5, -0.5});  // along the passage: it says nothing of its walls
  s.sections = {section(0, {1, 0, 0}, {{}, 1.0, {}, {}}, 0)};
  const core::PassageSize size = prior_of(s, Vec3::Zero()).legs[0].from_size;
  EXPECT_NEAR(size.left_m, 2.5, 1e-9);
  EXPECT_EQ(size.right_m, 1.0) << "the surveyor's own reading counts";
  EXPECT_NEAR(size.up_m, 1.0, 1e-9);
  EXPECT_EQ(size.down_m, core::kUnmeasuredWall_m);
}

TEST(SurveyPrior, LiesInACaveByTheStationsOfTheSameName) {
  const test::Folder folder;
  const std::string cave = folder.write("cave.info", "mesh cave.ply\n");
  EXPECT_FALSE(station_fit("s.svx", tee(), cave, {})) << "a cave that no survey has made";
  EXPECT_FALSE(station_fit("s.svx", tee(), "", {}));
  folder.write("cave.stations.csv",
               "name,x,y,z,flags\ncave.0,0.000,-1.000,2.000,entrance fixed\ncave.1,10.000,-1.000,2.000,\n"
               "\"cave.2\",20.010,-1.000,2.000,\nelsewhere.7,0.000,0.000,0.000,\n");
  const auto fit = station_fit("s.svx", tee(), cave, {});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->offset_m, Vec3(100, 51, 8));
  EXPECT_EQ(fit->names, 3u);
  EXPECT_NEAR(fit->median_m, 0, 1e-9);
  EXPECT_NEAR(fit->greatest_m, 0.01, 1e-9);
  Survey other = tee();
  for (survey::Station& s : other.stations) s.name = "other" + s.name;
  EXPECT_TRUE(says(error_of([&] { station_fit("s.svx", other, cave, {}); }), "s.svx: has no station of "));
  EXPECT_TRUE(says(error_of([&] { station_fit("s.svx", other, cave, {}); }), "give survey.offset"));
  EXPECT_EQ(station_fit("s.svx", other, cave, Vec3(1, 2, 3))->names, 0u);
  other.stations[1].aliases = {"cave.1"};
  EXPECT_EQ(station_fit("s.svx", other, cave, {})->offset_m, Vec3(100, 51, 8));
  folder.write("cave.stations.csv", "name,x,y,z,flags\ncave.0,0.0,far,2.0,\n");
  EXPECT_TRUE(
      says(error_of([&] { station_fit("s.svx", tee(), cave, {}); }), "stations.csv: line 2: expected name"));
}

TEST(SurveyPrior, ThatContradictsTheStationsOfTheCaveIsRefusedUnlessTheOffsetIsGiven) {
  const test::Folder folder;
  const std::string cave = folder.write("cave.info", "mesh cave.ply\n");
  folder.write("cave.stations.csv",
               "name,x,y,z,flags\ncave.0,0,0,0,\ncave.1,0,10,0,\ncave.2,0,20,0,\ncave.3,0,30,0,\n");
  const std::string said = error_of([&] { station_fit("s.svx", tee(), cave, {}); });
  EXPECT_TRUE(says(said, "s.svx: contradicts the cave")) << said;
  EXPECT_TRUE(says(said, "4 stations of the same name")) << said;
  const auto given = station_fit("s.svx", tee(), cave, Vec3(100, 50, 10));
  ASSERT_TRUE(given);
  EXPECT_EQ(given->offset_m, Vec3(100, 50, 10));
  EXPECT_NEAR(given->greatest_m, std::hypot(20, 20), 1e-9) << "of cave.2";
}

TEST(SurveyPrior, TheDistanceToItsLegsEndsAtTheirStations) {
  const core::SurveyPrior prior = prior_of(tee(), Vec3::Zero());
  EXPECT_NEAR(distance_to_legs_m(prior, {105, 50, 17}), 7, 1e-9);
  EXPECT_NEAR(distance_to_legs_m(prior, {97, 50, 14}), 5, 1e-9);
  EXPECT_TRUE(std::isinf(distance_to_legs_m({}, {0, 0, 0})));
}

TEST(SurveyPrior, OffsetsAreThreeNumbers) {
  EXPECT_EQ(read_offset("m.info", "survey.offset", " 1 -2.5 3e2 "), Vec3(1, -2.5, 300));
  EXPECT_EQ(read_offset("", "", offset_text({451234.5, 5078123, -0.125})), Vec3(451234.5, 5078123, -0.125));
  for (const char* bad : {"", "1 2", "1 2 3 4", "1 2 x", "1 2 nan"})
    EXPECT_TRUE(says(error_of([&] { read_offset("m.info", "survey.offset", bad); }),
                     "m.info: survey.offset: expected \"x y z\" in metres"))
        << bad;
}

}  // namespace
}  // namespace karst::survey_prior
