"""Reading back what karst wrote."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from .campaign import Campaign, is_campaign
from .errors import Error
from .run import Run, is_run


def load(folder: str | PathLike[str]) -> Run | Campaign:
    """The run of one vehicle or of a team, or the campaign, that is in the folder.

    Files are read when they are asked for: only the kind of the folder is looked at here. Raises Error if it
    is neither.
    """
    path = Path(folder)
    if is_campaign(path):
        return Campaign(path)
    if is_run(path):
        return Run(path)
    if not path.exists():
        raise Error.at(path, "", "is not there")
    raise Error.at(path, "", "is neither a run nor a campaign: it has no mission.info and no campaign.sqlite")
