"""What the policy decides in caves drawn by hand. No simulator; run it, or let pytest run it."""

import karst.testing
from my_nearest import MyNearest

# Seen from above, a cell a metre: '#' rock, '.' free, a letter is a free cell with a name. North is up.
TWO_PASSAGES = """
    #############
    #b.........a#
    #.#########.#
    #......s....#
    #############"""


def bench_at_the_start(**parameters):
    bench = karst.testing.Bench(MyNearest, TWO_PASSAGES, parameters={"min_cells": 5, **parameters})
    bench.position = bench.place("s")
    return bench


def test_without_a_frontier_the_cave_is_explored():
    assert isinstance(bench_at_the_start().decide(), karst.Explored)


def test_the_nearer_by_its_way_comes_first():
    bench = bench_at_the_start()
    bench.offer(1, bench.place("a"))
    bench.offer(2, bench.place("b"))
    goals = bench.decide().goals
    assert [goal.frontier_id for goal in goals] == [1, 2]
    assert goals[0].why == "5.4 m away"


def test_a_frontier_of_a_few_cells_is_ignored():
    bench = bench_at_the_start()
    bench.offer(1, bench.place("a"), cells=4)
    bench.offer(2, bench.place("b"))
    assert [goal.frontier_id for goal in bench.decide().goals] == [2]


if __name__ == "__main__":
    karst.testing.main()
