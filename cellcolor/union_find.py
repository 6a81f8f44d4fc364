"""Disjoint sets, for all but the checker, which has its own.

As ``networkx.utils.UnionFind``, without what the import of networkx takes: a tenth of a second and
more, at every start of the command.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import Generic, TypeVar

T = TypeVar("T", bound=Hashable)


class UnionFind(Generic[T]):
    """Disjoint sets of elements; one that was not seen before is a set of its own.

    Args:
        elements: the first ones.
    """

    def __init__(self, elements: Iterable[T] = ()) -> None:
        self._above = {element: element for element in elements}
        self._size = dict.fromkeys(self._above, 1)

    def __getitem__(self, element: T) -> T:
        """The element that stands for the set of this one."""
        above = self._above
        if element not in above:
            self._size[element] = 1
            return above.setdefault(element, element)
        while above[element] != element:
            above[element] = above[above[element]]
            element = above[element]
        return element

    def union(self, *elements: T) -> None:
        """Make one set of the sets of some elements; the largest gives its name."""
        if len(elements) == 2:  # by far the most, and worth a way of their own
            one, other = self[elements[0]], self[elements[1]]
            if one != other:
                if self._size[other] > self._size[one]:
                    one, other = other, one
                self._above[other] = one
                self._size[one] += self._size.pop(other)
            return
        roots = {self[element]: None for element in elements}
        if len(roots) < 2:
            return
        largest = max(roots, key=self._size.__getitem__)
        for root in roots:
            if root != largest:
                self._above[root] = largest
                self._size[largest] += self._size.pop(root)

    def copy(self) -> UnionFind[T]:
        """The same sets, to be united on their own."""
        other: UnionFind[T] = UnionFind()
        other._above = dict(self._above)
        other._size = dict(self._size)
        return other

    def sets(self) -> list[set[T]]:
        """All sets."""
        found: dict[T, set[T]] = {}
        for element in list(self._above):
            found.setdefault(self[element], set()).add(element)
        return list(found.values())
