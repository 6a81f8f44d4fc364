"""Write the JSON Schemas in this folder from the classes that read the files.

    python docs/schemas/write.py

Each is named after its format and the version that is written now. What a schema says of a member
is what the class says of the attribute. README.md has what schemas cannot say.
"""

from __future__ import annotations

import inspect
import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from cellcolor.data import bound, coverage, instance, plan, solution, surface

FOLDER = Path(__file__).parent
DIALECT = "https://json-schema.org/draft/2020-12/schema"

MODULES = (bound, coverage, instance, plan, solution, surface)
"""Where the classes are that the schemas have definitions of."""


@dataclass(frozen=True)
class Format:
    """A format as it is written now.

    Attributes:
        name: the member ``format``.
        version: the member ``version``; None for lines that have no such member, since they
            follow a document that has.
        adapter: what reads all other members.
        described_by: the class whose docstring says what they are.
    """

    name: str
    version: int | None
    adapter: TypeAdapter[Any]
    described_by: type


FORMATS = {
    "labelled-surface-2": Format(surface.FORMAT, 2, surface._ADAPTER, surface.LabelledSurface),
    "instance-2": Format(instance.FORMAT, 2, instance._ADAPTER, instance.Instance),
    "solution-2": Format(solution.FORMAT, 2, solution._ADAPTER, solution.Solution),
    "scheme-2": Format(
        solution.SCHEME_FORMAT, None, solution._SCHEME_ADAPTER, solution._SchemeLine
    ),
    "plan-1": Format(plan.FORMAT, 1, plan._ADAPTER, plan.Plan),
}
"""The formats by the names of their schemas' files."""


class _Untitled(GenerateJsonSchema):
    """Without titles of members, which would only be their names again."""

    def field_title_should_be_set(self, schema: Any) -> bool:  # noqa: ARG002
        """Never."""
        return False


def schema_text(file: str) -> str:
    """The text of one schema's file, given by its name without the suffix."""
    described = FORMATS[file]
    schema = described.adapter.json_schema(schema_generator=_Untitled)
    members = {"format": {"const": described.name}}
    title = described.name
    if described.version is not None:
        members["version"] = {"const": described.version}
        title = f"{title}, version {described.version}"
    schema["properties"] = members | schema["properties"]
    schema["required"] = [*members, *schema["required"]]
    _describe(schema, described.described_by)
    for name, definition in schema.get("$defs", {}).items():
        found = (getattr(module, name, None) for module in MODULES)
        _describe(definition, next(cls for cls in found if cls is not None))
    first = {"$schema": DIALECT, "title": title, "description": schema.pop("description")}
    return json.dumps(first | schema | {"title": title}, indent=2, ensure_ascii=False) + "\n"


def _describe(schema: dict[str, Any], cls: type) -> None:
    """What the class's docstring says, of itself and of each attribute."""
    summary, _, rest = (inspect.getdoc(cls) or "").partition("\n\n")
    schema["description"] = _plain(summary)
    listed = rest.partition("Attributes:\n")[2].partition("\n\n")[0]
    for name, text in re.findall(r"^    (\w+): (.*(?:\n {8}.*)*)", listed, re.MULTILINE):
        member = schema["properties"].get(name.rstrip("_"))
        if member is not None and "$ref" not in member:
            member["description"] = _plain(text)


def _plain(text: str) -> str:
    """Without line breaks, without markup: ``name`` and :class:`Name` become name."""
    joined = " ".join(text.split())
    return re.sub(r":\w+:`~?([^`]+)`", r"\1", joined).replace("``", "")


def main() -> None:
    """Write all of them."""
    for file in FORMATS:
        (FOLDER / f"{file}.schema.json").write_text(schema_text(file), encoding="utf-8")


if __name__ == "__main__":
    main()
