"""The labelled surface: a triangle mesh with the available colors of every vertex."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from cellcolor.arrays import Mask
from cellcolor.data.cells_and_edges import faults_of_color_names
from cellcolor.data.instance import Coverage
from cellcolor.data.value import (
    Document,
    Drawn,
    RowsOfThree,
    Triples,
    Value,
    WithArrays,
    check_lengths,
)
from cellcolor.data.wording import count, listed
from cellcolor.errors import InputError, refuse
from cellcolor.files.documents import sha256_of
from cellcolor.files.validation import Ascending, FreeContent, settle
from cellcolor.mesh.triangle_mesh import TriangleMesh, directed_edges

_FARTHEST = 1e9  # m


@dataclass(frozen=True, slots=True)
class Crack(Value):
    """A mesh edge across which colors that both ends have are not continuous.

    Ends and colors are put in order.

    Attributes:
        i: one end, the smaller vertex index.
        j: the other end.
        colors: the colors that are not continuous along the edge, ascending.
    """

    i: int
    j: int
    colors: Ascending

    def __post_init__(self) -> None:
        settle(self)
        for name, end in zip("ij", sorted((self.i, self.j)), strict=True):
            object.__setattr__(self, name, end)

    def __str__(self) -> str:
        numbers = "color" if len(self.colors) == 1 else "colors"
        return f"crack between vertices {self.i} and {self.j}: {numbers} {listed(self.colors)}"


class _InFile:
    """A crack is a list of its ends and its colors in a file."""

    def __get_pydantic_core_schema__(
        self, source: type[Crack], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        listed = handler.generate_schema(tuple[int, int, tuple[int, ...]])
        return core_schema.json_or_python_schema(
            core_schema.no_info_after_validator_function(lambda own: Crack(*own), listed),
            handler(source),
            serialization=core_schema.plain_serializer_function_ser_schema(
                lambda own: [own.i, own.j, list(own.colors)]
            ),
        )


@dataclass(frozen=True, eq=False, repr=False)
class LabelledSurface(WithArrays, Document, Drawn):
    """What a front end produces: where the surface is, and which colors reach each point.

    Lists and arrays are taken for every member, and put in order; the arrays are copies that
    nobody can change.

    Attributes:
        name: what to call it.
        colors: the names of the colors.
        vertices: (n, 3) float64, metres.
        faces: (m, 3) int64, counter-clockwise seen from outside.
        vertex_colors: color ids of each vertex, ascending; empty where unreachable or given up.
        cracks: see :class:`Crack`.
        meta: free, JSON-able.
        given_up: vertices, ascending, that a configuration reaches and whose colors were all
            taken away on purpose, as by a sliver policy; the others without a color are
            unreachable.

    Raises:
        InputError: anything that ``docs/formats.md`` forbids, with field and element.
    """

    FORMAT = "cellcolor/labelled-surface"
    ADDED = (("given_up",),)
    ALWAYS = ("cracks",)
    LAST = ("meta",)

    name: str
    colors: tuple[str, ...]
    vertices: RowsOfThree
    faces: Triples
    vertex_colors: tuple[Ascending, ...]
    cracks: tuple[Annotated[Crack, _InFile()], ...] = ()
    meta: FreeContent = field(default_factory=dict)
    given_up: Ascending = ()

    def __post_init__(self) -> None:
        settle(self)
        bad = np.argwhere(np.abs(self.vertices) > _FARTHEST)
        if len(bad):
            message = f"is beyond {_FARTHEST:g} m: areas could not be computed"
            raise InputError(None, f"vertices[{bad[0][0]}][{bad[0][1]}]", message)
        check_lengths(self, ("vertex_colors",), len(self.vertices), "vertices")
        refuse(self._faults_of_colors())
        _ = self.left_of  # refuses what is not an oriented 2-manifold
        refuse(self._faults_of_cracks())
        refuse(self._faults_of_given_up())

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(self.sha256)

    def __reduce__(self) -> tuple[Any, ...]:
        # Made from scratch, so that the arrays cannot be changed there either, and without caches.
        return type(self), tuple(getattr(self, member.name) for member in fields(self))

    def __str__(self) -> str:
        unreachable = int((~self.colored).sum()) - len(self.given_up)
        parts = [
            count(len(self.vertices), "vertex", "vertices"),
            count(len(self.faces), "triangle"),
            count(len(self.colors), "color"),
            count(len(self.cracks), "crack"),
        ]
        parts += [f"{unreachable} unreachable"] if unreachable else []
        parts += [f"{len(self.given_up)} given up"] if self.given_up else []
        return f"{self.name}: {', '.join(parts)}"

    def _faults_of_colors(self) -> Iterator[tuple[str, str]]:
        yield from faults_of_color_names(self.colors)
        for vertex, colors in enumerate(self.vertex_colors):
            for color in colors:
                if not 0 <= color < len(self.colors):
                    yield f"vertex_colors[{vertex}]", f"unknown color {color}"
            if len(set(colors)) != len(colors):
                yield f"vertex_colors[{vertex}]", "a color appears twice"

    def _faults_of_cracks(self) -> Iterator[tuple[str, str]]:
        seen: set[tuple[int, int]] = set()
        for number, crack in enumerate(self.cracks):
            where, pair = f"cracks[{number}]", (crack.i, crack.j)
            if pair not in self.left_of and pair[::-1] not in self.left_of:
                yield where, f"{crack.i}-{crack.j} is not an edge of the mesh"
            if pair in seen:
                yield where, f"edge {crack.i}-{crack.j} has a crack already"
            seen.add(pair)
            if not crack.colors or len(set(crack.colors)) != len(crack.colors):
                yield where, "needs at least one color, each once"
            shared = set(self.vertex_colors[crack.i]) & set(self.vertex_colors[crack.j])
            for color in crack.colors:
                if not 0 <= color < len(self.colors):
                    yield where, f"unknown color {color}"
                if color not in shared:
                    ends = f"vertices {crack.i} and {crack.j}"
                    yield where, f"color {color} is not shared by {ends}"

    def _faults_of_given_up(self) -> Iterator[tuple[str, str]]:
        for place, vertex in enumerate(self.given_up):
            where = f"given_up[{place}]"
            if not 0 <= vertex < len(self.vertices):
                yield where, f"there is no vertex {vertex}"
            if self.vertex_colors[vertex]:
                yield where, f"vertex {vertex} has colors"
            if vertex in self.given_up[place - 1 : place]:
                yield where, f"vertex {vertex} appears twice"

    @cached_property
    def left_of(self) -> dict[tuple[int, int], int]:
        """``{(i, j): k}`` for every triangle (i, j, k).

        See :func:`~cellcolor.mesh.triangle_mesh.directed_edges`.
        """
        return directed_edges(self.faces, len(self.vertices))

    @cached_property
    def mesh(self) -> TriangleMesh:
        """The mesh alone, with everything computed from it."""
        return TriangleMesh(self.vertices, self.faces)

    @property
    def vertex_areas(self) -> NDArray[np.float64]:
        """Square metres (n,) that each vertex owns: a third of each of its triangles."""
        return self.mesh.vertex_areas

    @property
    def colored(self) -> Mask:
        """The vertices (n,) that have a color."""
        return np.array([bool(own) for own in self.vertex_colors], dtype=bool)

    @property
    def vertex_normals(self) -> NDArray[np.float64]:
        """Outward unit normals (n, 3) of the mesh: of the triangles around, weighed by area.

        A vertex without triangles, or with triangles that cancel out, has (0, 0, 1).
        """
        return self.mesh.vertex_normals

    @property
    def coverage(self) -> Coverage | None:
        """How much of the surface is unreachable or given up; None if it has no area at all.

        Areas are those of the barycentric dual of the mesh.
        """
        areas = self.vertex_areas
        total = float(areas.sum())
        if not 0 < total < np.inf:
            return None
        given_up = list(self.given_up)
        unreachable = ~self.colored
        unreachable[given_up] = False
        shares = (float(areas[own].sum()) / total for own in (unreachable, given_up))
        first, second = (round(min(share, 1.0), 12) for share in shares)
        return Coverage(float(f"{total:.12g}"), first, second)

    def without_vertices(self, mask: Mask) -> LabelledSurface:
        """The surface without colors at some vertices (n,), which it gives up."""
        out = np.flatnonzero(mask).tolist()
        colors = list(self.vertex_colors)
        given_up = {*self.given_up, *(vertex for vertex in out if colors[vertex])}
        for vertex in out:
            colors[vertex] = ()
        cracks = tuple(crack for crack in self.cracks if not (mask[crack.i] or mask[crack.j]))
        return replace(
            self, vertex_colors=tuple(colors), given_up=tuple(sorted(given_up)), cracks=cracks
        )

    def without_colors(self, colors: Collection[int]) -> LabelledSurface:
        """The surface without some colors, but for vertices that have no others; as many names."""
        out = frozenset(colors)
        kept = tuple(
            own if out.issuperset(own) else tuple(color for color in own if color not in out)
            for own in self.vertex_colors
        )
        cracks = []
        for crack in self.cracks:
            both = set(kept[crack.i]).intersection(kept[crack.j], crack.colors)
            if both:
                cracks.append(Crack(crack.i, crack.j, tuple(sorted(both))))
        return replace(self, vertex_colors=kept, cracks=tuple(cracks))

    @cached_property
    def crack_colors(self) -> dict[tuple[int, int], frozenset[int]]:
        """``{(i, j): colors}`` with i < j: what is not continuous along each mesh edge's crack."""
        return {(crack.i, crack.j): frozenset(crack.colors) for crack in self.cracks}

    def cracked(self, a: int, b: int) -> frozenset[int]:
        """The colors that are not continuous along a mesh edge, given either way round."""
        return self.crack_colors.get((a, b) if a < b else (b, a), frozenset())

    @cached_property
    def sha256(self) -> str:
        """Fingerprint of what an instance is made of (docs/formats.md); no names, no ``meta``."""
        first = self.faces.argmin(axis=1)[:, None]
        faces = np.take_along_axis(self.faces, (first + np.arange(3)) % 3, axis=1)
        return sha256_of(
            {
                # Doubles in hexadecimal have one text in every language; adding 0 drops -0.
                "vertices": (self.vertices + 0.0).astype(">f8").tobytes().hex(),
                "faces": sorted(faces.tolist()),
                "vertex_colors": self.vertex_colors,
                "cracks": sorted([crack.i, crack.j, list(crack.colors)] for crack in self.cracks),
            }
            | ({"given_up": self.given_up} if self.given_up else {})
        )
