"""A campaign of two contestants in one cave, with a script in place of karst that prints as karst does."""

from __future__ import annotations

import json
from pathlib import Path

import karst

NAMES = ["far_first", "near|first"]
TEXT = "far_first covers more than near|first: 11.2 points\n"
VERDICT = {
    "metric": "coverage_auc", "declared": "coverage_auc", "subject": "coverage averaged over the flight", "unit": "", "is_fraction": True,
    "sentence": "far_first covers more than near|first: 11.2 points",
    "means": {
        "near|first": {"coverage_auc": 0.4, "coverage": None, "restricted_t90_s": 90.0},
        "far_first": {"coverage_auc": 0.512, "coverage": 0.8, "restricted_t90_s": 61.5},
    },
    "ranking": [
        {"contestant": "far_first", "best_place": 1, "worst_place": 1, "groups": "a", "trials": 6, "failed": 0,
         "mean": 0.512, "low": 0.5, "high": 0.524},
        {"contestant": "near|first", "best_place": 1, "worst_place": 2, "groups": "b", "trials": 6, "failed": 1,
         "mean": 0.4, "low": None, "high": None},
    ],
    "pairs": [
        {"a": "far_first", "b": "near|first", "pairs": 6, "mean_a": 0.512, "mean_b": 0.4, "difference": 0.112,
         "low": -0.08, "high": 0.14, "p": 0.0004, "rank_biserial": -0.5, "better": "far_first",
         "sentence": "far_first covers more than near|first: 11.2 points"},
    ],
}
SCRIPT = f"""\
#!/usr/bin/python3
import pathlib, sys
here = pathlib.Path(__file__).parent
if "--version" in sys.argv:
    print("karst {karst.__version__}")
elif "--json" in sys.argv:
    print((here / "results.json").read_text())
else:
    print((here / "results.txt").read_text(), end="")
"""


def write_campaign(folder: Path, program: Path) -> Path:
    """The campaign's folder; `program` becomes the script."""
    folder.mkdir()
    (folder / "campaign.sqlite").write_bytes(b"")
    trials = []
    for i, name in enumerate(NAMES):
        for seed in range(1, 7):
            failed = i == 1 and seed == 6
            figures = {"coverage": None, "coverage_auc": None}
            if not failed:
                figures = {"coverage": 0.8, "coverage_auc": 0.5 - 0.1 * i + 0.01 * seed}
            trials.append({
                "contestant": name, "cave": "maze", "seed": seed, "status": "failed" if failed else "done",
                "outcome": "", "reason": "", "ended": "", "binary_version": "1", "mission_hash": "2",
                "figures": figures,
                "curve": [] if failed else [[0.0, 0.0, 0.0], [10.0 * seed, 50.0, 0.8]],
                "timing": {"machine": "vm", "wall_s": 1.5}, "run_dir": str(folder / f"trials/{i}/{seed}"),
            })
    results = {
        "schema": "karst.results/1", "name": "made", "horizon_s": 90.0,
        "contestants": [{"name": n, "policy": n, "parameters": {}, "settings": {}} for n in NAMES],
        "caves": [{"name": "maze", "file": "maze.info", "start": "", "description": None}],
        "verdict": VERDICT,
        "trials": trials,
    }
    program.parent.mkdir(exist_ok=True)
    for name, text in {
        "results.json": json.dumps(results),
        "results.txt": TEXT,
        program.name: SCRIPT,
    }.items():
        (program.parent / name).write_text(text, encoding="utf-8")
    program.chmod(0o755)
    return folder
