#include "core_stack/mission/flight/step_watch.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

TEST(StepWatch, MissesAStepOnlyAfterItsPatience) {
  StepWatch watch(100 * kMillisecond);
  watch.came(3 * kSecond);
  EXPECT_FALSE(watch.missing(3 * kSecond + 100 * kMillisecond));
  EXPECT_TRUE(watch.missing(3 * kSecond + 101 * kMillisecond));
  EXPECT_EQ(watch.since(4 * kSecond), kSecond);
  watch.came(4 * kSecond);
  EXPECT_FALSE(watch.missing(4 * kSecond));
}

}  // namespace
}  // namespace karst::core
