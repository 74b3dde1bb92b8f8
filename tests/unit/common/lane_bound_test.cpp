#include "core_stack/common/lane_bound.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace karst::core {
namespace {

const auto kToTheEnd = [] { return false; };

TEST(LaneBound, GivesTheResultOfAJobWhenItsBudgetIsOverInTheOrderOfTheJobs) {
  for (const int threads : {1, 4}) {
    Executive executive(threads);
    LaneBound<std::vector<int>> numbers(executive, Lane::map);
    std::vector<std::pair<TimeNs, std::size_t>> sizes;
    executive.every("step", 10, 10, [&] {
      numbers.job(
          "add", 5,
          [n = executive.now()](std::vector<int>& v) {
            v.push_back(static_cast<int>(n));
            return v.size();
          },
          [&](std::size_t size) { sizes.emplace_back(executive.now(), size); });
    });
    executive.run_until(40, kToTheEnd);
    executive.drain();
    EXPECT_EQ(sizes, (std::vector<std::pair<TimeNs, std::size_t>>{{15, 1}, {25, 2}, {35, 3}}));
    EXPECT_EQ(numbers.while_idle(), (std::vector<int>{10, 20, 30, 40}));
  }
}

TEST(LaneBound, AJobThatThrowsIsToldAndTheResidentStaysAsItWas) {
  Executive executive(2);
  LaneBound<int> number(executive, Lane::map, 7);
  int used = 0;
  number.job(
      "fails", 5, [](int&) -> int { throw std::runtime_error("no"); }, [&](int) { ++used; });
  EXPECT_THROW(executive.run_until(10, kToTheEnd), std::runtime_error);
  number.job("doubles", 5, [](int& n) { n *= 2; });
  executive.run_until(20, kToTheEnd);
  executive.drain();
  EXPECT_EQ(used, 0);
  EXPECT_EQ(number.while_idle(), 14);
}

}  // namespace
}  // namespace karst::core
