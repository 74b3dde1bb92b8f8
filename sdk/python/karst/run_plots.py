"""Plots of one flight, or of a team's: coverage, plan, heights, battery and speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .errors import Error
from .plot_look import (
    BLUE, COLOURS, FREE, GREEN, GREY, LINES, PURPLE, ROCK, ROCK_ALONE, VERMILION, axes_for, label_axes,
    legend_above,
)
from .run import Run

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

TIME = "time from take-off (s)"
STEP_M = 0.1  # between points of the path in the height profile


def coverage(run: Run, ax: Axes | None = None) -> Axes:
    """Explored share of the cave in percent over time; explored volume in m³ if the share is not known."""
    ax, table = axes_for(ax), run.explored
    known = bool(np.isfinite(table["coverage"]).any())
    values = 100 * table["coverage"] if known else table["explored_m3"]
    ax.plot(table["since_takeoff_s"], values, color=BLUE, label=run.folder.name)
    ax.fill_between(table["since_takeoff_s"], 0, values, color=BLUE, alpha=0.15, linewidth=0)
    label_axes(ax, TIME, "coverage (%)" if known else "explored volume (m³)")
    ax.set_xlim(left=0)
    ax.set_ylim(0, 105 if known else None)
    _mark_homing(run, ax)
    return ax


def battery(run: Run, ax: Axes | None = None) -> Axes:
    """Battery left in percent over time, of each robot of a team."""
    ax = axes_for(ax)
    _plot_each(run, ax, lambda table: 100 * table["battery_fraction"], PURPLE)
    label_axes(ax, TIME, "battery left (%)")
    ax.set_ylim(0, 105)
    _mark_homing(run, ax)
    return ax


def speed(run: Run, ax: Axes | None = None) -> Axes:
    """Estimated speed in m/s over time, of each robot of a team."""
    ax = axes_for(ax)
    _plot_each(run, ax, lambda t: np.sqrt(t["vx_mps"] ** 2 + t["vy_mps"] ** 2 + t["vz_mps"] ** 2), VERMILION)
    label_axes(ax, TIME, "speed (m/s)")
    ax.set_ylim(bottom=0)
    _mark_homing(run, ax)
    return ax


def plan(run: Run, ax: Axes | None = None) -> Axes:
    """The map from above with the path and the goals: free space is light, rock without free space dark.

    A single vehicle's path has one colour out and another one home; of a team, each robot has its own.
    """
    ax = axes_for(ax, 6.4, 6.4)
    _draw_map_plan(run, ax)
    for i, (robot, path) in enumerate(_paths(run)):
        if run.robots:
            ax.plot(path["x_m"], path["y_m"], color=COLOURS[i % len(COLOURS)], linewidth=1.4,
                    linestyle=LINES[i % len(LINES)], label=robot.folder.name.replace("_", " "))
            continue
        home_s = _homing_s(robot)
        back = path["time_s"] >= (np.inf if home_s is None else home_s)
        for chosen, colour, label in ((~back, VERMILION, "path out"), (back, BLUE, "path home")):
            if chosen.any():
                ax.plot(path["x_m"][chosen], path["y_m"][chosen], color=colour, linewidth=1.4, label=label)
        _draw_goals(robot, ax)
        ax.plot(path["x_m"].iloc[:1], path["y_m"].iloc[:1], "^", color="black", markersize=8, label="start")
    label_axes(ax, "east x (m)", "north y (m)")
    ax.grid(False)
    ax.set_aspect("equal")
    legend_above(ax)
    return ax


def heights(run: Run, ax: Axes | None = None) -> Axes:
    """Height of the path over the distance flown, with the rock that the map has above and below it."""
    if run.robots:
        raise Error.at(run.folder, "heights", "each robot of a team has its own profile: see Run.robots")
    ax = axes_for(ax)
    (_, path), *_ = _paths(run)
    points = path[["x_m", "y_m", "z_m"]].to_numpy()
    along_m = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    steps_m = np.arange(0, along_m[-1] + STEP_M, STEP_M)
    even = np.column_stack([np.interp(steps_m, along_m, points[:, i]) for i in range(3)])
    rock = _rock(run)
    if rock is not None:
        below_m, above_m = _rock_beside(even, rock, run.map_resolution_m)
        ax.fill_between(steps_m, below_m, above_m, color=FREE, linewidth=0, label="free, in the map")
        ax.plot(steps_m, above_m, color=ROCK, linewidth=0.9, label="ceiling and floor")
        ax.plot(steps_m, below_m, color=ROCK, linewidth=0.9)
    ax.plot(steps_m, even[:, 2], color=VERMILION, linewidth=1.4, label="path")
    label_axes(ax, "distance flown (m)", "height z (m)")
    ax.set_xlim(0, steps_m[-1])
    legend_above(ax)
    return ax


def _plot_each(run: Run, ax: Axes, values, colour: str) -> None:
    """A curve for each vehicle from its telemetry, in the time of the whole run."""
    robots = run.robots or [run]
    for i, (robot, start_s) in enumerate(zip(robots, run.robot_starts_s or [0.0])):
        table = robot.telemetry
        ax.plot(table["time_s"] + start_s - run.takeoff_s, values(table), linewidth=1.2,
                color=COLOURS[i % len(COLOURS)] if run.robots else colour,
                linestyle=LINES[i % len(LINES)] if run.robots else "-",
                label=robot.folder.name.replace("_", " "))
    ax.set_xlim(left=0)
    if run.robots:
        legend_above(ax)


def _homing_s(run: Run) -> float | None:
    """When a single vehicle turned home, in its own time."""
    homeward = run.phases[run.phases["phase"] == "home"]
    return float(homeward["begin_s"].iloc[0]) if len(homeward) else None


def _mark_homing(run: Run, ax: Axes) -> None:
    if run.is_team:
        return
    home_s = _homing_s(run)
    if home_s is not None:
        ax.axvline(home_s - run.takeoff_s, color=GREY, linestyle=":", linewidth=1.2)
        ax.annotate(" way home", (home_s - run.takeoff_s, 1), xycoords=("data", "axes fraction"), va="bottom",
                    ha="center", fontsize="small", color=GREY)


def _paths(run: Run) -> list[tuple[Run, pd.DataFrame]]:
    """The estimated path of each vehicle from its take-off on."""
    paths = []
    for robot in run.robots or [run]:
        path = robot.trajectory
        if len(path) == 0:
            raise Error.at(robot.folder / "trajectory.tum", "", "has no pose: nothing was flown")
        flown = path[~(path["time_s"] < robot.takeoff_s)]  # all of it if take-off is not known
        paths.append((robot, flown if len(flown) else path))
    return paths


def _draw_goals(run: Run, ax: Axes) -> None:
    goals = run.goals
    for states, mark, colour, label in (
        (["reached"], "o", GREEN, "goal, reached"),
        (["rejected", "unreachable", "abandoned"], "x", PURPLE, "goal, refused or given up"),
    ):
        chosen = goals[goals["state"].isin(states)]
        if len(chosen):
            ax.plot(chosen["x_m"], chosen["y_m"], mark, color=colour, markersize=5, label=label)


def _draw_map_plan(run: Run, ax: Axes) -> None:
    """Columns of cells as pixels: light where one is free, dark where the map has rock only.

    A flight that was cut off has no free cells in its files: floor and ceiling then cover the path's place.
    """
    resolution_m = run.map_resolution_m
    rock, free = [], []
    for robot in run.robots or [run]:
        cells = _rock(robot)
        if cells is not None:
            rock.append(cells)
        if _has_map(robot):
            free.append(robot.map.cells(occupied=False))
    columns = [np.floor(np.concatenate(c)[:, :2] / resolution_m).astype(int) for c in (rock, free) if c]
    if not columns:
        return
    low, high = np.concatenate(columns).min(axis=0), np.concatenate(columns).max(axis=0) + 1
    image = np.ones((high[1] - low[1], high[0] - low[0], 4))
    image[..., 3] = 0  # unknown: transparent
    for cells, colour in zip(columns, (ROCK if free else ROCK_ALONE, FREE)):
        rgb = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        image[cells[:, 1] - low[1], cells[:, 0] - low[0]] = [*rgb, 1]
    (left, bottom), (right, top) = low * resolution_m, high * resolution_m
    ax.imshow(image, extent=(left, right, bottom, top), origin="lower", interpolation="nearest")


def _has_map(run: Run) -> bool:
    return any((run.folder / name).exists() for name in ("map.ot", "map.bt"))


def _rock(run: Run) -> np.ndarray | None:
    """(n, 3): rock of the final map, or of its growth if the flight was cut off, or None."""
    if _has_map(run):
        return run.map.cells()
    if (run.folder / "map_growth.bin").exists():
        return run.rock_at(float(np.finfo(float).max))  # until_s is inf of what stays
    return None


def _rock_beside(points: np.ndarray, rock: np.ndarray, resolution_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Heights of the nearest rock straight below and above each of the points (n, 3); NaN without any."""
    both = np.floor(np.concatenate([rock, points]) / resolution_m).astype(np.int64)
    both -= both.min(axis=0)
    extent = both.max(axis=0) + 1
    keys = (both[:, 0] * extent[1] + both[:, 1]) * extent[2] + both[:, 2]  # in order within each column
    lowest_m = np.floor(np.concatenate([rock, points])[:, 2].min() / resolution_m) * resolution_m
    cells, wanted = np.sort(keys[: len(rock)]), keys[len(rock) :]
    above = np.searchsorted(cells, wanted)
    heights_m = []
    for index, face in ((above - 1, 1.0), (above, 0.0)):  # upper face of the floor, lower one of the ceiling
        cell = cells[np.clip(index, 0, len(cells) - 1)]
        same_column = (index >= 0) & (index < len(cells)) & (cell // extent[2] == wanted // extent[2])
        heights_m.append(np.where(same_column, lowest_m + (cell % extent[2] + face) * resolution_m, np.nan))
    return heights_m[0], heights_m[1]
