#include "core_stack/common/format_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core_stack/common/counted.h"
#include "core_stack/common/decimal_text.h"
#include "core_stack/common/shell_word.h"
#include "core_stack/common/unit_text.h"

namespace karst::core {
namespace {

TEST(FormatText, IsWhatPrintfWrites) {
  EXPECT_EQ(format_text("%d %s %.2f %%", -3, "m", 0.125), "-3 m 0.12 %");
  EXPECT_EQ(format_text("%s", ""), "");
}

TEST(FormatText, HasNoLongestText) {
  const std::string name(100'000, 'x');
  EXPECT_EQ(format_text("%s and %s.", name.c_str(), name.c_str()), name + " and " + name + ".");
}

TEST(ShellWord, IsQuotedOnlyIfNeedBe) {
  EXPECT_EQ(shell_word("policy.auto.survey=own/tunnel.info"), "policy.auto.survey=own/tunnel.info");
  EXPECT_EQ(shell_word("1 2 1.5"), "'1 2 1.5'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_option("--start", "1 2 1.5"), " --start '1 2 1.5'");
  EXPECT_EQ(shell_option("--start", "-1 2 1.5"), " '--start=-1 2 1.5'") << "a value, not an option";
  EXPECT_EQ(shell_option("--start", ""), "");
}

TEST(DecimalText, ZeroHasNoSign) {
  EXPECT_EQ(decimal_text(-0.04, 1), "0.0");
  EXPECT_EQ(decimal_text(-0.0, 0), "0");
  EXPECT_EQ(decimal_text(-0.06, 1), "-0.1");
  EXPECT_EQ(decimal_text(-10.0, 1), "-10.0");
  EXPECT_EQ(decimal_text(-HUGE_VAL, 1), "-inf");
  EXPECT_EQ(decimal_text(Vec3(-0.001, -0.3, 1.22), 2), "0.00 -0.30 1.22");
}

TEST(UnitText, WritesCubicMetresAsPeopleDo) {
  EXPECT_EQ(unit_text("even_volume 10 m^3, 2 m^3"), "even_volume 10 m\u00B3, 2 m\u00B3");
  EXPECT_EQ(unit_text("m^2, m/s"), "m^2, m/s");
  EXPECT_EQ(unit_text(""), "");
}

TEST(Grouped, HasACommaBeforeEachThreeDigits) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(60'000), "60,000");
  EXPECT_EQ(grouped(1'234'567), "1,234,567");
}

TEST(ShortestText, ReadsBackAsTheSameNumber) {
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(-3), "-3");
  EXPECT_EQ(shortest_text(1e300), "1e+300");
  for (const double v : {1.0 / 3, 0.1 + 0.2, -2.2250738585072014e-308, 1.7976931348623157e308})
    EXPECT_EQ(std::strtod(shortest_text(v).c_str(), nullptr), v) << shortest_text(v);
}

}  // namespace
}  // namespace karst::core
