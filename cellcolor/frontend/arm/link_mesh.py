"""Mesh files of links, as vendors ship them: where they are, and what is in them.

A URDF names them by ``package://``, ``file://`` or relative names. A package is a folder with a
``package.xml`` that has its name, or, without such a file, a folder of that name.
"""

from __future__ import annotations

import math
import os
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import trimesh

from cellcolor.arrays import Array, Index
from cellcolor.errors import InputError

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


_ROS = "ROS_PACKAGE_PATH"
_DEEPEST = 4  # folders below a given one that packages are looked for in


def find_mesh(
    named: str, file: Path, field: str, folder: Path, package_folders: Sequence[Path]
) -> Path:
    """The file of a mesh.

    Args:
        named: what the URDF calls it.
        file, field: the URDF and the element, for errors.
        package_folders: packages, or folders that have some, asked first.

    Raises:
        InputError: there is no such file; says what was tried.
    """
    parts, places = urlsplit(named), iter([folder / named])
    if parts.scheme == "package":
        inside = unquote(parts.path.lstrip("/"))
        places = (root / inside for root in _roots(parts.netloc, folder, package_folders))
    elif parts.scheme == "file":
        places = iter([Path(unquote(parts.path))])
    elif len(parts.scheme) > 1:  # one letter is a drive of Windows
        message = f"{named!r}: only package://, file:// and names of files are known"
        raise InputError(str(file), field, message)
    tried = []
    for path in places:
        if path.is_file():
            return path
        tried.append(str(path))
    where = "; ".join(dict.fromkeys(tried)) or _searched(parts.netloc, folder, package_folders)
    raise InputError(str(file), field, f"no mesh {named!r}; tried {where}")


def _searched(package: str, folder: Path, package_folders: Sequence[Path]) -> str:
    given = ", ".join(map(str, package_folders)) or "none"
    return (
        f"to find the package {package!r} in robot.package_folders ({given}), in the folders "
        f"above {folder.resolve()}, and in ROS_PACKAGE_PATH ({os.environ.get(_ROS, 'not set')})"
    )


def _roots(package: str, folder: Path, package_folders: Sequence[Path]) -> Iterator[Path]:
    """Folders of the package, in the order in which they are asked."""
    for given in package_folders:
        yield from _below(given, package, _DEEPEST)
    here = folder.resolve()
    for above in (here, *here.parents):
        yield from _below(above, package, 1)
    for entry in os.environ.get(_ROS, "").split(os.pathsep):
        if entry:
            yield from _below(Path(entry), package, _DEEPEST)


def _below(folder: Path, package: str, depth: int) -> Iterator[Path]:
    """The folder and those in it, as far as they are the package; packages hold no others."""
    manifest = folder / "package.xml"
    if manifest.is_file():
        if _name(manifest) == package:
            yield folder
        return
    if folder.name == package and folder.is_dir():
        yield folder
    if depth == 0:
        return
    try:
        inner = sorted(entry.path for entry in os.scandir(folder) if entry.is_dir())
    except OSError:
        return
    for path in inner:
        yield from _below(Path(path), package, depth - 1)


def _name(manifest: Path) -> str | None:
    try:
        found = ET.parse(manifest).find("name")
    except (ET.ParseError, OSError):
        return None
    return None if found is None or found.text is None else found.text.strip()
