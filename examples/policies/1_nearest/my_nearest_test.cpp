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
const karst::testing::DrawnMap two_passages(1.0, {R"(
  #############
  #b.........a#
  #.#########.#
  #......s....#
  #############)"});

}  // namespace

int main() {
  karst::testing::Bench bench(karst_plugin_entry(), two_passages, {{"min_cells", "5"}});
  bench.position = two_passages.place('s');

  expect(bench.decide().outcome == KARST_OUTCOME_EXPLORED, "without a frontier the cave is explored");

  bench.offer(1, two_passages.place('a'), two_passages.place('a'));
  bench.offer(2, two_passages.place('b'), two_passages.place('b'));
  const karst::Decision both = bench.decide();
  expect(both.goals.size() == 2 && both.goals[0].frontier_id == 1, "the nearer by its way comes first");
  expect(both.goals[0].why == "5.4 m away", "the report says how far it is");

  bench.frontiers[0].cells = 4;
  expect(bench.decide().goals[0].frontier_id == 2, "a frontier of a few cells is ignored");
  return failures == 0 ? 0 : 1;
}
