"""A plan: another planner's one color per vertex, for the oracle to judge."""

from __future__ import annotations

import json
from dataclasses import dataclass
from os import PathLike
from typing import Any

from pydantic import ConfigDict, TypeAdapter

from cellcolor.data.wording import count
from cellcolor.files.documents import read_as, take_body, validate
from cellcolor.files.validation import settle

FORMAT = "cellcolor/plan"


@dataclass(frozen=True, slots=True, repr=False)
class Plan:
    """One color per vertex of a labelled surface.

    Attributes:
        vertex_colors: the painted color of each vertex, by its number, None exactly where it has
            none; lists and arrays of integers become this.

    Raises:
        InputError: a color is no integer, as ``True``, 1.0 and names are not.
    """

    __pydantic_config__ = ConfigDict(extra="forbid", strict=True)

    vertex_colors: tuple[int | None, ...]

    def __post_init__(self) -> None:
        settle(self)

    def __str__(self) -> str:
        painted = [color for color in self.vertex_colors if color is not None]
        vertices = count(len(self.vertex_colors), "vertex", "vertices")
        colors = count(len(set(painted)), "color")
        return f"plan for {vertices}, {len(painted)} of them painted, in {colors}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    def to_json(self) -> str:
        """The file's text."""
        return json.dumps(
            {"format": FORMAT, "version": 1, "vertex_colors": list(self.vertex_colors)}
        )

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> Plan:
        """A plan from a parsed JSON object."""
        return validate(_ADAPTER, take_body(document, FORMAT))

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Plan:
        """A plan from a file.

        Raises:
            InputError: the file cannot be read or holds something that the format forbids.
        """
        return read_as(path, cls.from_document)


_ADAPTER = TypeAdapter(Plan)
