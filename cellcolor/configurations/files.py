"""Joint solutions in files of other programs: ``.npz``, ``.json`` and ``.csv``.

``docs/how-to/your-ik.md`` has an example of each.
"""

from __future__ import annotations

import csv
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from cellcolor.errors import InputError, naming
from cellcolor.files.documents import parse_json, read_text

MEMBERS = ("vertices", "faces", "configurations", "offsets", "names", "limits", "periods")
"""What an archive or a JSON object may have; ``offsets`` only an archive."""


def read_joint_solutions(path: Path, vertices: int | None = None) -> dict[str, Any]:
    """Read a file of joint solutions, as arguments of
    :func:`~cellcolor.configurations.labelling.from_configurations`; without a mesh for ``.csv``.

    Args:
        path: ``.npz`` with ``configurations`` of all vertices in one array (k, joints) and
            ``offsets`` (n + 1,), where each vertex begins; ``.json`` with a list for each vertex;
            ``.csv`` with a row for each configuration: the number of the vertex, and the joints.
        vertices: how many there are, for ``.csv``, which has no mesh.

    Raises:
        InputError: the file cannot be read, or is something else; names file and field.
    """
    ending = path.suffix.lower()
    with naming(path):
        if ending == ".npz":
            return _from_archive(path)
        if ending == ".json":
            return _from_members(parse_json(read_text(path)))
        if ending == ".csv":
            if vertices is None:
                raise InputError(None, None, "has no mesh: say which (--mesh)")
            return _from_rows(path, vertices)
        raise InputError(None, None, "must end in .npz, .json or .csv")


def _from_archive(path: Path) -> dict[str, Any]:
    try:
        with np.load(path, allow_pickle=False) as archive:
            members: dict[str, Any] = {name: archive[name] for name in archive.files}
    except OSError as error:
        raise InputError(None, None, error.strerror or "cannot be read") from error
    except (ValueError, TypeError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(None, None, "is no archive of arrays (.npz)") from error
    _check_members(members)
    for name in ("vertices", "faces", "configurations"):
        if members[name].ndim != 2:
            raise InputError(None, name, f"has {members[name].ndim} dimensions, must have 2")
    flat, offsets = members["configurations"], members.pop("offsets", None)
    if offsets is None or offsets.ndim != 1 or offsets.dtype.kind not in "iu":
        raise InputError(None, "offsets", "must be whole numbers (n + 1,), where vertices begin")
    vertices = len(members["vertices"])
    if len(offsets) != vertices + 1:
        message = f"has {len(offsets)} entries, {vertices} vertices need {vertices + 1}"
        raise InputError(None, "offsets", message)
    falls = np.flatnonzero(np.diff(offsets) < 0)
    if offsets[0] != 0 or len(falls) or offsets[-1] != len(flat):
        message = f"must rise from 0 to {len(flat)}, the number of configurations"
        raise InputError(None, f"offsets[{falls[0] + 1}]" if len(falls) else "offsets", message)
    spans = list(zip(offsets[:-1].tolist(), offsets[1:].tolist(), strict=True))
    members["configurations"] = [flat[first:end] for first, end in spans]
    if "names" in members:
        own = [str(name) for name in members["names"].tolist()]
        if len(own) != len(flat):
            message = f"has {len(own)} entries for {len(flat)} configurations"
            raise InputError(None, "names", message)
        members["names"] = [own[first:end] for first, end in spans]
    return members


def _from_members(members: dict[str, Any]) -> dict[str, Any]:
    _check_members(members)
    if "offsets" in members:
        raise InputError(None, "offsets", "is of archives only; give a list for each vertex")
    for name in ("vertices", "faces", "configurations"):
        if not isinstance(members[name], list):
            raise InputError(None, name, "must be a list")
    return {name: value for name, value in members.items() if value is not None}


def _check_members(members: Mapping[str, Any]) -> None:
    for name in ("vertices", "faces", "configurations"):
        if name not in members:
            raise InputError(None, name, "is missing")
    for name in members:
        if name not in MEMBERS:
            raise InputError(None, name, f"is unknown; known are {', '.join(MEMBERS)}")


def _from_rows(path: Path, vertices: int) -> dict[str, Any]:
    configurations: list[list[list[float]]] = [[] for _ in range(vertices)]
    names: list[list[str]] = [[] for _ in range(vertices)]
    rows = csv.reader(read_text(path).splitlines())
    head = [word.strip().lower() for word in next(rows, [])]
    if not head or head[0] != "vertex":
        raise InputError(None, "line 1", "must begin with vertex, then a column for each joint")
    named = head[-1] == "name"
    joints = len(head) - 1 - named
    for line, row in enumerate(rows, start=2):
        if not row:
            continue
        if len(row) != len(head):
            raise InputError(
                None, f"line {line}", f"has {len(row)} columns, line 1 has {len(head)}"
            )
        try:
            vertex, angles = int(row[0]), [float(word) for word in row[1 : joints + 1]]
        except ValueError as error:
            raise InputError(None, f"line {line}", f"is no row of numbers: {error}") from None
        if not 0 <= vertex < vertices:
            message = f"there is no vertex {vertex}, the mesh has {vertices}"
            raise InputError(None, f"line {line}", message)
        configurations[vertex].append(angles)
        names[vertex].append(row[-1].strip() if named else "")
    return {"configurations": configurations} | ({"names": names} if named else {})
