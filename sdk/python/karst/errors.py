"""The one kind of error that this package raises on purpose."""

from __future__ import annotations

from os import PathLike


class Error(Exception):
    """Bad input, or a command that failed. The text names the file, the place in it and the reason."""

    @classmethod
    def at(cls, file: str | PathLike[str], place: str, reason: str) -> "Error":
        """An error that reads "file: place: reason", as those of the karst program do."""
        return cls(f"{file}: {place}: {reason}" if place else f"{file}: {reason}")
