"""Labelled surfaces from joint solutions in files, without a robot."""

from __future__ import annotations

from math import pi
from os import PathLike

from cellcolor.configurations.files import read_joint_solutions
from cellcolor.configurations.labelling import Conflicts, Labelling, from_configurations
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import naming
from cellcolor.files.paths import path_of


def label(
    source: str | PathLike[str],
    *,
    mesh: str | PathLike[str] | None = None,
    conflicts: Conflicts = "refuse",
    reach_m: float | None = None,
    deadline: Deadline = NEVER,
) -> Labelling:
    """A labelled surface from a file of joint solutions.

    Args:
        source: ``.npz``, ``.json`` or ``.csv``
            (:func:`~cellcolor.configurations.files.read_joint_solutions`).
        mesh: an OBJ, PLY or STL file in m, for ``.csv``, whose vertices are numbered from 0 in the
            order of this file.
        conflicts: see :func:`~cellcolor.configurations.labelling.from_configurations`.
        reach_m: of the arm, see there.
        deadline: when to give up.

    Raises:
        InputError: see there; names the file.
        OutOfTime: the deadline came first.
    """
    path = path_of(source)
    own = None
    if mesh is not None:
        from cellcolor.frontend.parts.mesh_file import read_mesh

        own = read_mesh(path_of(mesh), deadline)
    found = read_joint_solutions(path, None if own is None else len(own[0]))
    vertices, faces = (found.vertices, found.faces) if own is None else own
    with naming(path):
        assert vertices is not None  # only a CSV file has no mesh, and it was read with one
        assert faces is not None
        return from_configurations(
            vertices,
            faces,
            found.configurations,
            names=found.names,
            limits=found.limits,
            periods=2 * pi if found.periods is None else found.periods,
            conflicts=conflicts,
            reach_m=reach_m,
            name=path.stem,
            deadline=deadline,
        )
