"""A policy that asks another process for its answers: what `karst fly` flies for an environment.

The environment keeps one end of a pipe; the number of the other is in KARST_ENVIRONMENT_PIPE. Messages are
tuples: from here ("request", fields), ("said", value), ("refused", text); from there ("ask", of, name, arguments)
and ("answer", fields).
"""

from __future__ import annotations

import os
from multiprocessing.connection import Connection
from typing import Any

from karst import _hosted
from karst.errors import Error
from karst.policy import Policy

PIPE = "KARST_ENVIRONMENT_PIPE"


class Remote(Policy):
    """Asks the environment."""

    id = "environment"

    def activate(self) -> None:
        self._pipe = Connection(int(os.environ[PIPE]))

    def _answer(self, services: Any, fields: dict[str, Any]) -> tuple:
        try:
            self._pipe.send(("request", fields))
            while True:
                kind, *rest = self._pipe.recv()
                if kind == "answer":
                    return tuple(rest)
                self._pipe.send(_said(services, *rest))
        except (EOFError, OSError):
            os._exit(0)  # the environment is closed or begins anew: nobody wants this flight


def _said(services: Any, of: str, name: str, arguments: tuple) -> tuple[str, Any]:
    try:
        asked = services.map() if of == "map" else services
        return "said", getattr(asked, name)(*arguments)
    except Error as e:
        return "refused", str(e)
    except Exception as e:  # such as wrong types: the environment waits for an answer all the same
        return "refused", _hosted.told_of(e)[0]


class RemoteServices:
    """The services of a request in that process, with the names of karst._karst.Services."""

    def __init__(self, pipe: Connection):
        self._pipe = pipe
        self.ended = False

    def map(self) -> "RemoteMap":
        return RemoteMap(self)

    def ask(self, of: str, name: str, arguments: tuple) -> Any:
        if self.ended:
            raise Error("this request has ended: ask before the next step")
        try:
            self._pipe.send(("ask", of, name, arguments))
            kind, value = self._pipe.recv()
        except (EOFError, OSError):
            raise Error("the flight has ended") from None
        except Exception as e:  # nothing was sent
            raise Error(f"{name}() takes no such arguments: {e}") from None
        if kind == "refused":
            raise Error(value)
        return value

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # copy, pickle and the like look for such names
            raise AttributeError(name)
        return lambda *arguments: self.ask("services", name, arguments)


class RemoteMap:
    """The map there, with the names of karst._karst.Map."""

    def __init__(self, services: RemoteServices):
        self._services = services

    def retained(self) -> Any:
        raise Error("an environment keeps no copy of a map")

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return lambda *arguments: self._services.ask("map", name, arguments)
