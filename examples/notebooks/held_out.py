#!/usr/bin/python3
"""Compares the learned policy with nearest_frontier in caves that the training did not use.

    held_out.py [--out held_out.json] [--folder runs/held_out] [--jobs 2]

Presets that the training used come with other seeds, and three presets are new. Caves, seeds, flight time and figure
stand here, so that they were decided before the flights.
"""

import argparse
import dataclasses
import json
from pathlib import Path

import karst

CAVES = {"medium": 901, "vertical": 902, "maze": 903, "small": 904, "tight": 905, "large": 906}
SEEDS = 4
FLIGHT_S = 180
METRIC = "coverage_auc"
POLICY, BASELINE = "learned_frontier", "nearest_frontier"


def compare(folder, caves=CAVES, seeds=SEEDS, flight_s=FLIGHT_S, jobs=1, caves_in="caves/held_out"):
    """The campaign, flown or gone on with."""
    files = []
    for preset, seed in caves.items():
        stem = Path(caves_in, f"{preset}-{seed}")
        stem.parent.mkdir(parents=True, exist_ok=True)
        if not stem.with_suffix(".info").exists():
            karst.run_karst(["cave", "generate", "--preset", preset, "--seed", str(seed), "--out", stem])
        files.append(stem.with_suffix(".info"))
    karst.run_karst(["compare", f"{POLICY}.py", BASELINE, "--caves", *files, "--seeds", str(seeds), "--time",
                     f"{flight_s} s", "--metric", METRIC, "--jobs", str(jobs), "--keep", "figures", "--quiet",
                     "--out", folder])
    return karst.load(folder)


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
    parser.add_argument("--folder", default="runs/held_out")
    parser.add_argument("--jobs", type=int, default=1)
    a = parser.parse_args()
    found = record(compare(a.folder, jobs=a.jobs))
    Path(a.out).write_text(json.dumps(found, indent=1) + "\n")
    print(found["sentence"])


if __name__ == "__main__":
    main()
