"""Policies in Python on the bench: what they are given, what they may answer, and what is said of mistakes."""

import textwrap
import threading
import time

import karst
import karst.testing
import numpy as np
import pytest
from karst import _hosted, _script
from karst.parameters import parameters_of

RING = """
    #############
    #b.........a#
    #.#########.#
    #......s....#
    #############"""


def rows(drawing=RING):
    """Cells by (x, y), south first: an independent reading of a drawing."""
    lines = [line.strip() for line in drawing.strip().split("\n")][::-1]
    return {(x, y): c for y, line in enumerate(lines) for x, c in enumerate(line)}


FREE = {k for k, c in rows().items() if c not in "#?"}
ROCK = {k for k, c in rows().items() if c == "#"}


def center(cell):
    return np.array([cell[0] + 0.5, cell[1] + 0.5, 0.5])


def policy_of(decide, **attributes):
    return type("Mine", (karst.Policy,), {"decide": lambda self, request: decide(request), **attributes})


def bench_of(decide, drawing=RING, **attributes):
    bench = karst.testing.Bench(policy_of(decide, **attributes), drawing)
    bench.position = bench.start = bench.place("s")
    return bench


def asked(question, drawing=RING):
    """What a policy is told when it asks."""
    told = []

    def decide(request):
        told.append(question(request))
        return karst.Hold("asked")

    bench_of(decide, drawing).decide()
    return told[0]


# -- Parameters


class Tunable(karst.Policy):
    weight = karst.Real(1.5, 0, 10, "m", "metres")
    cells = karst.Integer(10, 1, 10000, "cells")
    greedy = karst.Boolean(True, "takes all")
    side = karst.Text("left", "first", ["left", "right"])

    def init(self):
        if self.weight > 9 and self.cells > 9:
            raise karst.Error("weight and cells contradict each other")

    def decide(self, request):
        return karst.Hold(repr((self.weight, self.cells, self.greedy, self.side)))


@pytest.mark.parametrize("given, seen", [
    ({}, (1.5, 10, True, "left")),
    ({"weight": 2}, (2.0, 10, True, "left")),
    ({"weight": 0.1, "cells": 7, "greedy": False, "side": "right"}, (0.1, 7, False, "right")),
    ({"greedy": "false", "cells": np.int64(3), "weight": np.float32(0.5)}, (0.5, 3, False, "left")),
])
def test_parameters(given, seen):
    reason = karst.testing.Bench(Tunable, RING, parameters=given).decide().reason
    assert reason == repr(seen)  # with their types


def test_declared_parameters():
    declared = [p.declaration() for p in parameters_of(Tunable)]
    assert [(d["id"], d["type"], d["default_number"], d["default_text"]) for d in declared] == [
        ("weight", 1, 1.5, ""), ("cells", 2, 10.0, ""), ("greedy", 3, 1.0, ""), ("side", 4, 0.0, "left")]
    assert declared[0]["unit"] == "m" and (declared[1]["low"], declared[1]["high"]) == (1, 10000)
    assert declared[3]["choices"] == "left|right" and [d["help"] for d in declared][0] == "metres"
    assert Tunable.weight.default == 1.5  # of the class: the declaration


def test_parameters_of_bases_come_first_and_may_be_fixed():
    class Derived(Tunable):
        extra = karst.Real(0, 0, 1, "", "more")
        cells = karst.Integer(3, 1, 5, "fewer")
        side = "right"

    assert [p.name for p in parameters_of(Derived)] == ["weight", "cells", "greedy", "extra"]
    assert karst.testing.Bench(Derived, RING).decide().reason == repr((1.5, 3, True, "right"))
    assert karst.testing.Bench(Tunable, RING).decide().reason == repr((1.5, 10, True, "left"))


def test_objects_have_values_of_their_own():
    one = karst.testing.Bench(Tunable, RING, parameters={"cells": 1})
    other = karst.testing.Bench(Tunable, RING, parameters={"cells": 2})
    assert "1, True" in one.decide().reason and "2, True" in other.decide().reason


@pytest.mark.parametrize("given, why", [
    ({"nope": 1}, "the policy declares no parameter nope"),
    ({"cells": "many"}, "the parameter cells is 'many', not a number"),
    ({"weight": 9.5}, r"weight and cells contradict each other \(test_policy.py, line \d+, in init\)"),
])
def test_wrong_parameters(given, why):
    with pytest.raises(karst.Error, match=why):
        karst.testing.Bench(Tunable, RING, parameters=given)


# -- Answers


def goals(*places):
    return [karst.Goal(p) for p in places]


@pytest.mark.parametrize("answer, kind, count", [
    (lambda r: karst.Goal([1, 2, 3]), karst.Fly, 1),
    (lambda r: goals([1, 2, 3], (4, 5, 6), np.float32([7, 8, 9])), karst.Fly, 3),
    (lambda r: tuple(goals([1, 2, 3])), karst.Fly, 1),
    (lambda r: (karst.Goal([i, 0, 0]) for i in range(4)), karst.Fly, 4),
    (lambda r: map(karst.Goal, np.zeros((2, 3))), karst.Fly, 2),
    (lambda r: karst.Fly(goals([1, 2, 3]), "why"), karst.Fly, 1),
    (lambda r: karst.Tour(iter(goals([1, 2, 3], [1, 2, 4]))), karst.Tour, 2),
    (lambda r: karst.Fly(goals(*[[1, 2, 3]] * 100)), karst.Fly, 64),
    (lambda r: karst.Hold("w"), karst.Hold, None),
    (lambda r: karst.Explored("w"), karst.Explored, None),
    (lambda r: karst.GoHome(), karst.GoHome, None),
])
def test_answers(answer, kind, count):
    found = bench_of(answer).decide()
    assert type(found) is kind
    if count is not None:
        assert len(found.goals) == count


def test_goals_arrive_as_they_were_given():
    given = [
        karst.Goal([1.25, -2, 3], 0.5, 0.75, 1.5, 7, -3.5, "äöü → why"),
        karst.Goal(np.arange(6.0)[::2], score=np.float32(2), frontier_id=np.uint32(3)),
    ]
    first, second = bench_of(lambda r: karst.Tour(given, "grün")).decide().goals
    assert first.position.tolist() == [1.25, -2, 3] and second.position.tolist() == [0, 2, 4]
    assert (first.heading_rad, first.tolerance_m, first.max_speed_mps, first.frontier_id, first.score, first.why) == (
        0.5, 0.75, 1.5, 7, -3.5, "äöü → why")
    assert np.isnan(second.heading_rad) and (second.tolerance_m, second.score, second.frontier_id) == (0.5, 2, 3)


def test_the_order_of_goals_is_the_policys():
    scores = [3, 9, 1]
    found = bench_of(lambda r: [karst.Goal([i, 0, 0], score=s) for i, s in enumerate(scores)]).decide()
    assert [g.score for g in found.goals] == scores


def test_goal_at_is_the_frontiers_viewpoint():
    bench = bench_of(lambda r: karst.goal_at(r.frontiers[0], 2, "there"))
    bench.offer(5, bench.place("a"), bench.place("b"))
    goal, = bench.decide().goals
    assert goal.position.tolist() == bench.place("a").tolist() and (goal.frontier_id, goal.score) == (5, 2)


def test_long_texts_and_many_goals_are_cut_and_told():
    bench = bench_of(lambda r: karst.Fly([karst.Goal([1, 2, 3], why="ä" * 500)] * 1000, "x" * 10**6))
    found = bench.decide()
    assert found.reason == "x" * 240 and {g.why for g in found.goals} == {"ä" * 120} and len(found.goals) == 64
    assert bench.log == ["of 1000 goals only the first 64 are offered: the host takes no more",
                         "65 texts are cut to 240 bytes: the host takes no longer lines"]


@pytest.mark.parametrize("answer, why", [
    (None, "TypeError: an answer is goals, karst.Tour, karst.Hold, karst.Explored or karst.GoHome, not None"),
    ("abc", "not a str"),
    (3, "not an int"),
    ({}, "not a dict"),
    (np.zeros((2, 3)), "not rows of frontiers"),
    ([], "ValueError: there is no goal: say why with karst.Explored, karst.Hold or karst.GoHome"),
    (karst.Fly([]), "there is no goal"),
    (karst.Fly(None), "karst.Fly takes a list of goals, not None"),
    (karst.Tour(karst.Goal([1, 2, 3])), "karst.Tour takes a list of goals, not a Goal"),
    ([karst.Goal([1, 2, 3]), None], "goal 1 is None, not a karst.Goal"),
    (karst.Goal([1, 2]), r"goal 0: position has the shape \(2,\), not \(3,\)"),
    (karst.Goal([[1, 2, 3]]), r"goal 0: position has the shape \(1, 3\), not \(3,\)"),
    (karst.Goal("abc"), r"goal 0: position has the shape \(\), not \(3,\)"),
    (karst.Goal(None), r"goal 0: position has the shape \(\), not \(3,\)"),
    (karst.Goal(["a", "b", "c"]), "goal 0: position holds something else than numbers"),
    (karst.Goal([1j, 0, 0]), "goal 0: position holds something else than numbers"),
    (karst.Goal([1, [2], 3]), "goal 0: position is a list, not three numbers"),
    (karst.Goal([1, 2, 3], heading_rad="east"), "goal 0: heading_rad is a str, not a number"),
    (karst.Goal([1, 2, 3], tolerance_m=None), "goal 0: tolerance_m is None, not a number"),
    (karst.Goal([1, 2, 3], score=10**400), "goal 0: score is too large"),
    (karst.Goal([1, 2, 3], frontier_id=1.0), "goal 0: frontier_id is a float, not a whole number"),
    (karst.Goal([1, 2, 3], frontier_id=-1), "goal 0: frontier_id is -1, not in 0 to 4294967295"),
    (karst.Goal([1, 2, 3], frontier_id=1 << 32), "goal 0: frontier_id is 4294967296, not in"),
    (karst.Goal([1, 2, 3], why=None), "goal 0: why is None, not a text"),
    (karst.Goal([1, 2, 3], why="\ud800"), "goal 0: why holds a character that is none"),
    (karst.Hold(3), "reason is an int, not a text"),
    (karst.Explored(b"\xff"), "reason is a bytes, not a text"),
])
def test_wrong_answers_are_named(answer, why):
    """In a list, and alone: a single goal was not looked at."""
    with pytest.raises(karst.Error, match=why) as raised:
        bench_of(lambda r: answer).decide()
    assert isinstance(raised.value.__cause__, (TypeError, ValueError))


def test_exceptions_name_their_place(capfd):
    def fails(request):
        raise ValueError("first line\nsecond line")

    bench = bench_of(fails)
    with pytest.raises(karst.Error, match=r"^ValueError: first line \(test_policy.py, line \d+, in fails\)$"):
        bench.decide()
    assert any("in fails" in line for line in bench.log) and bench.log[-1] == "second line"
    assert "second line" in capfd.readouterr().err


class Unspeakable(Exception):
    def __str__(self):
        raise RuntimeError


@pytest.mark.parametrize("raised, why", [
    (karst.Error("as it is"), r"^as it is \(test"), (SystemExit(3), "^SystemExit: 3"), (KeyboardInterrupt(), "^Keyb"),
    (MemoryError(), "^MemoryError "), (Unspeakable(), "^Unspeakable: its text cannot be shown"),
    (ValueError("\ud800"), r"^ValueError: \\ud800 "), (StopIteration(), "^StopIteration"),
])
def test_all_that_can_be_raised(raised, why):
    def fails(request):
        raise raised

    with pytest.raises(karst.Error, match=why) as caught:
        bench_of(fails).decide()
    assert caught.value.__cause__ is raised


def test_what_a_generator_raises_is_raised():
    def decide(request):
        yield karst.Goal([1, 2, 3])
        raise ValueError("in the middle")

    with pytest.raises(karst.Error, match="ValueError: in the middle"):
        bench_of(decide).decide()


# -- Life


class Remembers(karst.Policy):
    limit = karst.Integer(5, 1, 9, "limit")

    def __init__(self):
        self.calls = ["__init__"]

    def init(self):
        self.calls.append(f"init {self.limit}")

    def activate(self):
        self.calls.append("activate")

    def decide(self, request):
        self.calls.append(f"decide {request.sequence}")
        return karst.Fly([karst.Goal(request.position, frontier_id=3, why="here")], ", ".join(self.calls))

    def on_event(self, event):
        self.calls.append(f"{event.kind.name} {event.goal.frontier_id} {event.goal.why} {event.reason}")

    def save(self):
        return self.calls

    def restore(self, saved):
        self.calls += ["restore", *saved]


def test_life_and_events():
    bench = karst.testing.Bench(Remembers, RING, parameters={"limit": 2})
    bench.decide()
    bench.arrive()
    bench.decide()
    bench.fail(karst.EventKind.GOAL_REJECTED, "too near")
    assert bench.decide().reason == (
        "__init__, init 2, activate, decide 1, GOAL_REACHED 3 here reached, decide 2, "
        "GOAL_REJECTED 3 here too near, decide 3")


def test_save_restore_restart():
    bench = karst.testing.Bench(Remembers, RING, parameters={"limit": 2})
    bench.decide()
    saved = bench.saved()
    bench.restart(saved)
    assert bench.decide().reason.startswith("__init__, init 2, restore, __init__, init 2, activate, decide 1, activate")
    bench.restart()
    assert bench.decide().reason.startswith("__init__, init 2, activate, decide")
    with pytest.raises(karst.Error, match="UnpicklingError|pickle"):
        bench.restart(b"garbage")
    with pytest.raises(karst.Error, match="does not offer karst.state/1"):
        bench_of(lambda r: karst.Hold("")).saved()
    with pytest.raises(karst.Error, match="pickle"):
        bench_of(lambda r: karst.Hold(""), save=lambda self: (lambda: 1)).saved()


def test_events_of_later_versions_are_numbers():
    event = _hosted.event_of(99, 5, ([1, 2, 3], 0.0, 0.5, 0.0, 0, 0.0, ""), "new")
    assert event.kind == 99 and event.reason == "new" and event.stamp_ns == 5


def test_chance_is_the_same_for_the_same_seed():
    import random

    class Draws(karst.Policy):
        def decide(self, request):
            return karst.Hold(repr((self.rng.random(), random.random(), np.random.rand(), request.random(2).tolist())))

    def drawn(n):
        bench = karst.testing.Bench(Draws, RING)
        return [bench.decide().reason for _ in range(n)]

    first = drawn(3)
    np.random.seed(77)
    random.seed(5)
    assert drawn(3) == first and len(set(first)) == 3


# -- Requests


def test_fields_are_as_the_docstring_says():
    fields = asked(lambda r: r)
    for name, shape in {"position": 3, "velocity": 3, "orientation": 4, "body_rate": 3, "direction_of_flight": 3,
                        "start_position": 3, "start_orientation": 4, "last_goal": 3}.items():
        value = getattr(fields, name)
        assert value.shape == (shape,) and value.dtype == np.float64, name
    assert fields.sequence == 1 and isinstance(fields.stamp_ns, int) and isinstance(fields.deadline_ns, int)
    assert (fields.clearance_m, fields.max_speed_mps, fields.vehicle_radius_m) == (0.5, 2.0, 0.3)
    assert (fields.battery_fraction, fields.battery_seconds_left, fields.mission_seconds_left) == (0.8, 1200, 3600)
    assert fields.last_fate is karst.Fate.NONE and fields.time_s == 0
    sensor, = fields.sensors
    assert sensor.kind is karst.SensorKind.LIDAR and sensor.name == "os0_32" and sensor.max_range_m == 50
    assert sensor.position_in_body.tolist() == [0, 0, 0.1] and sensor.orientation_in_body.shape == (4,)
    assert set(karst.Request.__annotations__) <= set(vars(fields))
    assert fields.frontiers.shape == (0,) and fields.teammates.shape == (0,)
    assert fields.teammates.dtype.names == (
        "id", "stamp_ns", "position", "velocity", "goal", "seconds_before_homing")
    assert fields.frontiers.dtype.names == (
        "id", "cells", "centroid", "low", "high", "normal", "unknown_cells", "free_cells", "viewpoint",
        "viewpoint_heading_rad", "path_length_m")


def test_the_bench_sets_the_next_request():
    seen = []
    bench = bench_of(lambda r: seen.append(r) or karst.Hold(""))
    bench.heading_rad, bench.time_s, bench.seconds_before_homing = 1.0, 2.5, 33
    bench.direction_of_flight, bench.last_goal, bench.battery_fraction = (0, 1, 0), (1, 2, 3), 0.25
    bench.decide()
    r, = seen
    assert r.heading_rad == pytest.approx(1) and r.time_s == 2.5 and r.seconds_before_homing == 33
    assert r.direction_of_flight.tolist() == [0, 1, 0] and r.last_goal.tolist() == [1, 2, 3]
    assert r.battery_fraction == 0.25
    with pytest.raises(AttributeError, match="a bench has no positon"):
        bench.positon = (1, 2, 3)
    with pytest.raises(karst.Error, match=r"position must be one place, \(3,\), not \(2, 3\)|must have the shape"):
        bench.position = [[1, 2, 3], [4, 5, 6]]


def test_reachable_is_nearest_first():
    bench = bench_of(lambda r: karst.Hold(" ".join(str(i) for i in r.reachable()["id"])))
    for id, at in ((4, "a"), (2, "b"), (3, "b")):
        bench.offer(id, bench.place(at))
    bench.offer(1, (50, 50, 50))  # no path
    lost = bench.frontiers
    lost = np.append(lost, lost[:1])
    lost["id"][-1], lost["viewpoint"][-1] = 9, np.nan
    bench.frontiers = lost
    assert bench.decide().reason == "4 2 3"  # 2 and 3 are equally far
    with pytest.raises(karst.Error, match="frontiers is an array as bench.frontiers gives it"):
        bench.frontiers = np.zeros(3)


def test_frontiers_of_a_drawing():
    drawing = """
        ###?###
        ###.###
        ?..s..#
        #######"""
    found = []
    bench = bench_of(lambda r: found.append(r.frontiers) or karst.Hold(""), drawing)
    bench.offer_drawn()
    bench.decide()
    assert sorted(map(tuple, found[0]["centroid"])) == [(1.5, 1.5, 0.5), (3.5, 2.5, 0.5)]
    assert sorted(map(tuple, found[0]["normal"])) == [(-1, 0, 0), (0, 1, 0)] and found[0]["cells"].tolist() == [1, 1]


def test_a_request_that_has_ended_is_refused():
    kept = []
    bench = bench_of(lambda r: kept.append((r, r.map.retained())) or karst.Hold(""))
    bench.decide()
    (request, copy), = kept
    for call in (lambda: request.map.cells([0, 0, 0]), lambda: request.paths([0, 0, 0], []), request.should_stop,
                 lambda: request.map.free_cells, lambda: request.log("late"), lambda: request.random(1),
                 lambda: request.draw_text([0, 0, 0], "late"), lambda: request.map.retained()):
        with pytest.raises(karst.Error, match="this request has ended: keep what it said, or request.map.retained"):
            call()
    assert copy.cells(request.position) == [karst.Cell.FREE] and copy.free_cells == len(FREE)
    assert request.position.tolist() == bench.place("s").tolist() and len(request.frontiers) == 0
    bench.decide()
    with pytest.raises(karst.Error, match="has ended"):
        kept[0][0].map.cells([0, 0, 0])


def test_a_request_does_not_end_while_a_thread_asks():
    """The host may free its map then; a question on a thread of the policy's own would read on in it."""
    points = np.random.default_rng(3).uniform(0, 5, (200_000, 3))  # half a second
    told, threads = [], []

    def decide(request):
        begun = threading.Event()

        def ask():
            begun.set()
            told.append(request.map.distances_to_rock(points, 6.0))

        threads.append(threading.Thread(target=ask))
        threads[0].start()
        begun.wait()
        time.sleep(0.01)
        return karst.Hold("asked")

    bench = bench_of(decide)
    bench.decide()
    threads[0].join(0.2)  # to write down what it was told
    answered = len(told)
    threads[0].join()
    assert answered == len(told) == 1


# -- The map and the paths, against the drawing


def test_cells():
    every = [(x, y) for x in range(-1, 15) for y in range(-1, 7)]
    found = asked(lambda r: r.map.cells([center(c) for c in every]))
    assert found.dtype == np.uint8 and found.shape == (len(every),)
    assert found.tolist() == [1 if c in FREE else 2 if c in ROCK else 0 for c in every]
    info = asked(lambda r: (r.map.info(), r.map.free_cells, r.map.occupied_cells, r.map.resolution_m, r.map.revision))
    assert info[1:4] == (len(FREE), len(ROCK), 1.0) and info[0]["free_cells"] == len(FREE)


def test_counts():
    rng = np.random.default_rng(1)
    low = rng.uniform(-2, 10, (50, 3)) * [1, 1, 0.1]
    high = low + rng.uniform(0, 8, (50, 3))
    found = asked(lambda r: r.map.counts(low, high))
    assert found.dtype == np.uint64 and found.shape == (50, 3)
    span = [(x, y, z) for x in range(-3, 20) for y in range(-3, 20) for z in range(-1, 12)]
    at = np.array(span) + 0.5
    state = np.array([0 if z else 1 if (x, y) in FREE else 2 if (x, y) in ROCK else 0 for x, y, z in span])
    for i in range(50):
        inside = ((at >= low[i]) & (at <= high[i])).all(axis=1)
        assert found[i].tolist() == [(inside & (state == s)).sum() for s in (0, 1, 2)]


def test_rays():
    start = center((1, 1))
    ends = [center((11, 1)), center((20, 1)), center((1, 20)), center((1, 3)), start]
    found = asked(lambda r: r.map.cast_rays(start, ends))
    assert found.dtype.names == ("center", "length_m", "cell") and found.shape == (5,)
    assert found["cell"].tolist() == [1, 2, 2, 1, 1]
    assert found["length_m"].tolist() == [10, 11, 3, 2, 0]  # east to the wall at x 12, north to the one at y 4
    np.testing.assert_array_equal(found["center"][1], center((12, 1)))
    one = asked(lambda r: r.map.cast_rays([start, center((2, 1))], [center((3, 1)), center((4, 1))]))
    assert one["length_m"].tolist() == [2, 2]
    above = asked(lambda r: [r.map.cast_rays(start, start + [0, 0, 5], u)[0] for u in (False, True)])
    assert [(a["cell"], a["length_m"]) for a in above] == [(0, 1), (1, 5)]


def test_surface_and_distances():
    low, high = [-5, -5, -5], [20, 20, 20]
    found = asked(lambda r: r.map.surface(low, high))
    expected = {c for c in ROCK if {(c[0] + 1, c[1]), (c[0] - 1, c[1]), (c[0], c[1] + 1), (c[0], c[1] - 1)} & FREE}
    assert found.shape == (len(expected), 3) and {(int(x), int(y)) for x, y, _ in found} == expected
    points = np.random.default_rng(2).uniform([0, 0, 0], [13, 5, 1], (40, 3))
    rock = np.array([center(c) for c in ROCK])
    nearest = np.linalg.norm(points[:, None] - rock[None], axis=2).min(axis=1)
    for limit in (0.8, 3.0):
        np.testing.assert_allclose(
            asked(lambda r: r.map.distances_to_rock(points, limit)), np.minimum(nearest, limit), atol=1e-12)


def test_passages():
    drawing = """
        #####################
        #s.................a#
        #####################"""
    passages, ends = asked(lambda r: r.map.passages(), drawing)
    assert len(passages) == 1 and len(ends) == 2
    assert passages["ends"].dtype == np.uint32 and sorted(passages["ends"][0]) == [0, 1]
    assert ends["from_start_m"][0] < ends["from_start_m"][1] == pytest.approx(18)
    assert ends["kind"].tolist() == [2, 2] and passages["volume_m3"].tolist() == [19]
    assert passages["mean_width_m"][0] == pytest.approx(1) and passages["middle"].shape == (1, 3)
    at = asked(lambda r: r.map.passages_at([[10.5, 1.5, 0.5], [50, 50, 50]]), drawing)
    assert at["passage"].tolist() == [0, 0xFFFFFFFF] and at["from_start_m"][0] == pytest.approx(9, abs=1)


def shortest(start, goal):
    """Dijkstra's algorithm over the free cells, with eight neighbours."""
    left, best = {start: 0.0}, {}
    while left:
        cell = min(left, key=left.get)
        best[cell] = length = left.pop(cell)
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                next = cell[0] + dx, cell[1] + dy
                if next in FREE and next not in best:
                    left[next] = min(left.get(next, np.inf), length + np.hypot(dx, dy))
    return best.get(goal, np.inf)


def test_paths():
    goals = sorted(FREE) + [(0, 0), (40, 40)]
    start = (7, 1)
    expected = [shortest(start, g) for g in goals]
    lengths, paths = asked(lambda r: (r.path_lengths(r.position, [center(g) for g in goals]),
                                      r.paths(r.position, [center(g) for g in goals])))
    np.testing.assert_allclose(lengths, expected)
    for goal, path, length in zip(goals, paths, expected):
        assert path.length_m == pytest.approx(length)
        if np.isinf(length):
            assert path.points.shape == (0, 3) and path.clearance_m == 0 and np.isinf(path.time_s)
            continue
        np.testing.assert_array_equal(path.points[[0, -1]], [center(start), center(goal)])
        assert np.linalg.norm(np.diff(path.points, axis=0), axis=1).sum() == pytest.approx(length)
        assert path.clearance_m > 0 and path.time_s >= length / 2


def test_newly_seen():
    """Unknown cells within two metres of an eye in the open: all around, within 45 degrees of the horizon."""
    drawing = "\n".join(["?" * 9] * 4 + ["????s????"] + ["?" * 9] * 4)
    eye = np.array([4.5, 4.5, 0.6])  # the sensor is 0.1 m above the body
    offsets = np.array([(x, y, z) for x in range(-3, 4) for y in range(-3, 4) for z in range(-3, 4)])
    away = offsets + [4.5, 4.5, 0.5] - eye
    distance = np.linalg.norm(away, axis=1)
    elevation = np.arctan2(away[:, 2], np.hypot(away[:, 0], away[:, 1]))
    own = (offsets == 0).all(axis=1)
    seen = (distance >= 0.3) & (distance <= 2) & (np.abs(elevation) <= np.pi / 4) & ~own
    found = asked(lambda r: r.newly_seen([*r.position, 0.0], max_range_m=2), drawing)
    assert found.dtype == np.uint64 and found.tolist() == [seen.sum()]


@pytest.mark.parametrize("question, shape", [
    (lambda r, n: r.map.cells(n), (0,)),
    (lambda r, n: r.map.cast_rays([0, 0, 0], n), (0,)),
    (lambda r, n: r.map.cast_rays(n, n), (0,)),
    (lambda r, n: r.map.counts(n, n), (0, 3)),
    (lambda r, n: r.map.distances_to_rock(n, 1), (0,)),
    (lambda r, n: r.map.passages_at(n), (0,)),
    (lambda r, n: r.path_lengths([0, 0, 0], n), (0,)),
    (lambda r, n: np.array(r.paths([0, 0, 0], n)), (0,)),
    (lambda r, n: r.random(0), (0,)),
])
def test_batches_of_none(question, shape):
    assert asked(lambda r: question(r, [])).shape == shape
    assert asked(lambda r: question(r, np.zeros((0, 3)))).shape == shape


def test_batches_of_one_are_those_of_many():
    points = [[1.5, 1.5, 0.5], [7.5, 3.5, 0.5], [30, 30, 30]]
    for question in (lambda r, p: r.map.cells(p), lambda r, p: r.map.distances_to_rock(p, 3.0),
                     lambda r, p: r.path_lengths(r.position, p), lambda r, p: r.map.passages_at(p),
                     lambda r, p: r.map.cast_rays(r.position, p), lambda r, p: r.map.counts(p, np.add(p, 1))):
        many = asked(lambda r: question(r, points))
        for i, point in enumerate(points):
            one = asked(lambda r: question(r, point))
            assert one.shape[0] == 1 and one.dtype == many.dtype
            np.testing.assert_array_equal(one[0], many[i])


def test_more_items_than_one_call_of_the_host_takes():
    points = np.broadcast_to(center((1, 1)), (1_000_001, 3)).copy()
    points[-1] = center((0, 0))
    found = asked(lambda r: r.map.cells(points))
    assert found.shape == (1_000_001,) and found[0] == 1 and found[-2] == 1 and found[-1] == 2
    rays = asked(lambda r: r.map.cast_rays(points, points))
    assert rays.shape == (1_000_001,) and rays["cell"][-1] == 2
    assert len(asked(lambda r: r.path_lengths(r.position, np.full((4097, 3), 50.0)))) == 4097
    assert len(asked(lambda r: r.paths(r.position, np.full((65, 3), 50.0)))) == 65
    assert len(asked(lambda r: r.newly_seen(np.full((4097, 4), 0.5), max_range_m=0.4))) == 4097


@pytest.mark.parametrize("question, why", [
    (lambda r: r.map.cells([1, 2]), r"points must have the shape \(n, 3\) or \(3,\), not \(2,\)"),
    (lambda r: r.map.cells(np.zeros((1, 1, 3))), r"not \(1, 1, 3\)"),
    (lambda r: r.map.cells(None), r"points must have the shape"),
    (lambda r: r.map.cells("abc"), r"TypeError: cells\(\) takes no such arguments \(test_policy.py, line"),
    (lambda r: r.map.cast_rays([[1, 2, 3]] * 2, [[1, 2, 3]] * 3), r"2 rows and \w+ 3|2 rows and \w+ has 3"),
    (lambda r: r.map.counts([[0, 0, 0]] * 2, [1, 1, 1]), "low and high must have as many rows"),
    (lambda r: r.map.surface([[0, 0, 0]] * 2, [[1, 1, 1]] * 2), "low must be one place"),
    (lambda r: r.map.distances_to_rock([1, 1, 1], 0), r"limit_m is not in \(0, 100\] m"),
    (lambda r: r.path_lengths([[1, 2, 3]] * 2, [1, 2, 3]), "start must be one place"),
    (lambda r: r.newly_seen([1, 2, 3]), r"viewpoints must have the shape \(n, 4\) or \(4,\)"),
    (lambda r: r.newly_seen([1, 2, 3, 0], sensor=1), "there is no sensor 1: the vehicle has 1, and the first is sensor 0"),
    (lambda r: r.survey_distances([1, 2, 3]), "the mission has no survey"),
    (lambda r: r.imaged_states([1, 2, 3]), "the vehicle carries no colour camera"),
    (lambda r: r.random(-1), r"random\(\) takes no such arguments"),
])
def test_wrong_questions(question, why):
    with pytest.raises(karst.Error, match=why):
        asked(question)


def test_drawing_and_logging():
    bench = bench_of(lambda r: (r.draw_points([]), r.draw_points([[1, 2, 3]]), r.draw_lines([0, 0, 0], [[1, 1, 1]] * 2),
                                r.draw_text([0, 0, 0], "here", 0xFF0000), r.log("läuft"), r.log(["a", 1]),
                                karst.Hold(""))[-1])
    bench.decide()
    assert bench.log == ["läuft", "['a', 1]"]


# -- Files


@pytest.fixture
def opened(tmp_path):
    def policies(text, name="mine"):
        file = tmp_path / f"{name}.py"
        file.write_text(textwrap.dedent(text))
        return _script.policies_of(_script.module_of(str(file)))

    return policies


NEAR = """
    '''Of the module.'''
    import karst
    class Near(karst.Policy):
        '''Flies near.

        More.'''
        def decide(self, request):
            return karst.Hold(__name__)
"""


def test_a_file_with_a_class(opened):
    policy, = opened(NEAR)
    said = _hosted.description_of(policy)
    assert (said["id"], said["name"], said["version"], said["one_line"]) == ("mine", "mine", "0.1.0", "Flies near.")
    assert karst.testing.Bench(policy, RING).decide().reason.endswith("mine")


def test_a_function_is_a_policy(opened):
    policy, = opened("""
        '''Holds.'''
        import karst
        version = "2.0.0"
        def decide(request):
            return karst.Hold(str(request.sequence))
    """, "of_function")
    said = _hosted.description_of(policy)
    assert (said["id"], said["version"], said["one_line"]) == ("of_function", "2.0.0", "Holds.")
    assert karst.testing.Bench(policy, RING).decide().reason == "1"


def test_several_policies_bases_and_other_names(opened):
    found = opened("""
        import karst
        from karst import Policy
        class Base(Policy):
            def decide(self, request): return karst.Hold(self.say)
        class NearOne(Base):
            '''One.'''
            say = "1"
        class Far(Base):
            say = "2"
            id = "far_away"
        class Helper: pass
        Again = Far
    """)
    assert [_hosted.description_of(p)["id"] for p in found] == ["near_one", "far_away"]
    assert [karst.testing.Bench(p, RING).decide().reason for p in found] == ["1", "2"]


@pytest.mark.parametrize("name", ["random", "numpy", "types", "karst", "queue", "wave"])
def test_a_policy_named_like_a_module(opened, name):
    """Python's own keep their name, those that nothing has imported yet as well."""
    import importlib
    import sys

    loaded = sys.modules.get(name)
    policy, = opened(NEAR, name)
    assert _hosted.description_of(policy)["id"] == name
    assert sys.modules.get(name) is loaded
    assert importlib.import_module(name).__file__ != policy.decide.__code__.co_filename
    assert karst.testing.Bench(policy, RING).decide().reason.startswith("karst_policy_")


def test_a_module_beside_the_file(opened, tmp_path):
    (tmp_path / "beside_it.py").write_text("WHY = 'from beside'\n")
    policy, = opened("""
        import karst, beside_it
        class P(karst.Policy):
            def decide(self, request): return karst.Hold(beside_it.WHY)
    """, "with_module")
    assert karst.testing.Bench(policy, RING).decide().reason == "from beside"


@pytest.mark.parametrize("text, why", [
    ("x = 1", "holds no policy: a class that derives from karst.Policy, or a function decide"),
    ("import karst\nclass P(karst.Policy): pass", "holds no policy"),
    ("class P(:\n  pass", r"^mine.py, line 1: SyntaxError: "),
    ("import no_such_module_at_all", r"^ModuleNotFoundError: .*\(mine.py, line 1, in <module>\)$"),
    ("def f():\n    1 / 0\nf()", r"^ZeroDivisionError: division by zero \(mine.py, line 2, in f\)$"),
])
def test_files_without_a_policy(opened, text, why):
    import sys

    with pytest.raises(karst.Error, match=why):
        opened(text)
    sys.modules.pop("mine", None)


def test_drawings_that_are_none():
    for drawing, why in (("#!#", "not '!'"), ("#.#", None)):
        if why is not None:
            with pytest.raises(Exception, match=why):
                karst.testing.Bench(Tunable, drawing)
        else:
            with pytest.raises(Exception, match="no cell is named s"):
                karst.testing.Bench(Tunable, drawing).place("s")


class Looks(karst.Policy):
    """Counts what it would see."""

    weight = karst.Real(1.0, 0, 10, "m", "a weight")
    side = karst.Text("left", "a side", ["left", "right"])

    def decide(self, request):
        here = [*request.position, 0.0]
        self.seen = request.newly_seen(here), request.newly_seen(here, max_range_m=None)
        return karst.Hold()


def test_a_view_is_no_longer_than_the_sensors_and_ten_metres_by_default():
    import dataclasses

    bench = karst.testing.Bench(Looks, "?????\n??s??\n?????")
    bench.position = bench.place("s")
    bench.sensors = [dataclasses.replace(bench.sensors[0], max_range_m=4.0)]
    assert [s.max_range_m for s in bench.sensors] == [4.0] and bench.sensors[0].kind == karst.SensorKind.LIDAR
    bench.decide()
    bench.sensors = []
    with pytest.raises(karst.Error, match="the vehicle has no sensor"):
        bench.decide()


@pytest.mark.parametrize("values, said", [
    ({"weight": 11}, "weight is 11, not in 0 to 10"),
    ({"side": "up"}, "side is 'up', not one of left, right"),
])
def test_the_bench_refuses_values_that_no_flight_allows(values, said):
    with pytest.raises(karst.Error, match=said):
        karst.testing.Bench(Looks, "...", parameters=values)


class Keeps(karst.Policy):
    """Keeps a copy of the map, and itself, for longer than it lives."""

    left = []

    def decide(self, request):
        self.mine = self.decide  # a cycle: Python collects it some time later
        Keeps.left.append(request.map.retained())
        return karst.Hold()


def test_a_kept_map_ends_with_its_policy():
    import gc

    bench = karst.testing.Bench(Keeps, "...")
    bench.decide()
    kept = Keeps.left[-1]
    assert kept.cells([0.5, 0.5, 0.5])[0] == karst.Cell.FREE
    del bench
    gc.collect()
    with pytest.raises(karst.Error, match="the policy that kept this map has ended"):
        kept.cells([0.5, 0.5, 0.5])
    Keeps.left.clear()
    gc.collect()
