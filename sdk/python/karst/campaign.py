"""Many flights compared: a campaign's folder, read with the karst program.

karst computes means, intervals, tests and verdicts (docs/statistics.md). This module only takes them over.
"""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .errors import Error
from .needed import needed
from .printed_tables import cells_of, number_of, numbers_of
from .program import run_karst
from .run import Run
from .tables import read_text

if TYPE_CHECKING:
    import pandas as pd

STORE = "campaign.sqlite"
RANKING_COLUMNS = [
    "best_place", "worst_place", "contestant", "groups", "flights", "failed", "mean", "low", "high",
]


@dataclass(frozen=True)
class Verdict:
    """A pair of contestants in one figure. Shares are fractions; other values have the figure's unit.

    Values are as karst prints them in its tables, to two or three digits of the interval's width; NaN where
    there is none.
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
    p: float  # after correction for all pairs of contestants; 0 below 0.001
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
        self._tables: dict[str | None, dict[str, str]] = {}  # by metric: files of --paper, by name

    def __repr__(self) -> str:
        return f"Campaign({str(self.folder)!r})"

    @cached_property
    def results(self) -> dict:
        """All that `karst results --json` writes: schema, name, horizon_s, contestants, caves, trials."""
        text = run_karst(["results", self.folder, "--json", "-"])
        try:
            return json.loads(text)
        except json.JSONDecodeError as e:
            raise Error.at("karst results --json", f"line {e.lineno}", f"is no JSON: {e.msg}") from e

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

    @cached_property
    def metric(self) -> str:
        """The figure that decides, as the campaign declared it before it flew, such as "coverage_auc"."""
        return self._metric_of(None)

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
        """The figure in words with the unit in which karst prints it, such as "Final coverage (%)"."""
        return self._paper(metric, "ranking.md")[0][5]

    def table(self, metric: str | None = None) -> pd.DataFrame:
        """The means that `karst results` prints, of the flights that all contestants flew, by place.

        Columns: place ("1-3" if it is not certain), contestant, trials, failed, then the figures by their
        names in docs/metrics.md. A restricted time is the horizon where no flight reached the coverage.
        """
        pandas = needed("pandas", "reading a campaign's table")
        header, *rows = cells_of(self.text(metric), f"karst results {self.folder}")
        columns: dict[str, list] = {}
        for i, name in enumerate(header):
            cells = [row[i] for row in rows]
            if name in ("place", "contestant"):
                columns[name] = cells
            elif name in ("trials", "failed"):
                columns[name] = [int(c) for c in cells]
            else:
                columns[name] = [number_of(c) for c in cells]
        return pandas.DataFrame(columns)

    def ranking(self, metric: str | None = None) -> pd.DataFrame:
        """The contestants, best first.

        Columns: best_place, worst_place, contestant, groups, flights, failed, mean, low, high. Contestants
        with a common letter in `groups` are not shown to differ. `mean` is over the caves, with equal weight,
        and low to high its 95 % confidence interval.
        """
        pandas = needed("pandas", "reading a campaign's ranking")
        header, *rows = self._paper(metric, "ranking.md")
        whole = _whole(header[5])
        table = []
        for place, contestant, group, flights, failed, mean, interval, *_ in rows:
            places = [int(abs(n)) for n in numbers_of(place)]
            low, high = _interval(interval, whole)
            table.append((places[0], places[-1], contestant, group, int(flights), int(failed),
                          number_of(mean) / whole, low, high))
        return pandas.DataFrame(table, columns=RANKING_COLUMNS)

    def verdicts(self, metric: str | None = None) -> list[Verdict]:
        """The verdict on each pair of contestants; empty for a single contestant."""
        if len(self.contestants) < 2:
            return []
        header, *rows = self._paper(metric, "comparisons.md")
        about = self._metric_of(metric)
        sentences = _after_table(self.text(metric))[: len(rows)]
        if len(sentences) < len(rows):
            raise Error.at(f"karst results {self.folder} --pairs", "", "says no sentence on some pair")
        whole, verdicts = _whole(header[3]), []
        for row, sentence in zip(rows, sentences):
            a, b, pairs, mean_a, mean_b, difference, interval, p, rank, better = row
            low, high = _interval(interval, whole)
            verdicts.append(Verdict(
                a, b, about, int(pairs), number_of(mean_a) / whole, number_of(mean_b) / whole,
                number_of(difference) / whole, low, high, 0.0 if p.startswith("<") else number_of(p),
                number_of(rank), better if better in (a, b) else None, sentence,
            ))
        return verdicts

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
        text, count = self.text(metric), len(self.contestants)
        if count < 2:
            return "nothing to compare: a verdict needs two contestants"
        if count > 3:  # then karst begins with it
            lines = text.split("\n")
            return lines[1] if lines[0].startswith("The campaign declared") else lines[0]
        return _after_table(text)[-1]

    def _metric_of(self, metric: str | None) -> str:
        if metric is not None:
            return metric
        self._paper(None, "ranking.md")
        caption = self._tables[None]["ranking.md"].split("\n")[0].replace("\\", "")
        # "Contestants of campaign NAME by WORDS (METRIC): means over ..."
        return caption.partition("): means over")[0].rpartition("(")[2]

    def _paper(self, metric: str | None, name: str) -> list[list[str]]:
        """The cells of a table that karst writes for a paper: the only ones with intervals and p."""
        if metric not in self._tables:
            with tempfile.TemporaryDirectory(prefix="karst_") as folder:
                run_karst(["results", self.folder, "--paper", folder, "--force", *_option(metric)])
                self._tables[metric] = {f.name: read_text(f) for f in Path(folder).glob("*.md")}
        if name not in self._tables[metric]:
            raise Error.at(f"karst results {self.folder} --paper", name, "was not written")
        return cells_of(self._tables[metric][name], f"karst results {self.folder} --paper: {name}")


def is_campaign(folder: Path) -> bool:
    """Whether this is a campaign's folder, or its store."""
    return (folder / STORE).is_file() or (folder.name == STORE and folder.is_file())


def _option(metric: str | None) -> list[str]:
    return [] if metric is None else ["--metric", metric]


def _whole(heading: str) -> float:
    """What a printed value is divided by: tables for papers have shares in percent."""
    return 100.0 if heading.endswith("(%)") else 1.0


def _interval(cell: str, whole: float) -> tuple[float, float]:
    numbers = numbers_of(cell)[:2]
    return (numbers[0] / whole, numbers[1] / whole) if len(numbers) == 2 else (np.nan, np.nan)


def _after_table(text: str) -> list[str]:
    """The sentences below the table of means, without its notes."""
    lines = text.split("\n")
    last = max((i for i, line in enumerate(lines) if line.startswith("|")), default=-1)
    return [line for line in lines[last + 1 :] if line and not line.startswith(">")]
