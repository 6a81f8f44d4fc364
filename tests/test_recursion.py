"""No function of the package calls itself on the size of an input.

Python falls at a thousand calls, and a graph has more cells than that. What may call itself is
listed here with what limits it.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import networkx as nx
import pytest

import cellcolor

ALLOWED = {
    ("frontend/relaxing.py", "_contact_of_links"): "twice: all links, then each pair of them",
    ("files/validation.py", "plain"): "how deeply the annotations of a dataclass nest",
    ("frontend/arm/link_mesh.py", "_below"): "the folders looked into, _DEEPEST",
    ("frontend/tables.py", "_settled"): "how deeply TOML nests, which its reader limits",
    ("solvers/cpsat/cell_divisions.py", "decide"): "the darts of a cell, MOST_DARTS",
}
"""Functions that call themselves, and what the depth is limited by."""


def functions(
    node: ast.AST, within: str = ""
) -> Iterator[tuple[str, str, ast.FunctionDef | ast.AsyncFunctionDef]]:
    """Each function of a module with its class, which is empty for what is no method."""
    for inner in ast.iter_child_nodes(node):
        if isinstance(inner, ast.ClassDef):
            yield from functions(inner, inner.name)
        elif isinstance(inner, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield within, inner.name, inner
            yield from functions(inner)
        else:
            yield from functions(inner, within)


def calling_themselves(text: str) -> set[str]:
    """The functions of a module that call themselves, be it by way of others there."""
    found = list(functions(ast.parse(text)))
    names = {(within, name) for within, name, _ in found}
    graph: nx.DiGraph[tuple[str, str]] = nx.DiGraph()
    for within, name, function in found:
        own_names = {node.arg for node in ast.walk(function.args) if isinstance(node, ast.arg)}
        for node in ast.walk(function):
            called = None
            if isinstance(node, ast.Name) and node.id not in own_names:
                called = "", node.id
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                own = bool(within) and node.value.id in ("self", "cls", within)
                called = (within, node.attr) if own else None
            if called in names and isinstance(node.ctx, ast.Load):
                graph.add_edge((within, name), called)
    return {
        name
        for together in nx.strongly_connected_components(graph)
        for within, name in together
        if len(together) > 1 or graph.has_edge((within, name), (within, name))
    }


def test_the_scan_sees_recursion() -> None:
    assert calling_themselves("def f(n):\n  return f(n - 1)") == {"f"}
    assert calling_themselves("def f(n):\n  return map(f, n)") == {"f"}
    assert calling_themselves("def f(n):\n  return g(n)\ndef g(n):\n  return f(n)") == {"f", "g"}
    assert calling_themselves("class A:\n  def f(self):\n    yield from self.f()") == {"f"}
    assert calling_themselves("def f():\n  def g(n):\n    return g(n)\n  return g(0)") == {"g"}
    assert calling_themselves("def f():\n  return g()\ndef g():\n  return 0") == set()
    assert calling_themselves("class A:\n  def f(self):\n    return f(self)") == set()
    assert calling_themselves("def f(g):\n  return g\ndef g(f):\n  return f") == set()


@pytest.mark.second
def test_no_function_calls_itself_on_the_size_of_an_input() -> None:
    root = Path(cellcolor.__file__).parent
    found = {
        (path.relative_to(root).as_posix(), name)
        for path in root.rglob("*.py")
        for name in calling_themselves(path.read_text(encoding="utf-8"))
    }
    assert found == set(ALLOWED)
