"""Repairs of a mesh step by step, with a list of the changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.cleaning import (
    MOST_EDGES,
    against_the_others,
    filling,
    flat_faces,
    inside_out,
    merged,
    repeated_corners,
    repeated_faces,
    split,
    turned,
    used,
    without_flat,
)
from cellcolor.frontend.parts.mesh import check_corners, summed_normals
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

LEAST_SHARE = 0.01
"""Components with less than this share of the largest one's area are dropped, if not asked."""

_UPRIGHT = 1e-3  # summed normals of a vertex that are shorter nearly cancel out
Telling = Callable[[str], None]


@dataclass(frozen=True)
class Change:
    """One thing that a repair has changed.

    Attributes:
        what: a sentence.
        area_lost, area_gained: in the square of the mesh's unit.
    """

    what: str
    area_lost: float = 0.0
    area_gained: float = 0.0


@dataclass(frozen=True)
class Mending:
    """Options of a repair, lengths in the mesh's unit.

    Attributes:
        longest_hole: holes with a border up to that length are filled.
        least_share: components with less than this share of the largest one's area are dropped.
    """

    longest_hole: float = 0.0
    least_share: float = LEAST_SHARE


def mended(
    vertices: Array,
    faces: Faces,
    asked: Mending,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> tuple[Array, Faces, list[Change]]:
    """A mesh without the faults that can be repaired; others may remain.

    In this order: vertices in one place are merged; duplicate faces and faces without area are
    dropped; the winding is made consistent; the mesh is cut apart where it is not manifold; small
    components are dropped; the winding is made consistent between new neighbors;
    holes are filled; closed components are turned outward.

    Raises:
        InputError: coordinates that are not finite, a face of no vertex, nothing left.
    """
    _check(vertices, faces)
    changes: list[Change] = []

    def step(name: str) -> None:
        deadline.check()
        tell(name)

    step("merging vertices")
    before = len(vertices)
    there = len(np.unique(faces))
    vertices, faces = merged(vertices, faces)
    _note(changes, before - there, "vertex", "dropped that no face uses")
    _note(changes, there - len(vertices), "vertex", "merged with another in the same place")
    step("dropping useless faces")
    vertices, faces = _without_useless(vertices, faces, changes)
    step("making the winding consistent")
    faces = _wound(vertices, faces, changes, two_sided=True)
    step("cutting apart what is not manifold")
    vertices, faces = _manifold(vertices, faces, changes)
    step("dropping small components")
    vertices, faces = _large(vertices, faces, asked.least_share, changes)
    faces = _wound(vertices, faces, changes)
    step("filling holes")
    faces = _filled(vertices, faces, asked.longest_hole, changes, deadline)
    # A component that was open till now has an inside and an outside now.
    step("turning closed components outward")
    mesh = TriangleMesh(vertices, faces)
    wrong = inside_out(mesh)
    if wrong.any():
        parts = count(len(np.unique(mesh.parts()[wrong])), "closed component")
        changes.append(Change(f"{parts} turned outside out: {count(int(wrong.sum()), 'face')}"))
        faces = turned(faces, wrong)
    return vertices, faces, changes


def _check(vertices: Array, faces: Faces) -> None:
    bad = np.argwhere(~np.isfinite(vertices))
    if len(bad):
        row, axis = bad[0]
        raise InputError(None, f"vertices[{row}][{axis}]", "is not a finite number")
    check_corners(vertices, faces)
    if not len(faces):
        raise InputError(None, "faces", "there are none")


def counted(number: int, one: str) -> str:
    """``1 vertex``, ``1,200 vertices``."""
    several = "vertices" if one == "vertex" else f"{one}s"
    return f"{number:,} {one if number == 1 else several}"


def _note(changes: list[Change], number: int, one: str, what: str) -> None:
    if number:
        changes.append(Change(f"{counted(number, one)} {what}"))


def area_of(vertices: Array, faces: Faces) -> float:
    """The area of all faces."""
    return float(TriangleMesh(vertices, faces).areas.sum())


def _without_useless(vertices: Array, faces: Faces, changes: list[Change]) -> tuple[Array, Faces]:
    folded = repeated_corners(faces)
    _note(changes, int(folded.sum()), "face", "dropped: two corners in one place")
    faces = faces[~folded]
    twice = repeated_faces(faces)
    if twice.any():
        area = area_of(vertices, faces[twice])
        changes.append(Change(f"{count(int(twice.sum()), 'face')} dropped: duplicates", area))
    faces = faces[~twice]
    flat = int(flat_faces(vertices, faces).sum())
    if flat:
        faces = without_flat(vertices, faces)
        _note(changes, flat, "face", "dropped: without area; the face beside was parted instead")
    if not len(faces):
        raise InputError(None, "faces", "none is left that has an area and is no copy of another")
    return used(vertices, faces)


def _manifold(vertices: Array, faces: Faces, changes: list[Change]) -> tuple[Array, Faces]:
    number = len(faces)
    area = area_of(vertices, faces)
    while True:
        parted, renumbered, moved = split(vertices, faces)
        stuck = _stuck(parted, renumbered)
        if not stuck.any():
            break
        vertices, faces = used(vertices, faces[~stuck])
    before = area_of(vertices, faces)
    if number > len(faces):
        text = f"{count(number - len(faces), 'face')} dropped: in the way on edges with three faces"
        changes.append(Change(f"{text} and more", area - before))
    if len(parted) > len(vertices):
        copies = len(parted) - len(vertices)
        text = (
            f"{counted(copies, 'vertex')} added: the mesh cut apart where it was no manifold, "
            f"and copies of a vertex moved by up to {moved:.3g}"
        )
        changed = area_of(parted, renumbered) - before
        changes.append(Change(text, max(-changed, 0.0), max(changed, 0.0)))
    return parted, renumbered


def _stuck(vertices: Array, faces: Faces) -> Mask:
    """The smallest face (m,) on each edge that could not be cut apart: its ends are connected."""
    mesh = TriangleMesh(vertices, faces)
    (edges, sides), of_side, area = mesh.pairs, mesh.edge_of_side, mesh.areas[:, None]
    ascending = mesh.ascending.ravel()
    bad = mesh.triangles_at > 2
    bad[edges[ascending[sides[:, 0]] == ascending[sides[:, 1]]]] = True
    smallest = np.full(len(bad), np.inf)
    np.minimum.at(smallest, of_side, area)
    return np.asarray((bad[of_side] & (area <= smallest[of_side])).any(axis=1))


def _large(
    vertices: Array, faces: Faces, least: float, changes: list[Change]
) -> tuple[Array, Faces]:
    mesh = TriangleMesh(vertices, faces)
    part = mesh.parts()
    area = np.bincount(part, mesh.areas)
    small = area < least * area.max()
    if small.any():
        gone = float(area[small].sum())
        text = f"{count(int(small.sum()), 'component')} dropped: each with less than {least:.3g} of"
        changes.append(Change(f"{text} the largest one's area", gone))
    return used(vertices, faces[~small[part]])


def _wound(vertices: Array, faces: Faces, changes: list[Change], two_sided: bool = False) -> Faces:
    """Faces that wind like their neighbors; refused if they have to be two-sided and are not."""
    turn, one_sided = against_the_others(TriangleMesh(vertices, faces))
    if two_sided and one_sided.any():
        face = int(np.argmax(one_sided))
        message = "lies in a one-sided component, like a Moebius strip: it has no outside"
        place = ", ".join(f"{x:.4g}" for x in vertices[faces[face]].mean(axis=0))
        raise InputError(None, f"faces near ({place})", message)
    _note(changes, int(turn.sum()), "face", "turned to wind like those around")
    return turned(faces, turn)


def _filled(
    vertices: Array, faces: Faces, longest: float, changes: list[Change], deadline: Deadline
) -> Faces:
    if not longest:
        return faces
    mesh = TriangleMesh(vertices, faces)
    edges = {(i, j) for i, j in mesh.edges.tolist()}
    added: list[Faces] = []
    left = 0
    for loop in mesh.border_loops():
        deadline.check()
        points = vertices[loop]
        length = float(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum())
        if length > longest:
            continue
        new = filling(vertices, loop, edges) if len(loop) <= MOST_EDGES else None
        if new is None:
            left += 1
            continue
        added.append(new)
        edges |= {(i, j) for i, j in TriangleMesh(vertices, new).edges.tolist()}
    if added:
        fitting = _without_folds(vertices, faces, added)
        left += len(added) - len(fitting)
        added = fitting
    if added:
        new = np.concatenate(added)
        area = area_of(vertices, new)
        text = f"{count(len(added), 'hole')} filled with {count(len(new), 'face')}"
        changes.append(Change(text, 0.0, area))
        faces = np.concatenate([faces, new])
    _note(changes, left, "hole", f"left: more than {MOST_EDGES} edges, or nothing fits in")
    return faces


def _without_folds(vertices: Array, faces: Faces, added: list[Faces]) -> list[Faces]:
    """Fillings of holes but those that fold back onto the faces around, as in a slit."""
    normals = summed_normals(TriangleMesh(vertices, np.concatenate([faces, *added])))
    folded = np.linalg.norm(normals, axis=1) < _UPRIGHT
    return [new for new in added if not folded[new].any()]
