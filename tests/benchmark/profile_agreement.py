#!/usr/bin/env python3
"""Do policies rank in the profile `campaign` as they do in `full`, and how much faster is it?

    python3 tests/benchmark/profile_agreement.py fly   FOLDER --caves cave.info ...  # started again, it goes on
    python3 tests/benchmark/profile_agreement.py table FOLDER

Every policy flies through every cave with every seed in both profiles, with the same program, one profile after the
other, on every core. All flights of a seed come before those of the next one, so that it can stop early.
"""
import argparse
import csv
import itertools
import math
import random
import statistics
import subprocess
import sys
from pathlib import Path

import selection_campaign as campaign

PROFILES = ["campaign", "full"]
METRIC = "coverage_auc"


def fly(args):
    for seeds in range(1, args.seeds + 1):
        for profile in PROFILES:
            out = args.folder / profile
            text = "\n".join([
                f"name {profile}", f"profile {profile}", f'flight_time "{args.battery}"', 'trial_timeout "2 h"',
                f"seeds {seeds}", f"metric {METRIC}",
                f'settings {{ simulator {{ vehicle lidar_uav  battery_minutes "{args.battery}" }} }}',
                *(f"contestant {{ policy {policy} }}" for policy in args.policies),
                *(f'cave {{ file "{Path(cave).resolve()}" }}' for cave in args.caves), ""])
            file = args.folder / f"{profile}.info"
            file.write_text(text)
            print(f"{profile}: {len(args.policies)} policies, {len(args.caves)} caves, {seeds} seeds", flush=True)
            campaign.run(args, ["compare", str(file), "--out", str(out), "--keep", "figures", "--quiet",
                                "--jobs", str(args.jobs)],
                         stdout=open(args.folder / f"{profile}.txt", "w"))


def rows_of(args, profile):
    table = args.folder / f"{profile}.csv"
    campaign.run(args, ["results", str(args.folder / profile), "--csv", str(table)], stdout=subprocess.DEVNULL)
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    flown = {(row["contestant"], row["cave"], int(row["seed"])): row for row in rows if row["status"] == "done"}
    if len(flown) < len(rows):
        print(f"{profile}: {len(rows) - len(flown)} failed trials, left out in both profiles")
    return flown


def ranks(values):
    """Places from 1 on, the mean place for equal values."""
    order = sorted(values)
    return [statistics.fmean(i + 1 for i, o in enumerate(order) if o == v) for v in values]


def spearman(a, b):
    if len(set(a)) < 2 or len(set(b)) < 2:
        return math.nan
    return statistics.correlation(ranks(a), ranks(b))


def kendall(a, b):
    pairs = list(itertools.combinations(range(len(a)), 2))
    sign = [math.copysign(1, x) if x else 0 for i, j in pairs for x in [(a[i] - a[j]) * (b[i] - b[j])]]
    return sum(sign) / len(pairs)


def table(args):
    flown = {profile: rows_of(args, profile) for profile in PROFILES}
    both = sorted(set.intersection(*(set(rows) for rows in flown.values())))
    policies = sorted({p for p, _, _ in both})
    caves = sorted({c for _, c, _ in both})
    seeds = sorted({s for _, _, s in both})
    if len(caves) < 2:
        sys.exit("fewer than two caves: no errors over caves")
    whole = [s for s in seeds if all((p, c, s) in both for p in policies for c in caves)]
    if not whole:
        sys.exit("no seed is flown by all policies in all caves in both profiles yet")
    value = {profile: {key: float(rows[key][METRIC]) for key in both} for profile, rows in flown.items()}
    print(f"{len(policies)} policies, {len(caves)} caves, seeds {', '.join(map(str, whole))}: "
          f"{len(policies) * len(caves) * len(whole)} flights in each profile")
    for profile, rows in flown.items():
        mine = [rows[key] for key in both if key[2] in whole]
        seconds = sum(float(row["simulated_s"]) for row in mine)
        wall = sum(float(row["trial_s"]) for row in mine) / args.jobs
        ends = {}
        for row in mine:
            ends[row["outcome"]] = ends.get(row["outcome"], 0) + 1
        print(f"  {profile}: {seconds:.0f} s of flight in {wall:.0f} s on {args.jobs} cores, {seconds / wall:.1f} a second; "
              f"ends: {ends}; contacts: {sum(int(row['contacts'] or 0) for row in mine)}")

    def means(profile, seeds_of, in_caves):
        return [statistics.fmean(value[profile][p, c, s] for c in in_caves for s in seeds_of) for p in policies]

    print(f"\n{'policy':20} {'campaign':>9} {'full':>9}   mean {METRIC}, and place")
    mean = {profile: means(profile, whole, caves) for profile in PROFILES}
    place = {profile: ranks([-v for v in mean[profile]]) for profile in PROFILES}
    for i, policy in sorted(enumerate(policies), key=lambda ip: -mean["full"][ip[0]]):
        print(f"{policy:20} {mean['campaign'][i]:9.3f} {mean['full'][i]:9.3f}   "
              f"{place['campaign'][i]:.0f} {place['full'][i]:.0f}")
    print(f"over all caves: Spearman {spearman(mean['campaign'], mean['full']):.2f}, "
          f"Kendall {kendall(mean['campaign'], mean['full']):.2f}")
    draw = random.Random(1)
    drawn = []
    for _ in range(2000):
        some = draw.choices(caves, k=len(caves))
        drawn.append(spearman(means("campaign", whole, some), means("full", whole, some)))
    drawn = sorted(x for x in drawn if not math.isnan(x))
    print(f"  Spearman, 95 % over caves drawn with replacement: "
          f"{drawn[len(drawn) // 40]:.2f} to {drawn[len(drawn) * 39 // 40]:.2f}")
    print("by cave, Spearman between the profiles, and between two seeds within a profile:")
    for cave in caves:
        line = f"  {cave:16} {spearman(means('campaign', whole, [cave]), means('full', whole, [cave])):6.2f}"
        if len(whole) > 1:
            for profile in PROFILES:
                line += f"  {profile} {spearman(means(profile, whole[:1], [cave]), means(profile, whole[1:2], [cave])):6.2f}"
        print(line)

    # Pairs of policies: the mean difference over caves, as far as it goes beyond chance.
    shown = {profile: {} for profile in PROFILES}
    for profile in PROFILES:
        for a, b in itertools.combinations(policies, 2):
            by_cave = [statistics.fmean(value[profile][a, c, s] - value[profile][b, c, s] for s in whole) for c in caves]
            mean_d = statistics.fmean(by_cave)
            error = statistics.stdev(by_cave) / math.sqrt(len(by_cave))
            shown[profile][a, b] = (mean_d, abs(mean_d) > 2 * error)
    pairs = list(shown["full"])
    same_sign = sum(shown["full"][p][0] * shown["campaign"][p][0] > 0 for p in pairs)
    clear = [p for p in pairs if shown["campaign"][p][1]]
    kept = sum(shown["full"][p][0] * shown["campaign"][p][0] > 0 for p in clear)
    against = [p for p in clear if shown["full"][p][1] and shown["full"][p][0] * shown["campaign"][p][0] < 0]
    print(f"\npairs of policies: {same_sign} of {len(pairs)} with the same leader; of {len(clear)} that `campaign` tells "
          f"apart by two standard errors over caves, {kept}; told apart the other way round in `full`: {len(against)}")
    mean_shift = statistics.fmean(value["full"][k] - value["campaign"][k] for k in both if k[2] in whole)
    print(f"coverage averaged over the flight, full less campaign: {100 * mean_shift:+.2f} points")


def arguments(doc, seeds):
    """Those of a script that flies campaigns in a folder, and makes a table of them."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["fly", "table"])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--karst", default="karst", help="the program; a copy that no build replaces")
    parser.add_argument("--caves", nargs="+", default=[])
    parser.add_argument("--seeds", type=int, default=seeds)
    parser.add_argument("--battery", default="3 min")
    parser.add_argument("--jobs", type=int, default=2, help="trials at once; the same for the table")
    parser.add_argument("--policies", nargs="+", default=campaign.POLICIES)
    return parser


def main(parser, fly, table):
    args = parser.parse_args()
    if args.what == "table":
        return table(args)
    if not args.caves:
        parser.error("fly needs --caves")
    args.folder.mkdir(parents=True, exist_ok=True)
    fly(args)


if __name__ == "__main__":
    main(arguments(__doc__, seeds=2), fly, table)
