// A sequence of requests, with the events before each and the expectation of each answer.
//
//   const std::string fault = play(bench, {
//       {"at the start", [&](Bench& b) { b.position = map.place('s'); }, flies_to_frontier(1)},
//       {"it cannot be reached", [](Bench& b) { b.fail(KARST_EVENT_GOAL_UNREACHABLE); },
//       flies_to_frontier(2)},
//       {"it arrives", [](Bench& b) { b.arrive(); }, holds()}});
#pragma once
#include <functional>
#include <string>
#include <vector>

#include <karst/testing/bench.h>
#include <karst/testing/expect.h>

namespace karst::testing {

struct Step {
  std::string name;
  std::function<void(Bench&)> before;  // may be empty
  Expectation expected;
  double after_s = 1.0;  // time that passes before this step
};

/// "" if every answer was as expected, otherwise the first step with a mismatch, and the actual answer.
/// Rethrows exceptions of the policy.
inline std::string play(Bench& bench, const std::vector<Step>& steps) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    bench.time_s += steps[i].after_s;
    bench.seconds_before_homing -= steps[i].after_s;
    bench.battery_seconds_left -= steps[i].after_s;
    bench.mission_seconds_left -= steps[i].after_s;
    if (steps[i].before) steps[i].before(bench);
    const std::string fault = mismatch(bench.decide(), steps[i].expected);
    if (!fault.empty()) return "step " + std::to_string(i + 1) + ", " + steps[i].name + "\n" + fault;
  }
  return "";
}

}  // namespace karst::testing
