"""Small run directories for tests: one flight of four seconds along x, with a map of a few cells."""

from __future__ import annotations

import json
import struct
from pathlib import Path

EVENTS = [
    {"t": 0.0, "kind": "phase", "phase": "standby", "reason": ""},
    {"t": 1.0, "kind": "phase", "phase": "explore", "reason": ""},
    {"t": 1.5, "kind": "decision", "outcome": "goals", "goals": 1, "frontiers": 2, "policy": "p"},
    {"t": 1.5, "kind": "goal", "position": [3.0, 0.0, 1.0], "heading": None, "frontier": 7, "score": 2.5,
     "state": "accepted", "why": "near", "reason": ""},
    {"t": 1.5, "kind": "plan", "length": 3.0, "from": [0, 0, 1], "to": [3, 0, 1],
     "points": [[0, 0, 1], [3, 0, 1]]},
    {"t": 2.0, "kind": "goal", "position": [9.0, 0.0, 1.0], "state": "rejected", "reason": "rock"},
    {"t": 3.0, "kind": "phase", "phase": "home", "reason": "battery"},
    {"t": 3.0, "kind": "homing", "reason": "battery", "distance": 3.0, "seconds_left": 9.0},
    {"t": 4.0, "kind": "phase", "phase": "done", "reason": ""},
    {"t": 4.0, "kind": "outcome", "outcome": "landed", "reason": "at the start", "mass_kg": 2.0},
]
TELEMETRY = """\
t_s,phase,x,y,z,vx,vy,vz,heading_rad,ref_x,ref_y,ref_z,battery_fraction,seconds_left,explored_m3,home_m
0.50,standby,0,0,0,0,0,0,0,0,0,0,1.0,600,10,0
1.50,explore,0,0,1,3,4,0,0,0,0,1,0.9,590,20,0
2.50,explore,3,0,1,1,0,0,0,3,0,1,0.8,580,,3
3.50,home,0,0,1,0,0,0,nan,0,0,1,0.7,570,40,0
"""
LOCALIZATION = """\
stamp_s,used_s,accepted,free_directions,edges,planes,residual_m,believed,problem
0.100,0.180,1,0,3,918,0.0026,lidar,
0.200,0.280,0,1,0,4,0.0300,magnetic,"few matches, ""4"" of 50"
"""
GROWTH = [  # key, time in ms; negative: the cell ceased to be rock
    (0, 0, 0, 1000), (1, 0, 0, 1000), (-1, 2, 5, 1500), (1, 0, 0, -2000), (1, 0, 0, 3000), (0, 0, 0, 3500),
]
MISSION = 'seed 3\ncave\n{\n    file caves/demo.info\n    start ""\n}\nmap\n{\n    resolution "0.5 m"\n}\n'
METRICS = {"schema": "karst.metrics/1", "policy": "p", "outcome": "landed", "coverage": 0.8, "t90_s": None}


def write_run(folder: Path) -> Path:
    """A run directory as a finished flight leaves it, without OctoMap files."""
    folder.mkdir(parents=True)
    for name, text in {
        "mission.info": MISSION,
        "events.jsonl": "".join(json.dumps(e) + "\n" for e in EVENTS),
        "telemetry.csv": TELEMETRY,
        "localization.csv": LOCALIZATION,
        "decisions.csv": "t_s,decide_ms,plan_ms\n1.50,20.016,14.741\n",
        "truth.csv": "time_s,clearance_m,speed_mps,battery,power_w\n0.0,0.5,0.0,1.0,30.0\n",
        "truth_events.jsonl": '{"time_s": 1.0, "event": "take-off", "x": 0, "y": 1, "z": 2, "detail": ""}\n',
        "trajectory.tum": "# t x y z qx qy qz qw\n"
        + "".join(f"{0.1 * i:.4f} {0.1 * min(i, 40 - i):.6f} 0 0.75 0 0 0 1\n" for i in range(41)),
        "ground_truth.tum": "0.0 0 0 1 0 0 0 1\n",
        "timing.json": '{"simulated_s": 4.0}',
        "metrics.json": json.dumps(METRICS),
    }.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "map_growth.bin").write_bytes(b"".join(struct.pack("<4i", *record) for record in GROWTH))
    return folder


def write_team(folder: Path) -> Path:
    """A team's run of two robots; the second one is switched on after 40 s."""
    for name in ("robot_1", "robot_2"):
        write_run(folder / name)
    events = [
        {"t": 0.0, "kind": "team", "robots": 2, "strategy": "relay_tree", "base": [0, 0, 1], "reach": 15.0},
        {"t": 0.0, "kind": "start", "robot": 1},
        {"t": 1.0, "kind": "phase", "phase": "explore", "robot": 1},
        {"t": 40.0, "kind": "start", "robot": 2},
    ]
    (folder / "team.jsonl").write_text("".join(json.dumps(e) + "\n" for e in events))
    (folder / "mission.info").write_text(MISSION)
    (folder / "telemetry.csv").write_text("t_s,phase,explored_m3\n1,flying,10\n44,flying,50\n")
    (folder / "metrics.json").write_text(json.dumps(METRICS))
    return folder
