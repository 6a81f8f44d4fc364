"""The segments of a partly painted graph (paper, section V-A), with undo."""

from __future__ import annotations


class SegmentCounts:
    """Sub-cells joined into segments: a union-find whose last steps can be taken back.

    Attributes:
        cost: the paper's cost of the current painting, "the number of color segments in the
            current portion of the graph".
        region: of each sub-cell, where its segment must stay.
    """

    def __init__(self) -> None:
        self.cost = 0
        self.region: list[int] = []
        self._parent: list[int] = []
        self._size: list[int] = []
        self._joined: list[int] = []

    def add(self, region: int) -> int:
        """A new sub-cell, a segment of its own so far. Returns its number."""
        self.cost += 1
        self.region.append(region)
        self._parent.append(len(self._parent))
        self._size.append(1)
        return len(self._parent) - 1

    def find(self, subcell: int) -> int:
        """A sub-cell that stands for the whole segment."""
        parent = self._parent
        while parent[subcell] != subcell:
            subcell = parent[subcell]
        return subcell

    def join(self, a: int, b: int) -> None:
        """The painting continues from one sub-cell to the other; it may have done so before."""
        a, b = self.find(a), self.find(b)
        if a == b:
            return
        if self._size[a] < self._size[b]:
            a, b = b, a
        self._parent[b] = a
        self._size[a] += self._size[b]
        self._joined.append(b)
        self.cost -= 1

    def mark(self) -> tuple[int, int]:
        """Where to come back to."""
        return len(self._parent), len(self._joined)

    def undo(self, mark: tuple[int, int]) -> None:
        """Take back every step since the mark."""
        subcells, joined = mark
        while len(self._joined) > joined:
            child = self._joined.pop()
            self._size[self._parent[child]] -= self._size[child]
            self._parent[child] = child
            self.cost += 1
        self.cost -= len(self._parent) - subcells
        del self._parent[subcells:], self._size[subcells:], self.region[subcells:]
