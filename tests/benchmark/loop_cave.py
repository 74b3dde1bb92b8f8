#!/usr/bin/env python3
"""A cave of 3 km with two loops of 600 m, as a survey (Survex), and the path along it.

    loop_cave.py FOLDER              writes loops.svx and path.txt
    karst cave from-survey FOLDER/loops.svx --out FOLDER/loops --roughness 0.25
    loop_cave.py FOLDER --in-cave    writes path_in_cave.txt: the path in the frame of the cave, by its stations
    loop_recording FOLDER/loops.info FOLDER/path_in_cave.txt OUT xt32 512
"""
import csv
import math
import random
import sys

random.seed(3)


def passage(start, heading, length, turn_deg, steep):
    """Legs of 10 m that wander by `turn_deg` in all, with noise; returns the points after the start."""
    out, p, n = [], list(start), round(length / 10)
    for i in range(n):
        heading += turn_deg / n
        wander = 14 * math.sin(0.9 * i + 1.3) + random.uniform(-6, 6)
        a = math.radians(heading + wander)
        p = [p[0] + 10 * math.sin(a), p[1] + 10 * math.cos(a), p[2] + 10 * steep * math.sin(0.35 * i)]
        out.append(tuple(p))
    return out, heading


def closed(points, start):
    """Spreads the gap between the end and `start` over the points, so that the loop closes."""
    end, n = points[-1], len(points)
    return [tuple(p[k] + (i + 1) / n * (start[k] - end[k]) for k in range(3)) for i, p in enumerate(points)]


def put_in_cave(folder):
    first = next(r for r in csv.DictReader(open(folder + '/loops.stations.csv')) if r['name'] == 'loops.0')
    path = [tuple(map(float, line.split())) for line in open(folder + '/path.txt')]
    moved = [float(first[k]) - path[0][i] for i, k in enumerate('xyz')]
    with open(folder + '/path_in_cave.txt', 'w') as out:
        for p in path:
            out.write('%.3f %.3f %.3f\n' % tuple(p[i] + moved[i] for i in range(3)))


def main():
    folder = sys.argv[1]
    if '--in-cave' in sys.argv:
        return put_in_cave(folder)
    heading, at = 40.0, 0
    stations, legs, route = [(0.0, 0.0, 0.0)], [], [0]  # legs and route: indices of stations

    def go(points, end=None):
        nonlocal at
        for k, p in enumerate(points):
            if end is not None and k == len(points) - 1:
                legs.append((at, end))
                at = end
            else:
                stations.append(p)
                legs.append((at, len(stations) - 1))
                at = len(stations) - 1
            route.append(at)

    for trunk, turn, loop_turn in ((700, 60, 360), (600, -50, -360)):
        points, heading = passage(stations[at], heading, trunk, turn, 0.15)
        go(points)
        junction = at
        # The loop leaves to the side and comes back from the other one.
        side = heading - math.copysign(90, loop_turn)
        points, _ = passage(stations[junction], side + math.copysign(20, loop_turn), 600,
                            loop_turn - math.copysign(40, loop_turn), 0.1)
        go(closed(points, stations[junction]), junction)
    points, heading = passage(stations[at], heading, 500, 40, 0.15)
    go(points)

    with open(folder + '/loops.svx', 'w') as out:
        out.write('*begin loops\n*fix 0 0 0 0\n*data cartesian from to easting northing altitude\n')
        for a, b in legs:
            d = [stations[b][k] - stations[a][k] for k in range(3)]
            out.write(f'{a} {b} {d[0]:.3f} {d[1]:.3f} {d[2]:.3f}\n')
        out.write('*data passage station left right up down\n')
        for i in range(len(stations)):
            w, h = 1.6 + 0.9 * random.random(), 1.3 + 0.8 * random.random()
            out.write(f'{i} {w:.2f} {0.8 + w * random.random():.2f} {h + 0.8:.2f} {h:.2f}\n')
        out.write('*end loops\n')
    with open(folder + '/path.txt', 'w') as out:
        for i in route:
            out.write('%.3f %.3f %.3f\n' % stations[i])
    print(len(stations), 'stations', sum(math.dist(stations[a], stations[b]) for a, b in legs), 'm')


if __name__ == '__main__':
    main()
