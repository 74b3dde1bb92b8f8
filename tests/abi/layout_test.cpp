// The reviewed layout table, seen by a C++ compiler (layout_check.c asserts the same in C11).
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "sdk/abi/karst_abi.h"

namespace {

TEST(Layout, IsAsReviewed) {
#define KARST_SIZE(type, bytes)                        \
  EXPECT_EQ(sizeof(struct type), bytes##u) << #type;   \
  EXPECT_TRUE(std::is_standard_layout_v<struct type>); \
  EXPECT_TRUE(std::is_trivially_copyable_v<struct type>);
#define KARST_FIELD(type, field, offset) \
  EXPECT_EQ(offsetof(struct type, field), offset##u) << #type "." #field;
#include "sdk/abi/karst_abi_layout.inc"
}

TEST(HasMacro, AsksSizeBeforeItReadsTheSlot) {
  karst_policy_t table;
  std::memset(&table, 0xAB, sizeof table);  // every slot looks filled
  table.size = offsetof(karst_policy_t, destroy);
  EXPECT_FALSE(KARST_HAS(karst_policy_t, &table, destroy));
  EXPECT_TRUE(KARST_HAS(karst_policy_t, &table, deactivate));
  table.size = sizeof table;
  EXPECT_TRUE(KARST_HAS(karst_policy_t, &table, destroy));
  table.destroy = nullptr;
  EXPECT_FALSE(KARST_HAS(karst_policy_t, &table, destroy));
}

}  // namespace
