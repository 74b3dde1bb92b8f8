"""Many flights compared: a campaign's folder, read with the karst program.

karst computes means, intervals, tests and verdicts (docs/statistics.md). This module only takes them over.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .errors import Error
from .needed import needed
from .program import run_karst
from .run import Run

if TYPE_CHECKING:
    import pandas as pd

STORE = "campaign.sqlite"
RANKING_COLUMNS = [
    "best_place", "worst_place", "contestant", "groups", "trials", "failed", "mean", "low", "high",
]


@dataclass(frozen=True)
class Verdict:
    """A pair of contestants in one figure. Shares are fractions; other values have the figure's unit.

    NaN where there is no value.
    """

    a: str
    b: str
    metric: str
    pairs: int  # flights of both in the same cave with the same seed
    mean_a: float
    mean_b: float
    difference: float  # a - b
    low: float  # 95 % confidence interval of the difference
    high: float
    p: float  # after correction for all pairs of contestants
    rank_biserial: float
    better: str | None  # who is shown to be better (or to have more, if more is neither better nor worse)
    sentence: str  # the verdict in words, with its uncertainty


class Campaign:
    """A campaign's folder, finished or still flying. What karst says of it is kept once it was asked for.

    Load the folder again to see trials that have flown since. Where a method takes a `metric`, its default is
    the figure that the campaign declared. Shares, such as coverage, are fractions from 0 to 1. Methods raise
    Error with the program's message if karst cannot read the campaign.
    """

    def __init__(self, folder: str | PathLike[str]) -> None:
        path = Path(folder)
        self.folder = path.parent if path.name == STORE else path
        if not is_campaign(self.folder):
            raise Error.at(self.folder, "", f"is no campaign's folder: it has no {STORE}")
        self._texts: dict[str | None, str] = {}  # by metric: what karst results prints
        self._results: dict[str | None, dict] = {}  # by metric: all that it writes

    def __repr__(self) -> str:
        return f"Campaign({str(self.folder)!r})"

    @property
    def results(self) -> dict:
        """All that `karst results --json` writes: schema, name, horizon_s, contestants, caves, verdict, trials."""
        return self._results_about(None)

    def _results_about(self, metric: str | None) -> dict:
        if metric not in self._results:
            text = run_karst(["results", self.folder, "--json", "-", *_option(metric)])
            try:
                self._results[metric] = json.loads(text)
            except json.JSONDecodeError as e:
                raise Error.at("karst results --json", f"line {e.lineno}", f"is no JSON: {e.msg}") from e
        return self._results[metric]

    def _verdict(self, metric: str | None) -> dict:
        verdict = self._results_about(metric)["verdict"]
        if verdict is None:
            raise Error.at(self.folder, "", "no flight of it has ended yet")
        return verdict

    @property
    def name(self) -> str:
        """The campaign's name."""
        return self.results["name"]

    @property
    def horizon_s(self) -> float:
        """The longest possible flight, which limits restricted times."""
        return self.results["horizon_s"]

    @property
    def contestants(self) -> list[dict]:
        """name, policy, version, parameters and settings of each contestant."""
        return self.results["contestants"]

    @property
    def caves(self) -> list[dict]:
        """name, file, start, hash and description of each cave."""
        return self.results["caves"]

    @property
    def metric(self) -> str:
        """The figure that decides, as the campaign declared it before it flew, such as "coverage_auc"."""
        return self._verdict(None)["declared"]

    @cached_property
    def trials(self) -> pd.DataFrame:
        """A row for each trial that was flown, by contestant, cave and seed.

        Columns: contestant, cave, seed, status (done, failed), outcome, reason, ended; the figures of
        docs/metrics.md, NaN where one is unknown; trial_s, wall_s, simulated_s, decide_mean_ms ...
        plan_max_ms (wall clock, except simulated_s), machine, binary_version, mission_hash and run_dir.
        """
        pandas = needed("pandas", "reading a campaign's trials")
        rows = []
        for trial in self.results["trials"]:
            row = {k: v for k, v in trial.items() if k not in ("figures", "curve", "timing")}
            figures = {k: np.nan if v is None else v for k, v in trial["figures"].items()}
            rows.append({**row, **figures, **trial["timing"]})
        table = pandas.DataFrame(rows, columns=None if rows else ["contestant", "cave", "seed", "status"])
        last = [c for c in ("machine", "binary_version", "mission_hash", "run_dir") if c in table]
        return table[[c for c in table if c not in last] + last]

    @cached_property
    def curves(self) -> pd.DataFrame:
        """Coverage over time of all trials.

        Columns: contestant, cave, seed, since_takeoff_s, explored_m3, coverage.
        """
        pandas = needed("pandas", "reading a campaign's curves")
        rows = [
            (t["contestant"], t["cave"], t["seed"], *point)
            for t in self.results["trials"]
            for point in t["curve"]
        ]
        names = ["contestant", "cave", "seed", "since_takeoff_s", "explored_m3", "coverage"]
        return pandas.DataFrame(rows, columns=names).astype({"explored_m3": float, "coverage": float})

    def run(self, contestant: str, cave: str, seed: int) -> Run:
        """The flight of a trial. Raises Error if there is none, or if its folder was not kept."""
        for trial in self.results["trials"]:
            if (trial["contestant"], trial["cave"], trial["seed"]) == (contestant, cave, seed):
                return Run(trial["run_dir"])
        raise Error.at(self.folder, f"{contestant} in {cave}, seed {seed}", "no such trial was flown")

    def text(self, metric: str | None = None) -> str:
        """What `karst results --pairs` prints: the verdicts in words, and a table of means."""
        if metric not in self._texts:
            self._texts[metric] = run_karst(["results", self.folder, "--pairs", *_option(metric)])
        return self._texts[metric]

    def heading(self, metric: str | None = None) -> str:
        """The figure in words with the unit in which karst prints it, such as "final coverage (%)"."""
        verdict = self._verdict(metric)
        unit = "%" if verdict["is_fraction"] else verdict["unit"]
        return verdict["subject"] + (f" ({unit})" if unit else "")

    def table(self, metric: str | None = None) -> pd.DataFrame:
        """Means of every figure, of the flights that all contestants flew; a row each, by place.

        The index is the contestant; the columns are the figures by their names in docs/metrics.md.
        """
        pandas = needed("pandas", "reading a campaign's table")
        verdict = self._verdict(metric)
        places = [place["contestant"] for place in verdict["ranking"]]
        return pandas.DataFrame.from_dict(verdict["means"], orient="index").loc[places].astype(float)

    def ranking(self, metric: str | None = None) -> pd.DataFrame:
        """The contestants, best first.

        Columns: best_place, worst_place, contestant, groups, trials, failed, mean, low, high. Contestants
        with a common letter in `groups` are not shown to differ. `mean` is over the caves, with equal weight,
        and low to high its 95 % confidence interval.
        """
        pandas = needed("pandas", "reading a campaign's ranking")
        return pandas.DataFrame(self._verdict(metric)["ranking"], columns=RANKING_COLUMNS).astype(
            {"mean": float, "low": float, "high": float}
        )

    def verdicts(self, metric: str | None = None) -> list[Verdict]:
        """The verdict on each pair of contestants; empty for a single contestant."""
        verdict = self._verdict(metric)
        return [
            Verdict(metric=verdict["metric"], **{k: np.nan if v is None and k != "better" else v for k, v in pair.items()})
            for pair in verdict["pairs"]
        ]

    def verdict(self, a: str, b: str, metric: str | None = None) -> Verdict:
        """The verdict on two contestants, as a minus b. Raises Error if there is no such pair."""
        for v in self.verdicts(metric):
            if (v.a, v.b) == (a, b):
                return v
            if (v.a, v.b) == (b, a):
                return replace(v, a=a, b=b, mean_a=v.mean_b, mean_b=v.mean_a, difference=-v.difference,
                               low=-v.high, high=-v.low, rank_biserial=-v.rank_biserial)
        names = ", ".join(c["name"] for c in self.contestants)
        raise Error.at(self.folder, f"{a} and {b}", f"no such pair; the contestants are {names}")

    def sentence(self, metric: str | None = None) -> str:
        """The verdict on the whole campaign in one sentence."""
        return self._verdict(metric)["sentence"]


def is_campaign(folder: Path) -> bool:
    """Whether this is a campaign's folder, or its store."""
    return (folder / STORE).is_file() or (folder.name == STORE and folder.is_file())


def _option(metric: str | None) -> list[str]:
    return [] if metric is None else ["--metric", metric]
