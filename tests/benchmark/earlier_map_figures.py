"""earlier_map_figures.py RUNS SEED...: of earlier_map_campaign.sh, second flights with and without the earlier map, paired by cave and seed, by the rock surface
that the first flight had not seen (map_growth.bin), more than a cell beyond its rock."""
import json, math, os, statistics, struct, sys
R = sys.argv[1] + "/"
CELL = 0.2; AREA = CELL ** 2; HORIZON = 120
def events(run, kind):
    return [e for e in map(json.loads, open(run + "/events.jsonl")) if e["kind"] == kind]
def records(run):
    data = open(run + "/map_growth.bin", "rb").read()
    return struct.iter_unpack("<4i", data[:len(data) // 16 * 16])
def rock(run):
    cells = set()
    for x, y, z, t in records(run): (cells.add if t > 0 else cells.discard)((x, y, z))
    return cells
def series(run, old, T):
    """Each second from take-off: m2 of rock beyond `old`."""
    a, dx, dy, dz = T
    c, s = math.cos(a), math.sin(a)
    t0 = next(e["t"] for e in events(run, "phase") if e["phase"] == "takeoff")
    def new(x, y, z):
        x, y, z = (x + .5) * CELL - dx, (y + .5) * CELL - dy, (z + .5) * CELL - dz
        return (math.floor((c * x + s * y) / CELL), math.floor((-s * x + c * y) / CELL), math.floor(z / CELL)) not in old
    known, count, out = {}, 0, []
    for x, y, z, t in records(run):
        while len(out) <= abs(t) / 1000 - t0: out.append(count * AREA)
        k = (x, y, z)
        if k not in known: known[k] = new(x, y, z)
        if known[k]: count += 1 if t > 0 else -1
    while len(out) <= HORIZON: out.append(count * AREA)
    return out
def first_time(curve, m2):
    return next((float(i) for i, v in enumerate(curve[:HORIZON + 1]) if v >= m2), None)
def t_interval(xs):
    q = {2: 12.71, 3: 4.303, 4: 3.182, 5: 2.776, 6: 2.571, 7: 2.447, 8: 2.365, 9: 2.306, 10: 2.262}[len(xs)]
    m, h = statistics.mean(xs), q * statistics.stdev(xs) / math.sqrt(len(xs))
    return "%.1f [%.1f, %.1f]" % (m, m - h, m + h)
rows = []
for cave in range(101, 111):
    T = tuple(map(float, open(R + f"turned{cave}.truth").read().split()))
    start = tuple(map(float, open(R + f"turned{cave}.info").read().split('start "')[1].split()[:3]))
    old = None
    for seed in sys.argv[2:]:
        runs = {arm: R + f"{arm}_{cave}_{seed}" for arm in ("with", "without")}
        if os.path.exists(runs["with"] + "/metrics.json"):
            for x in events(runs["with"], "earlier_map"):
                if x["state"] != "found": print(cave, seed, x["state"], x["reason"]); continue
                p = [start[i] - T[1 + i] for i in range(3)]
                p = (math.cos(T[0]) * p[0] + math.sin(T[0]) * p[1], -math.sin(T[0]) * p[0] + math.cos(T[0]) * p[1], p[2])
                h, q = x["heading"], x["position"]
                there = (math.cos(h) * p[0] - math.sin(h) * p[1] + q[0], math.sin(h) * p[0] + math.cos(h) * p[1] + q[1], p[2] + q[2])
                turn = abs((h - T[0] + math.pi) % (2 * math.pi) - math.pi)
                print("located %d %s attempt %d at %.1f s: %.3f m (%.3f level), %.2f deg, overlap %.3f agreement %.4f residual %.3f rival %.2f; job %.1f s" % (cave, seed, x["attempt"], x["t"], math.dist(there, start), math.dist(there[:2], start[:2]), math.degrees(turn), x["overlap"], x["agreement"], x["residual"], x["rival"], json.load(open(runs["with"] + "/timing.json"))["jobs"]["earlier map"]["total_s"] if "jobs" in json.load(open(runs["with"] + "/timing.json")) else -1))
        if not all(os.path.exists(r + "/metrics.json") for r in runs.values()): continue
        if old is None:
            first = rock(R + f"first_{cave}")
            old = {(x + i, y + j, z + k) for x, y, z in first for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)}
        m = {arm: json.load(open(r + "/metrics.json")) for arm, r in runs.items()}
        rows.append({"cave": cave, "seed": seed, "first": len(first) * AREA, "m": m, "curves": {arm: series(r, old, T) for arm, r in runs.items()}})
for r in rows:
    w, o, m = r["curves"]["with"], r["curves"]["without"], r["m"]
    print("| %d | %s | %.0f | %s | %s | %.0f | %.1f / %.1f | %.2f / %.2f |" % (r["cave"], r["seed"], r["first"], " ".join("%.0f" % w[t] for t in (30, 60, 90, 120)), " ".join("%.0f" % o[t] for t in (30, 60, 90, 120)), m["with"]["added_volume_m3"] or -1, 100 * m["with"]["coverage"], 100 * m["without"]["coverage"], m["with"]["min_clearance_m"], m["without"]["min_clearance_m"]),
          "contacts", m["with"]["contacts"], m["without"]["contacts"], m["with"]["outcome"], m["without"]["outcome"])
caves = sorted({r["cave"] for r in rows})
for target in (50, 100, 250, 500):
    diffs, a_all, b_all, na, nb = [], [], [], 0, 0
    for cave in caves:
        d = []
        for r in (r for r in rows if r["cave"] == cave):
            a, b = (first_time(r["curves"][arm], target) for arm in ("with", "without"))
            na += a is not None; nb += b is not None
            a, b = (HORIZON if x is None else x for x in (a, b))
            d.append(b - a); a_all.append(a); b_all.append(b)
        diffs.append(statistics.mean(d))
    if len(diffs) > 1: print("| %d m2 | %d of %d | %d | %.1f | %.1f | %s |" % (target, na, len(a_all), nb, statistics.mean(a_all), statistics.mean(b_all), t_interval(diffs)))
for t in (30, 60, 90, 120):
    d = [statistics.mean([r["curves"]["with"][t] - r["curves"]["without"][t] for r in rows if r["cave"] == c]) for c in caves]
    if len(d) > 1: print("new m2 after %d s: %.0f with, %.0f without, difference %s" % (t, statistics.mean(r["curves"]["with"][t] for r in rows), statistics.mean(r["curves"]["without"][t] for r in rows), t_interval(d)))
