// What the policy decides in caves drawn by hand. No simulator, no test framework.
#include <karst/testing/bench.h>

#include <cstdio>

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

}  // namespace

int main() {
  karst::testing::Bench bench(karst_plugin_entry(), corridor);
  bench.position = corridor.place('s');
  bench.offer(1, corridor.place('a'), corridor.place('a'));
  bench.offer(2, corridor.place('b'), corridor.place('b'));
  expect(bench.decide().goals[0].frontier_id == 2, "of frontiers of one age the nearer one");

  bench.time_s = 30;
  const karst::Goal flown = bench.decide().goals[0];
  bench.tell(KARST_EVENT_GOAL_REACHED, flown);
  bench.offer(3, corridor.place('c'), corridor.place('c'));
  const karst::Decision d = bench.decide();
  expect(d.goals[0].frontier_id == 3, "what was found last comes first, although it is far");
  expect(d.goals[0].why == "seen for 0 s, 10.0 m away", "the report says why");

  bench.tell(KARST_EVENT_GOAL_REJECTED, d.goals[0], "too near to rock");
  expect(bench.decide().goals[0].frontier_id == 2, "a place where a goal came to nothing is left alone");

  const std::vector<unsigned char> saved = bench.saved();
  bench.restart({});
  expect(bench.decide().goals[0].frontier_id == 2, "a new object has forgotten: the nearer one again");
  bench.restart(saved);
  expect(bench.decide().goals[0].why == "seen for 30 s, 3.0 m away, under way",
         "one that was restored has not");

  bench.time_s = 51;
  expect(bench.decide().goals[0].frontier_id == 3, "for a while");
  return failures == 0 ? 0 : 1;
}
