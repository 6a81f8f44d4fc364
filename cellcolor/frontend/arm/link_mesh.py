"""Mesh files of links, as vendors ship them: any triangles, read by trimesh."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import trimesh

from cellcolor.arrays import Array, Index
from cellcolor.errors import InputError

__all__ = ["load_link_mesh"]

_FORMATS = (".stl", ".obj", ".dae")


def load_link_mesh(file: Path, scale: tuple[float, ...]) -> tuple[Array, Index]:
    """Vertices (n, 3) in m and faces (m, 3) of a link's mesh, in the frame of its ``<collision>``.

    Vertices in one place are one; repeated faces and those without area are left out. Nothing else
    is asked of it. A Collada file's own unit counts; its up axis does not, as in RViz.

    Args:
        scale: meters per unit along x, y and z; of an odd number of negative ones the mesh is
            mirrored, and its faces are turned round.

    Raises:
        InputError: it cannot be read, or holds no triangles.
    """
    if file.suffix.lower() not in _FORMATS:
        raise InputError(str(file), None, "not a mesh format known here (STL, OBJ, DAE)")
    try:
        loaded = trimesh.load_mesh(file, process=False, skip_materials=True)
    except ImportError as error:
        message = "Collada files need the package pycollada: pip install pycollada"
        raise InputError(str(file), None, message) from error
    except Exception as error:  # trimesh and what it calls raise whatever comes up
        message = f"cannot be read as a mesh: {error or type(error).__name__}"
        raise InputError(str(file), None, message) from error
    units = np.array(scale) * (_collada_unit(file) if file.suffix.lower() == ".dae" else 1.0)
    mesh = trimesh.Trimesh(loaded.vertices * units, loaded.faces, process=False)
    if not np.isfinite(mesh.vertices).all():
        raise InputError(str(file), "vertices", "has numbers that are not finite")
    mesh.merge_vertices()
    mesh.update_faces(mesh.unique_faces() & mesh.nondegenerate_faces(height=None))
    mesh.remove_unreferenced_vertices()
    if not len(mesh.faces):
        raise InputError(str(file), "faces", "has no triangles")
    faces = np.array(mesh.faces, dtype=np.int64)
    if np.prod(scale) < 0:
        faces = faces[:, ::-1]
    return np.array(mesh.vertices), faces


def _collada_unit(file: Path) -> float:
    """Meters per unit of a Collada file, 1 where it does not say; trimesh leaves it out."""
    found = re.search(rb"""<unit\b[^>]*\bmeter\s*=\s*["']([^"']+)""", file.read_bytes())
    try:
        unit = 1.0 if found is None else float(found.group(1))
    except ValueError:
        unit = math.nan
    if not (math.isfinite(unit) and unit > 0):
        raise InputError(str(file), "asset.unit", "must be a positive number of meters")
    return unit
