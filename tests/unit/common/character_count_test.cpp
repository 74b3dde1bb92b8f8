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

TEST(CharacterCount, TextIsCutBetweenCharacters) {
  EXPECT_EQ(first_characters("", 3), "");
  EXPECT_EQ(first_characters("rock", 0), "");
  EXPECT_EQ(first_characters("rock", 3), "roc");
  EXPECT_EQ(first_characters("rock", 9), "rock");
  EXPECT_EQ(first_characters("Höhle", 1), "H");
  EXPECT_EQ(first_characters("Höhle", 2), "Hö");
  EXPECT_EQ(first_characters("\u20ac\U0001F987x", 2), "\u20ac\U0001F987");
}

}  // namespace
}  // namespace karst::core
