#!/usr/bin/env python3
"""What is motion with a receding horizon worth, compared with sampled trajectories?

    python3 tests/benchmark/trajectory_campaign.py fly   FOLDER --caves cave.info ...  # started again, it goes on
    python3 tests/benchmark/trajectory_campaign.py table FOLDER

Every policy flies through every cave with every seed with both kinds of trajectory, in the profile `campaign`. All
flights of a seed come before those of the next one, so that it can stop early. A difference counts once a cave.
"""
import math
import random
import statistics
from pathlib import Path

import profile_agreement
import selection_campaign as campaign

KINDS = ["sampled", "horizon"]
METRICS = ["coverage_auc", "coverage", "exploring_speed_mps", "restricted_t50_s", "restricted_t90_s", "path_length_m",
           "min_clearance_m"]


def fly(args):
    for seeds in range(1, args.seeds + 1):
        for kind in KINDS:
            file = args.folder / f"{kind}.info"
            file.write_text("\n".join([
                f"name {kind}", "profile campaign", f'flight_time "{args.battery}"', f"seeds {seeds}",
                "metric coverage_auc", f"settings {{ motion {{ trajectory {kind} }}",
                f'  simulator {{ vehicle {args.vehicle}  battery_minutes "{args.battery}"  gust "{args.gust}" }} }}',
                *(f"contestant {{ policy {policy} }}" for policy in args.policies),
                *(f'cave {{ file "{Path(cave).resolve()}" }}' for cave in args.caves), ""]))
            print(f"{kind}: {len(args.policies)} policies, {len(args.caves)} caves, {seeds} seeds", flush=True)
            campaign.run(args, ["compare", str(file), "--out", str(args.folder / kind), "--keep", "figures", "--quiet",
                                "--jobs", str(args.jobs)], stdout=open(args.folder / f"{kind}.txt", "w"))


def sign_test(differences):
    """Two-sided p of as uneven a split between better and worse, if both were as likely."""
    signs = [d > 0 for d in differences if d != 0]
    few = min(sum(signs), len(signs) - sum(signs))
    return min(1.0, 2 * sum(math.comb(len(signs), k) for k in range(few + 1)) / 2 ** len(signs))


def table(args):
    flown = {kind: profile_agreement.rows_of(args, kind) for kind in KINDS}
    both = sorted(set(flown["sampled"]) & set(flown["horizon"]))
    caves, policies = sorted({k[1] for k in both}), sorted({k[0] for k in both})
    print(f"{len(both)} pairs of flights: {len(policies)} policies, {len(caves)} caves, "
          f"seeds {sorted({k[2] for k in both})}")
    for kind in KINDS:
        rows = flown[kind].values()
        ends = {}
        for row in rows:
            ends[row["outcome"]] = ends.get(row["outcome"], 0) + 1
        print(f"  {kind}: {len(rows)} flights, ends: {ends}, contacts: {sum(int(r['contacts'] or 0) for r in rows)}, "
              f"least clearance {min(float(r['min_clearance_m']) for r in rows):.2f} m")

    def values(kind, metric, keys):
        return [float(flown[kind][k][metric]) for k in keys if all(flown[t][k][metric] for t in KINDS)]

    draw = random.Random(1)
    print(f"\n{'metric':22}{'sampled':>9}{'horizon':>9}   ratio (95 % over caves), caves with more, p of the sign test")
    for metric in METRICS:
        mean = {kind: statistics.fmean(values(kind, metric, both)) for kind in KINDS}
        by_cave = {}
        for cave in caves:
            keys = [k for k in both if k[1] == cave]
            if a := values("sampled", metric, keys):
                by_cave[cave] = (statistics.fmean(a), statistics.fmean(values("horizon", metric, keys)))
        ratios = []
        for _ in range(2000):
            some = draw.choices(list(by_cave.values()), k=len(by_cave))
            ratios.append(sum(h for _, h in some) / sum(s for s, _ in some))
        ratios.sort()
        differences = [h - s for s, h in by_cave.values()]
        print(f"{metric:22}{mean['sampled']:9.3f}{mean['horizon']:9.3f}   {mean['horizon'] / mean['sampled']:.3f} "
              f"({ratios[50]:.3f} to {ratios[1949]:.3f}), {sum(d > 0 for d in differences)} of {len(differences)}, "
              f"p {sign_test(differences):.3f}")
    for which, name, values_of in ((0, "policy", policies), (1, "cave", caves)):
        print(f"\n{name:22}{'sampled':>9}{'horizon':>9}   mean coverage_auc")
        for value in values_of:
            keys = [k for k in both if k[which] == value]
            s, h = (statistics.fmean(values(kind, "coverage_auc", keys)) for kind in KINDS)
            print(f"{value:22}{s:9.3f}{h:9.3f}   {h / s:.3f}")


if __name__ == "__main__":
    parser = profile_agreement.arguments(__doc__, seeds=1)
    parser.add_argument("--vehicle", default="lidar_uav")
    parser.add_argument("--gust", default="0.5 m/s")
    profile_agreement.main(parser, fly, table)
