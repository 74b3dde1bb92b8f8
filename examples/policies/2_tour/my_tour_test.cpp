// What the policy decides in caves drawn by hand. No simulator, no test framework.
#include <karst/testing/bench.h>

#include <cstdio>
#include <string>

namespace {

int failures = 0;

void expect(bool good, const char* what) {
  std::printf("%s: %s\n", good ? "passed" : "FAILED", what);
  failures += good ? 0 : 1;
}

// Seen from above, a cell a metre: '#' rock, '.' free, a letter is a free cell with a name. North is up.
const karst::testing::DrawnMap corridor(1.0, {R"(
  ###################
  #a.....s..b......c#
  ###################)"});

/// The ids of the goals, in the order of the answer.
std::string order_of(const karst::Decision& d) {
  std::string out;
  for (const karst::Goal& g : d.goals) out += std::to_string(g.frontier_id);
  return out;
}

}  // namespace

int main() {
  karst::testing::Bench bench(karst_plugin_entry(), corridor, {{"stops", "3"}});
  bench.position = corridor.place('s');
  expect(bench.decide().outcome == KARST_OUTCOME_EXPLORED, "without a frontier the cave is explored");

  bench.offer(1, corridor.place('a'), corridor.place('a'));
  bench.offer(2, corridor.place('b'), corridor.place('b'));
  bench.offer(3, corridor.place('c'), corridor.place('c'));
  const karst::Decision d = bench.decide();
  // Always on to the nearest would be b, then c, then all the way back to a: 3 + 7 + 16 = 26 m.
  expect(order_of(d) == "123", "a first, then b and c on one way: 6 + 9 + 7 = 22 m");
  expect(d.in_order, "the answer is a tour");
  expect(d.goals[0].why == "stop 1 of 3, a tour of 22 m", "the report says so");
  expect(bench.host().drawings == 1, "the tour is drawn into the report");

  bench.offer(4, corridor.place('s'), corridor.place('s'));
  expect(bench.decide().goals.size() == 3, "only the nearest stops are visited");
  return failures == 0 ? 0 : 1;
}
