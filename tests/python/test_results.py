"""Runs read back: made-up ones, and damaged ones."""

import json

import numpy as np
import pytest
from karst.errors import Error
from karst.results import load
from karst.run import Run
from made_up_run import METRICS, write_run, write_team


@pytest.fixture
def folder(tmp_path):
    return write_run(tmp_path / "run")


def test_figures_and_settings(folder):
    run = load(folder)
    assert isinstance(run, Run)
    assert run.metrics == METRICS
    assert run.mission["map"]["resolution"] == "0.5 m" and run.mission["cave"]["start"] == ""
    assert run.mission_text.startswith("seed 3")
    assert run.timing["simulated_s"] == 4.0
    assert not run.is_locked and not run.is_team and run.robots == [] and run.problems == []


def test_columns_have_units(folder):
    run = load(folder)
    assert list(run.telemetry)[:8] == ["time_s", "phase", "x_m", "y_m", "z_m", "vx_mps", "vy_mps", "vz_mps"]
    assert list(run.localization)[:4] == ["time_s", "used_s", "accepted", "free_directions"]
    assert list(run.decisions) == ["time_s", "decide_ms", "plan_ms"]
    assert "battery_fraction" in run.truth
    assert list(run.truth_events)[:2] == ["time_s", "event"] and run.truth_events["y_m"][0] == 1
    assert list(run.trajectory) == ["time_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"]


def test_cells(folder):
    run = load(folder)
    assert run.telemetry["time_s"].tolist() == [0.5, 1.5, 2.5, 3.5]
    assert np.isnan(run.telemetry["explored_m3"][2]) and np.isnan(run.telemetry["heading_rad"][3])
    assert run.localization["accepted"].tolist() == [True, False]
    assert run.localization["planes"].dtype == int
    assert run.localization["problem"].tolist() == ["", 'few matches, "4" of 50']
    assert run.trajectory.shape == (41, 8) and run.trajectory["x_m"].max() == 2.0


def test_events(folder):
    run = load(folder)
    assert list(run.events)[:2] == ["time_s", "kind"] and len(run.events) == 10
    plan = run.events_of("plan").iloc[0]
    assert plan["length_m"] == 3.0 and plan["points_m"].shape == (2, 3)
    assert "length_m" not in run.events_of("goal")
    assert len(run.events_of("object")) == 0
    assert run.goals["state"].tolist() == ["accepted", "rejected"]
    assert run.goals["x_m"].tolist() == [3.0, 9.0] and run.goals["frontier"][0] == 7
    assert run.phases.values.tolist() == [["standby", 0, 1], ["explore", 1, 3], ["home", 3, 4]]
    assert run.takeoff_s == 1.0


def test_explored_volume_over_time(folder):
    table = load(folder).explored
    assert table["explored_m3"].tolist() == [10, 20, 40]
    assert table["since_takeoff_s"].tolist() == [-0.5, 0.5, 2.5]
    np.testing.assert_allclose(table["coverage"], [0.2, 0.4, 0.8])


def test_growth_of_the_map(folder):
    run = load(folder)
    growth = run.map_growth
    spans = {tuple(row) for row in growth.to_numpy().tolist()}
    # The cell 0 0 0 becomes rock twice, which is once; 1 0 0 is rock twice.
    assert spans == {
        (0.25, 0.25, 0.25, 1.0, np.inf),
        (0.75, 0.25, 0.25, 1.0, 2.0),
        (0.75, 0.25, 0.25, 3.0, np.inf),
        (-0.25, 1.25, 2.75, 1.5, np.inf),
    }
    assert [len(run.rock_at(t)) for t in (0.9, 1.0, 1.5, 2.0, 3.0)] == [0, 2, 3, 2, 3]


def test_growth_is_what_each_cell_says_by_itself(folder):
    """Against a dictionary of cells that is changed record by record, for random records."""
    random = np.random.default_rng(1)
    keys = random.integers(-2, 3, (4000, 3))
    times = np.sort(random.integers(1, 100000, 4000)) * random.choice([1, 1, -1], 4000)
    records = np.column_stack([keys, times]).astype("<i4")
    (folder / "map_growth.bin").write_bytes(records.tobytes())
    run = load(folder)
    rock, order = set(), iter(records.tolist())
    record = next(order, None)
    for moment_ms in (10000, 50000, 99999):
        while record is not None and abs(record[3]) <= moment_ms:
            (rock.add if record[3] > 0 else rock.discard)(tuple(record[:3]))
            record = next(order, None)
        found = np.rint(run.rock_at(moment_ms / 1000) / 0.5 - 0.5).astype(int)
        assert {tuple(k) for k in found.tolist()} == rock and len(found) == len(rock)


def test_team(tmp_path):
    run = load(write_team(tmp_path / "team"))
    assert run.is_team and [r.folder.name for r in run.robots] == ["robot_1", "robot_2"]
    assert run.robot_starts_s == [0.0, 40.0]
    assert run.events_of("team")["reach_m"][0] == 15.0
    assert run.explored["coverage"].tolist() == pytest.approx([0.16, 0.8])
    assert len(run.robots[1].trajectory) == 41
    for ask in ("trajectory", "phases", "map_growth", "decisions"):
        with pytest.raises(Error, match="Run.robots"):
            getattr(run, ask)


def test_missing_folder(tmp_path):
    with pytest.raises(Error, match="nowhere: is not there"):
        load(tmp_path / "nowhere")
    with pytest.raises(Error, match="neither a run nor a campaign"):
        load(tmp_path)
    with pytest.raises(Error, match="is not there"):
        Run(tmp_path / "nowhere")


def test_flight_that_was_cut_off(folder):
    """Killed in flight: no figures, no map, and half a line or record at the end of every file."""
    (folder / "metrics.json").unlink()
    for name in ("events.jsonl", "telemetry.csv", "trajectory.tum", "localization.csv", "map_growth.bin"):
        whole = (folder / name).read_bytes()
        (folder / name).write_bytes(whole[:-9])
    run = load(folder)
    with pytest.raises(Error, match=r"metrics.json: is not there: the flight was cut off; karst report"):
        run.metrics
    with pytest.raises(Error, match="map.ot: is not there"):
        run.map
    assert len(run.events) == 9 and len(run.telemetry) == 3 and len(run.trajectory) == 40
    assert len(run.localization) == 1 and len(run.map_growth) == 4
    assert len(run.problems) == 5 and all("cut off; left out" in p for p in run.problems)
    assert str(folder / "events.jsonl") + ": line 10" in run.problems[0]
    assert run.explored["coverage"].isna().all() and run.explored["explored_m3"].tolist() == [10, 20]
    (folder / "run.lock").touch()
    with pytest.raises(Error, match="a flight writes this folder, or was killed"):
        run.metrics


def test_last_line_that_was_not_written_whole(folder):
    """The power went off: the file has its length, but the last line's bytes are zeros."""
    with (folder / "events.jsonl").open("ab") as file:
        file.write(b"\0" * 40 + b"\n")
    run = load(folder)
    assert len(run.events) == 10 and "line 11" in run.problems[0]


@pytest.mark.parametrize(
    "name, ask, line, damage, message",
    [
        ("events.jsonl", "events", 3, '{"t": 1.5, "kind"', "line 3: is damaged"),
        ("events.jsonl", "events", 3, '{"t": "x", "kind": "goal"}', "line 3: is no JSON object with a "),
        ("events.jsonl", "events", 2, "[1, 2]", "line 2: is no JSON object"),
        ("telemetry.csv", "telemetry", 3, "1.5,explore,0,0", "line 3: has 4 cells instead of 16"),
        ("localization.csv", "localization", 2, "0.1,a,1,0,3,9,0,lidar,", "line 2, column used_s: .*\"a\""),
        ("trajectory.tum", "trajectory", 5, "0.4 0 0 1 0 0 0", "line 5: expected the eight numbers"),
        ("trajectory.tum", "trajectory", 7, "0.4 0 0 1 0 0 0 one", "line 7: expected the eight numbers"),
        ("metrics.json", "metrics", 1, '{"coverage": 0.8,', "line 1, column"),
        ("metrics.json", "metrics", 1, "[]", "is no JSON object"),
        ("mission.info", "mission", 5, '    start "', "line 5: a quoted text that does not end"),
        ("mission.info", "mission", 6, "", "line 3: the block that begins here does not end"),
        ("mission.info", "mission", 2, "}", "line 2: closes a block"),
        ("mission.info", "map_resolution_m", 9, "    resolution wide", "map.resolution: expected a length"),
    ],
)
def test_damage_names_file_and_line(folder, name, ask, line, damage, message):
    lines = (folder / name).read_text().split("\n")
    lines[line - 1] = damage
    (folder / name).write_text("\n".join(lines))
    run = load(folder)
    with pytest.raises(Error, match=message) as error:
        getattr(run, ask)
    assert str(error.value).startswith(str(folder / name) + ": ")
    assert len(run.decisions) == 1  # the rest can be read


def test_bytes_that_are_no_text(folder):
    (folder / "telemetry.csv").write_bytes(b"t_s,phase\n\xff\xfe\n")
    with pytest.raises(Error, match="telemetry.csv: byte 10: is no text in UTF-8"):
        load(folder).telemetry


def test_damaged_growth(folder):
    (folder / "map_growth.bin").write_bytes(np.array([0, 0, 0, 1, 1 << 30, 0, 0, 2], "<i4").tobytes())
    with pytest.raises(Error, match="map_growth.bin: byte 16: is damaged"):
        load(folder).map_growth


def test_empty_files(folder):
    for name in ("events.jsonl", "trajectory.tum", "map_growth.bin"):
        (folder / name).write_bytes(b"")
    run = load(folder)
    assert len(run.events) == 0 and len(run.trajectory) == 0 and len(run.map_growth) == 0
    assert len(run.goals) == 0 and len(run.phases) == 0 and np.isnan(run.takeoff_s)
    (folder / "telemetry.csv").write_bytes(b"")
    with pytest.raises(Error, match="telemetry.csv: line 1"):
        run.telemetry


def test_file_that_was_not_kept(folder):
    (folder / "decisions.csv").unlink()
    with pytest.raises(Error, match="decisions.csv: is not there"):
        load(folder).decisions


def test_settings_in_one_line_and_repeated_ones():
    from karst.mission_text import parse_info

    text = 'cave { file "a b.info" ; the first\n}\ncave { file c }\nname "say \\"x\\"\\n"\nbox 5 { edge 1 }\n'
    assert parse_info(text, "x") == {
        "cave": [{"file": "a b.info"}, {"file": "c"}],
        "name": 'say "x"\n',
        "box": {"": "5", "edge": "1"},
    }
    with pytest.raises(Error, match='x: line 1: "c" follows the value of a'):
        parse_info("a b c\n", "x")
    with pytest.raises(Error, match="blocks in each other"):
        parse_info("a {\n" * 200, "x")


def test_values_survive_json(folder):
    run = load(folder)
    assert json.loads(run.events.drop(columns=["position_m", "points_m", "from_m", "to_m"]).to_json())
