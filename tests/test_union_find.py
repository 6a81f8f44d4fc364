"""Disjoint sets of the solvers and of the checker, held against networkx."""

from __future__ import annotations

import networkx as nx
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.checker.groups import Groups
from cellcolor.union_find import UnionFind

NODES = st.integers(0, 9)


@given(st.sets(NODES), st.lists(st.lists(NODES, max_size=4)))
def test_the_sets_are_the_components(elements: set[int], unions: list[list[int]]) -> None:
    graph: nx.Graph[int] = nx.Graph()
    graph.add_nodes_from(elements)
    found = UnionFind(sorted(elements))
    groups: Groups[int] = Groups()
    for element in elements:
        groups.find(element)
    for union in unions:
        nx.add_path(graph, union)
        found.union(*union)
        for element in union:
            groups.join(union[0], element)
    components = sorted(map(sorted, nx.connected_components(graph)))
    assert sorted(map(sorted, found.sets())) == components
    assert sorted(map(sorted, groups.sets())) == components
    for component in components:
        assert {found[element] for element in component} <= set(component)
        assert len({found[element] for element in component}) == 1
        assert len({groups.find(element) for element in component}) == 1


def test_a_copy_is_united_on_its_own() -> None:
    first = UnionFind("abc")
    first.union("a", "b")
    other = first.copy()
    other.union("b", "c")
    assert sorted(map(sorted, first.sets())) == [["a", "b"], ["c"]]
    assert sorted(map(sorted, other.sets())) == [["a", "b", "c"]]
