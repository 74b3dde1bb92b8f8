"""Tests of a policy in caves drawn by hand, without a simulator.

::

    import karst.testing
    from my_nearest import MyNearest

    TWO_PASSAGES = '''
        #############
        #b.........a#
        #.#########.#
        #......s....#
        #############'''

    def test_the_nearer_comes_first():
        bench = karst.testing.Bench(MyNearest, TWO_PASSAGES)
        bench.position = bench.place("s")
        bench.offer(1, bench.place("a"))
        bench.offer(2, bench.place("b"))
        assert bench.decide().goals[0].frontier_id == 1

A layer is seen from above, north is up: '#' is rock, '.' free, '?' unknown, a letter a free cell with a name. The
policy is called through the same tables as in a flight.
"""

from __future__ import annotations

import sys
import traceback
from typing import Any, Mapping, Sequence

import numpy as np

from . import _hosted, _karst
from .errors import Error
from .policy import Policy
from .request import EventKind, Points
from .values import Answer, Explored, Fly, GoHome, Goal, Hold, Tour


class Bench:
    """Calls a policy as the host does, with requests that a test makes up.

    ``drawing``: a layer, or a list of layers from the lowest. ``resolution_m``: edge of a cell.
    ``parameters``: values by name, in SI units.

    These attributes are the content of the next request: ``position``, ``start``, ``direction_of_flight``,
    ``last_goal`` ((3,), m), ``heading_rad``, ``time_s``, ``seconds_before_homing``, ``battery_fraction``,
    ``battery_seconds_left``, ``mission_seconds_left``, and ``frontiers``, a record array as in a request.
    """

    def __init__(
        self,
        policy: type[Policy],
        drawing: str | Sequence[str],
        resolution_m: float = 1.0,
        parameters: Mapping[str, Any] | None = None,
    ):
        layers = [drawing] if isinstance(drawing, str) else list(drawing)
        values = [(name, _text(value)) for name, value in (parameters or {}).items()]
        object.__setattr__(self, "_bench", _raising(_karst.Bench, policy, resolution_m, layers, values))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._bench, name)

    def __setattr__(self, name: str, value: Any) -> None:
        if not hasattr(self._bench, name):
            raise AttributeError(f"a bench has no {name}")
        setattr(self._bench, name, value)

    def place(self, letter: str) -> np.ndarray:
        """The centre of the cell that a letter names: (3,), m."""
        return self._bench.place(letter)

    def offer(self, id: int, viewpoint: Points, centroid: Points | None = None, cells: int = 20) -> None:
        """Adds a frontier. Its path is measured in the map."""
        self._bench.offer(id, viewpoint, viewpoint if centroid is None else centroid, cells)

    def offer_drawn(self, min_cells: int = 1) -> None:
        """Replaces the frontiers by those of the drawing: where free cells meet unknown ones."""
        self._bench.offer_drawn(min_cells)

    def decide(self) -> Answer:
        """The policy's answer, as the host understands it. Raises karst.Error from what the policy raised."""
        outcome, in_order, reason, goals = _raising(self._bench.decide)
        goals = [Goal(*goal) for goal in goals]
        if outcome == 1:
            return Tour(goals, reason) if in_order else Fly(goals, reason)
        return {2: Hold, 3: Explored, 4: GoHome}[outcome](reason)

    def arrive(self) -> None:
        """The first goal of the last answer is reached: the vehicle is there, and the policy is told."""
        _raising(self._bench.arrive)

    def fail(self, kind: EventKind = EventKind.GOAL_UNREACHABLE, reason: str = "as the test wants it") -> None:
        """That goal failed."""
        _raising(self._bench.fail, int(kind), reason)

    def tell(self, kind: EventKind, goal: Goal, reason: str = "") -> None:
        """An event."""
        _raising(self._bench.tell, int(kind), goal, reason)

    def saved(self) -> bytes:
        """What the policy's ``save`` keeps."""
        return _raising(self._bench.saved)

    def restart(self, saved: bytes = b"") -> None:
        """As after a crash: a new object with the same parameters, and what was saved."""
        _raising(self._bench.restart, saved)

    @property
    def log(self) -> list[str]:
        """The lines that the policy logged."""
        return self._bench.log


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _raising(call: Any, *arguments: Any) -> Any:
    """Calls; an error comes from the exception that the policy raised, if it did."""
    _hosted.last_exception = None
    try:
        return call(*arguments)
    except Error as e:
        raise e from _hosted.last_exception


def main() -> None:
    """Runs the functions ``test_...`` of the program, says how each went, and ends it with an exit code."""
    failures = 0
    for name, test in list(vars(sys.modules["__main__"]).items()):
        if not name.startswith("test_") or not callable(test):
            continue
        try:
            test()
            print(f"passed: {name}")
        except Exception:
            failures += 1
            print(f"FAILED: {name}")
            traceback.print_exc()
    sys.exit(1 if failures else 0)
