"""A request as arrays of a fixed size, for what learns."""

from __future__ import annotations

import numpy as np

from .request import Request
from .spaces import Box, Dict

#: Columns of observation["frontiers"].
FRONTIER_COLUMNS = (
    "path_length_m", "forward_m", "left_m", "up_m", "normal_forward", "normal_left", "normal_up", "cells",
    "unknown_cells", "free_cells",
)
#: Entries of observation["vehicle"].
VEHICLE_ENTRIES = (
    "speed_mps", "up_mps", "from_start_m", "above_start_m", "seconds_before_homing", "battery_fraction",
    "frontiers",
)


def observation_space(max_frontiers: int) -> Dict:
    """Of what :func:`observation_of` returns."""
    return Dict(
        {
            "vehicle": Box(-np.inf, np.inf, (len(VEHICLE_ENTRIES),), np.float32),
            "frontiers": Box(-np.inf, np.inf, (max_frontiers, len(FRONTIER_COLUMNS)), np.float32),
            "mask": Box(0, 1, (max_frontiers,), np.int8),
        }
    )


def offered_frontiers(request: Request, max_frontiers: int) -> np.ndarray:
    """The rows of ``request.frontiers`` that an observation shows: those within reach, the nearest first."""
    return request.reachable()[:max_frontiers]


def observation_of(request: Request, max_frontiers: int) -> dict[str, np.ndarray]:
    """``vehicle`` (VEHICLE_ENTRIES), ``frontiers`` (max_frontiers, FRONTIER_COLUMNS), ``mask`` (max_frontiers,).

    Places and normals of frontiers are those of the viewpoint as seen from the vehicle: forward, left and up of
    its heading. Rows beyond the frontiers within reach are zero, and so is their mask.
    """
    near = offered_frontiers(request, max_frontiers)
    vehicle = np.array(
        [
            np.linalg.norm(request.velocity),
            request.velocity[2],
            np.linalg.norm(request.position - request.start_position),
            request.position[2] - request.start_position[2],
            min(request.seconds_before_homing, 1e6),
            request.battery_fraction,
            len(request.frontiers),
        ],
        np.float32,
    )
    cosine, sine = np.cos(request.heading_rad), np.sin(request.heading_rad)
    to_body = np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])
    rows = np.zeros((max_frontiers, len(FRONTIER_COLUMNS)), np.float32)
    n = len(near)
    rows[:n, 0] = near["path_length_m"]
    rows[:n, 1:4] = (near["viewpoint"] - request.position) @ to_body.T
    rows[:n, 4:7] = near["normal"] @ to_body.T
    rows[:n, 7] = near["cells"]
    rows[:n, 8] = near["unknown_cells"]
    rows[:n, 9] = near["free_cells"]
    mask = np.zeros(max_frontiers, np.int8)
    mask[:n] = 1
    return {"vehicle": vehicle, "frontiers": rows, "mask": mask}
