#!/usr/bin/env python3
"""Compares the loop closures of replays with the truth: judge_loops.py TRUTH.tum REPLAY [--all]

A closure is false if the relative pose of its two submaps is off by more than 0.5 m or 3 degrees. Prints the false ones
(--all: every one), and a line with the counts of each state."""
import bisect
import csv
import math
import sys


def multiply(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def conjugate(q):
    return (-q[0], -q[1], -q[2], q[3])


def rotate(q, v):
    return multiply(multiply(q, (*v, 0.0)), conjugate(q))[:3]


class Track:
    def __init__(self, file):
        rows = sorted(tuple(map(float, line.split())) for line in open(file) if line.strip() and line[0] != '#')
        self.times, self.rows = [r[0] for r in rows], rows

    def at(self, t):
        i = min(max(bisect.bisect(self.times, t), 1), len(self.times) - 1)
        a, b = self.rows[i - 1], self.rows[i]
        part = min(max((t - a[0]) / (b[0] - a[0]), 0), 1)
        sign = 1 if sum(x * y for x, y in zip(a[4:], b[4:])) > 0 else -1
        q = [x + part * (sign * y - x) for x, y in zip(a[4:], b[4:])]
        norm = math.sqrt(sum(x * x for x in q))
        return [x + part * (y - x) for x, y in zip(a[1:4], b[1:4])], tuple(x / norm for x in q)


def main():
    truth, replay = Track(sys.argv[1]), sys.argv[2]
    show_all = '--all' in sys.argv
    counts, worst = {}, (0.0, 0.0)
    for row in csv.DictReader(open(replay + '/loops.csv')):
        p_a, q_a = truth.at(float(row['older_s']))
        p_b, q_b = truth.at(float(row['newer_s']))
        p = rotate(conjugate(q_a), [b - a for a, b in zip(p_a, p_b)])
        q = multiply(conjugate(q_a), q_b)
        off_m = math.dist(p, [float(row[k]) for k in ('x', 'y', 'z')])
        w = abs(multiply(conjugate(q), tuple(float(row[k]) for k in ('qx', 'qy', 'qz', 'qw')))[3])
        off_deg = math.degrees(2 * math.acos(min(1, w)))
        false = off_m > 0.5 or off_deg > 3
        key = row['state'] + (' false' if false else ' true')
        counts[key] = counts.get(key, 0) + 1
        if row['state'] == 'closed':
            worst = max(worst[0], off_m), max(worst[1], off_deg)
        if false or show_all:
            print(f"{replay} {row['older_s']} {row['newer_s']} {row['state']}: off by {off_m:.3f} m, {off_deg:.2f} deg; "
                  f"{math.dist(p_a, p_b):.1f} m apart, overlap {row['overlap']}, residual {row['residual_m']}, "
                  f"correction {row['correction_m']}")
    print(f"{replay} {counts} worst closed {worst[0]:.3f} m {worst[1]:.2f} deg")


if __name__ == '__main__':
    main()
