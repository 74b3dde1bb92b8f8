"""Flights one decision a step: the same bytes again, wrong actions, what closing leaves behind."""

import copy
import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import karst
import numpy as np
import pytest
from karst.environment import Environment, Environments
from short_flight import SHORT

SETTINGS = {k: v for k, v in SHORT.items() if k.startswith("mission")}


@pytest.fixture
def make(small_cave):
    """Environments that are closed after the test."""
    made = []

    def new(**options):
        made.append(Environment(options.pop("cave", small_cave),
                                **{"time_s": 25, "settings": SETTINGS} | options))
        return made[-1]

    yield new
    for environment in made:
        environment.close()


def fly_nearest(environment, seed=1):
    """Flies to the nearest to the end; all that was returned."""
    observation, info = environment.reset(seed=seed)
    returned = [(observation, None, False, False)]
    while True:
        action = 0 if observation["mask"][0] else karst.Explored("nothing near")
        observation, reward, terminated, truncated, info = environment.step(action)
        returned.append((observation, reward, terminated, truncated))
        if terminated or truncated:
            return returned, info


def same(a, b):
    assert len(a) == len(b)
    for (x, *one), (y, *other) in zip(a, b):
        assert one == other and x.keys() == y.keys()
        for key in x:
            np.testing.assert_array_equal(x[key], y[key])


def children() -> set[int]:
    """Processes of this one."""
    return {int(pid) for task in Path("/proc/self/task").iterdir() for pid in (task / "children").read_text().split()}


def test_same_seed_and_actions_fly_the_same_bytes(make, tmp_path):
    flights = []
    for name in "ab":
        environment = make(keep=tmp_path / name)
        returned, info = fly_nearest(environment)
        flights.append((returned, info["metrics"], environment.run_folder))
    (first, metrics, a), (second, again, b) = flights
    same(first, second)
    assert metrics == again and len(first) > 3
    for file in ("trajectory.tum", "map.ot", "events.jsonl"):
        assert (a / file).read_bytes() == (b / file).read_bytes()
    other, _ = fly_nearest(make(), seed=2)
    assert any((x[0]["vehicle"] != y[0]["vehicle"]).any() for x, y in zip(first, other))


def test_spaces_contain_what_is_returned(make):
    environment = make(max_frontiers=4)
    returned, info = fly_nearest(environment)
    for observation, *_ in returned:
        assert environment.observation_space.contains(observation)
        assert {k: (v.shape, v.dtype) for k, v in observation.items()} == {
            "vehicle": ((7,), np.float32), "frontiers": ((4, 10), np.float32), "mask": ((4,), np.int8)}
        offered = observation["mask"].sum()
        assert (observation["frontiers"][offered:] == 0).all()
        assert (np.diff(observation["frontiers"][:offered, 0]) >= 0).all()
    assert environment.action_space.contains(environment.action_space.sample())
    assert returned[-1][1] == 0 and "request" not in info and info["metrics"]["outcome"] == "landed"
    same(returned[-1:], [(returned[-2][0], *returned[-1][1:])])  # the observation is the last one


def test_reward_is_the_growth_of_free_space(make):
    environment = make()
    _, before = environment.reset()
    _, reward, _, _, after = environment.step(0)
    cells = after["request"].map.free_cells - before["request"].free_cells
    assert reward == pytest.approx(after["request"].map.resolution_m ** 3 * cells) and reward > 0
    environment = make(reward=lambda before, after: after.time_s - before.time_s)
    environment.reset()
    assert environment.step(0)[1] > 0


def test_terminated_and_truncated(make):
    environment = make(settings=SETTINGS | {"mission.explored_patience": "1 s"})
    environment.reset()
    for _ in range(20):
        *_, terminated, truncated, info = environment.step(karst.Explored("enough"))
        if terminated or truncated:
            break
    assert terminated and not truncated and info["metrics"]["outcome"] == "landed"
    environment.reset()
    *_, terminated, truncated, info = environment.step(karst.GoHome("enough"))
    assert terminated and not truncated
    returned, _ = fly_nearest(environment)  # the time is over first
    assert returned[-1][2:] == (False, True)
    with pytest.raises(karst.Error, match=r"^there is no flight: reset\(\) begins one$"):
        environment.step(0)


def test_reset_in_flight(make):
    environment = make()
    alone, _ = fly_nearest(environment)
    before = children()
    environment.reset(seed=5)
    environment.step(0)
    environment.reset(seed=5)  # into the folder of the flight that is given up
    again, _ = fly_nearest(environment)
    same(alone, again)
    assert children() <= before


def test_step_without_reset(make):
    with pytest.raises(karst.Error, match=r"there is no flight: reset\(\) begins one"):
        make().step(0)


@pytest.mark.parametrize("action, why", [
    (99, r"there is no frontier 99: \d+ are within reach"),
    (-1, "there is no frontier -1"),
    ([0, 99], "there is no frontier 99"),
    ("north", "an action is a frontier's number, a place"),
    (None, "an action is a frontier's number, a place"),
    (1.5, "an action is a frontier's number, a place"),
    ([], "an action is a frontier's number, a place"),
    (np.zeros(2), "an action is a frontier's number, a place"),
    (np.array([np.nan, 0, 0]), "goal 0: its position is not finite"),
    (karst.Goal([1, 2]), r"goal 0: position has the shape \(2,\), not \(3,\)"),
    ([karst.Goal([1, 2, 3]), 3], "goal 1 is an int, not a karst.Goal"),
    (karst.Fly([]), "there is no goal"),
    (karst.Hold(3), "reason is an int, not a text"),
])
def test_wrong_actions_change_nothing(flown, action, why):
    """Each is refused, and the flight goes on as if it had not been."""
    with pytest.raises(karst.Error, match=why):
        flown.step(action)
    assert flown._request.map.cells(flown._request.position)[0] == karst.Cell.FREE


@pytest.fixture(scope="module")
def flown(small_cave):
    with Environment(small_cave, time_s=25, settings=SETTINGS) as environment:
        environment.reset()
        yield environment
        assert environment.step(0)[4]["request"].sequence == 2  # after all the wrong ones


def test_kinds_of_actions(make):
    """The same first goal, said in several ways, flies the same."""
    seen = []
    for said in (
        lambda r, f: 0, lambda r, f: np.array(0), lambda r, f: [0], lambda r, f: karst.goal_at(f),
        lambda r, f: karst.Fly([karst.goal_at(f)], "why"),
    ):
        environment = make()
        _, info = environment.reset()
        request = info["request"]
        observation, *_ = environment.step(said(request, request.reachable()[0]))
        seen.append((observation, None))
        environment.close()
    for other in seen[1:]:
        same(seen[:1], [other])
    environment = make()
    _, info = environment.reset()
    place = np.append(info["request"].reachable()[0]["viewpoint"], 1.0)
    _, _, _, _, info = environment.step(place)
    np.testing.assert_allclose(info["request"].last_goal, place[:3])


def test_a_class_of_the_callers_own(make):
    class MyGoal(karst.Goal):
        pass

    environment = make()
    _, info = environment.reset()
    *_, after = environment.step([MyGoal(info["request"].reachable()[0]["viewpoint"])])
    assert after["request"].sequence == 2 and after["request"].last_fate != karst.Fate.NONE


def test_the_map_can_be_asked_until_the_step(make):
    environment = make()
    observation, info = environment.reset()
    request = info["request"]
    at = request.position
    assert request.map.cells([at]).tolist() == [karst.Cell.FREE]
    near = request.reachable()
    lengths = request.path_lengths(at, near["viewpoint"], 0.5)
    assert lengths.shape == (len(near),) and np.isfinite(lengths).all()
    assert (lengths >= np.linalg.norm(near["viewpoint"] - at, axis=1) - 0.5 - 1e-6).all()
    assert len(request.paths(at, near["viewpoint"][:2])) == 2
    assert request.newly_seen(np.append(at, 0.0), max_range_m=3).shape == (1,)
    assert request.random(3).shape == (3,) and request.survey is None and request.imaging_camera is None
    environment.step(0)
    for call in (lambda: request.map.cells([at]), lambda: request.paths(at, [at]), lambda: request.draw_points(at)):
        with pytest.raises(karst.Error, match="this request has ended: ask before the next step"):
            call()


def test_wrong_questions_do_not_confuse_the_flight(make):
    """A question with wrong types was never answered, and the next request came in its place."""
    environment = make()
    _, info = environment.reset()
    request = info["request"]
    for points, why in (("abc", r"cells\(\) takes no such arguments"), ([[1, 2]], r"must have the shape \(n, 3\)")):
        with pytest.raises(karst.Error, match=why):
            request.map.cells(points)
    with pytest.raises(karst.Error, match="keeps no copy of a map"):
        request.map.retained()
    with pytest.raises(karst.Error, match="no survey"):
        request.survey_distances([0, 0, 0])
    with pytest.raises(AttributeError):
        request._services.__deepcopy__
    assert copy.copy(request.map) is not None
    assert request.map.cells(request.position)[0] == karst.Cell.FREE
    assert environment.step(0)[4]["request"].sequence == 2


def test_a_long_step_does_not_end_the_policy(make):
    """A minute of learning between two steps counted as a policy that hangs, and the fallback flew on."""
    environment = make()
    environment.reset()
    mission = (environment.run_folder / "mission.info").read_text()
    assert "hang_limit \"3600 s\"" in mission or "hang_limit 3600" in mission.replace('"', ""), mission


def test_close_in_flight_leaves_nothing(small_cave, monkeypatch, tmp_path):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    before = children()
    environment = Environment(small_cave, time_s=25, settings=SETTINGS)
    environment.reset()
    environment.step(0)
    assert children() > before and list(tmp_path.iterdir())
    environment.close()
    environment.close()
    assert children() <= before and not list(tmp_path.iterdir())
    with pytest.raises(karst.Error, match="there is no flight"):
        environment.step(0)
    monkeypatch.setattr("tempfile.tempdir", None)


def test_a_program_that_ends_in_flight_leaves_nothing(small_cave, tmp_path):
    script = tmp_path / "learn.py"
    script.write_text(textwrap.dedent(f"""
        import sys
        from karst.environment import Environment
        environment = Environment({str(small_cave)!r}, time_s=25, settings={SETTINGS!r})
        environment.reset()
        print(environment._flight.pid, flush=True)
        environment.step(0)
        sys.exit(3)
    """))
    (tmp_path / "tmp").mkdir()
    done = subprocess.run([sys.executable, script], capture_output=True, text=True,
                          env=os.environ | {"TMPDIR": str(tmp_path / "tmp")})
    assert done.returncode == 3 and done.stderr == ""
    assert not os.path.exists(f"/proc/{int(done.stdout)}") and not list((tmp_path / "tmp").iterdir())


def test_a_flight_that_is_killed(make):
    environment = make()
    _, info = environment.reset()
    environment._flight.kill()
    environment._flight.wait()
    with pytest.raises(karst.Error, match="the flight has ended"):
        info["request"].map.cells([0, 0, 0])
    with pytest.raises(karst.Error, match="the flight ended with exit code -9"):
        environment.step(0)
    assert environment.reset()[1]["request"].sequence == 1


def test_two_in_parallel_fly_as_each_alone(make):
    alone = [fly_nearest(make(), seed)[0] for seed in (1, 2)]
    both = Environments([make(), make()])
    returned = [[(observation, None, False, False)] for observation, _ in both.reset([1, 2])]
    with pytest.raises(karst.Error, match="there is no frontier 99"):
        both.step([0, 99])  # neither flies on
    while any(not (r[-1][2] or r[-1][3]) for r in returned):
        actions = [
            None if r[-1][2] or r[-1][3] else 0 if r[-1][0]["mask"][0] else karst.Explored("nothing near")
            for r in returned
        ]
        for r, stepped in zip(returned, both.step(actions)):
            if stepped is not None:
                r.append(stepped[:4])
    for one, other in zip(alone, returned):
        same(one, other)


@pytest.mark.parametrize("options, why", [
    ({"settings": {"mission.nope": "1"}}, r"--set: mission.nope: no such key"),
    ({"settings": {"mission.decision_period": "soon"}}, r"mission.decision_period: expected"),
    ({"vehicle": "boat"}, r'simulator.vehicle: expected one of .*, got "boat"'),
    ({"time_s": -1}, r"max_flight_time: expected a number"),
    ({"seed": -1}, r"seed: expected a whole number"),
])
def test_bad_settings_are_named_by_the_program(make, options, why):
    environment = make(**options)
    with pytest.raises(karst.Error, match=f"^the flight ended before its first request: .*{why}"):
        environment.reset()
    assert environment._flight.returncode == 1


def test_what_cannot_be_an_environment(make, small_cave):
    for options, why in (({"cave": "no.info"}, "no.info: is not there"), ({"reward": "x"}, "there is no reward x"),
                         ({"max_frontiers": 0}, "max_frontiers must be 1 or more")):
        with pytest.raises(karst.Error, match=why):
            make(**options)
    with pytest.raises(karst.Error, match="no.info: no such cave file"):
        make().reset(options={"cave": "no.info"})


def test_kept_runs(make, tmp_path):
    environment = make(keep=tmp_path / "kept")
    _, info = fly_nearest(environment)
    environment.close()
    run = karst.load(info["run"])
    assert run.metrics == json.loads(json.dumps(info["metrics"])) and run.mission["policy"]["name"] == "environment"
