/*
 * What the policy decides in a cave drawn by hand. No simulator, no test framework.
 */
#include <karst/testing/bench_c.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

static void expect(int good, const char* what) {
  printf("%s: %s\n", good ? "passed" : "FAILED", what);
  failures += good ? 0 : 1;
}

/* Seen from above, a cell a metre: '#' rock, '.' free, a letter is a free cell with a name. North is up. The
   lowest layer comes first; an empty line ends a layer. A pit leads down to a; b lies on the upper floor. */
static const char pit[] =
    "#######\n"
    "#a#####\n"
    "#######\n"
    "\n"
    "#######\n"
    "#.#####\n"
    "#######\n"
    "\n"
    "#######\n"
    "#..s.b#\n"
    "#######\n";

/* A bench with the vehicle at s, where it also started, and a frontier at a and at b. */
static karst_bench_t* bench_in_pit(const char* parameters) {
  karst_error_t error = {0};
  karst_bench_t* bench = karst_bench_create(karst_plugin_entry(), pit, 1.0, parameters, &error);
  if (!bench) {
    fprintf(stderr, "no bench: %s\n", error.text);
    exit(1);
  }
  karst_bench_state_t state = karst_bench_get_state(bench);
  state.position = state.start = karst_bench_place(bench, 's');
  karst_bench_set_state(bench, &state);
  karst_bench_offer(bench, 1, karst_bench_place(bench, 'a'), karst_bench_place(bench, 'a'), 20);
  karst_bench_offer(bench, 2, karst_bench_place(bench, 'b'), karst_bench_place(bench, 'b'), 20);
  return bench;
}

int main(void) {
  karst_error_t error = {0};
  karst_bench_t* bench = bench_in_pit("");
  expect(karst_bench_decide(bench, &error) == KARST_OK, "it decides");
  expect(karst_bench_goal_count(bench) == 1, "it flies to one goal");
  expect(karst_bench_goal(bench, 0).frontier_id == 1, "the lowest frontier, although the other is nearer");
  expect(strcmp(karst_bench_why(bench, 0), "the lowest, 2.0 m below the start") == 0,
         "the report says how low");

  karst_bench_clear_frontiers(bench);
  karst_bench_decide(bench, &error);
  expect(karst_bench_outcome(bench) == KARST_OUTCOME_EXPLORED, "without a frontier the cave is explored");
  karst_bench_destroy(bench);

  bench = bench_in_pit("max_path=3");
  karst_bench_decide(bench, &error);
  expect(karst_bench_goal(bench, 0).frontier_id == 2, "a frontier with too long a way to it is ignored");
  karst_bench_destroy(bench);
  return failures == 0 ? 0 : 1;
}
