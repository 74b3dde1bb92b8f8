// The reviewed layout table, seen by a C++ compiler (layout_check.c asserts the same in C11).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <type_traits>

#include "sdk/abi/karst_abi.h"
#include "sdk/abi/karst_abi_imaged.h"
#include "sdk/abi/karst_abi_survey.h"

namespace {

TEST(Layout, IsAsReviewed) {
#define KARST_SIZE(type, bytes)                        \
  EXPECT_EQ(sizeof(struct type), bytes##u) << #type;   \
  EXPECT_TRUE(std::is_standard_layout_v<struct type>); \
  EXPECT_TRUE(std::is_trivially_copyable_v<struct type>);
#define KARST_FIELD(type, field, offset) \
  EXPECT_EQ(offsetof(struct type, field), offset##u) << #type "." #field;
#include "sdk/abi/karst_abi_layout.inc"
#undef KARST_SIZE
#undef KARST_FIELD
}

TEST(Layout, AppendableStructsEndWithoutPadding) {
  // A field that is added later would lie in the padding, and look filled to KARST_HAS in tables made before
  // it.
  std::map<std::string, std::size_t> end;
  std::set<std::string> appendable;
#define KARST_SIZE(type, bytes)
#define KARST_FIELD(type, field, offset)                                                 \
  end[#type] = std::max(end[#type], offsetof(struct type, field) + sizeof(type::field)); \
  if (std::string(#field) == "size") appendable.insert(#type);
#include "sdk/abi/karst_abi_layout.inc"
#undef KARST_SIZE
#undef KARST_FIELD
#define KARST_SIZE(type, bytes)                          \
  if (appendable.contains(#type)) {                      \
    EXPECT_EQ(end[#type], sizeof(struct type)) << #type; \
  }
#define KARST_FIELD(type, field, offset)
#include "sdk/abi/karst_abi_layout.inc"
  EXPECT_GE(appendable.size(), 11u);
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
