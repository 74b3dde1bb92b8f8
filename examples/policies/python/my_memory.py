"""Explores branch by branch: on to what was found last, back to older openings later.

It remembers, from one decision to the next, when each frontier was first seen, what it flies to, and where it went in
vain; and it still does after a crash.
"""

import numpy as np

import karst

SAME_PLACE_M = 0.8
KEPT_BONUS_S = 8.0  # nearly equal goals must not take turns

FAILED = (karst.EventKind.GOAL_REJECTED, karst.EventKind.GOAL_UNREACHABLE, karst.EventKind.GOAL_ABANDONED)


class MyMemory(karst.Policy):
    """Explores branch by branch: what was found last comes first."""

    min_cells = karst.Integer(10, 1, 10000, "smaller frontiers are ignored: they are seldom openings")
    seconds_per_metre = karst.Real(1.0, 0, 100, "", "how much older a frontier seems for a metre of way")
    rest = karst.Real(20.0, 0, 3600, "s", "a place where a goal came to nothing is left alone for this long")

    def __init__(self):
        self.first_seen_s = {}  # by id of the frontier
        self.failed = []  # positions, and when
        self.under_way = 0  # the frontier flown to; 0: none

    def decide(self, request):
        now_s = request.time_s
        for id in request.frontiers["id"]:
            self.first_seen_s.setdefault(int(id), now_s)
        near = request.reachable()
        near = near[near["cells"] >= self.min_cells]
        goals, some_rest = [], False
        for f in near:
            if self.rests(f["viewpoint"], request.stamp_ns):
                some_rest = True
                continue
            age_s = now_s - self.first_seen_s[int(f["id"])]
            is_kept = f["id"] == self.under_way
            why = f"seen for {age_s:.0f} s, {f['path_length_m']:.1f} m away" + (", under way" if is_kept else "")
            bonus_s = KEPT_BONUS_S if is_kept else 0.0
            goals.append(karst.goal_at(f, bonus_s - age_s - self.seconds_per_metre * f["path_length_m"], why))
        if not goals:
            if some_rest:
                return karst.Hold("what is left was tried a short while ago")
            return karst.Explored("no frontier can be reached")
        goals.sort(key=lambda goal: (-goal.score, goal.frontier_id))
        self.under_way = goals[0].frontier_id
        return goals[:10]

    def on_event(self, event):
        if event.kind in FAILED:
            self.failed.append((event.goal.position, event.stamp_ns))
        elif event.kind != karst.EventKind.GOAL_REACHED:
            return  # also for kinds that later versions add
        if event.goal.frontier_id == self.under_way:
            self.under_way = 0

    def save(self):
        return self.first_seen_s, self.failed, self.under_way

    def restore(self, saved):
        self.first_seen_s, self.failed, self.under_way = saved

    def rests(self, place, now_ns):
        return any(
            np.linalg.norm(position - place) < SAME_PLACE_M and 1e-9 * (now_ns - since_ns) < self.rest
            for position, since_ns in self.failed
        )
