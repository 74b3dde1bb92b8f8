"""Imports of packages that only some functions need."""

from __future__ import annotations

import importlib
from types import ModuleType

from .errors import Error


def needed(module: str, what: str) -> ModuleType:
    """The module, or an Error that says how to install it. `what` names what needs it."""
    try:
        return importlib.import_module(module)
    except ImportError as e:
        package = module.partition(".")[0]
        raise Error(
            f"{what} needs the Python package {package} ({e}): apt-get install python3-{package}, "
            f"or pip install {package}"
        ) from e
