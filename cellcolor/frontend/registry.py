"""Classes that files name by their kind, from this package and from others.

Scenes and setups say of a part, an obstacle, a validity test or an arm which kind it is. There is a
registry for each of the four (:mod:`cellcolor.registered`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Generic, TypeVar

from pydantic_core import PydanticCustomError

from cellcolor.errors import InputError
from cellcolor.frontend.tables import Table
from cellcolor.registered import find, load

T = TypeVar("T")
Kind = TypeVar("Kind", bound=Table)


class Registry(Generic[T]):
    """Classes of one sort, such as all parts, by the name that files have for them."""

    def __init__(self, group: str, base: type[T], own: Mapping[str, str]) -> None:
        """Register the classes of this package.

        Args:
            group: of entry points, in which other distributions register theirs.
            base: what every class has to be derived from.
            own: the classes of this package by name, each written as ``module:class``.
        """
        self._group, self.base, self._own = group, base, own

    def find(self, name: str) -> type[T]:
        """The class of that name.

        Raises:
            InputError: no class has this name, or two have it; it cannot be imported; or it is not
                derived from the base class.
        """
        point = find(name, self._own, self._group)
        loaded = load(point)
        if not (isinstance(loaded, type) and issubclass(loaded, self.base)):
            message = f"{name!r} ({point.value}) is no {self.base.__name__}"
            raise InputError(None, None, message)
        return loaded


def of_kind(registry: Registry[Kind], content: object) -> Kind:
    """Read a file's table as the class that its key ``kind`` names; take a value as it is.

    Validators of pydantic call this, so errors are raised in the way that pydantic expects.
    """
    if isinstance(content, registry.base):
        return content
    if not isinstance(content, Mapping):
        raise PydanticCustomError("no_table", "must be a table with a kind")
    kind = content.get("kind")
    if not isinstance(kind, str):
        raise PydanticCustomError("no_kind", "needs a kind, in quotation marks")
    try:
        found = registry.find(kind)
    except InputError as error:
        raise PydanticCustomError("kind", "{text}", {"text": error.message}) from error
    return found.model_validate(content)
