// Axes of plots, and looks of contestants.
#include "sdk/campaign/paper/plot_axis.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include "sdk/campaign/paper/plot_look.h"

namespace karst::campaign {
namespace {

RC_GTEST_PROP(PlotAxis, CoversItsNumbersWithFewEvenTicks, ()) {
  const int power = *rc::gen::inRange(-5, 6);
  const double unit = std::pow(10.0, power);
  const double least = *rc::gen::inRange(-1000, 1000) * unit,
               most = least + *rc::gen::inRange(1, 2000) * unit;
  const PlotAxis axis = number_axis(least, most, 5, "x");
  const double rounding = 1e-6 * (most - least);
  RC_ASSERT(axis.low <= least + rounding);
  RC_ASSERT(axis.high >= most - rounding);
  RC_ASSERT(axis.high - axis.low < 3 * (most - least));  // it is not squeezed
  RC_ASSERT(axis.ticks.size() >= 2u);
  RC_ASSERT(axis.ticks.size() <= 8u);
  RC_ASSERT(std::abs(axis.ticks.front().at - axis.low) <= rounding);
  RC_ASSERT(std::abs(axis.ticks.back().at - axis.high) <= rounding);
  const double step = axis.ticks[1].at - axis.ticks[0].at;
  for (std::size_t i = 1; i < axis.ticks.size(); ++i)
    RC_ASSERT(std::abs(axis.ticks[i].at - axis.ticks[i - 1].at - step) <= 1e-6 * step);
}

TEST(PlotAxis, WritesRoundNumbers) {
  std::string texts;
  for (const PlotTick& t : number_axis(-0.07, 0.31, 4, "").ticks) texts += t.text + " ";
  EXPECT_EQ(texts, "\u22120.1 0.0 0.1 0.2 0.3 0.4 ");
  texts.clear();
  for (const PlotTick& t : number_axis(0, 300, 6, "").ticks) texts += t.text + " ";
  EXPECT_EQ(texts, "0 50 100 150 200 250 300 ");
}

TEST(PlotAxis, OfOneNumberHasAWidth) {
  const PlotAxis axis = number_axis(5, 5, 4, "");
  EXPECT_LE(axis.low, 5);
  EXPECT_GT(axis.high, axis.low);
}

TEST(PlotAxis, OfNamesBeginsAtTheTop) {
  const PlotAxis axis = name_axis({"first", "second"});
  EXPECT_GT(axis.low, axis.high);
  EXPECT_EQ(axis.ticks[0].at, 0);
  EXPECT_EQ(axis.ticks[1].text, "second");
  EXPECT_NE(name_axis({}).low, name_axis({}).high);
}

/// CIE L*, 0 to 100, of "#rrggbb": how light it is in grey.
double lightness(std::string_view colour) {
  const auto linear = [&](std::size_t at) {
    const long byte = std::strtol(std::string(colour.substr(at, 2)).c_str(), nullptr, 16);
    const double c = static_cast<double>(byte) / 255;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(1) + 0.7152 * linear(3) + 0.0722 * linear(5);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(PlotLook, ColoursDifferInGreyAndFromThePaper) {
  for (std::size_t a = 0; a < 5; ++a) {
    EXPECT_LT(lightness(plot_look(a).colour), 85);
    for (std::size_t b = a + 1; b < 5; ++b)
      EXPECT_GT(std::abs(lightness(plot_look(a).colour) - lightness(plot_look(b).colour)), 12)
          << plot_look(a).colour << " and " << plot_look(b).colour;
  }
}

TEST(PlotLook, TellsThirtyContestantsApartWithoutColour) {
  std::set<std::pair<std::string_view, std::string_view>> looks;
  for (std::size_t i = 0; i < 30; ++i) looks.insert({plot_look(i).dashes, plot_look(i).mark});
  EXPECT_EQ(looks.size(), 30u);
}

}  // namespace
}  // namespace karst::campaign
