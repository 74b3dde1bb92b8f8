"""Python's side of a policy that the host calls: see binding/policy_table.cpp."""

from __future__ import annotations

import inspect
import pickle
import random
import re
import sys
import traceback
from pathlib import Path
from typing import Any

import numpy as np

from .errors import Error
from .parameters import parameters_of
from .policy import Policy
from .request import event_of

_OWN = str(Path(__file__).parent)
last_exception: BaseException | None = None  # for the bench, which raises from it


def description_of(policy: type[Policy]) -> dict[str, Any]:
    """What the class says of itself, as the ABI has it."""
    id = vars(policy).get("id") or policy_id(policy)
    name = vars(policy).get("name", id)
    for what, text in (("id", id), ("name", name), ("version", policy.version)):
        if not isinstance(text, str):
            raise Error(f"the {what} of {policy.__name__} is {text!r}, not a text")
    if not re.fullmatch("[a-z][a-z0-9_]*", id):
        raise Error(f"{id!r} is no id of a policy: small letters, digits and _, the first one a letter, are allowed")
    doc = inspect.getdoc(policy)
    if doc == inspect.getdoc(Policy):
        doc = None
    doc = doc or sys.modules[policy.__module__].__doc__ or ""
    return {
        "id": id,
        "name": name,
        "version": policy.version,
        "one_line": doc.strip().split("\n")[0],
        "parameters": [p.declaration() for p in parameters_of(policy)],
    }


def policy_id(policy: type) -> str:
    """The name of its file, or, in a notebook, of the class: MyNearest is my_nearest."""
    file = getattr(sys.modules.get(policy.__module__), "__file__", None)
    if file and policy.__module__ != "__main__":
        return Path(file).stem
    return policy_id_of_class(policy)


def policy_id_of_class(policy: type) -> str:
    name = policy.__name__
    return "".join("_" + c.lower() if c.isupper() and i > 0 else c.lower() for i, c in enumerate(name))


def create(policy: type[Policy], seed: list[float]) -> Policy:
    """A new object. ``seed``: numbers of the host in [0, 1)."""
    words = [int(number * 2**32) for number in seed]
    # A policy that draws from the modules' own streams is repeatable all the same.
    random.seed(words[0])
    np.random.seed(words[1])
    made = policy.__new__(policy)
    made.rng = np.random.default_rng(words)
    made.__init__()
    return made


def init(policy: Policy, values: dict[str, Any]) -> None:
    for name, value in values.items():
        setattr(policy, name, value)
    policy.init()


def decide(policy: Policy, services: Any, fields: dict[str, Any]) -> tuple:
    return policy._answer(services, fields)


def on_event(policy: Policy, kind: int, stamp_ns: int, goal: tuple, reason: str) -> None:
    policy.on_event(event_of(kind, stamp_ns, goal, reason))


def remembers(policy: Policy) -> bool:
    return type(policy).save is not Policy.save


def save(policy: Policy) -> bytes:
    return pickle.dumps(policy.save(), protocol=5)


def restore(policy: Policy, saved: bytes) -> None:
    policy.restore(pickle.loads(saved))


def told_of(exception: BaseException) -> tuple[str, list[str]]:
    """One line that says what was raised and where, and the traceback. Prints it as well."""
    global last_exception
    last_exception = exception
    parts = [part for part in traceback.format_exception(exception) if f'File "{_OWN}' not in part]
    if not any(part.startswith("  File") for part in parts):  # all of it is karst's own: what was raised says it
        parts = [part for part in parts if not part.startswith("Traceback")]
    lines = [_readable(line) for part in parts for line in part.rstrip("\n").split("\n")]
    print("\n".join(lines), file=sys.stderr, flush=True)
    return _readable(_line(exception)), lines


def _readable(text: str) -> str:
    """Without lone surrogates, which no text of the host can hold."""
    return text.encode("utf-8", "backslashreplace").decode()


def _line(exception: BaseException) -> str:
    try:
        text = str(exception).split("\n")[0]
    except Exception:
        text = "its text cannot be shown"
    call, wrong, _ = text.partition("(): incompatible function arguments")  # of the binding
    if wrong:
        text = f"{call}() takes no such arguments"
    kind = "" if isinstance(exception, Error) else type(exception).__name__
    what = ": ".join(part for part in (kind, text) if part)
    if isinstance(exception, SyntaxError) and exception.filename:
        return f"{Path(exception.filename).name}, line {exception.lineno}: {kind}: {exception.msg}"
    for frame in reversed(traceback.extract_tb(exception.__traceback__)):
        if not frame.filename.startswith(_OWN) and not frame.filename.startswith("<frozen"):
            return f"{what} ({Path(frame.filename).name}, line {frame.lineno}, in {frame.name})"
    return what
