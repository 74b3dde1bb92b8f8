"""Plots of a campaign: coverage with its spread, paired differences, and the ranking."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .campaign import Campaign
from .errors import Error
from .plot_look import BLACK, COLOURS, GREY, LINES, MARKS, axes_for, label_axes, legend_above

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOMENTS = 101  # of a curve, as in karst's report


def coverage_curves(campaign: Campaign, cave: str | None = None, ax: Axes | None = None) -> Axes:
    """Coverage in percent over time of each contestant: the median of its flights, the quartiles as a band.

    After a flight ends, its coverage counts as constant. `cave` chooses the flights in one cave.
    """
    curves = campaign.curves
    if cave is not None:
        curves = curves[curves["cave"] == cave]
        if len(curves) == 0:
            names = ", ".join(c["name"] for c in campaign.caves)
            raise Error.at(campaign.folder, cave, f"no flight in such a cave; the caves are {names}")
    ax = axes_for(ax)
    moments_s = np.linspace(0, campaign.horizon_s, MOMENTS)
    for i, contestant in enumerate(c["name"] for c in campaign.contestants):
        flights = [
            _held(flight["since_takeoff_s"].to_numpy(), flight["coverage"].to_numpy(), moments_s)
            for _, flight in curves[curves["contestant"] == contestant].groupby(["cave", "seed"])
        ]
        if not flights:
            continue
        low, middle, high = 100 * np.nanquantile(flights, [0.25, 0.5, 0.75], axis=0)
        colour = COLOURS[i % len(COLOURS)]
        ax.plot(moments_s, middle, color=colour, linestyle=LINES[i % len(LINES)], label=contestant)
        ax.fill_between(moments_s, low, high, color=colour, alpha=0.15, linewidth=0)
    label_axes(ax, "time from take-off (s)", "coverage (%): median and quartiles")
    ax.set_xlim(0, campaign.horizon_s)
    ax.set_ylim(bottom=0)
    legend_above(ax)
    return ax


def paired_differences(
    campaign: Campaign,
    a: str | None = None,
    b: str | None = None,
    metric: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """The figure of a minus that of b for each pair of flights, by cave.

    Below stands karst's mean with its 95 % interval; a filled mark says that the difference is shown. a and b
    may be left out if there are two contestants. A pair of which a figure is unknown has no mark.
    """
    if a is None or b is None:
        names = [c["name"] for c in campaign.contestants]
        if len(names) != 2:
            raise Error.at(campaign.folder, "", f"say which two to compare of {', '.join(names)}")
        a, b = names
    verdict, heading = campaign.verdict(a, b, metric), campaign.heading(metric)
    scale = _scale(heading)
    trials = campaign.trials.set_index(["contestant", "cave", "seed"])[verdict.metric]
    differences = scale * (trials.loc[a] - trials.loc[b]).dropna()
    caves = [c["name"] for c in campaign.caves]
    ax = axes_for(ax, 6.4, 1.6 + 0.4 * len(caves))
    ax.axvline(0, color=GREY, linewidth=1)
    for row, cave in enumerate(caves):
        values = differences[differences.index.get_level_values("cave") == cave]
        spread = row + np.linspace(-0.2, 0.2, len(values)) if len(values) > 1 else [row] * len(values)
        ax.plot(values, spread, "o", color=COLOURS[0], alpha=0.7, markersize=5)
    at = len(caves)
    ax.plot([scale * verdict.low, scale * verdict.high], [at, at], color=BLACK, linewidth=2)
    fill = "full" if verdict.better else "none"
    ax.plot(scale * verdict.difference, at, "D", color=BLACK, markersize=7, fillstyle=fill)
    ax.set_yticks(range(at + 1), [*caves, "mean, 95 % CI"])
    ax.invert_yaxis()
    label_axes(ax, _difference_label(heading, a, b), "")
    shown = "a difference is shown" if verdict.better else "no difference is shown"
    ax.set_title(shown, loc="left", fontsize="medium")
    return ax


def ranking(campaign: Campaign, metric: str | None = None, ax: Axes | None = None) -> Axes:
    """Means of the contestants with karst's 95 % intervals, best first.

    Contestants with a common letter, on the right, are not shown to differ.
    """
    table, heading = campaign.ranking(metric), campaign.heading(metric)
    scale = _scale(heading)
    ax = axes_for(ax, 6.4, 1.2 + 0.4 * len(table))
    order = {c["name"]: i for i, c in enumerate(campaign.contestants)}  # the colours of the curves
    for row, place in enumerate(table.itertuples()):
        i = order[place.contestant]
        colour = COLOURS[i % len(COLOURS)]
        ax.plot([scale * place.low, scale * place.high], [row, row], color=colour, linewidth=2)
        ax.plot(scale * place.mean, row, MARKS[i % len(MARKS)], color=colour, markersize=7)
        ax.annotate(place.groups, (1.01, row), xycoords=("axes fraction", "data"), va="center", color=GREY)
    ax.set_yticks(range(len(table)), table["contestant"])
    ax.set_ylim(len(table) - 0.5, -0.5)
    label_axes(ax, heading, "")
    return ax


def _held(times_s: np.ndarray, values: np.ndarray, moments_s: np.ndarray) -> np.ndarray:
    """The value at each moment: that of the last point no later, and the first one before all points."""
    return values[np.clip(np.searchsorted(times_s, moments_s, side="right") - 1, 0, None)]


def _scale(heading: str) -> float:
    """From the figure to what the axis shows: karst prints shares in percent."""
    return 100.0 if heading.endswith("(%)") else 1.0


def _difference_label(heading: str, a: str, b: str) -> str:
    if heading.endswith("(%)"):
        heading = heading[:-3] + "(percentage points)"
    return f"{heading}\n{a} minus {b}"
