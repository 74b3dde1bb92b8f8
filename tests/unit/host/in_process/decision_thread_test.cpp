#include "sdk/host/in_process/decision_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace karst::host {
namespace {

TEST(DecisionThread, RunsEveryTaskOnTheSameThreadInOrder) {
  DecisionThread thread;
  int count = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(thread.run(
                  [&, i] {
                    if (count == i && std::this_thread::get_id() == thread.id()) ++count;
                  },
                  {60, 60}),
              "");
  }
  EXPECT_EQ(count, 1000);
}

TEST(DecisionThread, GivesUpOnATaskThatDoesNotReturnAndTakesNoOther) {
  auto gate = std::make_shared<std::promise<void>>();
  auto left = std::make_shared<std::promise<void>>();
  std::future<void> done = left->get_future();
  {
    DecisionThread thread;
    EXPECT_EQ(thread.run(
                  [gate, left] {
                    gate->get_future().wait();
                    left->set_value();
                  },
                  {0.05, 60}),
              "did not return within 0.05 s");
    EXPECT_TRUE(thread.hangs());
    bool ran = false;
    EXPECT_NE(thread.run([&] { ran = true; }, {60, 60}), "");
    EXPECT_FALSE(ran);
  }
  gate->set_value();  // the object is gone; its thread still ends well
  done.wait();
}

TEST(DecisionThread, CountsProcessorTimeSoThatALoadedMachineCostsNoPolicyItsFlight) {
  DecisionThread thread;
  const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(300)); };
  EXPECT_EQ(thread.run(wait, {60, 0.2}), "");  // as a thread that other programs keep from the processor
  auto stop = std::make_shared<std::atomic<bool>>(false);
  EXPECT_EQ(thread.run(
                [stop] {
                  while (!*stop) continue;
                },
                {60, 0.2}),
            "took more than 0.2 s of processor time");
  *stop = true;
}

}  // namespace
}  // namespace karst::host
