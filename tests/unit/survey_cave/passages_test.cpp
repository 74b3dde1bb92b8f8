// The tubes along the legs, and what is guessed of them.
#include "sdk/survey_cave/passages.h"

#include <gtest/gtest.h>

#include "tests/unit/survey_cave/made_passages.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using test::MadePassages;
using test::passages_made;
using test::SurveyMaker;

TEST(Passages, LeftAndRightAreThoseOfTheLegWhicheverWayItWasMeasured) {
  SurveyMaker m;
  m.station("a.0", {0, 0, 0}), m.station("a.1", {8, 0, 0});
  m.leg(1, 0);  // measured towards -x, while the sections face +x: their left is +y
  m.section(0, Vec3::UnitX(), 3, 1, 2, 0.5);
  m.section(1, Vec3::UnitX(), 3, 1, 2, 0.5);
  const MadePassages made = passages_made(m.survey);
  const Tube& t = made.tube(0);
  EXPECT_NEAR(t.distance({4, 3, 0}), 0, 0.02);
  EXPECT_NEAR(t.distance({4, -1, 0}), 0, 0.02);
  EXPECT_NEAR(t.distance({4, 0, 2}), 0, 0.02);
  EXPECT_NEAR(t.distance({4, 0, -0.5}), 0, 0.02);
  EXPECT_TRUE(made.passages.guessed.empty());
}

// Up and down of a sloping passage are vertical.
TEST(Passages, UpAndDownOfASlopingPassageAreMeasuredVertically) {
  SurveyMaker m;
  m.station("a.0", {0, 0, 0}), m.station("a.1", {10, 0, 6});
  m.leg(0, 1);
  for (const std::uint32_t s : {0u, 1u}) m.section(s, Vec3::UnitX(), 1, 1, 1.5, 0.5);
  const MadePassages made = passages_made(m.survey);
  const Tube& t = made.tube(0);
  EXPECT_NEAR(t.distance({5, 0, 3 + 1.5}), 0, 0.03);
  EXPECT_NEAR(t.distance({5, 0, 3 - 0.5}), 0, 0.03);
}

TEST(Passages, AShaftIsAsDeepAsItIsWideAndEndsWhereUpAndDownSay) {
  SurveyMaker m;
  m.station("p.top", {0, 0, 0}), m.station("p.bottom", {0, 0, -20});
  m.leg(0, 1);
  for (const std::uint32_t s : {0u, 1u}) m.section(s, Vec3::UnitY(), 2, 1, 3, 0.5);
  const MadePassages made = passages_made(m.survey);
  const Tube& t = made.tube(0);
  EXPECT_NEAR(t.distance({-2, 0, -10}), 0, 0.03) << "left of north is west";
  EXPECT_NEAR(t.distance({1, 0, -10}), 0, 0.03);
  EXPECT_NEAR(t.distance({0, 1.5, -10}), 0, 0.03) << "front and back: half of the width";
  EXPECT_NEAR(t.distance({0, -1.5, -10}), 0, 0.03);
  EXPECT_NEAR(t.distance({0, 0, 3}), 0, 1e-6) << "the roof";
  EXPECT_NEAR(t.distance({0, 0, -20.5}), 0, 1e-6) << "the floor";
  EXPECT_NEAR(made.passages.shafts_m, 20, 1e-9);
}

TEST(Passages, FourSplaysAcrossThePassageGiveItsSection) {
  SurveyMaker m;
  m.station("a.0", {0, 0, 0}), m.station("a.1", {6, 0, 0});
  m.leg(0, 1);
  for (const std::uint32_t s : {0u, 1u}) {
    m.section(s, Vec3::UnitX(), 9, 9, 9, 9);
    for (int i = 0; i < 8; ++i) {
      const double a = 2 * std::numbers::pi * i / 8;
      m.splay(s, {0.2, 1.5 * std::cos(a), 1.5 * std::sin(a)});
    }
    m.splay(s, {7, 0.5, 0.1});  // along the passage: tells nothing of its section
  }
  const MadePassages made = passages_made(m.survey);
  EXPECT_EQ(made.passages.sections_from_splays, 2u);
  EXPECT_NEAR(made.passages.splays_m, 6, 1e-9);
  for (int i = 0; i < 16; ++i) {
    const double a = 2 * std::numbers::pi * i / 16;
    EXPECT_NEAR(made.tube(0).distance({3, 1.5 * std::cos(a), 1.5 * std::sin(a)}), 0, 0.03);
  }
}

TEST(Passages, TubesOfOnePassageFollowEachOtherAndOthersAreApart) {
  SurveyMaker m = test::straight_passage(2, 10, 2);
  m.station("side.1", {10, 20, 0});
  m.leg(1, 3, 1);
  const MadePassages made = passages_made(m.survey);
  EXPECT_NE(made.tube(2).passage(), made.tube(0).passage());
  EXPECT_EQ(made.tube(0).passage(), made.tube(1).passage());
  EXPECT_TRUE(made.tube(0).to().open && made.tube(1).from().open) << "one plane, which halves the angle";
  EXPECT_FALSE(made.tube(2).from().open);
}

TEST(Passages, GuessedMetresAreHalfOfALegForEachOfItsEnds) {
  SurveyMaker m;
  for (int i = 0; i < 5; ++i) m.station("a." + std::to_string(i), {10.0 * i, 0, 0});
  for (std::uint32_t i = 0; i < 4; ++i) m.leg(i, i + 1);
  m.section(0, Vec3::UnitX(), 1, 1, 1, 1);
  m.section(3, Vec3::UnitX(), 4, 4, 4, 4).dimensions.up_m.reset();  // stations 1 and 2 lie between, 4 beyond
  const MadePassages made = passages_made(m.survey);
  double without_m = 0, partly_m = 0;
  for (const GuessedLeg& g : made.passages.guessed) without_m += g.without_m, partly_m += g.partly_m;
  EXPECT_NEAR(without_m, 5 + 10 + 5 + 5, 1e-6);
  EXPECT_NEAR(partly_m, 5 + 5, 1e-6);
  EXPECT_EQ(made.passages.defaults_m, 0);
  m.leg(m.station("b.0", {0, 50, 0}), m.station("b.1", {10, 50, 0}));
  EXPECT_NEAR(passages_made(m.survey).passages.defaults_m, 10, 1e-6);
}

}  // namespace
}  // namespace karst::survey_cave
