#!/usr/bin/env python3
"""earlier_map_figures.py RUNS SEED...: the figures of docs/results/earlier_map.md, of the flights of
earlier_map_campaign.sh in RUNS.

Second flights with and without the earlier map are paired by cave and seed. New rock is rock of map_growth.bin that
lies more than a cell from all rock of the first flight's map. Known rock is all of a flight's own map; that of the
earlier map counts from when it is taken in. Times count from the take-off."""
import json
import math
import os
import statistics
import struct
import sys

CELL_M, AREA_M2, HORIZON_S = 0.2, 0.04, 120
ARMS = ('with', 'without')
STUDENT = {1: 12.71, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262}  # 97.5 %


def events(run, kind):
    return [e for e in map(json.loads, open(run + '/events.jsonl')) if e['kind'] == kind]


def changes(run):
    """Cells that become rock (time > 0) or no longer are (time < 0): x, y, z, ms."""
    data = open(run + '/map_growth.bin', 'rb').read()
    return struct.iter_unpack('<4i', data[:len(data) // 16 * 16])


def rock(run):
    cells = set()
    for x, y, z, t in changes(run):
        (cells.add if t > 0 else cells.discard)((x, y, z))
    return cells


def neighbourhood(cells):
    near = (-1, 0, 1)
    return {(x + i, y + j, z + k) for x, y, z in cells for i in near for j in near for k in near}


def curves(run, old, turn, moved):
    """New and known rock in m2, for each second from the take-off."""
    c, s = math.cos(turn), math.sin(turn)
    take_off_s = next(e['t'] for e in events(run, 'phase') if e['phase'] == 'takeoff')

    def is_new(cell):
        x, y, z = ((k + 0.5) * CELL_M - d for k, d in zip(cell, moved))
        return tuple(math.floor(v / CELL_M) for v in (c * x + s * y, -s * x + c * y, z)) not in old

    judged, new, known, out = {}, 0, 0, []
    for x, y, z, t in changes(run):
        while len(out) <= abs(t) / 1000 - take_off_s:
            out.append((new * AREA_M2, known * AREA_M2))
        cell = (x, y, z)
        if cell not in judged:
            judged[cell] = is_new(cell)
        step = 1 if t > 0 else -1
        known += step
        new += step if judged[cell] else 0
    while len(out) <= HORIZON_S:
        out.append((new * AREA_M2, known * AREA_M2))
    return [n for n, _ in out[:HORIZON_S + 1]], [k for _, k in out[:HORIZON_S + 1]]


def time_to(curve, m2):
    return next((float(t) for t, v in enumerate(curve) if v >= m2), None)


def interval(values):
    mean = statistics.mean(values)
    if len(values) < 2:
        return f'{mean:.1f}'
    half = STUDENT[len(values) - 1] * statistics.stdev(values) / math.sqrt(len(values))
    return f'{mean:.1f} ({mean - half:.1f} to {mean + half:.1f})'


def print_place(run, cave, seed, start, turn, moved):
    """How far the place that was found is off, by the truth of the turned cave."""
    for e in events(run, 'earlier_map'):
        if e['state'] != 'found':
            print(f"place {cave} {seed}: attempt {e['attempt']} at {e['t']:.1f} s {e['state']}: {e['reason']}")
            continue
        x, y, z = (a - b for a, b in zip(start, moved))
        x, y = math.cos(turn) * x + math.sin(turn) * y, -math.sin(turn) * x + math.cos(turn) * y
        c, s = math.cos(e['heading']), math.sin(e['heading'])
        found = [v + p for v, p in zip((c * x - s * y, s * x + c * y, z), e['position'])]
        off = abs((e['heading'] - turn + math.pi) % (2 * math.pi) - math.pi)
        print(f"place {cave} {seed}: attempt {e['attempt']} at {e['t']:.1f} s, off by {math.dist(found, start):.3f} m "
              f"({math.dist(found[:2], start[:2]):.3f} level) and {math.degrees(off):.2f} deg; overlap "
              f"{e['overlap']:.3f}, agreement {e['agreement']:.4f}, residual {e['residual']:.3f}, rival {e['rival']:.2f}")


def pairs(folder, seeds):
    for cave in range(101, 111):
        turn, *moved = map(float, open(f'{folder}/turned{cave}.truth').read().split())
        start = tuple(map(float, open(f'{folder}/turned{cave}.info').read().split('start "')[1].split()[:3]))
        first = rock(f'{folder}/first_{cave}')
        old = neighbourhood(first)
        for seed in seeds:
            runs = {arm: f'{folder}/{arm}_{cave}_{seed}' for arm in ARMS}
            if not all(os.path.exists(run + '/metrics.json') for run in runs.values()):
                continue
            print_place(runs['with'], cave, seed, start, turn, moved)
            yield {'cave': cave, 'seed': seed, 'first': len(first) * AREA_M2,
                   'metrics': {arm: json.load(open(run + '/metrics.json')) for arm, run in runs.items()},
                   'curves': {arm: curves(run, old, turn, moved) for arm, run in runs.items()}}


def print_saved(name, rows, caves, which, target):
    """Mean over caves of what is saved; a flight that does not reach a target counts as the horizon."""
    times = {arm: [time_to(r['curves'][arm][which], target(r)) for r in rows] for arm in ARMS}
    counted = {arm: [HORIZON_S if t is None else t for t in ts] for arm, ts in times.items()}
    saved = [statistics.mean(b - a for r, a, b in zip(rows, counted['with'], counted['without']) if r['cave'] == c)
             for c in caves]
    reached = ' and '.join(str(sum(t is not None for t in times[arm])) for arm in ARMS)
    print(f"| {name} | {reached} of {len(rows)} | {statistics.mean(counted['with']):.1f} s | "
          f"{statistics.mean(counted['without']):.1f} s | {interval(saved)} |")


def main():
    folder, seeds = sys.argv[1], sys.argv[2:]
    rows = list(pairs(folder, seeds))
    for r in rows:
        m = r['metrics']
        new = {arm: ', '.join(f"{r['curves'][arm][0][t]:.0f}" for t in (30, 60, 90, 120)) for arm in ARMS}
        print(f"| {r['cave']}, {r['seed']} | {r['first']:.0f} | {new['with']} | {new['without']} | "
              f"{100 * m['with']['coverage']:.1f} / {100 * m['without']['coverage']:.1f} | "
              f"{m['with']['min_clearance_m']:.2f} / {m['without']['min_clearance_m']:.2f} |"
              f" contacts {m['with']['contacts']} {m['without']['contacts']}, "
              f"{m['with']['outcome']} {m['without']['outcome']}")
    caves = sorted({r['cave'] for r in rows})
    for m2 in (50, 100, 250, 500):
        print_saved(f'{m2} m² of new rock', rows, caves, 0, lambda r, m2=m2: m2)
    for m2 in (0, 250, 500, 1000):
        print_saved(f"as much as the first flight and {m2} m²", rows, caves, 1, lambda r, m2=m2: r['first'] + m2)
    for t in (30, 60, 90, 120):
        both = {arm: [r['curves'][arm][0][t] for r in rows] for arm in ARMS}
        more = [statistics.mean(a - b for r, a, b in zip(rows, both['with'], both['without']) if r['cave'] == c)
                for c in caves]
        print(f"| new rock after {t} s | | {statistics.mean(both['with']):.0f} m² | "
              f"{statistics.mean(both['without']):.0f} m² | {interval(more)} |")


if __name__ == '__main__':
    main()
