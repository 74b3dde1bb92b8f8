"""What plots show, and what their axes say. How they look was looked at once, not here."""

import numpy as np
import pytest
from karst.errors import Error
from karst.results import load
from made_up_campaign import NAMES, write_campaign
from made_up_run import write_run, write_team

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

from karst import plots  # noqa: E402


@pytest.fixture
def run(tmp_path):
    return load(write_run(tmp_path / "run"))


@pytest.fixture
def team(tmp_path):
    return load(write_team(tmp_path / "team"))


@pytest.fixture
def campaign(tmp_path, monkeypatch):
    monkeypatch.setenv("KARST", str(tmp_path / "bin/karst"))
    return load(write_campaign(tmp_path / "made", tmp_path / "bin/karst"))


@pytest.fixture(autouse=True)
def close_figures():
    yield
    matplotlib.pyplot.close("all")


def labels(ax):
    return ax.get_xlabel(), ax.get_ylabel()


def test_axes_are_named_with_units(run):
    time = "time from take-off (s)"
    assert labels(plots.coverage(run)) == (time, "coverage (%)")
    assert labels(plots.battery(run)) == (time, "battery left (%)")
    assert labels(plots.speed(run)) == (time, "speed (m/s)")
    assert labels(plots.plan(run)) == ("east x (m)", "north y (m)")
    assert labels(plots.heights(run)) == ("distance flown (m)", "height z (m)")


def test_given_axes_are_used(run):
    _, ax = matplotlib.pyplot.subplots()
    for plot in (plots.coverage, plots.battery, plots.speed, plots.plan, plots.heights):
        assert plot(run, ax) is ax


def test_curves(run):
    line = plots.coverage(run).lines[0]
    np.testing.assert_allclose(line.get_xydata(), [[-0.5, 20], [0.5, 40], [2.5, 80]])
    np.testing.assert_allclose(plots.speed(run).lines[0].get_ydata(), [0, 5, 1, 0])
    np.testing.assert_allclose(plots.battery(run).lines[0].get_ydata(), [100, 90, 80, 70])


def test_volume_where_coverage_is_not_known(run):
    (run.folder / "metrics.json").unlink()
    assert plots.coverage(run).get_ylabel() == "explored volume (m³)"


def test_plan_has_path_goals_and_rock(run):
    ax = plots.plan(run)
    drawn = {line.get_label(): line for line in ax.lines}
    assert set(drawn) == {"path out", "path home", "goal, refused or given up", "start"}
    assert drawn["goal, refused or given up"].get_xydata().tolist() == [[9.0, 0.0]]
    image = ax.images[0]
    assert tuple(image.get_extent()) == (-0.5, 1.0, 0.0, 1.5)
    assert (image.get_array()[..., 3] > 0).sum() == 3  # three columns with rock
    (run.folder / "map_growth.bin").unlink()
    assert len(plots.plan(load(run.folder)).images) == 0


def test_height_profile_has_floor_and_ceiling(run):
    records = [[x, 0, z, 100] for x in range(0, 3) for z in (-1, 4, 6)]  # rock at z -0.5..0, 2..2.5, 3..3.5
    (run.folder / "map_growth.bin").write_bytes(np.array(records, "<i4").tobytes())
    ceiling, floor, path = plots.heights(run).lines
    x = np.array(path.get_xdata())
    known = x <= 0.4  # the path has come to x = 1.0 + 0.4 m by then; rock ends at 1.5 m
    assert set(np.array(floor.get_ydata())[known]) == {0.0}
    assert set(np.array(ceiling.get_ydata())[known]) == {2.0}
    middle = (x > 0.55) & (x < 1.2)
    assert np.isnan(np.array(floor.get_ydata())[middle]).all()


def test_team(team):
    assert len(plots.plan(team).lines) == 2
    first, second = plots.battery(team).lines
    assert second.get_xdata()[0] - first.get_xdata()[0] == 40
    assert plots.coverage(team).get_ylabel() == "coverage (%)"
    with pytest.raises(Error, match="Run.robots"):
        plots.heights(team)


def test_nothing_was_flown(run):
    (run.folder / "trajectory.tum").write_text("")
    with pytest.raises(Error, match="trajectory.tum: has no pose"):
        plots.plan(run)


def test_coverage_curves(campaign):
    ax = plots.coverage_curves(campaign)
    assert labels(ax) == ("time from take-off (s)", "coverage (%): median and quartiles")
    far, near = ax.lines
    assert [far.get_label(), near.get_label()] == NAMES
    reached = dict(zip(np.round(far.get_xdata(), 1), far.get_ydata()))
    assert reached[36.0] == 40 and reached[45.0] == 80  # three, then four of six flights have reached 80 %
    with pytest.raises(Error, match="no flight in such a cave; the caves are maze"):
        plots.coverage_curves(campaign, "tunnel")


def test_paired_differences(campaign):
    ax = plots.paired_differences(campaign)
    assert "far_first minus near|first" in ax.get_xlabel() and "percentage points" in ax.get_xlabel()
    marks = [line for line in ax.lines if line.get_marker() == "o"]
    np.testing.assert_allclose(marks[0].get_xdata(), [10] * 5)  # one of six pairs has a failed flight
    mean = next(line for line in ax.lines if line.get_marker() == "D")
    assert mean.get_xdata() == pytest.approx([11.2]) and mean.get_fillstyle() == "full"
    assert ax.get_title(loc="left") == "a difference is shown"


def test_ranking(campaign):
    ax = plots.ranking(campaign)
    assert [t.get_text() for t in ax.get_yticklabels()] == NAMES
    assert ax.get_xlabel() == "coverage averaged over the flight (%)"
    means = [line.get_xdata()[0] for line in ax.lines if len(line.get_xdata()) == 1]
    assert means == pytest.approx([51.2, 40.0])
