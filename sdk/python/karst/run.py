"""One flight, read back from its run directory."""

from __future__ import annotations

from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .errors import Error
from .maps import Map, read_growth, read_map
from .mission_text import parse_info
from .needed import needed
from .tables import read_events, read_json, read_poses, read_table, read_text

if TYPE_CHECKING:
    import pandas as pd

GOAL_COLUMNS = ["time_s", "state", "x_m", "y_m", "z_m", "heading_rad", "score", "frontier", "why", "reason"]


class Run:
    """A run directory. A file is read when it is first asked for, and then kept.

    Tables are pandas data frames; the names of their columns end with the unit. `time_s` counts from the
    start of the mission (of a robot of a team: from when it was switched on). The world frame has x east, y
    north, z up, in metres. docs/run_directory.md and docs/metrics.md define every column and figure.

    A file that is missing or damaged raises Error when it is asked for; all others can still be read. Half a
    line at the end of a file, as a killed flight leaves it, is left out and named in `problems`.
    """

    def __init__(self, folder: str | PathLike[str]) -> None:
        self.folder = Path(folder)
        self.problems: list[str] = []  # what was left out of the files read so far
        if not self.folder.is_dir():
            raise Error.at(self.folder, "", "is no folder" if self.folder.exists() else "is not there")
        if not is_run(self.folder):
            raise Error.at(self.folder, "", "is no run directory: it has no mission.info and no events.jsonl")

    def __repr__(self) -> str:
        return f"Run({str(self.folder)!r})"

    @cached_property
    def metrics(self) -> dict:
        """The figures of docs/metrics.md: numbers, texts, and None where one is unknown."""
        file = self.folder / "metrics.json"
        if not file.exists():
            why = "a flight writes this folder, or was killed" if self.is_locked else "the flight was cut off"
            raise Error.at(file, "", f"is not there: {why}; karst report {self.folder} computes the figures")
        return read_json(file)

    @cached_property
    def mission(self) -> dict:
        """All settings of mission.info as nested dicts of text: mission["map"]["resolution"] is "0.2 m"."""
        return parse_info(self.mission_text, self.folder / "mission.info")

    @cached_property
    def mission_text(self) -> str:
        """mission.info as it is; karst fly repeats the flight with this file."""
        return read_text(self.folder / "mission.info")

    @property
    def is_locked(self) -> bool:
        """Whether run.lock is there: a flight writes the folder, or was killed and left the file behind."""
        return (self.folder / "run.lock").exists()

    @property
    def is_team(self) -> bool:
        """Whether this is the run of a team, which has `robots`."""
        return (self.folder / "team.jsonl").exists()

    @cached_property
    def robots(self) -> list[Run]:
        """The runs of a team's robots, the first one first; empty for a single vehicle."""
        folders = [d for d in self.folder.glob("robot_*") if d.name[6:].isdigit() and is_run(d)]
        return [Run(d) for d in sorted(folders, key=lambda d: int(d.name[6:]))]

    @cached_property
    def robot_starts_s(self) -> list[float]:
        """When each of `robots` was switched on, in the team's time."""
        starts = self.events_of("start")
        times = dict(zip(starts["robot"], starts["time_s"])) if len(starts) else {}
        return [float(times.get(int(r.folder.name[6:]), np.nan)) for r in self.robots]

    @cached_property
    def events(self) -> pd.DataFrame:
        """What happened: time_s, kind, and the fields of all kinds, NaN where an event has no such field.

        Of a team, these are the events of the team and of its base.
        """
        return read_events(self.folder / ("team.jsonl" if self.is_team else "events.jsonl"), self.problems)

    def events_of(self, kind: str) -> pd.DataFrame:
        """The events of one kind, such as "decision", with only the columns that this kind has."""
        chosen = self.events[self.events["kind"] == kind]
        return chosen.dropna(axis=1, how="all").reset_index(drop=True)

    @cached_property
    def goals(self) -> pd.DataFrame:
        """What became of goals: time_s, state, x_m, y_m, z_m, heading_rad, score, frontier, why, reason."""
        goals = self.events[self.events["kind"] == "goal"].reset_index(drop=True)
        points = np.array(list(goals["position_m"])) if len(goals) else np.empty((0, 3))
        goals = goals.assign(x_m=points[:, 0], y_m=points[:, 1], z_m=points[:, 2])
        return goals.reindex(columns=GOAL_COLUMNS)

    @cached_property
    def phases(self) -> pd.DataFrame:
        """phase, begin_s, end_s: consecutive; the last one ends with the last event. A team has none."""
        if self.is_team:
            raise Error.at(self.folder, "phases", "each robot of a team has its own: see Run.robots")
        pandas = needed("pandas", "reading a run's phases")
        events = self.events_of("phase")
        names = list(events["phase"]) if len(events) else []
        times = [*events["time_s"], float(self.events["time_s"].max())] if names else [np.nan]
        table = pandas.DataFrame({"phase": names, "begin_s": times[:-1], "end_s": times[1:]})
        return table[table["phase"] != "done"]

    @cached_property
    def takeoff_s(self) -> float:
        """When the first phase after standby began: the start of the flight. NaN if it did not begin."""
        events = self.events_of("phase")
        flown = events[events["phase"] != "standby"] if len(events) else events
        return float(flown["time_s"].iloc[0]) if len(flown) else float("nan")

    @cached_property
    def trajectory(self) -> pd.DataFrame:
        """The vehicle's estimate of its pose: time_s, x_m, y_m, z_m, qx, qy, qz, qw (body to world)."""
        return read_poses(self._file("trajectory.tum"), self.problems)

    @cached_property
    def ground_truth(self) -> pd.DataFrame:
        """The simulator's pose of the vehicle, with the columns of `trajectory`, 100 times a second."""
        return read_poses(self._file("ground_truth.tum"), self.problems)

    @cached_property
    def telemetry(self) -> pd.DataFrame:
        """Ten times a second: time_s, phase, x_m ... vz_mps, heading_rad, ref_x_m ..., battery_fraction,
        seconds_left, explored_m3, home_distance_m. Of a team: time_s, phase, explored_m3."""
        return read_table(self.folder / "telemetry.csv", self.problems)

    @cached_property
    def localization(self) -> pd.DataFrame:
        """A row for each scan: time_s (of the scan), used_s, accepted, free_directions, edges, planes,
        residual_m, position_sigma_m, heading_sigma_rad, believed, problem."""
        return read_table(self._file("localization.csv"), self.problems)

    @cached_property
    def decisions(self) -> pd.DataFrame:
        """Wall-clock cost of each decision: time_s, decide_ms, plan_ms. What it was is in `events`."""
        return read_table(self._file("decisions.csv"), self.problems)

    @cached_property
    def truth(self) -> pd.DataFrame:
        """The simulator's record: time_s, clearance_m, speed_mps, battery_fraction, power_w, wind ..."""
        return read_table(self._file("truth.csv"), self.problems)

    @cached_property
    def truth_events(self) -> pd.DataFrame:
        """The simulator's events: time_s, event, detail, speed_mps, x_m, y_m, z_m."""
        return read_events(self._file("truth_events.jsonl"), self.problems, "time_s", "event")

    @cached_property
    def unsurveyed(self) -> pd.DataFrame:
        """Of a mission with a survey: time_s, unsurveyed_m3."""
        return read_table(self._file("unsurveyed.csv"), self.problems)

    @cached_property
    def frames(self) -> pd.DataFrame:
        """The colour camera's pictures: time_s, file, x_m ... qw (its pose), width_px, height_px, fx_px"""
        return read_table(self._file("frames.csv"), self.problems)

    @cached_property
    def objects(self) -> dict:
        """objects.json: the objects of interest that were found, with positions in metres."""
        return read_json(self._file("objects.json"))

    @cached_property
    def timing(self) -> dict:
        """timing.json: wall-clock figures."""
        return read_json(self.folder / "timing.json")

    @cached_property
    def evaluation(self) -> dict:
        """evaluation.json, which karst evaluate writes: errors of trajectory and map."""
        return read_json(self._file("evaluation.json"))

    @cached_property
    def explored(self) -> pd.DataFrame:
        """Explored volume over time: time_s, since_takeoff_s, explored_m3, coverage (0 to 1).

        Coverage over time is not recorded. As in docs/metrics.md it is the final coverage times the volume
        over the final volume, and at most 1. It is NaN if metrics.json has no coverage, or is missing.
        """
        pandas = needed("pandas", "reading the explored volume")
        telemetry = self.telemetry[["time_s", "explored_m3"]].dropna()
        final_m3 = telemetry["explored_m3"].iloc[-1] if len(telemetry) else np.nan
        has_figures = (self.folder / "metrics.json").exists()
        final_coverage = self.metrics.get("coverage") if has_figures else None
        share = np.nan if final_coverage is None else final_coverage / final_m3 if final_m3 > 0 else 0.0
        return pandas.DataFrame({
            "time_s": telemetry["time_s"],
            "since_takeoff_s": telemetry["time_s"] - self.takeoff_s,
            "explored_m3": telemetry["explored_m3"],
            "coverage": np.minimum(1.0, telemetry["explored_m3"] * share),
        }).reset_index(drop=True)

    @cached_property
    def map(self) -> Map:
        """The final map, of map.ot (log-odds), or of map.bt (free or occupied) if that is all there is."""
        for name in ("map.ot", "map.bt"):
            if self._file(name).exists():
                return read_map(self.folder / name)
        raise Error.at(self.folder, "map.ot", "is not there, nor is map.bt: they are written at the end")

    @cached_property
    def map_growth(self) -> pd.DataFrame:
        """A row for each time that a cell was rock: x_m, y_m, z_m (centre), from_s, until_s (inf: never)."""
        return read_growth(self._file("map_growth.bin"), self.map_resolution_m, self.problems)

    def rock_at(self, time_s: float) -> np.ndarray:
        """(n, 3) float64: centres in metres of the cells that the map held as rock at this time."""
        growth = self.map_growth
        then = growth[(growth["from_s"] <= time_s) & (growth["until_s"] > time_s)]
        return then[["x_m", "y_m", "z_m"]].to_numpy()

    @property
    def map_resolution_m(self) -> float:
        """Edge length of a cell of the map, as mission.info has it."""
        try:
            return float(self.mission["map"]["resolution"].split()[0])
        except (KeyError, TypeError, AttributeError, IndexError, ValueError):
            file = self.folder / "mission.info"
            raise Error.at(file, "map.resolution", "expected a length in metres") from None

    def _file(self, name: str) -> Path:
        """A file of a single vehicle."""
        if self.is_team and not (self.folder / name).exists():
            raise Error.at(self.folder, name, "a team has none, but each of its robots has: see Run.robots")
        return self.folder / name


def is_run(folder: Path) -> bool:
    """Whether a flight wrote, or writes, this folder."""
    return any((folder / name).is_file() for name in ("mission.info", "events.jsonl", "team.jsonl"))
