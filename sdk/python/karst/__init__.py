"""karst: exploration policies for cave-flying UAVs, their flights, and an environment to learn in.

A policy is a class in a file::

    import karst

    class MyNearest(karst.Policy):
        \"\"\"Flies to the nearest frontier.\"\"\"

        def decide(self, request):
            nearest = request.reachable()[:10]
            if len(nearest) == 0:
                return karst.Explored("no frontier can be reached")
            return [karst.goal_at(f, score=-f["path_length_m"]) for f in nearest]

``karst fly --policy my_nearest.py`` flies it. ``karst.load("runs/demo")`` reads a flight or a campaign.
World frame: x east, y north, z up. Metres, seconds, radians.
"""

from karst.errors import Error
from karst.parameters import Boolean, Integer, Real, Text
from karst.policy import Policy
from karst.request import Cell, Event, EventKind, Fate, Map, Path, Request, Sensor, SensorKind
from karst.values import Explored, Fly, Goal, GoHome, Hold, Tour, goal_at

__all__ = [
    "Boolean", "Cell", "Error", "Event", "EventKind", "Explored", "Fate", "Fly", "GoHome", "Goal", "Hold",
    "Integer", "Map", "Path", "Policy", "Real", "Request", "Sensor", "SensorKind", "Text", "Tour", "goal_at",
]
