// Which legs go on as one passage.
#include "sdk/survey_cave/passage_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/survey_cave/surveys.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using test::SurveyMaker;
using Numbers = std::vector<std::uint32_t>;

PassageJoints joints_made(const survey::Survey& survey) {
  const SurveyPart part = part_of("cave.th", survey, {});
  return joints_of(survey, part, graph_of(survey, part, Vec3::Zero()));
}

/// Legs of 10 m from the origin towards these places; those at odd places are measured towards the origin.
SurveyMaker star(const std::vector<Vec3>& towards) {
  SurveyMaker m;
  m.station("a.0", Vec3::Zero());
  for (std::uint32_t i = 0; i < towards.size(); ++i) {
    m.station("a." + std::to_string(i + 1), 10 * towards[i].normalized());
    m.leg(i % 2 == 0 ? 0 : i + 1, i % 2 == 0 ? i + 1 : 0);
  }
  return m;
}

std::vector<Joint> at_node(const PassageJoints& made, std::uint32_t node) {
  std::vector<Joint> joints;
  for (const Joint& j : made.joints)
    if (j.node == node) joints.push_back(j);
  return joints;
}

TEST(Joints, TheTwoLegsThatTurnLeastGoOnAndTheThirdBeginsThere) {
  const PassageJoints made = joints_made(star({{1, 0, 0}, {-1, 0.2, 0}, {-1, 0.6, 0}}).survey);
  EXPECT_EQ(passage_numbers(made), (Numbers{0, 0, 2}));
  const std::vector<Joint> joints = at_node(made, 0);
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(joints[0].ends.size(), 2u);
  ASSERT_EQ(joints[1].ends.size(), 1u);
  EXPECT_EQ(joints[1].ends[0].way, 2u);
  EXPECT_GT(joints[1].normal.dot(Vec3(-1, 0.6, 0).normalized()), 0.999) << "outwards along its leg";
}

TEST(Joints, TwoPassagesMayCrossAtAStation) {
  const PassageJoints made = joints_made(star({{1, 0, 0}, {0, 1, 0}, {-1, 0.1, 0}, {0.1, -1, 0}}).survey);
  EXPECT_EQ(passage_numbers(made), (Numbers{0, 1, 0, 1}));
}

TEST(Joints, ASharperTurnThanEightyDegreesEndsAPassage) {
  const auto numbers_at = [](double turn_deg) {
    const double a = std::numbers::pi * turn_deg / 180;
    return passage_numbers(joints_made(star({{-1, 0, 0}, {std::cos(a), std::sin(a), 0}}).survey));
  };
  EXPECT_EQ(numbers_at(79), (Numbers{0, 0}));
  EXPECT_EQ(numbers_at(81), (Numbers{0, 1}));
}

TEST(Joints, TheSectionHalvesTheAngleBetweenItsLegs) {
  const PassageJoints made = joints_made(star({{-1, 0, 0}, {0.5, std::sqrt(0.75), 0}}).survey);
  const std::vector<Joint> joints = at_node(made, 0);
  ASSERT_EQ(joints.size(), 1u);
  const double a = std::numbers::pi / 6;
  EXPECT_NEAR(std::abs(joints[0].normal.dot(Vec3(std::cos(a), std::sin(a), 0))), 1, 1e-9);
}

TEST(Joints, SectionsOfGentleLegsAreVerticalAndThoseOfShaftsLevel) {
  const PassageJoints made = joints_made(star({{1, 0, 0.8}, {0, 0.1, -1}}).survey);
  EXPECT_EQ(made.ways.at(0).normal, Vec3::UnitX());
  EXPECT_EQ(made.ways.at(0).steep, 0);
  EXPECT_EQ(made.ways.at(1).steep, 1);
  EXPECT_EQ(made.ways.at(1).normal, made.ways.at(1).axis);
  EXPECT_TRUE(is_shaft(at_node(made, 2).at(0)));
  EXPECT_FALSE(is_shaft(at_node(made, 1).at(0)));
}

TEST(Joints, LegsWithoutALengthHaveNoWay) {
  SurveyMaker m = test::straight_passage(2, 10, 1);
  m.station("cave.same", {10, 0, 0.004});
  m.leg(1, 3);
  const PassageJoints made = joints_made(m.survey);
  EXPECT_EQ(made.ways.size(), 2u);
  EXPECT_EQ(passage_numbers(made), (Numbers{0, 0}));
}

TEST(Joints, EveryWayKnowsTheJointsOfItsEnds) {
  const PassageJoints made = joints_made(star({{1, 0, 0}, {-1, 0.2, 0}, {0, 1, 0}, {0, 0, 1}}).survey);
  for (std::uint32_t w = 0; w < made.ways.size(); ++w)
    for (const std::size_t end : {0, 1}) {
      const Joint& joint = made.joints.at(made.ways[w].joint.at(end));
      EXPECT_EQ(joint.node, made.ways[w].node.at(end));
      EXPECT_TRUE(std::any_of(joint.ends.begin(), joint.ends.end(),
                              [&](const WayEnd& e) { return e.way == w && e.end == end; }));
    }
}

}  // namespace
}  // namespace karst::survey_cave
