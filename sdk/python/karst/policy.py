"""The base class of policies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .request import Request
from .values import answer_fields

if TYPE_CHECKING:
    from .request import Event
    from .values import Answer


class Policy:
    """Chooses where the vehicle flies next.

    Derive from it and write ``decide``. The class may say:

    ``id``: its name in a mission file, [a-z][a-z0-9_]*; the file's name without ``.py`` if it does not.
    ``name``: for people; the id if it does not say.
    ``version``: its own semantic version.

    The first line of its docstring is what `karst policy list` shows. Parameters are attributes
    (:class:`karst.Real` and the like). ``__init__`` takes no argument; values of parameters are there from
    ``init`` on.
    """

    version = "0.1.0"
    rng: np.random.Generator  #: numbers that are the same in every flight with the mission's seed

    def init(self) -> None:
        """Called once the parameters are set. Raise karst.Error if they contradict each other."""

    def activate(self) -> None:
        """Requests follow."""

    def decide(self, request: Request) -> Answer:
        """Goals, best first, or karst.Tour, karst.Hold, karst.Explored, karst.GoHome.

        An exception costs this decision: the vehicle goes on to its goal. The third in a row ends the policy.
        """
        raise NotImplementedError(f"{type(self).__name__} has no decide()")

    def on_event(self, event: Event) -> None:
        """What became of a goal, and other events between two requests. Ignore kinds that you do not know."""

    def deactivate(self) -> None:
        """No request follows."""

    def save(self) -> Any:
        """What it must remember if its process breaks: anything that pickle takes, at most a megabyte or so.

        Called after every decision, so it should take a millisecond at most. A policy that does not override
        it begins anew.
        """
        return None

    def restore(self, saved: Any) -> None:
        """What ``save`` returned before its process broke; called before ``activate``."""

    def _answer(self, services: Any, fields: dict[str, Any]) -> tuple:
        """As the host has it: see karst/_remote.py for another way."""
        return answer_fields(self.decide(Request(services, fields)))
