#!/usr/bin/env python3
"""The campaign behind an experience to ship: caves of seven kinds, two vehicles, two batteries.

    python3 tests/benchmark/selection_campaign.py caves  FOLDER            # makes and describes the caves
    python3 tests/benchmark/selection_campaign.py plan   FOLDER            # says how much there is to fly
    python3 tests/benchmark/selection_campaign.py fly    FOLDER            # flies; started again, it goes on
    python3 tests/benchmark/selection_campaign.py learn  FOLDER --out experience.info
    karst select --leave-one-out --results experience.info

The flights go in rounds. A round flies one cave of each kind by all contestants with one seed, each cave under one
condition (vehicle and battery), so that the conditions take turns over caves and kinds. After six rounds each of the 42
caves has been flown under one condition, after twelve under two, and so on. Whenever it is stopped, the kinds have been
flown equally often and the conditions nearly so, but for the round under way. Goals cost no flights: they are figures
of the same flights.

Tuned parameters: put what `karst tune` wrote as preset.info into FOLDER/tuned as NAME.info. They are appended as
contestants, to rounds that were flown before as well.

The caves are drawn from ranges, and kept if their figures lie in the ranges of real caves (REAL below): those that
`karst cave describe` measured of the meshes and of three parts of the survey in ../shared/data (docs/select.md).
"""
import argparse
import csv
import json
import os
import random
import re
import subprocess
import sys
from pathlib import Path

# Ranges of real caves, by `karst cave describe`: indian_tunnel, rough_tunnel, jean_bernard, darpa_cave_01 and 02; of the
# survey of the Jean-Bernard, the parts C37.Riviera, B22.ChampsElysees and RiviereAval.Riviere1.
REAL = {
    "volume": (297, 138932), "length": (86.6, 1347), "width": (1.90, 7.50), "width_spread": (1.05, 2.92),
    "height": (2.03, 9.88), "drop": (13.6, 83.6), "verticality": (0.08, 0.47), "branching": (0, 1.91),
    "loops": (0, 0.83), "tortuosity": (1.05, 1.70),
}
# Eight caves are no census: a drawn cave may be beyond their range by this factor. Counts of 100 m have an offset, as
# in the distance of two caves.
BEYOND = 1.4
OFFSET = {"branching": 1.0, "loops": 0.5, "verticality": 0.3}

# Kind: preset of karst cave generate, and ranges of its recipe. Volumes are such that the longer battery covers
# between a fifth and all of the cave.
KINDS = {
    "tube": ("small", {"volume": (3000, 9000), "passage_width": (6, 8), "verticality": (0, 0.15), "branching": (0, 0.1),
                       "loops": (0, 0), "domes": (0, 1), "shafts": (0, 0), "chimneys": (0, 0), "breakdown": (0.3, 1)}),
    "gallery": ("medium", {"volume": (3000, 6000), "passage_width": (3, 4.5), "verticality": (0.05, 0.2),
                           "branching": (0.1, 0.35), "loops": (0, 1), "domes": (0, 1), "shafts": (0, 1),
                           "chimneys": (0, 1)}),
    "meander": ("tight", {"volume": (700, 1500), "passage_width": (2.2, 3), "verticality": (0.2, 0.4),
                          "branching": (0, 0.3), "loops": (0, 0), "domes": (0, 0), "shafts": (0, 1),
                          "chimneys": (0, 1)}),
    "alpine": ("vertical", {"volume": (3000, 7000), "passage_width": (3.5, 5), "verticality": (0.3, 0.6),
                            "branching": (0.1, 0.3), "loops": (0, 1), "domes": (0, 2), "shafts": (2, 4),
                            "chimneys": (0, 2)}),
    "branches": ("medium", {"volume": (3000, 8000), "passage_width": (4, 6), "verticality": (0.1, 0.3),
                            "branching": (0.6, 0.9), "loops": (0, 0), "domes": (0, 2), "shafts": (0, 1),
                            "chimneys": (0, 1)}),
    "maze": ("maze", {"volume": (3000, 6000), "passage_width": (3, 4), "verticality": (0, 0.2), "branching": (0.3, 0.6),
                      "loops": (3, 8), "domes": (0, 1), "shafts": (0, 0), "chimneys": (0, 1)}),
    "halls": ("large", {"volume": (6000, 14000), "passage_width": (4.5, 7), "verticality": (0.1, 0.3),
                        "branching": (0.1, 0.4), "loops": (0, 1), "domes": (3, 5), "shafts": (0, 2),
                        "chimneys": (0, 1)}),
}
WHOLE = {"loops", "domes", "shafts", "chimneys"}
TRIES = 60

VEHICLES = ["lidar_uav", "camera_uav"]
BATTERIES = ["3 min", "6 min"]
# All policies but beyond_survey: no cave here has a survey.
POLICIES = ["nearest_frontier", "highest_frontier", "lateral_frontier", "unknown_ratio", "information_gain",
            "viewpoint_tour", "deep_cave", "surface_coverage"]
OBJECTS = 20


def run(args, command, **how):
    return subprocess.run([args.karst, *command], check=True, text=True, **how)


def inside(figures):
    """The figure that no real cave has, or None."""
    for name, (low, high) in REAL.items():
        offset = OFFSET.get(name, 0)
        if not (low + offset) / BEYOND - offset <= figures[name] <= (high + offset) * BEYOND - offset:
            return f"{name} {figures[name]:.3g}"
    return None


def described(args, cave):
    out = run(args, ["cave", "describe", "--json", str(cave)], stdout=subprocess.PIPE).stdout
    figures = json.loads(out)
    return figures.get("figures", figures)


def make_cave(args, kind, number):
    """The first of TRIES recipes whose cave has figures as real ones have; else the one tried last is named."""
    preset, ranges = KINDS[kind]
    out = args.folder / "caves" / f"{kind}{number}"
    for attempt in range(TRIES):
        seed = args.seed + 1000 * number + attempt
        draw = random.Random(f"{kind} {seed}")
        recipe = {key: draw.randint(low, high) if key in WHOLE else round(draw.uniform(low, high), 3)
                  for key, (low, high) in ranges.items()}
        recipe["passage_width"] = f"{recipe['passage_width']} m"
        settings = [word for key, value in recipe.items() for word in ("--set", f"{key}={value}")]
        run(args, ["cave", "generate", "--quiet", "--force", "--preset", preset, "--seed", str(seed), *settings,
                   "--out", str(out)])
        figures = described(args, out.with_suffix(".info"))
        odd = inside(figures)
        if odd is None:
            return {"cave": out.name, "kind": kind, "preset": preset, "seed": seed,
                    "recipe": "; ".join(f"{k}={v}" for k, v in recipe.items()), **figures}
        print(f"{out.name}, seed {seed}: {odd} is beyond real caves", flush=True)
    sys.exit(f"{out.name}: none of {TRIES} recipes gave a cave like real ones")


def caves_of(folder):
    table = folder / "caves.csv"
    if not table.exists():
        return []
    with open(table, newline="") as file:
        return list(csv.DictReader(file))


def make_caves(args):
    """In the order of rounds: the first cave of each kind, the second of each kind, ..."""
    (args.folder / "caves").mkdir(parents=True, exist_ok=True)
    rows = caves_of(args.folder)
    known = {row["cave"] for row in rows}
    for number in range(1, args.of_each + 1):
        for kind in KINDS:
            if f"{kind}{number}" in known:
                continue
            rows.append(make_cave(args, kind, number))
            with open(args.folder / "caves.csv.new", "w", newline="") as file:
                table = csv.DictWriter(file, fieldnames=list(rows[-1]))
                table.writeheader()
                table.writerows(rows)
            os.replace(args.folder / "caves.csv.new", args.folder / "caves.csv")
            print(f"{rows[-1]['cave']}: {rows[-1]['recipe']}", flush=True)


def conditions(args):
    return [(f"{vehicle}_{battery.replace(' ', '')}", vehicle, battery)
            for battery in args.batteries for vehicle in args.vehicles]


def rounds_of(args):
    """The flights of each round on top of those before: ({name of condition: caves}, seeds)."""
    names = [name for name, _, _ in conditions(args)]
    kinds = list(KINDS)
    rows = caves_of(args.folder)
    numbers = sorted({int(row["cave"].removeprefix(row["kind"])) for row in rows})
    flown = {name: [] for name in names}
    rounds = []
    for turn in range(len(names)):
        for number in numbers:
            for row in rows:
                if row["cave"] == f"{row['kind']}{number}":
                    flown[names[(turn + number + kinds.index(row["kind"])) % len(names)]].append(row["cave"])
            rounds.append(({name: list(caves) for name, caves in flown.items()}, 1))
    return rounds + [(flown, seed) for seed in range(2, args.seeds + 1)]


def contestants(args):
    lines = [f"contestant {{ policy {policy} }}" for policy in args.policies]
    for preset in sorted((args.folder / "tuned").glob("*.info")):
        text = preset.read_text()
        body = text[text.index("{") + 1:text.rindex("}")]  # of policy { name ... parameters { ... } }
        lines.append(f"contestant {{ name {preset.stem}\n" + body.replace("name ", "policy ", 1) + "}")
    return lines


def in_order(args, name, caves):
    """The caves of a campaign that was begun come first, as there: a store is only ever appended to."""
    file = args.folder / f"{name}.info"
    begun = re.findall(r"^cave { file caves/(\w+)\.info }$", file.read_text(), re.M) if file.exists() else []
    return begun + [cave for cave in caves if cave not in begun]


def write_campaign(args, name, vehicle, battery, caves, seeds):
    text = "\n".join([
        f"name {name}", "profile campaign", f'flight_time "{battery}"', 'trial_timeout "1 h"',
        f"seeds {seeds}", "metric coverage_auc",
        "settings {", f'  simulator {{ vehicle {vehicle}  battery_minutes "{battery}"  '
        f'rgb {{ fitted true }}  objects {{ count {OBJECTS} }} }}', "}",
        *contestants(args), *(f"cave {{ file caves/{cave}.info }}" for cave in caves), ""])
    file = args.folder / f"{name}.info"
    file.write_text(text)
    return file


def done_file(args, name):
    return args.folder / f"{name}.flown"


def flown_whole(args, name, caves, seeds):
    """Whether these contestants have flown all of it."""
    file = done_file(args, name)
    if not file.exists():
        return False
    state = json.loads(file.read_text())
    return (state["contestants"] == contestants(args) and set(caves) <= set(state["caves"])
            and seeds <= state["seeds"])


def fly(args):
    for number, (flights, seeds) in enumerate(rounds_of(args)[:args.rounds], 1):
        for name, vehicle, battery in conditions(args):
            if flown_whole(args, name, flights[name], seeds):
                continue
            caves = in_order(args, name, flights[name])
            print(f"round {number}: {name}, {len(caves)} caves, {seeds} seeds", flush=True)
            campaign = write_campaign(args, name, vehicle, battery, caves, seeds)
            command = ["compare", str(campaign), "--out", str(args.folder / name), "--keep", "figures", "--quiet"]
            if args.any_binary:
                command.append("--any-binary")
            if args.jobs:
                command += ["--jobs", str(args.jobs)]
            run(args, command, stdout=open(args.folder / f"{name}.txt", "w"))
            done_file(args, name).write_text(
                json.dumps({"contestants": contestants(args), "caves": caves, "seeds": seeds}))


def plan(args):
    minutes = {name: float(battery.split()[0]) for name, _, battery in conditions(args)}
    before_flights, before_hours = 0, 0
    for number, (caves, seeds) in enumerate(rounds_of(args), 1):
        per_cave = seeds * len(contestants(args))
        flights = sum(len(c) for c in caves.values()) * per_cave
        hours = sum(len(c) * minutes[name] for name, c in caves.items()) * per_cave / 60
        flown = all(flown_whole(args, name, c, seeds) for name, c in caves.items())
        print(f"round {number}: {flights - before_flights} flights, at most {hours - before_hours:.1f} flight hours"
              f"{', flown' if flown else ''}")
        before_flights, before_hours = flights, hours
    print(f"{before_flights} flights in all: {len(conditions(args))} conditions, {len(contestants(args))} contestants")


def learn(args):
    stores = [str(args.folder / name) for name, _, _ in conditions(args) if (args.folder / name).exists()]
    run(args, ["select", "--learn", *stores, "--out", str(args.out)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["caves", "plan", "fly", "learn"])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--karst", default="karst", help="the program; a copy that no build replaces")
    parser.add_argument("--of-each", type=int, default=6, help="caves of each kind; default 6: 42 caves")
    parser.add_argument("--kinds", nargs="+", default=list(KINDS))
    parser.add_argument("--seed", type=int, default=0, help="another seed, other caves")
    parser.add_argument("--seeds", type=int, default=1, help="flights of each contestant in each cave")
    parser.add_argument("--rounds", type=int, help="stop after so many")
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--any-binary", action="store_true")
    parser.add_argument("--vehicles", nargs="+", default=VEHICLES)
    parser.add_argument("--batteries", nargs="+", default=BATTERIES)
    parser.add_argument("--policies", nargs="+", default=POLICIES)
    parser.add_argument("--out", type=Path, default=Path("experience.info"))
    args = parser.parse_args()
    unknown = [kind for kind in args.kinds if kind not in KINDS]
    if unknown:
        parser.error(f"no such kind: {unknown[0]}; there are {', '.join(KINDS)}")
    for kind in list(KINDS):
        if kind not in args.kinds:
            del KINDS[kind]
    if args.what != "caves" and not caves_of(args.folder):
        parser.error(f"{args.folder} has no caves yet: make them with `caves`")
    {"caves": make_caves, "plan": plan, "fly": fly, "learn": learn}[args.what](args)


if __name__ == "__main__":
    main()
