"""A mesh remeshed to edges of about one length, by gpytoolbox in a process of its own.

What comes back may have faces without area, and faces laid back onto the ones beside them, along
sharp edges above all. They are mended here.

The method is Botsch and Kobbelt's ("A remeshing approach to multiresolution modeling", 2004): edges
are parted, drawn together and flipped, and vertices moved along the surface and put back onto it.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.folds import fold_angle, folds, unfolded
from cellcolor.frontend.parts.holes import border_groups
from cellcolor.frontend.parts.remesh import refine
from cellcolor.frontend.parts.repairing import Change, Mending, Telling, mended
from cellcolor.frontend.parts.sharp import SHARP, sharp_edges
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.parts.topology import edge_table, face_areas
from cellcolor.frontend.sizes import MOST_VERTICES

__all__ = ["Deviation", "expected_vertices", "length_for", "remeshed"]

_CHILD = Path(__file__).with_name("remesh_child.py")
_ASK = 0.2  # s, between two looks at the time
_LONGEST = 4 / 3  # of the wanted length: edges of a border above that are halved first
_ROUNDS = 3  # of mending folds and what else is wrong; the second seldom finds more
_FEWEST = 10  # vertices; a mesh so coarse has lost its shape


@dataclass(frozen=True)
class Deviation:
    """How far two meshes are from each other, at vertices and middles of faces.

    Attributes:
        greatest, mean: from the old mesh to the new one.
        greatest_back, mean_back: from the new one to the old one.
    """

    greatest: float
    mean: float
    greatest_back: float
    mean_back: float


def expected_vertices(area: float, length: float) -> float:
    """How many vertices a mesh of equilateral triangles has about, two triangles for each."""
    return float(area / (np.sqrt(3) / 2 * length**2))


def length_for(area: float, vertices: float) -> float:
    """The length of edges with which a mesh has about so many vertices."""
    return float(np.sqrt(area / (np.sqrt(3) / 2 * vertices)))


def remeshed(
    vertices: Array,
    faces: Faces,
    length: float,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> tuple[Array, Faces, list[Change], Deviation]:
    """A manifold mesh with edges of about one length; sharp edges stay, and so does the border.

    Vertices of the border keep their places; its edges are halved where they are longer than four
    thirds of the length, and not joined where they are shorter. Folds that the remeshing has made
    are mended, and the list says what that took and what is left.

    Args:
        length: wanted, in the unit of the vertices.
        tell: told what is being done.

    Raises:
        InputError: too many vertices would come of it, or too few; the library has failed, was out
            of memory, or has torn holes.
        ModuleNotFoundError: gpytoolbox is not installed.
        OutOfTime: the deadline came first.
    """
    area = float(face_areas(vertices, faces).sum())
    expected = expected_vertices(area, length)
    if not _FEWEST <= expected <= MOST_VERTICES:
        message = f"gives about {expected:,.0f} vertices, {_FEWEST} to {MOST_VERTICES:,} fit"
        raise InputError(None, "edge_length_m", message)
    if find_spec("gpytoolbox") is None:
        raise ModuleNotFoundError("No module named 'gpytoolbox'", name="gpytoolbox")
    table = edge_table(faces)
    i, j = table.ends[table.count == 1].T
    border = np.linalg.norm(vertices[i] - vertices[j], axis=1)
    if border.max(initial=0.0) > _LONGEST * length:
        try:
            vertices, faces = refine(vertices, faces, _LONGEST * length, deadline)
        except InputError as error:
            raise InputError(None, "edge_length_m", error.message) from error
    kept = sharp_edges(vertices, faces, SHARP)
    tell(f"remeshing to about {expected:,.0f} vertices")
    made = _asked(deadline, vertices=vertices, faces=faces, length=length, kept=kept)
    tell("mending folds")
    points, corners, changes = _mended(
        made["vertices"], made["faces"].astype(np.int64), fold_angle(vertices, faces), length,
        deadline,
    )  # fmt: skip
    if _borders(corners) > _borders(faces):
        message = "gpytoolbox has torn holes into the mesh; shorter edges keep more of its shape"
        raise InputError(None, "edge_length_m", message)
    tell("measuring the deviation")
    measured = _asked(
        deadline, vertices=vertices, faces=faces, new_vertices=points, new_faces=corners
    )
    deviation = Deviation(*measured["there"].tolist(), *measured["back"].tolist())
    return points, corners, changes, deviation


def _mended(
    vertices: Array, faces: Faces, angle: float, length: float, deadline: Deadline
) -> tuple[Array, Faces, list[Change]]:
    """A remeshed mesh without folds as far as possible, and what that took."""
    taken = 0
    changes: list[Change] = []
    for _ in range(_ROUNDS):
        vertices, faces, gone = unfolded(vertices, faces, angle, length, deadline)
        taken += gone
        vertices, faces, more = mended(vertices, faces, Mending(0.0, 0.0), deadline)
        changes += more
        left = folds(vertices, faces, angle)
        if not left or not more:
            break
    if taken:
        name = "1 vertex" if taken == 1 else f"{taken:,} vertices"
        changes.insert(0, Change(f"folds mended: {name} drawn into neighbors"))
    if left:
        place = ", ".join(f"{x:.4g}" for x in vertices[left[0]].mean(axis=0))
        where = f"at ({place}) m" if len(left) == 1 else f"the first at ({place}) m"
        text = f"{count(len(left), 'fold')} of {np.degrees(angle):.0f} degrees and more left"
        changes.append(Change(f"{text}, {where}"))
    return vertices, faces, changes


def _borders(faces: Faces) -> int:
    return int(border_groups(edge_table(faces))[1].max(initial=-1)) + 1


def _asked(deadline: Deadline, **question: Any) -> Any:
    """What the child answers to an archive of arrays, which is one as well."""
    given = io.BytesIO()
    np.savez(given, **question)
    return np.load(io.BytesIO(_run(given.getvalue(), deadline)))


def _run(given: bytes, deadline: Deadline) -> bytes:
    """What the child answers."""
    command = [sys.executable, "-P", str(_CHILD)]
    pipe = subprocess.PIPE
    with tempfile.TemporaryFile() as stored:
        stored.write(given)
        stored.seek(0)
        with subprocess.Popen(command, stdin=stored, stdout=pipe, stderr=pipe) as child:
            try:
                answer, complaint = _answer(child, deadline)
            finally:
                child.kill()
    if child.returncode:
        lines = complaint.decode(errors="replace").split("\n")
        why = next((line for line in reversed(lines) if line.strip()), "")
        if "MemoryError" in why or "bad_alloc" in why:
            why = "out of memory, 3 GiB"
        raise InputError(
            None,
            "edge_length_m",
            f"gpytoolbox could not remesh it ({why or f'signal {-child.returncode}'})",
        )
    return answer


def _answer(child: subprocess.Popen[bytes], deadline: Deadline) -> tuple[bytes, bytes]:
    """What the child writes until it ends, to standard output and to standard error."""
    while True:
        try:
            return child.communicate(timeout=_ASK)
        except subprocess.TimeoutExpired:
            deadline.check()
