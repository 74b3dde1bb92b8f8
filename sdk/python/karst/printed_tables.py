"""Tables in Markdown, as the karst program prints them."""

from __future__ import annotations

import re

from .errors import Error

_NUMBER = re.compile(r"[+-]?\d+(\.\d+)?(e[+-]?\d+)?")


def cells_of(text: str, source: str) -> list[list[str]]:
    """The cells of the first table in the text, by row; the header is the first row. `source` is for errors.

    Bold marks and backslashes before marks are taken away.
    """
    lines = text.split("\n")
    first = next((i for i, line in enumerate(lines) if line.startswith("|")), None)
    if first is None or first + 1 == len(lines):
        raise Error.at(source, "", "has no table; is this karst of another version than this package?")
    rows = []
    for line in [lines[first], *lines[first + 2 :]]:  # the second line is a rule
        if not line.startswith("|"):
            break
        rows.append([_plain(cell) for cell in re.split(r"(?<!\\)\|", line)[1:-1]])
    return rows


def number_of(cell: str) -> float:
    """The number in a cell, or NaN. "> 300" is 300: a restricted mean time at the horizon."""
    found = _NUMBER.search(cell.replace("\u2212", "-"))
    return float(found[0]) if found else float("nan")


def numbers_of(cell: str) -> list[float]:
    """All numbers in a cell, such as those of an interval "[1.2, 3.4]" or of places "1-5"."""
    return [float(n[0]) for n in _NUMBER.finditer(cell.replace("\u2212", "-"))]


def _plain(cell: str) -> str:
    cell = cell.strip()
    if len(cell) > 4 and cell.startswith("**") and cell.endswith("**"):
        cell = cell[2:-2]
    return re.sub(r"\\(.)", r"\1", cell)
