#include "sdk/host/boundary/asked.h"

#include <gtest/gtest.h>

namespace karst::host {
namespace {

TEST(NameOfWhatAPolicyWasAsked, OfARequestHasNumberAndTime) {
  core::DecisionRequest request;
  request.sequence = 7;
  request.stamp = core::from_seconds(12.34);
  EXPECT_EQ(asked(request), "request 7 at 12.3 s");
}

TEST(NameOfWhatAPolicyWasAsked, OfAnEventHasKindAndTime) {
  EXPECT_EQ(told({core::PolicyEvent::Kind::goal_unreachable, core::from_seconds(0.5), {}, ""}),
            "event unreachable at 0.5 s");
}

}  // namespace
}  // namespace karst::host
