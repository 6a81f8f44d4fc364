"""Things by name: those of this package, and those that other distributions register.

A name leads to ``module:name``, which is imported when somebody asks for it and not before. Other
distributions register theirs by entry points, in their ``pyproject.toml``::

    [project.entry-points."cellcolor.parts"]
    torus = "torus_part:Torus"
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from cellcolor.errors import InputError


def known_names(own: Mapping[str, str], group: str) -> tuple[str, ...]:
    """All names, this package's own first; nothing is imported for that.

    Args:
        own: what this package has, as ``module:name`` by name.
        group: of the entry points of others.
    """
    return (*own, *sorted(set(entry_points(group=group).names) - own.keys()))


def find(name: str, own: Mapping[str, str], group: str, field: str | None = None) -> EntryPoint:
    """What is registered by a name. Nobody can replace what is this package's own.

    Args:
        own: what this package has, as ``module:name`` by name.
        group: of the entry points of others.
        field: to be named in errors.

    Raises:
        InputError: nothing has this name, or two distributions have registered different things.
    """
    if name in own:
        return EntryPoint(name, own[name], group)
    found = {point.value: point for point in entry_points(group=group, name=name)}
    if not found:
        known = ", ".join(known_names(own, group))
        raise InputError(None, field, f"there is no {name!r}; there are {known}")
    if len(found) > 1:
        raise InputError(None, field, f"{name!r} is registered as {' and as '.join(sorted(found))}")
    (point,) = found.values()
    return point


def load(point: EntryPoint, field: str | None = None) -> Any:
    """Import what another distribution has registered.

    Raises:
        InputError: that fails, in whatever way.
    """
    try:
        return point.load()
    except Exception as error:  # the code of others may raise anything
        reason = f"{type(error).__name__}: {error}"
        message = f"{point.name!r}, registered as {point.value}, cannot be loaded: {reason}"
        raise InputError(None, field, message) from error
