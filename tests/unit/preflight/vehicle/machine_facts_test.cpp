#include <gtest/gtest.h>

#include <filesystem>

#include "sdk/preflight/vehicle/measurements.h"

namespace karst::preflight {
namespace {

TEST(MachineFacts, AFolderThatIsToBeCreatedHasTheSpaceOfTheOneAbove) {
  const MachineFacts here = machine_facts("."), below = machine_facts("not/there/yet");
  ASSERT_TRUE(here.free_bytes && below.free_bytes);
  EXPECT_NEAR(static_cast<double>(*here.free_bytes), static_cast<double>(*below.free_bytes), 1e9);
  EXPECT_FALSE(std::filesystem::exists("not"));
  EXPECT_TRUE(here.clock_plausible);
}

TEST(MachineFacts, AFolderWithoutSpaceHasNone) {
  const MachineFacts facts = machine_facts("/proc/self");
  ASSERT_TRUE(facts.free_bytes.has_value());
  EXPECT_EQ(*facts.free_bytes, 0u);
}

}  // namespace
}  // namespace karst::preflight
