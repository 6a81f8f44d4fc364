"""Every picture by name; ``cellcolor show --view NAME`` draws it (docs/how-to/extend.md).

A picture is a function. The names of its parameters say what it is drawn of:

=================  =============================================================================
``surface``        the labelled surface
``graph``          the topological graph
``decomposition``  the topological graph, and where it lies on the surface
``solution``       a solution of the graph with a division, which the checker has found valid
``verdicts``       what came of verifying the bounds of this solution on the surface
``plan``           one color for each vertex of the surface, valid or not
``reasons``        what became of every candidate of the scene that the surface was built from
``build``          all that the front end found when it built the scene
``color``          the number of a color of the surface
``branch``         the number of an inverse-kinematic branch
``vertex``         the index of a vertex of the surface
``marked``         indices of vertices of the plan that are pointed at
=================  =============================================================================

An option of ``show`` with a default is passed only where it is given; nothing else has a default.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import EntryPoint
from typing import TYPE_CHECKING

from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.pictures.picture import Picture2D, Picture3D

PICTURES = {
    "arm": "cellcolor.pictures.arm:draw_arm",
    "cells": "cellcolor.pictures.surface_pictures:draw_cells",
    "color": "cellcolor.pictures.surface_pictures:draw_color",
    "graph": "cellcolor.pictures.topological_graph:draw_graph",
    "plan": "cellcolor.pictures.surface_pictures:draw_plan",
    "reasons": "cellcolor.pictures.surface_pictures:draw_reasons",
    "segments": "cellcolor.pictures.surface_pictures:draw_segments",
    "why": "cellcolor.pictures.why_not_fewer:draw_why",
}
"""The function of each, as ``module:name``; it is imported when somebody asks for the picture."""


@dataclass(frozen=True)
class Picture:
    """A picture's function, and the names of its parameters.

    Attributes:
        draw: called with parts by name. It raises InputError where these parts cannot be drawn
            together, and names the part.
        needs: what it cannot be drawn without.
        takes: options that it uses besides, where they are given.
    """

    draw: Callable[..., Picture2D | Picture3D]
    needs: tuple[str, ...]
    takes: tuple[str, ...]


def make_picture(name: str) -> Picture:
    """The picture of that name.

    Raises:
        InputError: there is none.
        ModuleNotFoundError: it needs an extra that is not installed.
    """
    if name not in PICTURES:
        raise InputError(None, "view", f"there is no {name!r}; there are {', '.join(PICTURES)}")
    draw = EntryPoint(name, PICTURES[name], "").load()
    parameters = inspect.signature(draw).parameters.values()
    needs = tuple(one.name for one in parameters if one.default is one.empty)
    takes = tuple(one.name for one in parameters if one.default is not one.empty)
    return Picture(draw, needs, takes)
