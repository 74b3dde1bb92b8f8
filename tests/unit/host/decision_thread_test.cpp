#include "sdk/host/decision_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace karst::host {
namespace {

TEST(DecisionThread, RunsEveryTaskOnTheSameThreadInOrder) {
  DecisionThread thread;
  int count = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(thread.run(
        [&, i] {
          if (count == i && std::this_thread::get_id() == thread.id()) ++count;
        },
        60.0));
  }
  EXPECT_EQ(count, 1000);
}

TEST(DecisionThread, GivesUpOnATaskThatDoesNotReturnAndTakesNoOther) {
  auto gate = std::make_shared<std::promise<void>>();
  auto left = std::make_shared<std::promise<void>>();
  std::future<void> done = left->get_future();
  {
    DecisionThread thread;
    EXPECT_FALSE(thread.run(
        [gate, left] {
          gate->get_future().wait();
          left->set_value();
        },
        0.05));
    EXPECT_TRUE(thread.hangs());
    bool ran = false;
    EXPECT_FALSE(thread.run([&] { ran = true; }, 60.0));
    EXPECT_FALSE(ran);
  }
  gate->set_value();  // the object is gone; its thread still ends well
  done.wait();
}

}  // namespace
}  // namespace karst::host
