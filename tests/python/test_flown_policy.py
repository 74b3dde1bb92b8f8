"""A policy in Python and the same in C++: the same flights, byte for byte, and the commands around policies."""

import json
import shutil
import subprocess
from pathlib import Path

import karst
import pytest
from short_flight import SHORT, fly
from short_flight import karst as run

ROOT = Path(__file__).parents[2]
PYTHON = ROOT / "examples/policies/python/my_nearest.py"
SAME = ("trajectory.tum", "events.jsonl", "map.ot", "metrics.json")
SETTINGS = SHORT | {"mission.mapping_range": "15 m"}


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    """The policy in C++."""
    compiler = shutil.which("g++")
    if compiler is None:
        pytest.skip("there is no g++")
    built = tmp_path_factory.mktemp("twin") / "my_nearest.so"
    subprocess.run([compiler, "-std=c++20", "-O2", "-shared", "-fPIC", "-fvisibility=hidden",
                    f"-I{ROOT}/sdk/include", f"-I{ROOT}/sdk/abi",
                    ROOT / "examples/policies/1_nearest/my_nearest.cpp", "-o", built], check=True)
    return built


@pytest.fixture(scope="module")
def flown(small_cave, tmp_path_factory):
    """Half a minute, recorded, of the policy in Python in a process of its own."""
    folder = tmp_path_factory.mktemp("flown") / "python"
    flight = fly(small_cave, PYTHON, folder, "--record-requests", time_s=30, settings=SETTINGS)
    assert flight.code == 0, flight.err
    return flight


def test_the_policy_decides(flown):
    own = [d for d in flown.of("decision") if d["policy"] == "my_nearest" and d["outcome"] == "goals"]
    assert flown.landed and len(own) >= 4 and flown.printed == ""
    assert {g["why"][-6:] for g in flown.of("goal") if g["state"] == "accepted"} == {"m away"}


@pytest.mark.parametrize("options", [[], ["--in-process"]], ids=["isolated", "in_process"])
@pytest.mark.parametrize("language", ["python", "c++"])
@pytest.mark.parametrize("threads", ["1", "4"])
def test_same_bytes(small_cave, twin, flown, tmp_path, language, options, threads):
    """In Python or C++, in a process of its own or in karst's, on one thread or on four."""
    flight = fly(small_cave, PYTHON if language == "python" else twin, tmp_path / "run", *options,
                 threads=threads, time_s=30, settings=SETTINGS)
    assert flight.code == 0, flight.err
    for name in SAME:
        assert (flight.folder / name).read_bytes() == (flown.folder / name).read_bytes(), name


def test_replay_gives_the_same_answers(flown, twin):
    for options in ([], ["--plugin", PYTHON], ["--plugin", twin]):
        done = run("policy", "replay", flown.folder, "--expect-same", "--json", *options)
        if not options and "my_nearest" in done.stderr and done.returncode == 1:
            continue  # it is not installed
        assert done.returncode == 0, done.stdout + done.stderr
    told = run("policy", "replay", flown.folder, "--plugin", PYTHON, "--set", "min_cells=10000", "--expect-same")
    assert told.returncode == 2 and "no frontier can be reached" in told.stdout


def test_policy_check(tmp_path):
    """What the program checks of any policy; without what takes long."""
    groups = ["entry", "lifecycle", "parameters", "goals", "requests.one_frontier", "requests.no_frontier",
              "requests.thousands", "state", "services", "determinism.repeat", "process"]
    done = run("policy", "check", PYTHON, "--json", *[w for g in groups for w in ("--test", g)])
    said = json.loads(done.stdout)
    failed = {t["name"]: t["figures"] if "figures" in t else t for t in said["tests"] if t["outcome"] == "failed"}
    assert done.returncode == 0 and said["passed"], failed
    assert sum(t["outcome"] == "passed" for t in said["tests"]) > 15


def test_policy_check_finds_faults(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text("import karst\nclass P(karst.Policy):\n    '''Wrong.'''\n"
                    "    def decide(self, request): return karst.Goal([1, 2])\n")
    done = run("policy", "check", file, "--test", "goals")
    assert done.returncode == 2 and "goal 0: position has the shape (2,), not (3,)" in done.stdout


def test_compare_and_go_on(small_cave, tmp_path):
    folder = tmp_path / "campaign"
    command = ["compare", PYTHON, "nearest_frontier", "--caves", small_cave, "--time", "20 s", "--jobs", "1",
               "--quiet", "--out", folder]
    done = run(*command, "--seeds", "1")
    assert done.returncode == 0, done.stderr
    trials = karst.load(folder).trials
    assert sorted(trials["contestant"]) == ["my_nearest", "nearest_frontier"]
    kept = {f: f.stat().st_mtime_ns for f in folder.rglob("metrics.json")}
    done = run("compare", folder, "--quiet")  # all is flown
    assert done.returncode == 0, done.stderr
    more = run(*command, "--seeds", "2")
    assert more.returncode == 0, more.stderr
    assert len(karst.load(folder).trials) == 4
    assert all(f.stat().st_mtime_ns == at for f, at in kept.items())  # those are not flown again


def test_a_changed_file_is_another_policy(small_cave, tmp_path):
    """A campaign does not go on with trials of two versions."""
    file = tmp_path / "mine.py"
    file.write_text(PYTHON.read_text())
    command = ["compare", file, "nearest_frontier", "--caves", small_cave, "--time", "20 s", "--jobs", "1",
               "--quiet", "--out", tmp_path / "campaign", "--seeds"]
    assert run(*command, "1").returncode == 0
    file.write_text(PYTHON.read_text().replace("[:10]", "[:9]"))
    done = run(*command, "2")
    assert done.returncode == 1 and "mine" in done.stderr, done.stderr


def test_policy_list_names_it(tmp_path):
    done = run("policy", "list", "--plugin", PYTHON)
    if done.returncode != 0:
        done = run("policy", "list", PYTHON)
    assert done.returncode == 0 and "Flies to the frontier with the shortest way to it" in done.stdout, done.stderr
