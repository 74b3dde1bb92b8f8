#!/usr/bin/env python3
"""Expected and true volume behind frontiers, from logs of the policy known_cave.

    expected_and_true.py LOG.csv ...

For both ways to count: Spearman's rank correlation with the truth within a decision, averaged over the frontiers of
all decisions with at least five; and the means of both by tenths of the frontiers, ordered by what was expected.
"""
import csv
import statistics
import sys


def ranks(values):
    order = sorted(range(len(values)), key=values.__getitem__)
    out = [0.0] * len(values)
    i = 0
    while i < len(order):
        j = i
        while j + 1 < len(order) and values[order[j + 1]] == values[order[i]]:
            j += 1
        for k in range(i, j + 1):
            out[order[k]] = (i + j) / 2
        i = j + 1
    return out


def spearman(a, b):
    a, b = ranks(a), ranks(b)
    return statistics.correlation(a, b) if len(set(a)) > 1 and len(set(b)) > 1 else None


def main():
    rows = []
    for file in sys.argv[1:]:
        with open(file, newline="") as log:
            rows += [(file, r["decision"], float(r["by_openings_m3"]), float(r["expected_m3"]), float(r["near_m3"]))
                     for r in csv.DictReader(log) if r["far_m3"]]
    print(f"{len(rows)} frontiers of {len({r[:2] for r in rows})} decisions in {len(sys.argv) - 1} flights")
    if len(rows) < 10:
        sys.exit("expected_and_true: needs logs with ten frontiers at least")
    for name, column in (("by openings", 2), ("expected", 3)):
        weights, sums = 0, 0.0
        for decision in {r[:2] for r in rows}:
            some = [r for r in rows if r[:2] == decision]
            if len(some) >= 5 and (rho := spearman([r[column] for r in some], [r[4] for r in some])) is not None:
                weights, sums = weights + len(some), sums + rho * len(some)
        rho = f"{sums / weights:.2f}" if weights else "unknown"
        print(f"\n{name}: rank correlation within a decision {rho}\n  expected m^3, true m^3, frontiers")
        rows.sort(key=lambda r: r[column])
        for tenth in range(10):
            some = rows[len(rows) * tenth // 10:len(rows) * (tenth + 1) // 10]
            print(f"  {statistics.fmean(r[column] for r in some):8.1f} {statistics.fmean(r[4] for r in some):8.1f} "
                  f"{len(some):6}")


if __name__ == "__main__":
    main()
