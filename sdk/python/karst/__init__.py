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

from . import plots
from ._karst import abi as __abi__
from ._karst import version as __version__
from .campaign import Campaign, Verdict
from .environment import Environment, Environments
from .errors import Error
from .maps import read_map
from .parameters import Boolean, Integer, Real, Text
from .policy import Policy
from .program import run_karst
from .request import Cell, Event, EventKind, Fate, Map, Path, Request, Sensor, SensorKind, Survey
from .results import load
from .run import Run
from .values import Explored, Fly, Goal, GoHome, Hold, Tour, goal_at

__all__ = [
    "Boolean", "Campaign", "Cell", "Environment", "Environments", "Error", "Event", "EventKind", "Explored", "Fate",
    "Fly", "GoHome", "Goal", "Hold", "Integer", "Map", "Path", "Policy", "Real", "Request", "Run", "Sensor",
    "SensorKind", "Survey", "Text", "Tour", "Verdict", "goal_at", "load", "plots", "read_map", "run_karst",
]
