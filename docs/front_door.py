"""The list of docs/api.md: every public name with the summary of its docstring."""

from __future__ import annotations

import inspect

import cellcolor


def front_door() -> str:
    """What ``import cellcolor`` gives as a list in Markdown, functions before classes."""
    values = {name: getattr(cellcolor, name) for name in cellcolor.__all__}
    functions = [name for name, value in values.items() if inspect.isfunction(value)]
    classes = [name for name, value in values.items() if inspect.isclass(value)]
    return "".join(_line(name, values[name]) for name in [*functions, *classes])


def _line(name: str, value: type) -> str:
    role = "class" if inspect.isclass(value) else "func"
    said = " ".join((inspect.getdoc(value) or "").partition("\n\n")[0].split())
    return f"- {{py:{role}}}`cellcolor.{name} <{value.__module__}.{name}>`: {said}\n"
