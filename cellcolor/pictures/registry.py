"""Every picture by name; ``cellcolor show --view NAME`` draws it (docs/how-to/add-a-picture.md)."""

from __future__ import annotations

from importlib.metadata import EntryPoint
from typing import TYPE_CHECKING

from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.pictures.interface import Picture

PICTURES = {
    "arm": "cellcolor.pictures.arm:ArmPicture",
    "cells": "cellcolor.pictures.by_cell_and_color:CellPicture",
    "color": "cellcolor.pictures.by_cell_and_color:ColorPicture",
    "graph": "cellcolor.pictures.topological_graph:GraphPicture",
    "plan": "cellcolor.pictures.by_plan:PlanPicture",
    "reasons": "cellcolor.pictures.by_reason:ReasonPicture",
    "segments": "cellcolor.pictures.by_segment:SegmentPicture",
    "why": "cellcolor.pictures.why_not_fewer:WhyNotFewerPicture",
}
"""The class of each, as ``module:name``; it is imported when somebody asks for the picture."""


def make_picture(name: str) -> Picture:
    """The picture of that name.

    Raises:
        InputError: there is none.
        ModuleNotFoundError: it needs an extra that is not installed.
    """
    if name not in PICTURES:
        raise InputError(None, "view", f"there is no {name!r}; there are {', '.join(PICTURES)}")
    picture: Picture = EntryPoint(name, PICTURES[name], "").load()()
    return picture
