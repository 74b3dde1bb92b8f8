"""Flies to the frontier with the shortest way to it."""

import numpy as np

import karst


class MyNearest(karst.Policy):
    """Flies to the frontier with the shortest way to it."""

    version = "0.1.0"
    min_cells = karst.Integer(10, 1, 10000, "smaller frontiers are ignored: they are seldom openings")

    def decide(self, request):
        near = request.reachable()
        near = near[near["cells"] >= self.min_cells]
        if len(near) == 0:
            return karst.Explored("no frontier can be reached")
        score = -near["path_length_m"]
        best = np.lexsort((near["id"], -score))[:10]  # a fixed order where scores are equal
        return [karst.goal_at(near[i], score[i], f"{near['path_length_m'][i]:.1f} m away") for i in best]
