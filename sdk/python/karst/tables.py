"""The text files of a run as data frames.

A flight that was killed leaves half a line at the end of a file. That line is left out, and `problems` says
so. Any other damage is an Error with the file, the line and the reason.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .errors import Error
from .needed import needed

if TYPE_CHECKING:
    import pandas as pd

TEXT_COLUMNS = {"phase", "believed", "problem", "file"}
WHOLE_COLUMNS = {"free_directions", "edges", "planes", "width", "height"}
POSE_COLUMNS = ["time_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"]

# The files name most units, but not all. What a name here does not have keeps its name.
_COLUMN_NAMES = {
    "t_s": "time_s", "stamp_s": "time_s", "x": "x_m", "y": "y_m", "z": "z_m",
    "vx": "vx_mps", "vy": "vy_mps", "vz": "vz_mps",
    "ref_x": "ref_x_m", "ref_y": "ref_y_m", "ref_z": "ref_z_m", "battery": "battery_fraction",
    "width": "width_px", "height": "height_px", "fx": "fx_px", "fy": "fy_px", "cx": "cx_px", "cy": "cy_px",
}
_EVENT_NAMES = {
    "t": "time_s", "position": "position_m", "heading": "heading_rad", "length": "length_m", "from": "from_m",
    "to": "to_m", "points": "points_m", "deviation": "deviation_m", "correction": "correction_s",
    "distance": "distance_m", "ground": "ground_m", "hover": "hover_m", "base": "base_m", "reach": "reach_m",
    "positions": "positions_m", "x": "x_m", "y": "y_m", "z": "z_m",
}


def read_bytes(file: Path) -> bytes:
    """The file's bytes. Raises Error if it is missing or cannot be read."""
    try:
        return file.read_bytes()
    except FileNotFoundError:
        raise Error.at(file, "", "is not there: the flight has not written it, or it was not kept") from None
    except OSError as e:
        raise Error.at(file, "", f"cannot be read: {e.strerror}") from e


def read_text(file: Path) -> str:
    """The file's text. Raises Error as read_bytes does, and if it is not UTF-8."""
    try:
        return read_bytes(file).decode("utf-8")
    except UnicodeDecodeError as e:
        raise Error.at(file, f"byte {e.start}", "is no text in UTF-8") from e


def read_json(file: Path) -> dict:
    """The JSON object in the file. Raises Error with the line of damage."""
    try:
        value = json.loads(read_text(file))
    except json.JSONDecodeError as e:
        raise Error.at(file, f"line {e.lineno}, column {e.colno}", f"is damaged: {e.msg}") from e
    if not isinstance(value, dict):
        raise Error.at(file, "line 1", "is no JSON object")
    return value


def read_table(file: Path, problems: list[str]) -> pd.DataFrame:
    """A CSV file of a run. Columns are named with units; an unknown number is NaN, and an empty text ""."""
    pandas = needed("pandas", "reading a run's tables")
    lines = csv.reader(_whole_lines(file, problems))
    names = next(lines, None)
    if names is None:
        raise Error.at(file, "line 1", "has no line with the names of its columns")
    rows, numbers = [], []
    for row in lines:
        if len(row) != len(names):
            raise Error.at(file, f"line {lines.line_num}", f"has {len(row)} cells instead of {len(names)}")
        rows.append(row)
        numbers.append(lines.line_num)
    columns = {}
    for i, name in enumerate(names):
        cells = [row[i] for row in rows]
        values = cells if name in TEXT_COLUMNS else _floats(cells, name, numbers, file)
        if name == "accepted":
            values = values == 1
        elif name in WHOLE_COLUMNS and np.isfinite(values).all():
            values = values.astype(int)
        columns[_COLUMN_NAMES.get(name, name)] = values
    return pandas.DataFrame(columns)


def read_poses(file: Path, problems: list[str]) -> pd.DataFrame:
    """A file in TUM format: columns time_s, x_m, y_m, z_m, qx, qy, qz, qw; the body's pose in the world."""
    pandas = needed("pandas", "reading a run's poses")
    lines = _whole_lines(file, problems)
    used = [line for line in lines if line.strip() and not line.startswith("#")]
    try:
        poses = np.loadtxt(used, ndmin=2) if used else np.empty((0, 8))
    except ValueError:
        poses = None
    if poses is None or poses.shape[1] != 8:
        raise _bad_pose(lines, file)
    return pandas.DataFrame(poses, columns=POSE_COLUMNS)


def read_events(file: Path, problems: list[str], time: str = "t", kind: str = "kind") -> pd.DataFrame:
    """A file with a JSON object a line: time_s and `kind`, then the other fields in alphabetical order.

    A field that an event does not have is NaN. Positions are arrays (3), paths and drawings arrays (n, 3), in
    metres. `time` and `kind` are the fields' names in the file.
    """
    pandas = needed("pandas", "reading a run's events")
    events = []
    lines = _whole_lines(file, problems)
    for number, line in enumerate(lines, 1):
        try:
            event = json.loads(line)
            known = isinstance(event, dict) and isinstance(event.get(kind), str)
            good = known and isinstance(event.get(time), (int, float))
            reason = "" if good else f"is no JSON object with a number {time} and a text {kind}"
        except ValueError as e:  # also what json says of a number without end
            reason = f"is damaged: {e}"
        if not reason:
            events.append({_EVENT_NAMES.get(k, k): _as_array(k, v) for k, v in event.items()})
        elif number == len(lines):  # the power went off: the line's end was written, not all of the line
            problems.append(f"{file}: line {number}: {reason}; left out, as the last line")
        else:
            raise Error.at(file, f"line {number}", reason)
    others = sorted({k for e in events for k in e} - {"time_s", kind})
    return pandas.DataFrame.from_records(events, columns=["time_s", kind, *others])


def _as_array(name: str, value):
    """Points as arrays; a list with unknown numbers becomes NaN there."""
    if _EVENT_NAMES.get(name, "").endswith("_m") and isinstance(value, list):
        try:
            return np.array(value, dtype=float)
        except (TypeError, ValueError):
            return value
    return value


def _whole_lines(file: Path, problems: list[str]) -> list[str]:
    """Lines without their ends. Left out and reported: half a line at the end; lines with zeros, as a power cut
    leaves them where data did not reach the disk."""
    lines = read_text(file).split("\n")
    if lines[-1]:
        problems.append(f"{file}: line {len(lines)}: is cut off; left out")
    lines = lines[:-1]
    lost = [number for number, line in enumerate(lines, 1) if "\0" in line]
    if lost:
        problems.append(f"{file}: line {lost[0]}: holds zeros, as do {len(lost) - 1} others; left out")
    return [line for line in lines if "\0" not in line]


def _floats(cells: list[str], name: str, numbers: list[int], file: Path) -> np.ndarray:
    try:
        return np.array([float(c) if c else np.nan for c in cells])
    except ValueError:
        for cell, number in zip(cells, numbers):
            if not _is_number(cell):
                place = f"line {number}, column {name}"
                raise Error.at(file, place, f'expected a number, got "{cell}"') from None
        raise


def _is_number(cell: str) -> bool:
    try:
        float(cell or "nan")
    except ValueError:
        return False
    return True


def _bad_pose(lines: list[str], file: Path) -> Error:
    for number, line in enumerate(lines, 1):
        words = line.split()
        if words and not line.startswith("#") and not (len(words) == 8 and all(map(_is_number, words))):
            return Error.at(file, f"line {number}", "expected the eight numbers t x y z qx qy qz qw")
    return Error.at(file, "", "is no file of poses")
