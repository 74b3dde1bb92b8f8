"""A tour over the viewpoints of the nearest frontiers: the order that makes the whole way short."""

import numpy as np

import karst


def length_m(path_m, order):
    """``path_m[i, j]``: from stop i to stop j. Stop 0 is where the vehicle is."""
    return sum(path_m[a, b] for a, b in zip(order, order[1:]))


def changed(order, i, j):
    """The order with stops i to j turned round (2-opt), with stop i moved to place j, and j to i (or-opt)."""
    before, part, after = order[:i], order[i : j + 1], order[j + 1 :]
    yield before + part[::-1] + after
    yield before + part[1:] + part[:1] + after
    yield before + part[-1:] + part[:-1] + after


def short_tour(path_m):
    """Always on to the nearest stop; then whatever small change makes the way shorter, until none does."""
    order, rest = [0], list(range(1, len(path_m)))
    while rest:
        nearest = min(range(len(rest)), key=lambda k: path_m[order[-1], rest[k]])
        # The one that was first takes the place of the nearest.
        rest[0], rest[nearest] = rest[nearest], rest[0]
        order.append(rest.pop(0))
    shorter = True
    while shorter:
        shorter = False
        for i in range(1, len(order) - 1):
            for j in range(i + 1, len(order)):
                for other in changed(order, i, j):
                    if length_m(path_m, other) < length_m(path_m, order) - 1e-6:
                        order, shorter = other, True
    return order


class MyTour(karst.Policy):
    """Visits the viewpoints of the nearest frontiers in a short tour."""

    stops = karst.Integer(12, 1, 30, "how many viewpoints a tour visits at the most: the nearest ones")
    min_cells = karst.Integer(10, 1, 10000, "smaller frontiers are ignored: they are seldom openings")

    def decide(self, request):
        near = request.reachable()
        near = near[near["cells"] >= self.min_cells][: self.stops]
        if len(near) == 0:
            return karst.Explored("no frontier can be reached")
        path_m = self.path_lengths(request, near)
        order = short_tour(path_m)
        total_m = length_m(path_m, order)
        stops = [near[stop - 1] for stop in order[1:]]
        places = np.array([f["viewpoint"] for f in stops])
        request.draw_lines(np.vstack([request.position, places[:-1]]), places, 0x40A0FF)
        return karst.Tour(
            karst.goal_at(f, -k, f"stop {k} of {len(stops)}, a tour of {total_m:.0f} m")
            for k, f in enumerate(stops, 1)
        )

    @staticmethod
    def path_lengths(request, near):
        """One question for each stop: a search finds the ways from one place to all the others.

        The way back to where the vehicle is does not count, as the tour is open. Where no way is known, it is
        taken as very long.
        """
        path_m = np.zeros((len(near) + 1, len(near) + 1))
        path_m[0, 1:] = near["path_length_m"]
        for i, place in enumerate(near["viewpoint"]):
            found = request.path_lengths(place, near["viewpoint"], request.map.resolution_m)
            path_m[i + 1, 1:] = np.where(np.isfinite(found), found, 1e4)
        return path_m
