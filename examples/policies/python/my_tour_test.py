"""What the policy decides in caves drawn by hand. No simulator; run it, or let pytest run it."""

import karst.testing
from my_tour import MyTour

CORRIDOR = """
    ###################
    #a.....s..b......c#
    ###################"""


def test_a_tour_goes_the_short_way_round():
    bench = karst.testing.Bench(MyTour, CORRIDOR, parameters={"stops": 3})
    bench.position = bench.place("s")
    assert isinstance(bench.decide(), karst.Explored)
    for id, place in enumerate("abc", 1):
        bench.offer(id, bench.place(place))
    answer = bench.decide()
    assert isinstance(answer, karst.Tour)
    # Always on to the nearest would be b, then c, then all the way back to a: 3 + 7 + 16 = 26 m.
    assert [goal.frontier_id for goal in answer.goals] == [1, 2, 3]
    assert answer.goals[0].why == "stop 1 of 3, a tour of 22 m"
    bench.offer(4, bench.place("s"))
    assert len(bench.decide().goals) == 3, "only the nearest stops are visited"


if __name__ == "__main__":
    karst.testing.main()
