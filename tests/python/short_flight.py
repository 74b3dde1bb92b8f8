"""Flights of a few simulated seconds, and what they leave behind."""

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from karst.program import program

# A second of computing each: a few decisions near the start.
SHORT = {
    "mission.home_reserve": "5 s",
    "mission.decision_period": "1 s",
    "mission.mapping_range": "10 m",
    "simulator.lidar.rate": "5 Hz",
    "simulator.pose.fitted": "always",
    "localization.source": "pose_sensor",
}


@dataclass
class Flight:
    code: int
    out: str
    err: str
    folder: Path

    @property
    def events(self) -> list[dict]:
        return [json.loads(line) for line in (self.folder / "events.jsonl").read_text().splitlines()]

    def of(self, kind: str) -> list[dict]:
        return [e for e in self.events if e["kind"] == kind]

    @property
    def printed(self) -> str:
        file = self.folder / "policy_output.txt"
        return file.read_text() if file.exists() else ""

    @property
    def landed(self) -> bool:
        return json.loads((self.folder / "metrics.json").read_text())["outcome"] == "landed"


def karst(*arguments, timeout_s=120, **environment) -> subprocess.CompletedProcess:
    # The flights find the module by themselves.
    env = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | environment
    return subprocess.run([str(program()), *map(str, arguments)], capture_output=True, encoding="utf-8",
                          errors="replace", stdin=subprocess.DEVNULL, timeout=timeout_s, check=False, env=env)


def fly(cave, policy, folder, *options, time_s=17, settings=SHORT, threads=1, **environment) -> Flight:
    command = ["fly", "--cave", cave, "--policy", policy, "--time", f"{time_s} s", "--out", folder, "--force",
               "--no-report", "--threads", threads, "--cave-cache", Path(cave).parent / "cache", *options]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    done = karst(*command, **environment)
    return Flight(done.returncode, done.stdout, done.stderr, Path(folder))
