// Words and numbers of figures, as verdicts and papers print them.
#include "sdk/campaign/verdict/figure_words.h"

#include <gtest/gtest.h>

namespace karst::campaign {
namespace {

TEST(FigureWords, NumbersHaveTheDigitsAskedFor) {
  EXPECT_EQ(decimals_for(0.034, 2), 3);
  EXPECT_EQ(decimals_for(5, 2), 1);
  EXPECT_EQ(decimals_for(12, 2), 0);
  EXPECT_EQ(decimals_for(12345, 2), 0) << "never fewer than none";
  EXPECT_EQ(decimals_for(1e-12, 2), 6) << "never more than six";
  EXPECT_EQ(decimals_for(0, 2), 1) << "of a scale that is not known";
}

TEST(FigureWords, ZeroHasNoSign) {
  EXPECT_EQ(fixed_text(-0.04, 1), "0.0");
  EXPECT_EQ(fixed_text(-0.4, 0), "0");
  EXPECT_EQ(fixed_text(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed_text(-1e-9, 6), "0.000000");
}

TEST(FigureWords, NamesAreListed) {
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed({"near"}), "near");
  EXPECT_EQ(listed({"near", "far", "high"}), "near, far and high");
}

TEST(FigureWords, EveryFigureHasASubjectAndAVerb) {
  for (const evaluation::MetricDefinition& figure : evaluation::metric_definitions()) {
    EXPECT_FALSE(subject_of(figure).empty()) << figure.name;
    for (const bool more : {true, false}) EXPECT_TRUE(verb_of(figure, more).ends_with("than")) << figure.name;
    EXPECT_NE(verb_of(figure, true), verb_of(figure, false)) << figure.name;
  }
}

TEST(FigureWords, SharesAreFractionsAndCountsAndLengthsAreNot) {
  const auto is_share = [](std::string_view name) {
    return is_fraction(
        evaluation::metric_definitions()[static_cast<std::size_t>(evaluation::metric_index(name))]);
  };
  for (const char* name :
       {"completed", "standing_share", "coverage", "coverage_auc", "coverage_at_25", "surface_seen",
        "battery_left", "objects_reported_share", "data_at_base_share", "robots_landed", "robots_connected"})
    EXPECT_TRUE(is_share(name)) << name;
  for (const char* name : {"contacts", "objects_seen", "depth_m", "drift_percent", "path_length_m"})
    EXPECT_FALSE(is_share(name)) << name;
}

TEST(FigureWords, HeadlineFiguresAreFigures) {
  EXPECT_FALSE(headline_figures().empty());
  for (const std::string_view name : headline_figures()) EXPECT_GE(evaluation::metric_index(name), 0) << name;
}

}  // namespace
}  // namespace karst::campaign
