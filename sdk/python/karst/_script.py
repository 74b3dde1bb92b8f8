"""The policies of a file: what `karst fly --policy FILE.py` opens."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import inspect
import os
import io
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from . import _hosted, _karst
from .errors import Error
from .policy import Policy

_plugins: dict[str, Any] = {}  # by path: the host may open a file more than once

# The process has no locale, and what a policy prints goes into a pipe: each line at once, whatever is in it.
for _stream in (sys.stdout, sys.stderr):
    if isinstance(_stream, io.TextIOWrapper):
        _stream.reconfigure(encoding="utf-8", errors="backslashreplace", line_buffering=True)


def plugin_of_file(path: str) -> Any:
    """A capsule with the plugin. Raises Error with what the host says after the file's name."""
    key = os.path.abspath(path)  # not what a link leads to: the policy is named by the file that was given
    if key not in _plugins:
        _plugins[key] = _karst.plugin_of(policies_of(module_of(key)))
    return _plugins[key]


def module_of(path: str) -> ModuleType:
    """Runs the file as a module. Modules beside it can be imported."""
    name = Path(path).stem
    if _is_taken(name, path):
        name = f"karst_policy_{len(_plugins)}_{name.replace('.', '_')}"
    folder = str(Path(path).parent)
    if folder not in sys.path:
        sys.path.append(folder)
    loader = importlib.machinery.SourceFileLoader(name, path)  # whatever a link to it ends in
    spec = importlib.util.spec_from_file_location(name, path, loader=loader)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses and pickle look there
    try:
        spec.loader.exec_module(module)
    except BaseException as e:
        del sys.modules[name]
        raise Error(_hosted.told_of(e)[0]) from e
    return module


def _is_taken(name: str, path: str) -> bool:
    """Whether another module has the name: one of Python's, which others may import later, or another policy."""
    if name in sys.modules or "." in name:
        return True
    try:
        found = importlib.util.find_spec(name)
    except (ImportError, ValueError):
        return False
    return found is not None and found.origin != path


def policies_of(module: ModuleType) -> list[type[Policy]]:
    """The classes of policies that the file itself defines; else its function `decide`."""
    own = [
        value
        for value in dict.fromkeys(v for v in vars(module).values() if inspect.isclass(v))  # once under two names
        if issubclass(value, Policy) and value.__module__ == module.__name__
        and _names(value) & {"decide", "_answer"}
    ]
    # A class from which another of the file derives is a base, and no policy of its own.
    own = [c for c in own if not any(c is not other and issubclass(other, c) for other in own)]
    if own:
        for policy in own:
            if len(own) > 1 and "id" not in vars(policy):
                policy.id = _hosted.policy_id_of_class(policy)
        return own
    if inspect.isfunction(getattr(module, "decide", None)):
        return [_from_function(module)]
    for value in vars(module).values():
        if inspect.isclass(value) and issubclass(value, Policy) and value.__module__ == module.__name__:
            raise Error(f"holds no policy: the class {value.__name__} has no decide(self, request)")
    raise Error("holds no policy: a class that derives from karst.Policy, or a function decide(request)")


def _names(policy: type) -> set[str]:
    """What the class and its bases below Policy define."""
    return {name for base in policy.__mro__ if base is not Policy and issubclass(base, Policy)
            for name in vars(base)}


def _from_function(module: ModuleType) -> type[Policy]:
    """A policy without a state."""
    decide = module.decide
    doc = decide.__doc__ or module.__doc__
    attributes = {
        "decide": lambda self, request: decide(request),
        "__doc__": doc,
        "__module__": module.__name__,
        "id": getattr(module, "id", Path(module.__file__).stem),
        "version": getattr(module, "version", Policy.version),
    }
    return type("Decide", (Policy,), attributes)
