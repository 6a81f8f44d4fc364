"""Disjoint sets, for the checker alone: it shares nothing with the solvers but the data classes."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Generic, TypeVar

T = TypeVar("T", bound=Hashable)


class Groups(Generic[T]):
    """Disjoint sets of nodes."""

    def __init__(self) -> None:
        self._above: dict[T, T] = {}

    def find(self, node: T) -> T:
        """The one that stands for a set; a node not seen before is a set of its own."""
        above = self._above
        above.setdefault(node, node)
        while above[node] != node:
            above[node] = above[above[node]]
            node = above[node]
        return node

    def join(self, one: T, other: T) -> None:
        """Make one set of two."""
        self._above[self.find(one)] = self.find(other)

    def sets(self) -> list[list[T]]:
        """The sets, each in the order in which its nodes came."""
        found: dict[T, list[T]] = {}
        for node in self._above:
            found.setdefault(self.find(node), []).append(node)
        return list(found.values())
