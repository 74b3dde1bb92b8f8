"""A request: where the vehicle is, what it knows of the cave, and what the host computes for a policy."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np

from .values import Goal

Points = np.ndarray | Sequence[Sequence[float]] | Sequence[float]


class Cell(enum.IntEnum):
    """The class of a cell of the map."""

    UNKNOWN = 0
    FREE = 1
    OCCUPIED = 2


class Fate(enum.IntEnum):
    """What became of the last chosen goal."""

    NONE = 0
    UNDER_WAY = 1
    REACHED = 2
    REJECTED = 3
    UNREACHABLE = 4
    ABANDONED = 5
    SUPERSEDED = 6


class SensorKind(enum.IntEnum):
    """LIDAR: a sector of a sphere. CAMERA: depth, a pyramid. RGB: colour, it does not change the map."""

    LIDAR = 1
    CAMERA = 2
    RGB = 3


class EventKind(enum.IntEnum):
    """The kinds of events. Later versions add kinds, which arrive as plain numbers."""

    GOAL_REACHED = 1
    GOAL_REJECTED = 2
    GOAL_UNREACHABLE = 3
    GOAL_ABANDONED = 4
    GOAL_SUPERSEDED = 5
    HOMING = 6
    FRAME_CORRECTED = 7
    MAP_MERGED = 8


@dataclass(frozen=True)
class Event:
    """An event between two requests. ``goal`` is meaningful for the kinds of goals."""

    kind: EventKind | int
    stamp_ns: int
    goal: Goal
    reason: str


@dataclass(frozen=True)
class Sensor:
    """The field of view of a sensor, in its own frame (x forward, y left, z up).

    ``position_in_body``: (3,), m. ``orientation_in_body``: (4,), w x y z, sensor to body.
    """

    name: str
    kind: SensorKind | int
    position_in_body: np.ndarray
    orientation_in_body: np.ndarray
    min_range_m: float
    max_range_m: float
    horizontal_fov_rad: float
    low_elevation_rad: float
    high_elevation_rad: float

    @classmethod
    def of(cls, fields: dict[str, Any]) -> Sensor:
        """As the module's part in C++ gives it."""
        return cls(**fields | {"kind": _member(SensorKind, fields["kind"])})


@dataclass(frozen=True)
class Path:
    """A clear path. ``points``: (n, 3), m, the start first; (0, 3) if no path is known.

    ``length_m`` and ``time_s`` (from rest to rest) are infinite then, ``clearance_m`` is 0.
    """

    points: np.ndarray
    length_m: float
    clearance_m: float
    time_s: float


@dataclass(frozen=True)
class Survey:
    """The passages that a survey tells of before the flight.

    ``legs``: record array: from_station, to_station, from_position (3,), to_position (3,), and the distances to
    the walls, from_left_right_up_down_m (4,), to_left_right_up_down_m (4,).
    ``leads``: record array of the stations where it ends: position (3,), station, kind (1: an end,
    2: the cave goes on).
    """

    legs: np.ndarray
    leads: np.ndarray


class Map:
    """The occupancy map. Questions take batches; a thousand points cost little more than one.

    The map of a request lives until ``decide`` returns; ``retained()`` gives a copy that lasts. All calls raise
    karst.Error where the host refuses them.
    """

    def __init__(self, binding: Any):
        self._map = binding

    def info(self) -> dict[str, float]:
        """resolution_m, revision, free_cells and occupied_cells at once."""
        return self._map.info()

    @property
    def resolution_m(self) -> float:
        """Edge of a cell."""
        return self._map.info()["resolution_m"]

    @property
    def revision(self) -> int:
        """Grows when the class of any cell changes."""
        return self._map.info()["revision"]

    @property
    def free_cells(self) -> int:
        return self._map.info()["free_cells"]

    @property
    def occupied_cells(self) -> int:
        return self._map.info()["occupied_cells"]

    def cells(self, points: Points) -> np.ndarray:
        """The class of the cell at each of (n, 3) points: (n,) uint8, numbers of karst.Cell."""
        return self._map.cells(points)

    def cast_rays(self, start: Points, end: Points, through_unknown: bool = False) -> np.ndarray:
        """Rays from (n, 3), or from one place (3,), to (n, 3).

        Returns (n,) records: center (3,) of the cell that stopped the ray, or of its last one; length_m from the
        ray's start to there; cell, the class of what stopped it, FREE if nothing did.
        """
        return self._map.cast_rays(start, end, through_unknown)

    def counts(self, low: Points, high: Points) -> np.ndarray:
        """Unknown, free and occupied cells in each closed box: (n, 3) uint64 for (n, 3) corners."""
        return self._map.counts(low, high)

    def surface(self, low: Points, high: Points) -> np.ndarray:
        """Centres of the occupied cells in a box that have a free neighbour: (n, 3)."""
        return self._map.surface(low, high)

    def distances_to_rock(self, points: Points, limit_m: float) -> np.ndarray:
        """Metres from each point to the centre of the nearest occupied cell, at most ``limit_m`` (to 100 m).

        Unknown cells are no rock. Where no rock is near, the cost grows with the cube of ``limit_m``.
        """
        return self._map.distances_to_rock(points, limit_m)

    def passages(self) -> tuple[np.ndarray, np.ndarray]:
        """The passages that are connected to the start, and their ends, both by distance from the start.

        Passages: ends (2,) indices, length_m, mean_width_m, least_width_m, mean_height_m, least_height_m,
        volume_m3, frontier_m2, middle (3,). Ends: position (3,), from_start_m, width_m, height_m, volume_m3,
        frontier_m2, kind (1 junction, 2 dead end, 3 open end, 4 ring), ways. Indices hold for this map only.
        """
        return self._map.passages()

    def passages_at(self, points: Points) -> np.ndarray:
        """What is around each point: passage or end (index; 0xffffffff: none), from_start_m, width_m, height_m."""
        return self._map.passages_at(points)

    def retained(self) -> Map:
        """A copy that outlives the request; tens of milliseconds for a large map."""
        return Map(self._map.retained())


class Request:
    """One request of the host. World frame; metres, seconds, radians.

    ``sequence``: 1, 2, ... ``stamp_ns``: its time. ``deadline_ns``: when the answer takes effect.
    ``position``, ``velocity``, ``orientation`` (w x y z, body to world), ``body_rate``: the vehicle, predicted
    for the deadline while it flies.
    ``direction_of_flight``: (3,), unit; along the heading at rest.
    ``start_position``, ``start_orientation``: of the start.
    ``seconds_before_homing``: until the flight home must begin.
    ``max_speed_mps``, ``clearance_m``, ``vehicle_radius_m``.
    ``last_goal``, ``last_fate``: the goal that was chosen last, and what became of it.
    ``frontiers``: record array by id: id, cells, centroid (3,), low (3,), high (3,), normal (3,), unknown_cells,
    free_cells, viewpoint (3,) (NaN: none), viewpoint_heading_rad, path_length_m (infinite: none known).
    ``teammates``: record array: id, stamp_ns, position (3,), velocity (3,), goal (3,), seconds_before_homing.
    ``sensors``: list of :class:`Sensor`.
    ``battery_fraction``, ``battery_seconds_left``, ``mission_seconds_left``: 0: not told.
    ``map``: :class:`Map`.
    """

    sequence: int
    stamp_ns: int
    deadline_ns: int
    position: np.ndarray
    velocity: np.ndarray
    orientation: np.ndarray
    body_rate: np.ndarray
    direction_of_flight: np.ndarray
    start_position: np.ndarray
    start_orientation: np.ndarray
    seconds_before_homing: float
    max_speed_mps: float
    clearance_m: float
    vehicle_radius_m: float
    last_goal: np.ndarray
    last_fate: Fate
    frontiers: np.ndarray
    teammates: np.ndarray
    sensors: list[Sensor]
    battery_fraction: float
    battery_seconds_left: float
    mission_seconds_left: float
    map: Map

    def __init__(self, services: Any, fields: dict[str, Any]):
        self.__dict__.update(fields)
        self._services = services
        self.last_fate = _member(Fate, fields["last_fate"])
        self.sensors = [Sensor.of(s) for s in fields["sensors"]]
        self.map = Map(services.map())

    @property
    def time_s(self) -> float:
        """Time of the request."""
        return self.stamp_ns * 1e-9

    @property
    def heading_rad(self) -> float:
        """Of the body, counter-clockwise from east."""
        w, x, y, z = self.orientation
        return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))

    def reachable(self) -> np.ndarray:
        """The frontiers that have a viewpoint with a known path, the nearest by its path first."""
        all = self.frontiers
        known = np.isfinite(all["path_length_m"]) & np.isfinite(all["viewpoint"]).all(axis=1)
        near = all[known]
        return near[np.lexsort((near["id"], near["path_length_m"]))]

    def path_lengths(self, start: Points, goals: Points, tolerance_m: float = 0.5) -> np.ndarray:
        """Metres of a clear path from (3,) to within the tolerance of each of (n, 3): (n,), infinite if none."""
        return self._services.path_lengths(start, goals, tolerance_m)

    def paths(self, start: Points, goals: Points, tolerance_m: float = 0.5) -> list[Path]:
        """A path to each goal with its points: one search each, so ask for the few that matter."""
        return [Path(*p) for p in self._services.paths(start, goals, tolerance_m)]

    def newly_seen(self, viewpoints: Points, sensor: int = 0, max_range_m: float | None = 10.0) -> np.ndarray:
        """Unknown cells that a sensor would see from each of (n, 4) viewpoints x, y, z, heading: (n,) uint64.

        Rays pass through unknown cells, up to ``max_range_m`` or the sensor's own range, whichever is shorter;
        None: to the sensor's own. Cost and count grow with the cube of the range: a LiDAR's 50 m take seconds.
        ``sensor``: its place in ``sensors``. Raises karst.Error if the vehicle has no such sensor.
        """
        return self._services.newly_seen(sensor, viewpoints, max_range_m)

    def draw_points(self, points: Points, rgb: int = 0x0072B2) -> None:
        """Points in the report, next to this decision. ``rgb``: 0xRRGGBB."""
        self._services.draw_points(points, rgb)

    def draw_lines(self, start: Points, end: Points, rgb: int = 0x0072B2) -> None:
        """Lines in the report."""
        self._services.draw_lines(start, end, rgb)

    def draw_text(self, at: Points, text: str, rgb: int = 0x0072B2) -> None:
        """A text in the report, at most 240 bytes."""
        self._services.draw_text(at, text, rgb)

    def log(self, text: str) -> None:
        """One line in the mission's log."""
        self._services.log(str(text), 1)

    def random(self, count: int = 1) -> np.ndarray:
        """Uniform in [0, 1), the same in every flight with the mission's seed: (count,)."""
        return self._services.random(count)

    def should_stop(self) -> bool:
        """Whether the host no longer waits: long loops should ask, and return."""
        return self._services.should_stop()

    @property
    def survey(self) -> Survey | None:
        """The survey that the mission has, if any."""
        known = self._services.survey()
        return None if known is None else Survey(*known)

    def survey_distances(self, points: Points) -> np.ndarray:
        """Metres from each point to the nearest surveyed passage, negative in it. Raises without a survey."""
        return self._services.survey_distances(points)

    @property
    def imaging_camera(self) -> tuple[Sensor, float, float] | None:
        """The colour camera, its largest angle of incidence (rad), and the seconds between two pictures."""
        camera = self._services.imaging_camera()
        if camera is None:
            return None
        fields, incidence_rad, period_s = camera
        return Sensor.of(fields), incidence_rad, period_s

    def imaged_states(self, points: Points) -> np.ndarray:
        """Whether the surface cell at each point was imaged (karst_abi_imaged.h). Raises without a camera."""
        return self._services.imaged_states(points)

    def unimaged(self, low: Points, high: Points) -> np.ndarray:
        """The surface cells of a box that were not imaged: records center (3,), normal (3,)."""
        return self._services.unimaged(low, high)

    def newly_imaged(self, viewpoints: Points) -> np.ndarray:
        """Cells that a picture from each of (n, 4) viewpoints would add: (n,)."""
        return self._services.newly_imaged(viewpoints)


def _member(kind: type[enum.IntEnum], number: int) -> Any:
    """The member of that number, or the number if a later version added it."""
    try:
        return kind(number)
    except ValueError:
        return number


def event_of(kind: int, stamp_ns: int, goal: tuple, reason: str) -> Event:
    """As the host tells it."""
    return Event(_member(EventKind, kind), stamp_ns, Goal(*goal), reason)
