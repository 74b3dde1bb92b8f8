// A pipe that is drained while nobody asks, and left alone when it is closed.
#include "sdk/host/isolation/output_drain.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <memory>
#include <string>
#include <thread>

namespace karst::test {
namespace {

using host::OutputDrain;
using host::PolicyOutput;

void print(int descriptor, const std::string& text) {
  ASSERT_EQ(write(descriptor, text.data(), text.size()), static_cast<ssize_t>(text.size()));
}

TEST(OutputDrain, TakesMoreThanAPipeHoldsWithoutBeingAsked) {
  const auto output = std::make_shared<PolicyOutput>();
  {
    OutputDrain drain(output);
    for (int i = 0; i < 5000; ++i) print(drain.write_end(), std::string(99, 'x') + "\n");  // half a megabyte
    print(drain.write_end(), "the last");
  }
  EXPECT_TRUE(output->last_lines().ends_with("x\nthe last\n")) << output->last_lines();
}

TEST(OutputDrain, EndsAlthoughTheOtherEndStaysOpen) {
  const auto output = std::make_shared<PolicyOutput>();
  int kept = -1;
  {
    OutputDrain drain(output);
    kept = dup(drain.write_end());
    drain.close_write_end();
    EXPECT_EQ(drain.write_end(), -1);
    print(kept, "said\n");
  }
  close(kept);
  EXPECT_EQ(output->last_lines(), "said\n");
}

/// Of this process, in seconds.
double processor_time_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST(OutputDrain, AClosedPipeIsNotLookedAtAgain) {
  const auto output = std::make_shared<PolicyOutput>();
  OutputDrain drain(output);
  print(drain.write_end(), "all\n");
  drain.close_write_end();
  const double before_s = processor_time_s();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_LT(processor_time_s() - before_s, 0.1) << "it spins";
}

}  // namespace
}  // namespace karst::test
