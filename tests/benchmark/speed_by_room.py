#!/usr/bin/env python3
"""How fast does a vehicle explore, by the room around it?

    python3 tests/benchmark/speed_by_room.py RUN ...

For each run and for all of them: the mean speed while exploring, by the width of the passage. The width is twice the
true distance from the vehicle's centre to the nearest rock: a passage is at least as wide. Runs need truth.csv and
telemetry.csv, as `karst fly` writes them.
"""
import csv
import sys
from pathlib import Path

WIDTHS_M = [0, 1.5, 2, 3, 4, 6, float("inf")]


def exploring(run):
    """Begin and end of exploring, in seconds."""
    with open(run / "telemetry.csv", newline="") as file:
        times = [float(row["t_s"]) for row in csv.DictReader(file) if row["phase"] == "explore"]
    if not times:
        sys.exit(f"{run / 'telemetry.csv'}: no row of phase explore")
    return times[0], times[-1]


def samples(run, radius_m):
    """Width of the passage in m and speed in m/s, at each row of truth.csv while exploring."""
    begin_s, end_s = exploring(run)
    with open(run / "truth.csv", newline="") as file:
        return [(2 * (float(row["clearance_m"]) + radius_m), float(row["speed_mps"])) for row in csv.DictReader(file)
                if begin_s <= float(row["time_s"]) <= end_s]


def line(name, rows):
    cells = []
    for low_m, high_m in zip(WIDTHS_M, WIDTHS_M[1:]):
        speeds = [speed for width, speed in rows if low_m <= width < high_m]
        cells.append(f"{sum(speeds) / len(speeds):5.2f} ({100 * len(speeds) / len(rows):2.0f} %)" if speeds else " " * 12)
    return f"{name:40}" + " ".join(f"{cell:>13}" for cell in cells)


def main():
    radius_m = 0.3  # of the hull of the vehicles that come with karst
    runs = [Path(argument) for argument in sys.argv[1:]]
    if not runs:
        sys.exit(__doc__)
    heads = [f"{low:g} to {high:g} m" if high < 1e9 else f"{low:g} m and more"
             for low, high in zip(WIDTHS_M, WIDTHS_M[1:])]
    print(f"{'mean m/s (share of the time), by width':40}" + " ".join(f"{head:>13}" for head in heads))
    every = []
    for run in runs:
        rows = samples(run, radius_m)
        every += rows
        print(line("/".join(run.parts[-2:])[-40:], rows))
    if len(runs) > 1:
        print(line(f"all {len(runs)}", every))


if __name__ == "__main__":
    main()
