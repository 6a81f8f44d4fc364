"""``cellcolor.inspect`` and ``cellcolor.repair``: meshes of parts before they go into a scene."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from cellcolor.deadline import Deadline
from cellcolor.door.asked import Telling, Work, begun
from cellcolor.door.installed import extras_for
from cellcolor.errors import InputError, naming
from cellcolor.files.writing import path_of

if TYPE_CHECKING:
    from cellcolor.frontend.parts.inspection import Inspection
    from cellcolor.frontend.parts.repairing import RepairedPart


def inspect(
    part: Any,
    *,
    unit: str | None = None,
    **work: Unpack[Work],
) -> Inspection:
    """Report what a part's mesh has, what is wrong with it, and what a repair would change.

    Args:
        part: a mesh file (STL, OBJ, PLY), a ``trimesh.Trimesh``, or vertices (n, 3) and faces
            (m, 3).
        unit: ``m``, ``mm``, ``cm`` or ``in``; None for the likely one, which is reported.
        **work: :class:`~cellcolor.door.asked.Work`.

    Raises:
        InputError: it cannot be read or looked through; names file and element.
        OutOfTime: the time limit came first.
    """
    deadline, tell = begun(work)
    with _opened(part, deadline, tell) as (name, vertices, faces):
        from cellcolor.frontend.parts.inspection import inspect_mesh

        return inspect_mesh(name, vertices, faces, unit, deadline, tell)


def repair(
    part: Any,
    *,
    unit: str | None = None,
    fill_holes_m: float = 0.0,
    least_component: float = 0.01,
    edge_length_m: float | None = None,
    **work: Unpack[Work],
) -> RepairedPart:
    """A part's mesh repaired, so that a scene can use it.

    Args:
        part: as of :func:`inspect`.
        unit: ``m``, ``mm``, ``cm`` or ``in``; None for the likely one.
        fill_holes_m: holes with a border up to that length are filled.
        least_component: components with less than this share of the largest one's area are
            dropped.
        edge_length_m: remesh to edges of about that length; needs the extra ``parts``.
        **work: :class:`~cellcolor.door.asked.Work`.

    Raises:
        InputError: it cannot be read or made good; names file and element.
        OutOfTime: the time limit came first.
    """
    deadline, tell = begun(work)
    with _opened(part, deadline, tell) as (_, vertices, faces):
        from cellcolor.frontend.parts.mesh_file import UNITS, likely_unit
        from cellcolor.frontend.parts.repairing import repair_mesh

        reason = f"must be one of {', '.join(UNITS)}, is {unit!r}"
        if unit is None:
            extent = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 0.0
            unit, reason = likely_unit(extent)
        scale = UNITS.get(unit or "")
        if scale is None:
            raise InputError(None, "unit", reason)
        how = fill_holes_m, least_component, edge_length_m
        return repair_mesh(vertices, faces, scale, *how, deadline, tell)


@contextmanager
def _opened(part: Any, deadline: Deadline, tell: Telling) -> Iterator[tuple[str, Any, Any]]:
    """A part's name, vertices and faces; errors inside name its file and the extra they lack."""
    path = path_of(part) if isinstance(part, str | PathLike) else None
    name = "part" if path is None else path.name
    with naming(path), extras_for(name):
        from cellcolor.frontend.parts.mesh import ArraysObject
        from cellcolor.frontend.parts.mesh_file import read_mesh

        if path is None:
            own = ArraysObject.of(part)
            yield name, own.vertices, own.faces
            return
        tell("reading")
        yield name, *read_mesh(path, deadline)
