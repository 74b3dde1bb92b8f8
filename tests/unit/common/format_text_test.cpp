#include "core_stack/common/format_text.h"

#include <gtest/gtest.h>

#include <cstdlib>

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

TEST(ShortestText, ReadsBackAsTheSameNumber) {
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(-3), "-3");
  EXPECT_EQ(shortest_text(1e300), "1e+300");
  for (const double v : {1.0 / 3, 0.1 + 0.2, -2.2250738585072014e-308, 1.7976931348623157e308})
    EXPECT_EQ(std::strtod(shortest_text(v).c_str(), nullptr), v) << shortest_text(v);
}

}  // namespace
}  // namespace karst::core
