"""Flies to the frontier with the shortest way to it."""

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
        return [karst.goal_at(f, -f["path_length_m"], f"{f['path_length_m']:.1f} m away") for f in near[:10]]
