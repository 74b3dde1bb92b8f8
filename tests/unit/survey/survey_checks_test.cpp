// What of a survey looks like a blunder.
#include "sdk/survey/survey_checks.h"

#include "tests/unit/survey/adjusted_surveys.h"

namespace karst::survey {
namespace {

/// A passage of two legs of 10 m.
Survey two_legs() {
  Survey s;
  for (int i = 0; i < 3; ++i) {
    Station station;
    station.name = "cave." + std::to_string(i);
    station.position_m = {10.0 * i, 0, 0};
    s.stations.push_back(station);
  }
  s.legs.resize(2);
  s.legs[0].to = 1, s.legs[1].from = 1, s.legs[1].to = 2;
  return s;
}

Loops::Traverse traverse(double error_percent, std::optional<double> sigmas) {
  Loops::Traverse t;
  t.from = "a", t.to = "b", t.length_m = 20, t.error_percent = error_percent;
  t.error_m = error_percent / 100 * t.length_m;
  t.sigmas = sigmas;
  return t;
}

TEST(SurveyChecks, LoopsOfMoreThanFivePercentAndThreeStandardDeviationsAreNamed) {
  Survey s = two_legs();
  s.loops.traverses = {traverse(4.9, 9), traverse(20, 2.9)};
  EXPECT_TRUE(survey_checks(s).empty()) << "either may be noise";
  s.loops.traverses.push_back(traverse(70.7, 70));
  s.loops.traverses.push_back(traverse(6, {}));
  ASSERT_EQ(survey_checks(s).size(), 1u);
  EXPECT_EQ(survey_checks(s)[0],
            "2 traverses of loops err by more than 5 %; the worst by 70.7 %, 14.14 m on 20 m, 70.0 standard "
            "deviations, from a to b: a reading or an equate is wrong");
}

TEST(SurveyChecks, LongLegsAndFarWallsAreNamedWithTheirPlace) {
  Survey s = two_legs();
  s.files = {"cave.th"};
  s.legs[1].source = {0, 12};
  Section section;
  section.station = 1;
  section.dimensions.left_m = 50;
  s.sections = {section};
  EXPECT_TRUE(survey_checks(s).empty());
  s.stations[2].position_m.x() = 130;
  s.sections[0].dimensions.up_m = 51;
  const std::vector<std::string> checks = survey_checks(s);
  ASSERT_EQ(checks.size(), 2u);
  EXPECT_EQ(checks[0],
            "1 leg longer than 100 m; the longest has 120.0 m, from cave.1 to cave.2 (cave.th: line 12)");
  EXPECT_EQ(checks[1], "1 section with a wall more than 50 m away; the farthest at 51.0 m, seen from cave.1");
  s.legs[1].surface = s.stations[1].surface = true;
  EXPECT_TRUE(survey_checks(s).empty()) << "over ground, legs are long";
}

TEST(SurveyChecks, AnEquateThatContradictsTheLegsIsNamed) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = test::adjusted_lines("fix 1 0 0 0\n" + test::kNormal +
                                        "1 2 10 0 0\n2 3 10 90 0\n3 4 10 0 0\nequate 1 3\n");
  ASSERT_EQ(survey_checks(s).size(), 1u);
  EXPECT_TRUE(test::says(survey_checks(s)[0], "the worst by 70.7 %")) << survey_checks(s)[0];
}

TEST(SurveyChecks, ATraverseIsNamedWithThePlaceOfALegAtItsEnd) {
  SKIP_WITHOUT_SURVEX();
  const Survey s = test::adjusted_lines("fix 1 0 0 0\n" + test::kNormal +
                                        "0 1 5 0 0\n1 2 10 0 0\n2 3 10 90 0\n3 4 10 180 0\n4 1 3 270 0\n");
  ASSERT_EQ(survey_checks(s).size(), 1u);
  EXPECT_TRUE(test::says(survey_checks(s)[0], "from s.1 to s.1 (")) << survey_checks(s)[0];
  const auto names = [&](const Leg& leg) {
    return test::says(survey_checks(s)[0], "line " + std::to_string(leg.source.line) + ")");
  };
  EXPECT_TRUE(names(s.legs[1]) || names(s.legs[4]))
      << "a ring may be passed either way: " << survey_checks(s)[0];
}

TEST(SurveyChecks, ALegThatCutsATraverseShortIsNotItsFirst) {
  Survey s = two_legs();
  s.files = {"cave.th"};
  s.legs[0].source = {0, 5};
  s.legs[1].source = {0, 7};
  Leg chord;
  chord.to = 2;
  chord.source = {0, 3};
  s.legs.push_back(chord);
  s.loops.traverses = {traverse(70.7, 70)};
  s.loops.traverses[0].stations = {"cave.2", "cave.1", "cave.0"};
  ASSERT_EQ(survey_checks(s).size(), 1u);
  EXPECT_TRUE(test::says(survey_checks(s)[0], "(cave.th: line 7)")) << survey_checks(s)[0];
}

/// Why the fixes of these lines are refused; empty if they are not.
std::string refusal_of_fixes(const std::string& lines) {
  try {
    refuse_contradictory_fixes(test::adjusted_lines(lines));
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(SurveyChecks, FixesFarApartOnAFewLegsAreRefusedWithTheirPlace) {
  SKIP_WITHOUT_SURVEX();
  const auto refusal = [](const std::string& fix) {
    return refusal_of_fixes("fix 1 0 0 0\nfix 3 " + fix + "\n" + test::kNormal + "1 2 10 0 0\n2 3 10 0 0\n");
  };
  EXPECT_EQ(refusal("0 75 0"), "") << "a coarse fix";
  EXPECT_EQ(refusal("0 500 0 300 300 300"), "") << "it says how coarse it is";
  const std::string text = refusal("0 500 0");
  EXPECT_TRUE(test::says(text, "both of them fixed, are 20 m long, and would have to move by 480 m")) << text;
  EXPECT_TRUE(test::says(text, ": line ")) << text;
  EXPECT_EQ(
      refusal_of_fixes("fix 1 0 0 0\n" + test::kNormal + "1 2 5 0 0\n2 3 5 0 0\n1 4 405 0 0\n4 3 5 0 0\n"),
      "")
      << "a slip in a reading is a check";
}

}  // namespace
}  // namespace karst::survey
