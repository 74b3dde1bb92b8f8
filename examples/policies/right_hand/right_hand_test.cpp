// A policy's own test, without a simulator and without a test framework.
#include <karst/testing/bench.h>

#include <cstdio>

int main() {
  const karst::testing::DrawnMap map(1.0, {R"(
    ....l....
    .........
    ....s...e
    .........
    ....r....)"});
  karst::testing::Bench bench(karst_plugin_entry(), map);
  bench.position = map.place('s');
  bench.direction_of_flight = {1, 0, 0};
  bench.offer(1, map.place('l'), map.place('l'));
  bench.offer(2, map.place('e'), map.place('e'));
  bench.offer(3, map.place('r'), map.place('r'));
  const karst::Decision d = bench.decide();
  const bool good = d.goals.size() == 3 && d.goals[0].frontier_id == 3 && d.goals[1].frontier_id == 2;
  std::printf("%s: %s\n", good ? "passed" : "FAILED",
              d.goals.empty() ? d.reason.c_str() : d.goals[0].why.c_str());
  return good ? 0 : 1;
}
