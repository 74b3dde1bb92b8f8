// An option that was renamed is refused with its new name.
#include "core_stack/common/former_keys.h"

#include <gtest/gtest.h>

#include <string>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::core {
namespace {

std::string error_of_setting(const std::string& key) {
  double separation_m = 3;
  OptionTable t;
  t.under("team", [&](OptionTable& team) { team.add("separation", separation_m, "m", 1, 20, "distance"); });
  try {
    t.set("a.info", key, "2");
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(FormerKeys, ARenamedKeyIsRefusedWithItsNewName) {
  EXPECT_NE(error_of_setting("team.keep_apart").find("is now called team.separation"), std::string::npos);
  EXPECT_EQ(error_of_setting("team.separation"), "");
}

TEST(FormerKeys, AreNotNamedWhereTheNewKeyDoesNotExist) {
  EXPECT_EQ(error_of_setting("homing.keep_apart").find("is now called"), std::string::npos);
}

TEST(FormerKeys, KeepTheirSection) {
  EXPECT_EQ(renamed("homing.landing.most_slope"), "homing.landing.max_slope");
  EXPECT_EQ(renamed("most_volume"), "max_volume");
  EXPECT_EQ(renamed("team.robots"), "");
}

}  // namespace
}  // namespace karst::core
