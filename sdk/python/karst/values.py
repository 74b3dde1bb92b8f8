"""What a policy answers: goals, or that there are none."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterable, Sequence

import numpy as np


@dataclass
class Goal:
    """A place to fly to.

    ``position``: (3,) in the world frame, m; finite.
    ``heading_rad``: of the vehicle's body there, counter-clockwise from east; NaN: any.
    ``tolerance_m``: the goal is reached when the vehicle is nearer than this; above 0.
    ``max_speed_mps``: 0: the mission's limit, which also caps it.
    ``frontier_id``: the frontier that it is for; 0: none.
    ``score``: higher is better, in the policy's own unit; finite.
    ``why``: one line for the report, at most 240 bytes.
    """

    position: Sequence[float] | np.ndarray
    heading_rad: float = math.nan
    tolerance_m: float = 0.5
    max_speed_mps: float = 0.0
    frontier_id: int = 0
    score: float = 0.0
    why: str = ""


def goal_at(frontier: np.void, score: float = 0.0, why: str = "") -> Goal:
    """A goal at the viewpoint, and with the heading, that the core proposes for a frontier.

    ``frontier``: one row of ``request.frontiers``.
    """
    return Goal(
        position=frontier["viewpoint"],
        heading_rad=float(frontier["viewpoint_heading_rad"]),
        frontier_id=int(frontier["id"]),
        score=float(score),
        why=why,
    )


@dataclass
class Fly:
    """Ranked goals, best first: the core flies to the first that passes its checks. At most 64 are taken."""

    goals: Iterable[Goal]
    reason: str = ""


@dataclass
class Tour:
    """Goals to visit one after the other. The core may ask again before the last one is reached."""

    goals: Iterable[Goal]
    reason: str = ""


@dataclass
class Hold:
    """Go on to the present goal, or stay; the core asks again soon."""

    reason: str = ""


@dataclass
class Explored:
    """Nothing is left to fly to now.

    The core asks again, and believes it once the vehicle has hovered without a goal for the time
    ``mission.explored_patience``.
    """

    reason: str = ""


@dataclass
class GoHome:
    """Fly home for another reason."""

    reason: str = ""


Answer = Fly | Tour | Hold | Explored | GoHome | Goal | Iterable[Goal]

# Numbers of the ABI (karst_abi_types.h).
_GOALS, _HOLD, _EXPLORED, _GO_HOME = 1, 2, 3, 4


def answer_fields(answer: Answer) -> tuple[int, bool, str, list[Goal]]:
    """Outcome, whether the goals are in order, reason and goals, as the ABI has them. Raises TypeError."""
    if isinstance(answer, Hold):
        return _HOLD, False, answer.reason, []
    if isinstance(answer, Explored):
        return _EXPLORED, False, answer.reason, []
    if isinstance(answer, GoHome):
        return _GO_HOME, False, answer.reason, []
    if isinstance(answer, (Fly, Tour)):
        return _GOALS, isinstance(answer, Tour), answer.reason, _goals(answer.goals)
    if isinstance(answer, Goal):
        return _GOALS, False, "", [answer]
    if isinstance(answer, (list, tuple)) or hasattr(answer, "__next__"):
        return _GOALS, False, "", _goals(answer)
    raise TypeError(
        f"decide() returned {_what(answer)}: goals, karst.Hold, karst.Explored or karst.GoHome are expected"
    )


def _goals(goals: Iterable[Goal]) -> list[Goal]:
    goals = list(goals)
    for i, goal in enumerate(goals):
        if not isinstance(goal, Goal):
            raise TypeError(f"goal {i} that decide() returned is {_what(goal)}, not a karst.Goal")
        for name in ("heading_rad", "tolerance_m", "max_speed_mps", "score"):
            if not isinstance(getattr(goal, name), (int, float, np.number)):
                raise TypeError(f"goal {i}: {name} is {_what(getattr(goal, name))}, not a number")
        if not isinstance(goal.frontier_id, (int, np.integer)):
            raise TypeError(f"goal {i}: frontier_id is {_what(goal.frontier_id)}, not a whole number")
        if not isinstance(goal.why, str):
            raise TypeError(f"goal {i}: why is {_what(goal.why)}, not a text")
        if np.shape(goal.position) != (3,):
            raise TypeError(f"goal {i}: position has the shape {np.shape(goal.position)}, not (3,)")
    if not goals:
        raise ValueError("decide() returned no goal: say why with karst.Explored, karst.Hold or karst.GoHome")
    return goals


def _what(value: object) -> str:
    return "None" if value is None else f"a {type(value).__name__}"
