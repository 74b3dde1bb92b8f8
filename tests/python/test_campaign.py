"""A campaign read with a script in place of karst."""

import json

import numpy as np
import pytest
from karst.campaign import Campaign
from karst.errors import Error
from karst.results import load
from made_up_campaign import NAMES, write_campaign
from made_up_run import write_run


@pytest.fixture
def campaign(tmp_path, monkeypatch):
    program = tmp_path / "bin/karst"
    monkeypatch.setenv("KARST", str(program))
    return load(write_campaign(tmp_path / "made", program))


def test_trials(campaign):
    assert isinstance(campaign, Campaign)
    assert campaign.name == "made" and campaign.horizon_s == 90 and campaign.metric == "coverage_auc"
    trials = campaign.trials
    assert len(trials) == 12 and list(trials)[:4] == ["contestant", "cave", "seed", "status"]
    assert trials["coverage"].dtype == float and np.isnan(trials["coverage"].iloc[-1])
    assert list(trials)[-4:] == ["machine", "binary_version", "mission_hash", "run_dir"]
    curves = campaign.curves
    assert list(curves) == ["contestant", "cave", "seed", "since_takeoff_s", "explored_m3", "coverage"]
    assert len(curves) == 22


def test_table(campaign):
    table = campaign.table()
    assert table.index.tolist() == NAMES
    assert table["restricted_t90_s"].tolist() == [61.5, 90.0]
    assert table["coverage"][0] == 0.8 and np.isnan(table["coverage"][1])


def test_ranking(campaign):
    ranking = campaign.ranking()
    assert ranking["contestant"].tolist() == NAMES and ranking["groups"].tolist() == ["a", "b"]
    assert ranking[["best_place", "worst_place"]].values.tolist() == [[1, 1], [1, 2]]
    assert ranking[["mean", "low", "high"]].values.tolist()[0] == [0.512, 0.5, 0.524]
    assert ranking["low"].isna().tolist() == [False, True]
    assert campaign.heading() == "coverage averaged over the flight (%)"


def test_verdict(campaign):
    verdict = campaign.verdict(*NAMES)
    assert campaign.verdicts() == [verdict]
    assert (verdict.a, verdict.b, verdict.metric, verdict.pairs) == (*NAMES, "coverage_auc", 6)
    assert (verdict.mean_a, verdict.mean_b, verdict.difference) == pytest.approx((0.512, 0.4, 0.112))
    assert (verdict.low, verdict.high, verdict.p, verdict.rank_biserial) == (-0.08, 0.14, 0.0004, -0.5)
    assert verdict.better == "far_first" and verdict.sentence.startswith("far_first covers more")
    assert campaign.sentence() == verdict.sentence
    back = campaign.verdict(*reversed(NAMES))
    assert (back.mean_a, back.difference, back.low, back.high) == pytest.approx((0.4, -0.112, -0.14, 0.08))
    assert back.better == "far_first" and back.rank_biserial == 0.5
    with pytest.raises(Error, match="far_first and nobody: no such pair; the contestants are far_first"):
        campaign.verdict("far_first", "nobody")


def test_run_of_a_trial(campaign):
    with pytest.raises(Error, match="is not there"):  # --keep, or moved away
        campaign.run("far_first", "maze", 3)
    write_run(campaign.folder / "trials/0/3")
    assert campaign.run("far_first", "maze", 3).takeoff_s == 1.0
    with pytest.raises(Error, match="far_first in maze, seed 9: no such trial"):
        campaign.run("far_first", "maze", 9)


def test_not_a_campaign(tmp_path):
    with pytest.raises(Error, match="it has no campaign.sqlite"):
        Campaign(tmp_path)


def test_no_program(campaign, monkeypatch):
    monkeypatch.setenv("KARST", "/no/such/karst")
    with pytest.raises(Error, match="is no program"):
        campaign.trials


def test_output_of_another_version(campaign, tmp_path):
    (tmp_path / "bin/results.json").write_text("{")
    with pytest.raises(Error, match="karst results --json: line"):
        campaign.trials


def test_no_flight_has_ended(campaign, tmp_path):
    results = json.loads((tmp_path / "bin/results.json").read_text())
    (tmp_path / "bin/results.json").write_text(json.dumps(results | {"verdict": None, "trials": []}))
    assert len(campaign.trials) == 0
    with pytest.raises(Error, match="no flight of it has ended yet"):
        campaign.ranking()
