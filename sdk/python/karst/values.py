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
GOALS, HOLD, EXPLORED, GO_HOME = 1, 2, 3, 4


def answer_fields(answer: Answer) -> tuple[int, bool, str, list[Goal]]:
    """Outcome, whether the goals are in order, reason and goals, as the ABI has them.

    Raises TypeError or ValueError with what is wrong. Numbers that are not finite are left to the host, which
    drops such goals.
    """
    if isinstance(answer, Hold):
        return HOLD, False, _text(answer.reason, "reason"), []
    if isinstance(answer, Explored):
        return EXPLORED, False, _text(answer.reason, "reason"), []
    if isinstance(answer, GoHome):
        return GO_HOME, False, _text(answer.reason, "reason"), []
    if isinstance(answer, (Fly, Tour)):
        if not isinstance(answer.goals, Iterable):
            raise TypeError(f"karst.{type(answer).__name__} takes a list of goals, not {_what(answer.goals)}")
        return GOALS, isinstance(answer, Tour), _text(answer.reason, "reason"), _goals(answer.goals)
    if isinstance(answer, Goal):
        return GOALS, False, "", _goals([answer])
    if isinstance(answer, (list, tuple)) or hasattr(answer, "__next__"):
        return GOALS, False, "", _goals(answer)
    expected = "goals, karst.Tour, karst.Hold, karst.Explored or karst.GoHome"
    if isinstance(answer, (np.void, np.ndarray)):
        raise TypeError(f"an answer is {expected}, not rows of frontiers: karst.goal_at makes a goal of each")
    raise TypeError(f"an answer is {expected}, not {_what(answer)}")


def _goals(goals: Iterable[Goal]) -> list[Goal]:
    goals = list(goals)
    for i, goal in enumerate(goals):
        if isinstance(goal, np.void):
            raise TypeError(f"goal {i} is a row of frontiers: karst.goal_at makes a goal of it")
        if not isinstance(goal, Goal):
            raise TypeError(f"goal {i} is {_what(goal)}, not a karst.Goal")
        for name in ("heading_rad", "tolerance_m", "max_speed_mps", "score"):
            number = getattr(goal, name)
            if not isinstance(number, (int, float, np.integer, np.floating)):
                raise TypeError(f"goal {i}: {name} is {_what(number)}, not a number")
            if isinstance(number, int) and abs(number) > 1 << 1000:
                raise ValueError(f"goal {i}: {name} is too large")
        if not isinstance(goal.frontier_id, (int, np.integer)):
            raise TypeError(f"goal {i}: frontier_id is {_what(goal.frontier_id)}, not a whole number")
        if not 0 <= goal.frontier_id < 1 << 32:
            raise ValueError(f"goal {i}: frontier_id is {goal.frontier_id}, not in 0 to {(1 << 32) - 1}")
        _text(goal.why, f"goal {i}: why")
        _check_position(goal.position, f"goal {i}: position")
    if not goals:
        raise ValueError("there is no goal: say why with karst.Explored, karst.Hold or karst.GoHome")
    return goals


def _check_position(position: object, name: str) -> None:
    try:
        array = position if isinstance(position, np.ndarray) else np.asarray(position)
    except ValueError:  # rows of different lengths
        raise TypeError(f"{name} is {_what(position)}, not three numbers") from None
    if array.shape != (3,):
        raise TypeError(f"{name} has the shape {array.shape}, not (3,)")
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} holds something else than numbers")


def _text(value: object, name: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} is {_what(value)}, not a text")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{name} holds a character that is none: a lone surrogate") from None
    return value


def _what(value: object) -> str:
    name = type(value).__name__
    return "None" if value is None else f"{'an' if name[0] in 'aeiou' else 'a'} {name}"
