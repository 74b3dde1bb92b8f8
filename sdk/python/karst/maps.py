"""The final map of a flight, and how it grew."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .errors import Error
from .needed import needed
from .tables import read_bytes

if TYPE_CHECKING:
    import pandas as pd

_FARTHEST_CELL = 1 << 24  # a cell beyond is thousands of kilometres away: the record is damaged


@dataclass(frozen=True, eq=False, repr=False)
class Map:
    """Known cells, as cubes that hold one or more cells of one value. World frame: x east, y north, z up."""

    centres_m: np.ndarray  # (n, 3) float64
    sizes_m: np.ndarray  # (n) float64: edge length of the cube
    log_odds: np.ndarray  # (n) float32: of being occupied; of a .bt file only its sign counts
    resolution_m: float  # edge length of a cell

    def __repr__(self) -> str:
        return f"Map({len(self.sizes_m)} cubes, resolution_m={self.resolution_m})"

    @property
    def occupied(self) -> np.ndarray:
        """(n) bool: rock. The other cubes are free; what is unknown has no cube."""
        return self.log_odds >= 0

    @property
    def free_volume_m3(self) -> float:
        """Known-free volume: explored_volume_m3 of metrics.json."""
        return float((self.sizes_m[~self.occupied] ** 3).sum())

    def cells(self, occupied: bool = True) -> np.ndarray:
        """(k, 3) float64: centres in metres of single cells, all of one size, occupied or free ones."""
        chosen = self.occupied if occupied else ~self.occupied
        centres, edges = self.centres_m[chosen], np.rint(self.sizes_m[chosen] / self.resolution_m).astype(int)
        parts = [np.empty((0, 3))]
        for edge in np.unique(edges):
            steps = (np.indices((edge, edge, edge)).reshape(3, -1).T - (edge - 1) / 2) * self.resolution_m
            parts.append((centres[edges == edge][:, None, :] + steps).reshape(-1, 3))
        return np.concatenate(parts)


def read_map(file: str | PathLike[str]) -> Map:
    """Reads an OctoMap file, .ot (log-odds) or .bt (free or occupied). Raises Error with the reason."""
    try:
        from . import _maps
    except ImportError as e:
        raise Error(f"reading OctoMap files needs the module karst._maps, which was not built: {e}") from e
    try:
        return Map(*_maps.read(fspath(file)))
    except _maps.InputError as e:
        raise Error(str(e)) from e


def read_growth(file: Path, resolution_m: float, problems: list[str]) -> pd.DataFrame:
    """map_growth.bin: a row for each time that a cell was occupied, in order of from_s.

    Columns: x_m, y_m, z_m (the cell's centre), from_s, until_s (inf: to the end). Half a record at the end is
    left out, and `problems` says so.
    """
    pandas = needed("pandas", "reading the growth of a map")
    data = read_bytes(file)
    whole = len(data) // 16
    if len(data) % 16:
        problems.append(f"{file}: byte {16 * whole}: a record is cut off; left out")
    records = np.frombuffer(data, dtype="<i4", count=4 * whole).reshape(-1, 4)
    written = records.any(axis=1)  # no cell changes at 0 ms: a power cut left zeros
    if not written.all():
        problems.append(f"{file}: {int((~written).sum())} records were never written; left out")
    far = np.abs(records[:, :3].astype(np.int64)).max(axis=1, initial=0) >= _FARTHEST_CELL
    if far.any():
        raise Error.at(file, f"byte {16 * int(far.argmax())}", "is damaged: a cell out of this world")
    records = records[written]
    whole = len(records)
    # The file is in order of time. A stable sort by cell keeps each cell's changes in that order.
    records = records[np.lexsort((records[:, 2], records[:, 1], records[:, 0]))]
    cell, appears = records[:, :3], records[:, 3] >= 0
    same_cell = np.zeros(whole, bool)
    same_cell[1:] = (cell[1:] == cell[:-1]).all(axis=1)
    before = np.zeros(whole, bool)  # occupied before this record
    before[1:] = appears[:-1] & same_cell[1:]
    changes = records[appears != before]  # a repeated state says nothing new
    begins = np.flatnonzero(changes[:, 3] >= 0)
    until_ms = np.full(len(begins), np.inf)
    after = np.minimum(begins + 1, len(changes) - 1)
    ends = changes[after, 3] < 0  # changes of a cell alternate: the end, if any, follows its beginning
    until_ms[ends] = -changes[after[ends], 3]
    centres = (changes[begins, :3] + 0.5) * resolution_m
    table = pandas.DataFrame(
        {"x_m": centres[:, 0], "y_m": centres[:, 1], "z_m": centres[:, 2],
         "from_s": changes[begins, 3] / 1000.0, "until_s": until_ms / 1000.0}
    )
    return table.sort_values("from_s", kind="stable", ignore_index=True)
