"""A campaign of two contestants in one cave, with a script in place of karst that prints as karst does."""

from __future__ import annotations

import json
from pathlib import Path

import karst

NAMES = ["far_first", "near|first"]
TEXT = """\
made: means over 1 cave, of the flights that all have flown

| place | contestant | trials | failed | coverage_auc | coverage | restricted_t90_s | contacts |
|---:|---|---:|---:|---:|---:|---:|---:|
| 1 | far_first | 6 | 0 | 0.512 | 0.800 | 61.5 | 0.000 |
| 2 | other | 6 | 1 | 0.400 | - | > 90.0 | 1.500 |

> 90: no flight reached this coverage before the horizon of 90 s.

far_first covers more than near|first: 11.2 points (95 % CI 8.0 to 14.0 points; 1 cave x 6 seeds, p = 0.031)
"""
RANKING = r"""**Table:** Contestants of campaign made by words (coverage\_auc): means over 1 cave.

| Place | Contestant | Group | Flights | Failed | Coverage averaged over the flight (%) | 95 % CI (%) |
| --: | :-- | :-- | --: | --: | --: | --: |
| 1   | far\_first  | a | 6 | 0 | **51.20** | \[50.00, 52.40\] |
| 1–2 | near\|first | b | 6 | 1 |     40.00 |                – |
"""
COMPARISONS = r"""**Table:** Pairs.

| A | B | Pairs | Mean of A (%) | Mean of B (%) | A − B (percentage points) | CI | p | Rank | Shown better |
| :-- | :-- | --: | --: | --: | --: | --: | --: | --: | :-- |
| **far\_first** | near\|first | 6 | 51.2 | 40.0 | 11.2 | \[−8.00, 14.0\]† | \< 0.001 | −0.50 | far\_first |
"""
SCRIPT = """\
#!/usr/bin/python3
import pathlib, sys
if sys.argv[1:] == ["--version"]:
    print("karst VERSION")
    sys.exit()
here = pathlib.Path(__file__).parent
if "--json" in sys.argv:
    print((here / "results.json").read_text())
elif "--paper" in sys.argv:
    folder = pathlib.Path(sys.argv[sys.argv.index("--paper") + 1])
    for name in ("ranking.md", "comparisons.md"):
        (folder / name).write_text((here / name).read_text())
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
        "trials": trials,
    }
    program.parent.mkdir(exist_ok=True)
    for name, text in {
        "results.json": json.dumps(results),
        "results.txt": TEXT,
        "ranking.md": RANKING,
        "comparisons.md": COMPARISONS,
        program.name: SCRIPT.replace("VERSION", karst.__version__),
    }.items():
        (program.parent / name).write_text(text, encoding="utf-8")
    program.chmod(0o755)
    return folder
