"""Wavefront OBJ as one mesh: positions and faces, whatever else the file has.

Groups, objects and materials part a file into meshes, and texture coordinates double vertices along
seams. To a robot all of it is one surface.
"""

from __future__ import annotations

import itertools
from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.surface import Faces

__all__ = ["read_obj"]


def read_obj(file: Path, deadline: Deadline) -> tuple[Array, Faces]:
    """Vertices (n, 3) in the order of the file, and triangles (m, 3).

    A face of more corners is cut into a fan about its first one.

    Raises:
        InputError: unreadable, a face of fewer than three corners, an index of no vertex, what is
            not a number; names the line.
        OutOfTime: the deadline came first.
    """
    points, corners = array("d"), array("q")
    try:
        with file.open(encoding="utf-8", errors="replace") as stream:
            for number, line in deadline.watch(_lines(stream)):
                kind, *words = line.split() or [""]
                try:
                    if kind == "v":
                        points.extend(map(float, words[:3]))
                        if len(points) % 3:
                            raise ValueError("a vertex has three coordinates")
                    elif kind == "f":
                        face = [_index(word, len(points) // 3) for word in words]
                        if len(face) < 3:
                            raise ValueError("a face has three corners or more")
                        for second, third in itertools.pairwise(face[1:]):
                            corners.extend((face[0], second, third))
                except (ValueError, OverflowError) as error:
                    raise InputError(str(file), f"line {number}", str(error)) from error
    except OSError as error:
        raise InputError(str(file), None, error.strerror or "cannot be read") from error
    vertices = np.array(points, dtype=np.float64).reshape(-1, 3)
    return vertices, np.array(corners, dtype=np.int64).reshape(-1, 3)


def _lines(stream: TextIO) -> Iterator[tuple[int, str]]:
    """Lines with their numbers; one that ends in a backslash goes on in the next."""
    begun = ""
    for number, line in enumerate(stream, start=1):
        text = line.partition("#")[0].rstrip()
        if text.endswith("\\"):
            begun += text[:-1] + " "
            continue
        yield number, begun + text
        begun = ""


def _index(word: str, known: int) -> int:
    """The vertex of a corner ``v``, ``v/vt`` or ``v/vt/vn``; below zero counted from the end."""
    given = int(word.partition("/")[0])
    index = given - 1 if given > 0 else known + given
    if not given or not 0 <= index < known:
        raise ValueError(f"there is no vertex {given} so far")
    return index
