"""A flight and a campaign of a few seconds: what is read back is what karst says of them."""

import json

import numpy as np
import pytest
from karst.errors import Error
from karst.maps import read_map
from karst.program import program, run_karst
from karst.results import load


@pytest.fixture(scope="module")
def cave(tmp_path_factory):
    try:
        program()
    except Error as e:
        pytest.skip(str(e))
    stem = tmp_path_factory.mktemp("caves") / "demo"
    run_karst(["cave", "generate", "--preset", "small", "--seed", "7", "--out", stem])
    return stem.with_suffix(".info")


@pytest.fixture(scope="module")
def run(cave):
    folder = cave.parent / "run"
    run_karst(["fly", "--cave", cave, "--policy", "nearest_frontier", "--time", "20 s", "--out", folder])
    return load(folder)


@pytest.fixture(scope="module")
def campaign(cave):
    folder = cave.parent / "campaign"
    run_karst(["compare", "nearest_frontier", "highest_frontier", "--caves", cave, "--seeds", "2",
               "--time", "30 s", "--jobs", "1", "--out", folder, "--quiet"])
    return load(folder)


def test_figures_are_those_of_karst_table(run):
    header, _, row, *_ = (line.split("|")[1:-1] for line in run_karst(["table", run.folder]).split("\n") if "|" in line)
    printed = {name.strip(): cell.strip(" *") for name, cell in zip(header, row)}
    for name, key, factor in (
        ("explored m³", "explored_volume_m3", 1),
        ("coverage %", "coverage", 100),
        ("path m", "path_length_m", 1),
        ("battery %", "battery_left", 100),
    ):
        assert float(printed[name]) == pytest.approx(factor * run.metrics[key], abs=0.51)


def test_tables_agree_with_the_figures(run):
    figures = run.metrics
    flown = run.ground_truth[run.ground_truth["time_s"].between(run.takeoff_s, run.events["time_s"].max())]
    steps = np.diff(flown[["x_m", "y_m", "z_m"]].to_numpy(), axis=0)
    assert np.linalg.norm(steps, axis=1).sum() == pytest.approx(figures["path_length_m"], rel=1e-3)
    assert run.telemetry["battery_fraction"].iloc[-1] == figures["battery_left"]
    assert (run.goals["state"] == "accepted").sum() == figures["goals_accepted"]
    exploring = run.phases[run.phases["phase"] == "explore"]
    assert (exploring["end_s"] - exploring["begin_s"]).sum() == pytest.approx(figures["exploration_time_s"])
    assert run.explored["coverage"].iloc[-1] == pytest.approx(figures["coverage"])
    assert run.truth["clearance_m"].min() <= figures["min_clearance_m"]
    assert len(run.decisions) > 0 and run.localization["accepted"].any()
    assert run.mission["policy"]["name"] == "nearest_frontier" and run.problems == []


def test_map_agrees_with_the_figures(run):
    pytest.importorskip("karst._maps")
    assert run.map.resolution_m == run.map_resolution_m
    assert run.map.free_volume_m3 == pytest.approx(run.metrics["explored_volume_m3"])
    assert read_map(run.folder / "map.bt").free_volume_m3 == pytest.approx(run.map.free_volume_m3)
    points = np.frombuffer((run.folder / "map.ply").read_bytes().partition(b"end_header\n")[2], "<f4")
    cells = run.map.cells()
    assert len(cells) == len(points) // 3
    np.testing.assert_allclose(np.sort(cells[:, 0]), np.sort(points.reshape(-1, 3)[:, 0]), atol=1e-4)
    final = {tuple(c) for c in np.rint(cells / 0.1).astype(int).tolist()}
    grown = {tuple(c) for c in np.rint(run.rock_at(1e9) / 0.1).astype(int).tolist()}
    assert len(final ^ grown) < 0.01 * len(final)  # the last scan may come after the last record


def test_trials_are_those_of_the_csv(campaign):
    pandas = pytest.importorskip("pandas")
    file = campaign.folder.parent / "trials.csv"
    run_karst(["results", campaign.folder, "--csv", file])
    table, trials = pandas.read_csv(file), campaign.trials
    assert len(trials) == 4
    for column in ("seed", "coverage_auc", "restricted_t90_s", "path_length_m", "wall_s"):
        np.testing.assert_allclose(trials[column], table[column])
    assert trials["contestant"].tolist() == table["contestant"].tolist()


def test_coverage_of_a_trial_is_its_curve(campaign):
    """The coverage over time that is computed here, against that which karst stored."""
    run = campaign.run("nearest_frontier", campaign.caves[0]["name"], 1)
    curves = campaign.curves
    stored = curves[(curves["contestant"] == "nearest_frontier") & (curves["seed"] == 1)]
    later = stored[stored["since_takeoff_s"] > 0]
    found = np.interp(later["since_takeoff_s"], run.explored["since_takeoff_s"], run.explored["coverage"])
    np.testing.assert_allclose(found, later["coverage"], atol=1e-6)


def test_verdict_agrees_with_the_trials(campaign):
    means = campaign.trials.groupby("contestant")["coverage_auc"].mean()
    verdict = campaign.verdict("nearest_frontier", "highest_frontier")
    assert campaign.metric == verdict.metric == "coverage_auc" and verdict.pairs == 2
    assert verdict.mean_a == pytest.approx(means["nearest_frontier"], abs=1e-5)
    assert verdict.difference == pytest.approx(verdict.mean_a - verdict.mean_b, abs=1e-5)
    assert verdict.better is None and verdict.sentence == campaign.sentence()
    ranking = campaign.ranking().set_index("contestant")
    assert ranking["mean"]["nearest_frontier"] == pytest.approx(verdict.mean_a, abs=1e-5)
    table = campaign.table()
    assert table["coverage_auc"]["highest_frontier"] == pytest.approx(means["highest_frontier"], abs=1e-5)
    assert campaign.heading("path_length_m") == "path length (m)"
    assert json.dumps(campaign.results)


def test_unknown_metric(campaign):
    with pytest.raises(Error, match="there is no figure called coverag"):
        campaign.ranking("coverag")


def test_plots_of_flights(run, campaign, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from karst import plots

    for plot in (plots.coverage, plots.plan, plots.heights, plots.battery, plots.speed):
        plot(run).figure.savefig(tmp_path / "run.png")
    for plot in (plots.coverage_curves, plots.paired_differences, plots.ranking):
        plot(campaign).figure.savefig(tmp_path / "campaign.png")
    matplotlib.pyplot.close("all")
