#include "sdk/selection/figure_words.h"

#include <gtest/gtest.h>

#include <string>

#include "sdk/selection/experience.h"

namespace {

using namespace karst::selection;

TEST(FigureWords, SharesAreWholeOnlyIfTheyAre) {
  EXPECT_EQ(share_text(0.999), ">99 %");
  EXPECT_EQ(share_text(0.9999999), ">99 %");
  EXPECT_EQ(share_text(1), "100 %");
  EXPECT_EQ(share_text(0.724), "72 %");
  EXPECT_EQ(share_text(0.004), "<1 %");
  EXPECT_EQ(share_text(0), "0 %");
}

TEST(FigureWords, ValuesHaveSensibleDigitsAndUnits) {
  EXPECT_EQ(metric_value_text("coverage_auc", 0.722), "72 %");
  EXPECT_EQ(metric_value_text("explored_volume_m3", 1440.3), "1440 m³");
  EXPECT_EQ(metric_value_text("energy_wh", 20.66), "20.7 Wh");
  EXPECT_EQ(metric_value_text("contacts", 0), "0");
  EXPECT_EQ(metric_words("coverage_auc"), "coverage averaged over the flight");
  EXPECT_EQ(metric_words("no_such_metric"), "no_such_metric");
}

// A volume was "5.2e+03 m³".
TEST(FigureWords, RoundedNumbersHaveThreeDigitsAndNoPowerOfTen) {
  EXPECT_EQ(rounded_number(0.5432), "0.543");
  EXPECT_EQ(rounded_number(80), "80");
  EXPECT_EQ(rounded_number(999.4), "999");
  EXPECT_EQ(rounded_number(999.7), "1,000");
  EXPECT_EQ(rounded_number(5204), "5,200");
  EXPECT_EQ(rounded_number(-6914), "-6,910");
  EXPECT_EQ(rounded_number(9996), "10,000");
  EXPECT_EQ(rounded_number(20349), "20,300");
  EXPECT_EQ(rounded_number(1234567), "1,230,000");
}

TEST(FigureWords, EveryLearnedMetricHasWords) {
  for (const std::string& metric : learned_metrics())
    EXPECT_EQ(metric_words(metric).find('_'), std::string::npos);
}

}  // namespace
