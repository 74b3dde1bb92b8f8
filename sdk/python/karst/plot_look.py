"""What all plots have in common: axes, colours and line styles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .needed import needed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's palette, which the colour-blind can tell apart.
BLACK, BLUE, VERMILION, GREEN, ORANGE, SKY, PURPLE = (
    "#000000", "#0072b2", "#d55e00", "#009e73", "#e69f00", "#56b4e9", "#cc79a7",
)
COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK)
LINES = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)))
MARKS = ("o", "s", "^", "D", "v")
ROCK, ROCK_ALONE, FREE, GREY = "#4d4d4d", "#bdbdbd", "#e8e8e8", "#707070"


def axes_for(ax: Axes | None, width_in: float = 6.4, height_in: float = 3.6) -> Axes:
    """The axes itself, or those of a new figure of this size in inches."""
    if ax is not None:
        return ax
    pyplot = needed("matplotlib.pyplot", "plotting")
    _, made = pyplot.subplots(figsize=(width_in, height_in), layout="constrained")
    return made


def label_axes(ax: Axes, x: str, y: str) -> None:
    """Labels, a faint grid behind the data, and no frame above and on the right."""
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    ax.grid(color="#d9d9d9", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def legend_above(ax: Axes, columns: int = 3) -> None:
    """A legend outside of the data, above it on the left."""
    ax.legend(loc="lower left", bbox_to_anchor=(0, 1.01), ncol=columns, frameon=False, borderaxespad=0,
              fontsize="small")
