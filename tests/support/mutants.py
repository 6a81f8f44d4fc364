"""A module of the package with one line of its source changed, for as long as a test runs."""

from __future__ import annotations

import importlib
import inspect
import sys
from types import ModuleType

import pytest


def change(patch: pytest.MonkeyPatch, module: str, old: str, new: str) -> None:
    """Replace a piece of a module's source, which has to be there once.

    Whatever the package has imported from the module is replaced by what the changed source makes.
    """
    original = importlib.import_module(module)
    source = inspect.getsource(original)
    assert source.count(old) == 1, f"{module} has {old!r} {source.count(old)} times"
    changed = ModuleType(module)
    changed.__dict__.update(__file__=original.__file__, __package__=original.__package__)
    patch.setitem(sys.modules, module, changed)  # dataclasses look their module up
    made = compile(source.replace(old, new), f"{original.__file__}, changed", "exec")
    exec(made, vars(changed))
    own = {
        name: value
        for name, value in vars(original).items()
        if getattr(value, "__module__", None) == module
    }
    users = [m for name, m in sys.modules.items() if name.startswith("cellcolor.")]
    for other in (original, *users):
        for name, value in own.items():
            if vars(other).get(name) is value:
                patch.setattr(other, name, vars(changed)[name])
