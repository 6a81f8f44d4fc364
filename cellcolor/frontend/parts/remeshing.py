"""A mesh remeshed to edges of about one length, by gpytoolbox in a process of its own.

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

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.remesh import refine
from cellcolor.frontend.parts.repairing import Telling
from cellcolor.frontend.parts.sharp import SHARP, sharp_edges
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.parts.topology import edge_table, face_areas
from cellcolor.frontend.sizes import MOST_VERTICES

__all__ = ["Deviation", "expected_vertices", "length_for", "remeshed"]

_CHILD = Path(__file__).with_name("remesh_child.py")
_ASK = 0.2  # s, between two looks at the time
_LONGEST = 4 / 3  # of the wanted length: edges of a border above that are halved first
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
) -> tuple[Array, Faces, Deviation]:
    """A manifold mesh with edges of about one length; sharp edges stay, and so does the border.

    Vertices of the border keep their places; its edges are halved where they are longer than four
    thirds of the length, and not joined where they are shorter.

    Args:
        length: wanted, in the unit of the vertices.
        tell: told what is being done.

    Raises:
        InputError: too many vertices would come of it, or too few; the library has failed, or was
            out of memory.
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
    given = io.BytesIO()
    kept = sharp_edges(vertices, faces, SHARP)
    np.savez(given, vertices=vertices, faces=faces, length=length, kept=kept)
    tell(f"remeshing to about {expected:,.0f} vertices")
    made = np.load(io.BytesIO(_run(given.getvalue(), deadline)))
    deviation = Deviation(*made["there"].tolist(), *made["back"].tolist())
    return made["vertices"], made["faces"].astype(np.int64), deviation


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
