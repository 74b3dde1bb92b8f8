#include "core_stack/common/format_text.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace karst::core
