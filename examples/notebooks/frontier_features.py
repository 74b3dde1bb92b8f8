"""What a linear policy knows of a frontier: the columns of a matrix with a row for each frontier.

The training and the policy that it makes share this file. All columns are about 0 to 1 in size, so that their
weights can be compared.
"""

import numpy as np

import karst

#: The columns of features().
NAMES = ("path", "turn", "under_way", "unknown", "size", "gain", "rate", "off_path", "deeper", "up")
NEAREST_ONLY = np.array([-1.0] + [0.0] * (len(NAMES) - 1))  # the weights of "the nearest comes first"

CONSIDERED = 24  # the nearest frontiers; those farther away are ignored
LOOKED_AT = 8  # of these, the nearest: what their viewpoints would show costs most
GAIN_RANGE_M = 5.0
MOST_GAIN_M3 = 40.0
MIN_CELLS = 10
SAME_PLACE_M = 1.6  # the core moves a viewpoint a little when the map changes


class Features:
    """Keeps the way flown from one decision to the next."""

    def __init__(self):
        self.flown = np.empty((0, 3))

    def candidates(self, request):
        """The rows of request.frontiers that come into question, the nearest first."""
        near = request.reachable()
        return near[(near["cells"] >= MIN_CELLS) & (near["path_length_m"] > 0.6)][:CONSIDERED]

    def of(self, request, near):
        """(n, len(NAMES)) for the n frontiers `near`."""
        self.flown = np.vstack([self.flown, request.position])
        there = near["viewpoint"] - request.position
        straight_m = np.maximum(np.linalg.norm(there, axis=1), 1e-9)
        turn = 0.5 * (1 - there @ request.direction_of_flight / straight_m)
        flies_to_goal = request.last_fate == karst.Fate.UNDER_WAY
        under_way = flies_to_goal & (np.linalg.norm(near["viewpoint"] - request.last_goal, axis=1) < SAME_PLACE_M)
        around = near["unknown_cells"] + near["free_cells"].astype(float)
        off_path_m = np.linalg.norm(near["centroid"][:, None] - self.flown, axis=2).min(axis=1)
        gain_m3 = self._gain_m3(request, near)
        time_s = 1.5 + near["path_length_m"] / (0.75 * request.max_speed_mps) + 3 * turn
        from_start_m = request.path_lengths(
            request.start_position, np.vstack([near["viewpoint"], request.position]), request.clearance_m)
        known = np.isfinite(from_start_m)
        deeper_m = np.where(known, from_start_m, 0.0)[:-1] - np.where(known, from_start_m, 0.0)[-1]
        deeper_m = np.where(known[:-1] & known[-1], deeper_m, 0.0)
        return np.column_stack([
            near["path_length_m"] / 10,
            turn,
            under_way,
            near["unknown_cells"] / np.maximum(around, 1),
            np.log1p(near["cells"]) / 5,
            gain_m3 / 20,
            gain_m3 / time_s / 5,
            np.minimum(off_path_m, 6) / 6,
            np.clip(deeper_m, -20, 20) / 10,
            there[:, 2] / 5,
        ])

    def _gain_m3(self, request, near):
        """Unknown space in view of each viewpoint; of the far ones, the mean of the others."""
        some = near[:LOOKED_AT]
        viewpoints = np.column_stack([some["viewpoint"], some["viewpoint_heading_rad"]])
        cells = request.newly_seen(viewpoints, 0, GAIN_RANGE_M)
        gain_m3 = np.minimum(cells * request.map.resolution_m**3, MOST_GAIN_M3)
        return np.concatenate([gain_m3, np.full(len(near) - len(some), gain_m3.mean())])


def decide(features, weights, request, goals=8):
    """A policy's answer: the frontiers with the highest weighted sums, best first."""
    near = features.candidates(request)
    if len(near) == 0:
        return karst.Explored("no frontier can be reached")
    scores = features.of(request, near) @ weights
    best = np.lexsort((near["id"], -scores))[:goals]
    return [karst.goal_at(near[i], scores[i], f"{near['path_length_m'][i]:.1f} m away") for i in best]
