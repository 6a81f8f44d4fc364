"""Borders between the areas of a labelled surface, walked with the area on the left.

An area is a cell, or what no color reaches, or what lies beyond the border of the mesh.

The curves live on the dual of the mesh: a border crosses every mesh edge whose two ends belong
to different areas, and every crack, and runs from triangle to triangle. Each border loop of the
mesh itself is closed with a virtual vertex outside, so that every mesh edge has two triangles.
"""

from __future__ import annotations

from collections.abc import Sequence

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline

Step = tuple[int, int]
"""A border where it crosses one mesh edge: the vertex on its left and the one on its right."""

Curve = tuple[Step, ...]
"""A topological edge as it lies on the mesh: the mesh edges that it crosses, in order."""


class ClosedMesh:
    """A labelled surface's mesh with its holes closed by virtual vertices.

    Attributes:
        third: ``{(i, j): k}`` for every triangle (i, j, k), virtual ones included.
        real_count: vertices with an index from here on are virtual.
    """

    def __init__(self, surface: LabelledSurface) -> None:
        self.real_count = len(surface.vertices)
        self.third = dict(surface.left_of)
        virtual = self.real_count
        # Along a border of the mesh a is followed by successor[a] with the outside on the left.
        successor = {b: a for a, b in surface.left_of if (b, a) not in surface.left_of}
        while successor:
            vertex = min(successor)
            while vertex in successor:
                following = successor.pop(vertex)
                self.third[vertex, following] = virtual
                self.third[following, virtual] = vertex
                self.third[virtual, vertex] = following
                vertex = following
            virtual += 1
        self.vertex_count = virtual


class Borders:
    """All borders of a division of the mesh into areas.

    Args:
        vertex_cell: the cell of each vertex; ``OUTSIDE`` where unreachable.

    Attributes:
        cell_of: the cell of each vertex, those of virtual ones ``OUTSIDE``.
        steps: all mesh edges that a border crosses, each in both directions.
    """

    def __init__(self, surface: LabelledSurface, vertex_cell: Sequence[int]) -> None:
        self.mesh = ClosedMesh(surface)
        virtual = self.mesh.vertex_count - self.mesh.real_count
        self.cell_of = cell_of = [*vertex_cell, *[OUTSIDE] * virtual]
        self._cracked = surface.cracked
        self._colors = [frozenset(colors) for colors in surface.vertex_colors]
        self._colors += [frozenset()] * virtual
        self.steps: set[Step] = {
            (a, b) for a, b in self.mesh.third if cell_of[a] != cell_of[b] or surface.cracked(a, b)
        }

    def joinable(self, a: int, b: int) -> frozenset[int]:
        """The colors that may continue across a mesh edge, given either way round."""
        return (self._colors[a] & self._colors[b]) - self._cracked(a, b)

    def following(self, step: Step) -> Step:
        """The next step of a walk along the border with the same area on the left."""
        u, v = step
        w = self.mesh.third[u, v]
        if (u, w) in self.steps:
            return u, w
        if (w, v) in self.steps:
            return w, v
        return v, u  # the free end of a crack: turn and walk back along its other side

    def ends_in_corner(self, step: Step) -> bool:
        """Whether a step leads into a triangle that holds a corner of the border."""
        u, v = step
        w = self.mesh.third[u, v]
        crossed = 1 + ((u, w) in self.steps) + ((w, v) in self.steps)
        return crossed != 2 or self.kind(step) != self.kind(self.following(step))

    def kind(self, step: Step) -> tuple[int, int, frozenset[int]]:
        """The cells to the left and to the right, and the colors that may continue across."""
        u, v = step
        return self.cell_of[u], self.cell_of[v], self.joinable(u, v)

    def curves(self, deadline: Deadline = NEVER) -> list[Curve]:
        """The topological edges, each with an area other than ``OUTSIDE`` on its left."""
        curves: list[Curve] = []
        done: set[Step] = set()
        # Curves between corners first; what is left over then are closed curves without any.
        starts = sorted(self.steps)
        corners = [step for step in deadline.watch(starts) if self.ends_in_corner(step[::-1])]
        for first in deadline.watch(corners + starts):
            if first in done or self.cell_of[first[0]] == OUTSIDE:
                continue
            steps = [first]
            while not self.ends_in_corner(steps[-1]):
                following = self.following(steps[-1])
                if following == first:
                    break
                steps.append(following)
            curves.append(tuple(steps))
            done.update(steps, (step[::-1] for step in steps))
        return curves
