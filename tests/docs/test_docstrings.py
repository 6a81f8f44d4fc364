"""What Sphinx would warn of, and the build of the site with it, found without Sphinx."""

from __future__ import annotations

import ast
import re
from collections import Counter
from functools import cache
from pathlib import Path

import cellcolor

PACKAGE = Path(cellcolor.__file__).parent
MODULES = sorted(PACKAGE.rglob("*.py"))


@cache
def trees() -> dict[Path, ast.Module]:
    """Parsed once, and not where tests are only collected."""
    return {path: ast.parse(path.read_text(encoding="utf-8")) for path in MODULES}


def types_before_colons(docstring: str) -> list[str]:
    """What a ``Returns`` or ``Yields`` section has before a colon in its first line.

    Sphinx takes that for a type, and looks for a class of that name, unless it is a shape.
    """
    lines = re.findall(r"^ *(?:Returns|Yields):\n *(.*)$", docstring, re.MULTILINE)
    plain = [re.sub(r":\w+:`[^`]*`|`+[^`]*`+", "", line) for line in lines]
    return [line.partition(":")[0] for line in plain if re.match(r"\w.*:(\s|$)", line)]


def test_no_sentence_about_a_result_is_taken_for_its_type() -> None:
    for path, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                where = path.relative_to(PACKAGE), node.name
                assert types_before_colons(ast.get_docstring(node) or "") == [], where


def test_a_sentence_with_a_colon_is_found() -> None:
    assert types_before_colons("Find.\n\nReturns:\n    The edges:\n    all.\n") == ["The edges"]
    assert types_before_colons("Find.\n\nReturns:\n    ``a: b`` of all.\n    More: less.\n") == []


def test_a_public_class_shares_its_name_with_no_other() -> None:
    """Annotations name it without its module, so Sphinx would find two."""
    classes = Counter(
        node.name
        for tree in trees().values()
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
    )
    shared = {name for name in cellcolor.__all__ if classes[name] > 1}
    assert shared == set()
