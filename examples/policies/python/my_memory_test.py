"""What the policy decides in caves drawn by hand. No simulator; run it, or let pytest run it."""

import karst.testing
from my_memory import MyMemory

CORRIDOR = """
    ###################
    #a.....s..b......c#
    ###################"""


def first(bench):
    return bench.decide().goals[0]


def test_what_was_found_last_comes_first_and_failures_rest():
    bench = karst.testing.Bench(MyMemory, CORRIDOR)
    bench.position = bench.place("s")
    bench.offer(1, bench.place("a"))
    bench.offer(2, bench.place("b"))
    assert first(bench).frontier_id == 2, "of frontiers of one age the nearer one"

    bench.time_s = 30
    flown = first(bench)
    bench.tell(karst.EventKind.GOAL_REACHED, flown)
    bench.offer(3, bench.place("c"))
    last = first(bench)
    assert last.frontier_id == 3, "what was found last comes first, although it is far"
    assert last.why == "seen for 0 s, 10.0 m away"

    bench.tell(karst.EventKind.GOAL_REJECTED, last, "too near to rock")
    assert first(bench).frontier_id == 2, "a place where a goal came to nothing is left alone"

    saved = bench.saved()
    bench.restart()
    assert first(bench).frontier_id == 2, "a new object has forgotten: the nearer one again"
    bench.restart(saved)
    assert first(bench).why == "seen for 30 s, 3.0 m away, under way", "one that was restored has not"

    bench.time_s = 51
    assert first(bench).frontier_id == 3, "for a while"


if __name__ == "__main__":
    karst.testing.main()
