#include "core_stack/common/character_count.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

TEST(CharacterCount, IsOfCharactersNotBytes) {
  EXPECT_EQ(character_count(""), 0u);
  EXPECT_EQ(character_count("rock"), 4u);
  EXPECT_EQ(character_count("Höhle"), 5u);
  EXPECT_EQ(character_count("\u00b2 \u20ac \U0001F987"), 5u) << "of two, three and four bytes";
}

}  // namespace
}  // namespace karst::core
