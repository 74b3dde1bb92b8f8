#!/usr/bin/env python3
"""Is the policy that an experience proposes better than the default, in caves made after the experience was closed?

    python3 tests/benchmark/selection_verdict.py caves  FOLDER [--meshes cave.info ...]  # makes caves by other recipes
    python3 tests/benchmark/selection_verdict.py select FOLDER --experience FILE         # writes down what is proposed
    python3 tests/benchmark/selection_verdict.py fly    FOLDER                           # flies; started again, it goes on
    python3 tests/benchmark/selection_verdict.py table  FOLDER                           # the verdict, by goal

Each cave gets one condition (vehicle and battery), in turns. For each goal, the proposed policy flies there with the
same seeds as the default of `karst fly` and the overall best of the experience. A policy that is proposed for several
goals flies once. Where `karst select` refuses, the default is taken, as `policy auto` with `otherwise` does.
"""
import argparse
import csv
import itertools
import json
import math
import random
import statistics
import subprocess
import sys
from pathlib import Path

import selection_campaign as campaign

DEFAULT = "nearest_frontier"  # what `karst fly` flies without a policy
GOALS = {"soonest": "coverage_auc", "deepest": "depth_m"}

# Recipes that the experience has not: other ranges, and kinds mixed.
OTHER_KINDS = {
    "narrow_loops": ("maze", {"volume": (1000, 2500), "passage_width": (2.4, 3), "verticality": (0.1, 0.3),
                              "branching": (0.2, 0.4), "loops": (1, 3), "domes": (0, 1), "shafts": (0, 1),
                              "chimneys": (0, 1)}),
    "wide_branches": ("large", {"volume": (6000, 12000), "passage_width": (5, 7), "verticality": (0, 0.2),
                                "branching": (0.5, 0.8), "loops": (0, 2), "domes": (0, 2), "shafts": (0, 1),
                                "chimneys": (0, 1)}),
    "steep_tube": ("small", {"volume": (2000, 6000), "passage_width": (4, 6), "verticality": (0.3, 0.5),
                             "branching": (0, 0.2), "loops": (0, 0), "domes": (0, 1), "shafts": (0, 2),
                             "chimneys": (0, 1)}),
    "domes_on_a_meander": ("tight", {"volume": (1500, 3500), "passage_width": (2.5, 3.5), "verticality": (0.1, 0.3),
                                     "branching": (0.1, 0.3), "loops": (0, 1), "domes": (2, 3), "shafts": (0, 1),
                                     "chimneys": (0, 1)}),
    "shafts_and_loops": ("vertical", {"volume": (3000, 8000), "passage_width": (3, 5), "verticality": (0.2, 0.5),
                                      "branching": (0.3, 0.6), "loops": (1, 3), "domes": (0, 2), "shafts": (1, 3),
                                      "chimneys": (1, 3)}),
    "medium_again": ("medium", {"volume": (2500, 9000), "passage_width": (3, 6), "verticality": (0, 0.4),
                                "branching": (0, 0.7), "loops": (0, 3), "domes": (0, 2), "shafts": (0, 2),
                                "chimneys": (0, 2)}),
}


def make_caves(args):
    campaign.KINDS.clear()
    campaign.KINDS.update(OTHER_KINDS)
    campaign.make_caves(args)


def caves(args):
    made = [args.folder / "caves" / f"{row['cave']}.info" for row in campaign.caves_of(args.folder)]
    listed = args.folder / "meshes.txt"
    return made + [Path(line) for line in listed.read_text().split("\n") if line] if listed.exists() else made


def experience_json(args, *words):
    done = subprocess.run([args.karst, "select", "--json", "--results", str(args.experience), *words],
                          text=True, stdout=subprocess.PIPE)
    if done.returncode not in (0, 3):
        sys.exit(done.returncode)
    return json.loads(done.stdout)


def select(args):
    """Writes choices.json: for each cave its condition, and for each goal the contestant."""
    file = args.folder / "choices.json"
    if file.exists():
        sys.exit(f"{file}: what was proposed is written down already")
    left_out = experience_json(args, "--leave-one-out")
    often = statistics.mode(choice["overall_best"]["contestant"] for choice in left_out["choices"])
    turns = itertools.cycle(campaign.conditions(args))
    choices = []
    for cave, (condition, vehicle, battery) in zip(caves(args), turns):
        asked = ["--cave", str(cave), "--vehicle", vehicle, "--battery", battery]
        proposed, presets = {}, {DEFAULT: {"policy": DEFAULT, "parameters": {}}}
        for goal in GOALS:
            answer = experience_json(args, *asked, "--for", goal)
            if answer["refused"]:
                proposed[goal] = {"contestant": DEFAULT, "refused": answer["reason"]}
                continue
            first = answer["ranking"][0]
            proposed[goal] = {"contestant": first["contestant"], "expected": first["expected"], "low": first["low"],
                              "high": first["high"], "confidence": answer["confidence"]}
            presets[first["contestant"]] = {"policy": answer["policy"], "parameters": answer["parameters"]}
        if often not in presets:
            if often not in campaign.POLICIES:
                sys.exit(f"the overall best, {often}, is no policy with its defaults: name its preset here")
            presets[often] = {"policy": often, "parameters": {}}
        choices.append({"cave": str(cave.resolve()), "condition": condition, "vehicle": vehicle, "battery": battery,
                        "overall": often, "proposed": proposed, "presets": presets})
        print(f"{cave.stem}, {condition}: " + ", ".join(f"{goal}: {p['contestant']}" for goal, p in proposed.items()),
              flush=True)
    file.write_text(json.dumps(choices, indent=1))


def contestant(name, preset):
    values = "".join(f'  {key} "{value}"' for key, value in preset["parameters"].items())
    return f"contestant {{ name {name}  policy {preset['policy']}  parameters {{{values} }} }}"


def store(args, choice):
    return args.folder / Path(choice["cave"]).stem


def fly(args):
    for choice in json.loads((args.folder / "choices.json").read_text()):
        out = store(args, choice)
        text = "\n".join([
            f"name {out.name}", "profile campaign", f'flight_time "{choice["battery"]}"', 'trial_timeout "1 h"',
            f"seeds {args.seeds}", "metric coverage_auc",
            f'settings {{ simulator {{ vehicle {choice["vehicle"]}  battery_minutes "{choice["battery"]}" }} }}',
            *(contestant(name, preset) for name, preset in choice["presets"].items()),
            f'cave {{ file "{choice["cave"]}" }}', ""])
        file = args.folder / f"{out.name}.info"
        file.write_text(text)
        print(f"{out.name}, {choice['condition']}: {', '.join(choice['presets'])}", flush=True)
        campaign.run(args, ["compare", str(file), "--out", str(out), "--keep", "figures", "--quiet", "--any-binary"],
                     stdout=open(args.folder / f"{out.name}.txt", "w"))


def means(args, choice, metric):
    """{contestant: mean over the seeds}; a flight that did not end well counts with what it has."""
    table = args.folder / f"{store(args, choice).name}.csv"
    campaign.run(args, ["results", str(store(args, choice)), "--csv", str(table)], stdout=subprocess.DEVNULL)
    values = {}
    with open(table, newline="") as file:
        for row in csv.DictReader(file):
            values.setdefault(row["contestant"], []).append(float(row[metric]))
    return {name: statistics.fmean(v) for name, v in values.items()}


def paired(differences):
    """Mean, its 95 % interval from caves drawn with replacement, and p of an exact or drawn sign-flip test."""
    n, mean = len(differences), statistics.fmean(differences)
    draw = random.Random(1)
    drawn = sorted(statistics.fmean(draw.choices(differences, k=n)) for _ in range(10000))
    flips = (itertools.product((-1, 1), repeat=n) if n <= 16 else
             ([draw.choice((-1, 1)) for _ in range(n)] for _ in range(50000)))
    sums = [abs(sum(s * d for s, d in zip(signs, differences))) for signs in flips]
    p = sum(s >= abs(sum(differences)) - 1e-12 for s in sums) / len(sums)
    return mean, drawn[249], drawn[9749], p


def table(args):
    choices = json.loads((args.folder / "choices.json").read_text())
    for goal, metric in GOALS.items():
        print(f"{goal} ({metric}), {len(choices)} caves")
        print(f"  {'cave':24} {'condition':16} {'proposed':>30} {'default':>10} {'overall best':>13}")
        against = {"proposed against the default": [], "proposed against the overall best": [],
                   "proposed, or the overall best where it refuses, against the default": []}
        for choice in choices:
            values = means(args, choice, metric)
            name = choice["proposed"][goal]["contestant"]
            mine, default, overall = values[name], values[DEFAULT], values[choice["overall"]]
            print(f"  {Path(choice['cave']).stem:24} {choice['condition']:16} {name:>21} {mine:8.3f} {default:10.3f} "
                  f"{overall:13.3f}")
            # As logarithms of ratios: caves and depths have very different sizes.
            otherwise = overall if "refused" in choice["proposed"][goal] else mine
            for logs, (one, other) in zip(against.values(), [(mine, default), (mine, overall), (otherwise, default)]):
                logs.append(math.log(max(one, 1e-9) / max(other, 1e-9)))
        for what, logs in against.items():
            mean, low, high, p = paired(logs)
            print(f"  {what}: {100 * math.expm1(mean):+.1f} % "
                  f"(95 % {100 * math.expm1(low):+.1f} to {100 * math.expm1(high):+.1f}, p {p:.3g}), better in "
                  f"{sum(x > 0 for x in logs)}, the same in {sum(x == 0 for x in logs)}, worse in {sum(x < 0 for x in logs)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["caves", "select", "fly", "table"])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--karst", default="karst", help="the program; a copy that no build replaces")
    parser.add_argument("--experience", type=Path)
    parser.add_argument("--meshes", nargs="+", default=[], help="of caves: .info files of other caves, flown as well")
    parser.add_argument("--of-each", type=int, default=1)
    parser.add_argument("--seed", type=int, default=700000, help="of the recipes: not those of the experience")
    parser.add_argument("--seeds", type=int, default=3, help="flights of each policy in each cave")
    parser.add_argument("--vehicles", nargs="+", default=campaign.VEHICLES)
    parser.add_argument("--batteries", nargs="+", default=campaign.BATTERIES)
    args = parser.parse_args()
    if args.what == "select" and not args.experience:
        parser.error("select needs --experience FILE")
    if args.what == "caves":
        make_caves(args)
        (args.folder / "meshes.txt").write_text("\n".join(str(Path(m).resolve()) for m in args.meshes))
        return
    {"select": select, "fly": fly, "table": table}[args.what](args)


if __name__ == "__main__":
    main()
