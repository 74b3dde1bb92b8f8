"""Where the karst program is, and how it is run."""

from __future__ import annotations

import functools
import os
import re
import shutil
import signal
import subprocess
from collections.abc import Sequence
from pathlib import Path

from ._karst import version
from .errors import Error


def program() -> Path:
    """The karst program to run.

    It is the one that the environment variable KARST names, else the one that was installed with this
    package, else the one on the PATH. Raises Error, which says where it was looked for, or that it is of
    another version than this module.
    """
    found = _found()
    said = _version_of(str(found))
    if said != version:
        raise Error.at(found, "", f"is version {said}, and this module is {version}: install one of them anew")
    return found


@functools.cache
def _version_of(file: str) -> str:
    try:
        said = subprocess.run([file, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    except OSError as e:
        raise Error.at(file, "", f"cannot be run: {e.strerror}") from e
    number = re.search(r"\d+\.\d+\.\d+", said.stdout)
    return number[0] if number else "unknown"


def _found() -> Path:
    named = os.environ.get("KARST")
    if named:
        found = shutil.which(named)
        if found is None:
            raise Error.at("KARST", named, "is no program; this environment variable names the karst program")
        return Path(found)
    # The package lies in PREFIX/lib/karst/python/karst.
    beside = Path(__file__).resolve().parents[4] / "bin" / "karst"
    if os.access(beside, os.X_OK) and beside.is_file():
        return beside
    found = shutil.which("karst")
    if found is None:
        raise Error(
            "the karst program was not found: the environment variable KARST is not set, "
            f"{beside} is no program, and there is no karst on the PATH"
        )
    return Path(found)


def run_karst(args: Sequence[str | os.PathLike[str]]) -> str:
    """Runs karst with these arguments and returns what it prints.

    Raises Error with the program's own message if it fails, or if there is no program.
    """
    command = [str(program()), *map(os.fspath, args)]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8",
                              errors="replace", check=False)
    except OSError as e:
        raise Error.at(command[0], "", f"cannot be run: {e.strerror}") from e
    if done.returncode < 0:
        raise Error(f"{' '.join(command)}: was ended by {_signal_name(-done.returncode)}")
    if done.returncode > 0:
        said = done.stderr.strip() or done.stdout.strip() or f"exit code {done.returncode}, without a message"
        raise Error(said.removeprefix("karst: "))
    return done.stdout


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
