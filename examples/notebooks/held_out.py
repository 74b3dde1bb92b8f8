#!/usr/bin/python3
"""Compares the learned policy with nearest_frontier in caves that the training did not use.

    held_out.py [--out held_out.json] [--jobs 2]

Presets that the training used come with other seeds, and three presets are new. Caves, seeds, flight time and figure
stand here, so that they were decided before the flights.
"""

import argparse
import dataclasses
import json
from pathlib import Path

import karst

CAVES = {"medium": 921, "vertical": 922, "maze": 923, "small": 924, "tight": 925, "large": 926}
SEEDS = 3
FLIGHT_S = 180
METRIC = "coverage_auc"
POLICY, BASELINE = "learned_frontier", "nearest_frontier"


def campaign_text(caves, seeds, flight_s):
    """A campaign file. Its paths are relative to it."""
    files = "".join(f"cave {{ file caves/held_out/{preset}-{seed}.info }}\n" for preset, seed in caves.items())
    return (f'flight_time "{flight_s} s"\nseeds {seeds}\nmetric {METRIC}\n'
            f"contestant {{ policy {POLICY}.py }}\ncontestant {{ policy {BASELINE} }}\n{files}")


def compare(name, caves=CAVES, seeds=SEEDS, flight_s=FLIGHT_S, jobs=1):
    """The campaign of that name, flown or gone on with."""
    for preset, seed in caves.items():
        stem = Path(f"caves/held_out/{preset}-{seed}")
        stem.parent.mkdir(parents=True, exist_ok=True)
        if not stem.with_suffix(".info").exists():
            karst.run_karst(["cave", "generate", "--preset", preset, "--seed", str(seed), "--out", stem])
    Path(f"{name}.info").write_text(campaign_text(caves, seeds, flight_s))
    karst.run_karst(["compare", f"{name}.info", "--jobs", str(jobs), "--keep", "figures", "--quiet",
                     "--out", f"runs/{name}"])
    return karst.load(f"runs/{name}")


def record(campaign):
    """What the notebook shows of it: the verdict as karst has it, and a row for each flight."""
    rows = campaign.trials[["contestant", "cave", "seed", "status", METRIC, "coverage", "path_length_m"]]
    return {
        "settings": {"caves": CAVES, "seeds": SEEDS, "flight_s": FLIGHT_S, "metric": METRIC, "profile": "campaign",
                     "vehicle": "lidar_uav", "karst": karst.__version__},
        "verdict": dataclasses.asdict(campaign.verdict(POLICY, BASELINE)),
        "sentence": campaign.sentence(),
        "trials": json.loads(rows.to_json(orient="records")),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default="held_out.json")
    parser.add_argument("--jobs", type=int, default=1)
    a = parser.parse_args()
    found = record(compare("held_out", jobs=a.jobs))
    Path(a.out).write_text(json.dumps(found, indent=1) + "\n")
    print(found["sentence"])


if __name__ == "__main__":
    main()
