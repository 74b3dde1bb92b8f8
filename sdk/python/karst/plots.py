"""Plots of runs and of campaigns with matplotlib.

Every function takes an axes to draw into, or makes a figure of its own, and returns the axes. Save a plot
with `axes.figure.savefig("plot.png")`. Colours are safe for the colour-blind; contestants also differ in line
style and mark.
"""

from .campaign_plots import coverage_curves, paired_differences, ranking
from .run_plots import battery, coverage, heights, plan, speed

__all__ = [
    "battery",
    "coverage",
    "coverage_curves",
    "heights",
    "paired_differences",
    "plan",
    "ranking",
    "speed",
]
