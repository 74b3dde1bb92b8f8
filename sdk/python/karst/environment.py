"""An environment to learn in: a flight, one decision a step, in Gymnasium's convention."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from dataclasses import fields
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Any, Callable, Mapping, Sequence

import numpy as np

from . import _remote
from .errors import Error
from .observation import observation_of, observation_space, offered_frontiers
from .program import program
from .request import Request
from .spaces import Discrete
from .values import EXPLORED, GO_HOME, Answer, Explored, Fly, Goal, GoHome, Hold, Tour, answer_fields, goal_at

try:
    from gymnasium import Env as _Base
except ImportError:
    _Base = object  # the convention needs no base class

Action = int | Sequence[int] | np.ndarray | Answer
Reward = Callable[[Request, Request], float]

#: What `karst compare` flies by default: poses from a sensor, five LiDAR turns a second.
CAMPAIGN = {
    "simulator.pose.fitted": "always",
    "localization.source": "pose_sensor",
    "simulator.lidar.rate": "5 Hz",
}


def new_volume(before: Request, after: Request) -> float:
    """Free space that became known, m3."""
    return after.resolution_m**3 * (after.free_cells - before.free_cells)


def new_volume_less_time(before: Request, after: Request) -> float:
    """Free space that became known, m3, less 1 m3 for each second."""
    return new_volume(before, after) - (after.time_s - before.time_s)


REWARDS: dict[str, Reward] = {"new_volume": new_volume, "new_volume_less_time": new_volume_less_time}


class Environment(_Base):
    """A flight through a cave, in which the caller is the policy.

    ``cave``: a cave's .info file. ``seed``: of the next flight; ``reset`` may give another. ``vehicle``:
    lidar_uav, lidar_only_uav or camera_uav. ``time_s``: flight time. ``reward``: a name of REWARDS, or a function
    of the request before and the one after a step. ``max_frontiers``: rows of an observation. ``settings``: keys
    of the mission, over those of CAMPAIGN; ``full=True`` leaves those out, so that LOAM localizes. ``keep``: the
    folder that keeps the runs; by default they are deleted.

    An observation is that of :mod:`karst.observation`; ``info["request"]`` is the request itself, whose map and
    paths can be asked until the next step. An action is the number of a frontier in the observation, a place
    (3,) or (4,) with the heading, or whatever a policy's ``decide`` may return.

    A step is one decision. ``terminated``: the caller said that the cave is explored, or flew home, and the
    vehicle has landed. ``truncated``: time or battery were over, or the flight failed. In both cases
    ``info["metrics"]`` has the figures of the flight, the reward is 0 and the observation is the last one.
    """

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode = None

    def __init__(
        self,
        cave: str | os.PathLike[str],
        seed: int = 1,
        vehicle: str = "lidar_uav",
        *,
        time_s: float = 300.0,
        reward: str | Reward = "new_volume",
        max_frontiers: int = 32,
        settings: Mapping[str, Any] | None = None,
        full: bool = False,
        keep: str | os.PathLike[str] | None = None,
    ):
        if isinstance(reward, str) and reward not in REWARDS:
            raise Error(f"there is no reward {reward}; there are: {', '.join(REWARDS)}")
        if max_frontiers < 1:
            raise Error("max_frontiers must be 1 or more")
        if not Path(cave).is_file():
            raise Error.at(cave, "", "is not there")
        self.cave, self.vehicle, self.time_s = Path(cave), vehicle, time_s
        self.max_frontiers = max_frontiers
        self.observation_space = observation_space(max_frontiers)
        self.action_space = Discrete(max_frontiers)
        self._reward = REWARDS[reward] if isinstance(reward, str) else reward
        self._settings = ({} if full else dict(CAMPAIGN)) | dict(settings or {})
        self._seed = seed
        self._kept = keep is not None
        self._runs = Path(tempfile.mkdtemp(prefix="karst-environment-")) if keep is None else Path(keep)
        self._flight: subprocess.Popen | None = None
        self._pipe: Connection | None = None
        self._request: Request | None = None
        self._observation: dict[str, np.ndarray] | None = None
        self._ended_by_caller = False

    # -- Gymnasium's convention

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Begins a flight, and returns the first request's observation. A flight under way is given up.

        ``seed``: of this flight, and of those after it. ``options``: {"cave": FILE} flies through another cave.
        """
        self.reset_begin(seed=seed, options=options)
        return self.reset_end()

    def step(self, action: Action) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        """Observation, reward, terminated, truncated, info. Raises Error for an action that is none."""
        self.step_begin(action)
        return self.step_end()

    def render(self) -> None:
        """The report of a kept run shows it: `karst report`."""

    def close(self) -> None:
        """Gives the flight up, and deletes what need not be kept."""
        self._give_up()
        if not self._kept:
            shutil.rmtree(self._runs, ignore_errors=True)

    def __enter__(self) -> Environment:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_runs", None) is not None:
            self.close()

    # -- In two halves, so that several environments fly at once: see Environments

    def reset_begin(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> None:
        self._give_up()
        if seed is not None:
            self._seed = int(seed)
            self.action_space.seed(self._seed)
        if options and "cave" in options:
            self.cave = Path(options["cave"])
        self._start()

    def reset_end(self) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        if not self._receive():
            raise Error(f"the flight ended before its first request: {self._why_it_ended()}")
        return self._observation, self._info()

    def step_begin(self, action: Action) -> None:
        self._send(self._fields_of(action))

    def _fields_of(self, action: Action) -> tuple:
        """As the flight takes them. Raises Error if the action is none, and then nothing has happened."""
        if self._request is None or self._pipe is None:
            raise Error("there is no flight: reset() begins one")
        if self._request._services.ended:
            raise Error("a step is under way: step_end() ends it")
        try:
            outcome, in_order, reason, goals = answer_fields(self._answer_of(action))
        except (TypeError, ValueError) as e:
            raise Error(str(e)) from None
        for i, goal in enumerate(goals):
            if not np.isfinite(np.asarray(goal.position, float)).all():
                raise Error(f"goal {i}: its position is not finite")
        # A class of the caller's own would be unknown there.
        return outcome, in_order, reason, [Goal(**{f.name: getattr(g, f.name) for f in fields(Goal)}) for g in goals]

    def _send(self, answer: tuple) -> None:
        self._ended_by_caller = answer[0] in (EXPLORED, GO_HOME)
        self._before = self._request
        self._request._services.ended = True
        try:
            self._pipe.send(("answer", *answer))
        except OSError:
            pass  # the flight is over: step_end says why

    def step_end(self) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        if self._receive():
            return self._observation, float(self._reward(self._before, self._request)), False, False, self._info()
        self._request = None
        explored = self._ended_by_caller
        metrics = self._metrics()
        done = explored and metrics.get("outcome") == "landed"
        return self._observation, 0.0, done, not done, {"metrics": metrics, "run": str(self.run_folder)}

    @property
    def run_folder(self) -> Path:
        """Of the present flight, or of the last one."""
        return self._runs / f"{self.cave.stem}-{self._seed}"

    # -- The flight

    def _start(self) -> None:
        ours, theirs = Pipe()
        command = [
            str(program()), "fly", "--cave", str(self.cave), "--seed", str(self._seed), "--time", f"{self.time_s:g} s",
            "--policy", str(Path(_remote.__file__)), "--in-process", "--threads", "1", "--quiet", "--no-report",
            "--force", "--out", str(self.run_folder), "--cave-cache", str(self._runs / "caves"),
        ]
        # While the caller thinks, the flight waits: an hour, and not the minute that a policy has.
        fixed = {"simulator.vehicle": self.vehicle, "policy.hang_limit": "3600 s"}
        for key, value in (fixed | self._settings).items():
            command += ["--set", f"{key}={value}"]
        self._runs.mkdir(parents=True, exist_ok=True)
        self._said = tempfile.TemporaryFile()
        self._flight = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=self._said, stderr=self._said,
            pass_fds=[theirs.fileno()], env=os.environ | {_remote.PIPE: str(theirs.fileno())},
        )
        theirs.close()
        self._pipe = ours
        self._has_folder = False

    def _give_up(self) -> None:
        if self._pipe is not None:
            self._pipe.close()
            self._pipe = None
        if self._flight is not None:
            self._flight.kill()
            self._flight.wait()
            self._flight = None
            self._said.close()
            if self._has_folder:  # else the lock may be that of another flight
                (self.run_folder / "run.lock").unlink(missing_ok=True)
        self._request = None

    def _receive(self) -> bool:
        """Waits for the next request. False if the flight has ended."""
        try:
            _, fields = self._pipe.recv()
        except (EOFError, OSError):
            return False
        self._has_folder = True
        self._request = Request(_remote.RemoteServices(self._pipe), fields)
        info = self._request.map.info()
        self._request.free_cells, self._request.resolution_m = info["free_cells"], info["resolution_m"]
        self._observation = observation_of(self._request, self.max_frontiers)
        return True

    def _info(self) -> dict[str, Any]:
        return {"request": self._request, "time_s": self._request.time_s}

    def _metrics(self) -> dict[str, Any]:
        code = self._flight.wait()
        try:
            return json.loads((self.run_folder / "metrics.json").read_text())
        except (OSError, ValueError):
            raise Error(f"the flight ended with exit code {code}: {self._why_it_ended()}") from None

    def _why_it_ended(self) -> str:
        self._flight.wait()
        self._said.seek(0)
        text = self._said.read().decode("utf-8", "replace").strip()
        return text.removeprefix("karst: ") or "it said nothing"

    # -- Actions

    def _answer_of(self, action: Action) -> Answer:
        if isinstance(action, (Fly, Tour, Hold, Explored, GoHome, Goal)):
            return action
        near = offered_frontiers(self._request, self.max_frontiers)
        if isinstance(action, np.ndarray) and action.ndim == 0:
            action = action.item()
        if isinstance(action, (bool, np.bool_)):
            raise Error("an action is a frontier's number, not true or false")
        if isinstance(action, (int, np.integer)):
            return goal_at(near[_row(action, near)])
        place = np.asarray(action) if not _holds_goals(action) else None
        if place is not None and place.shape in ((3,), (4,)) and place.dtype.kind == "f":
            return Goal(place[:3], **({"heading_rad": float(place[3])} if len(place) == 4 else {}))
        if place is not None and place.ndim == 1 and place.dtype.kind in "iu":
            return [goal_at(near[_row(i, near)]) for i in place]
        if _holds_goals(action):
            return list(action)
        raise Error("an action is a frontier's number, a place (3,) or (4,), a list of numbers, or goals")


class Environments:
    """Several environments whose flights go on at the same time, each in a process of its own."""

    def __init__(self, environments: Sequence[Environment]):
        self.environments = list(environments)

    def reset(self, seeds: Sequence[int] | None = None) -> list[tuple[dict[str, np.ndarray], dict[str, Any]]]:
        """As each one's reset."""
        for i, e in enumerate(self.environments):
            e.reset_begin(seed=None if seeds is None else seeds[i])
        return [e.reset_end() for e in self.environments]

    def step(self, actions: Sequence[Action | None]) -> list[tuple | None]:
        """As each one's step. None instead of an action leaves that environment as it is, and gives None."""
        answers = [
            None if action is None else e._fields_of(action)  # all of them before one flies on: any may be wrong
            for e, action in zip(self.environments, actions, strict=True)
        ]
        for e, answer in zip(self.environments, answers):
            if answer is not None:
                e._send(answer)
        return [None if a is None else e.step_end() for e, a in zip(self.environments, actions)]

    def close(self) -> None:
        for e in self.environments:
            e.close()


def _row(number: int, near: np.ndarray) -> int:
    if not 0 <= number < len(near):
        raise Error(f"there is no frontier {number}: {len(near)} are within reach")
    return int(number)


def _holds_goals(action: Any) -> bool:
    return isinstance(action, (list, tuple)) and any(isinstance(goal, Goal) for goal in action)
