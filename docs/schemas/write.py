"""Write the JSON Schemas in this folder from the classes that read the files.

    python docs/schemas/write.py

Each is named after its format and the version that is written now; scenes and setups, which are
TOML, have none. What a schema says of a member is what the class says of the attribute. README.md
has what schemas cannot say.
"""

from __future__ import annotations

import inspect
import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic.json_schema import GenerateJsonSchema

from cellcolor.data import (
    bounds,
    instance,
    library_index,
    plan,
    solution,
    surface,
    tool_paths,
    trajectory,
    trajectory_verdict,
    verdicts,
)
from cellcolor.data.value import adapter_of

FOLDER = Path(__file__).parent
DIALECT = "https://json-schema.org/draft/2020-12/schema"

MODULES = (
    bounds,
    instance,
    library_index,
    plan,
    solution,
    surface,
    tool_paths,
    trajectory,
    trajectory_verdict,
    verdicts,
)
"""Where the classes are that the schemas have definitions of."""


@dataclass(frozen=True)
class Format:
    """A format as it is written now.

    Attributes:
        version: the member ``version``; None for lines that have no such member, since they
            follow a document that has.
        kind: the class of its values, whose docstring says what the members are.
    """

    version: int | None
    kind: Any


FORMATS = {
    "labelled-surface-2": Format(2, surface.LabelledSurface),
    "instance-2": Format(2, instance.Instance),
    "solution-3": Format(3, solution.Solution),
    "scheme-3": Format(None, solution.SchemeLine),
    "plan-1": Format(1, plan.Plan),
    "tool-paths-1": Format(1, tool_paths.ToolPaths),
    "solution-verdict-1": Format(1, verdicts.SolutionVerdict),
    "plan-verdict-1": Format(1, verdicts.PlanVerdict),
    "check-error-1": Format(1, verdicts.CheckError),
    "library-1": Format(1, library_index.LibraryIndex),
    "trajectory-1": Format(1, trajectory.Trajectory),
    "trajectory-verdict-1": Format(1, trajectory_verdict.TrajectoryVerdict),
}
"""The JSON formats by the names of their schemas' files."""

TABLES = ("scene", "setup")
"""The schemas of TOML files."""


class _Untitled(GenerateJsonSchema):
    """Without titles of members, which would only be their names again."""

    def field_title_should_be_set(self, schema: Any) -> bool:  # noqa: ARG002
        """Never."""
        return False


def schema_text(file: str) -> str:
    """The text of one schema's file, given by its name without the suffix."""
    schema = _table_schema(file) if file in TABLES else _format_schema(FORMATS[file])
    first = {name: schema.pop(name) for name in ("title", "description")}
    return json.dumps({"$schema": DIALECT} | first | schema, indent=2, ensure_ascii=False) + "\n"


def _format_schema(described: Format) -> dict[str, Any]:
    schema = adapter_of(described.kind).json_schema(schema_generator=_Untitled)
    members = {"format": {"const": described.kind.FORMAT}}
    title = described.kind.FORMAT
    if described.version is not None:
        members["version"] = {"const": described.version}
        title = f"{title}, version {described.version}"
    schema["properties"] = members | schema["properties"]
    schema["required"] = [*members, *schema["required"]]
    _describe(schema, described.kind)
    for name, definition in schema.get("$defs", {}).items():
        found = (getattr(module, name, None) for module in MODULES)
        _describe(definition, next(cls for cls in found if cls is not None))
    return schema | {"title": title}


def _table_schema(file: str) -> dict[str, Any]:
    """A scene's or a setup's. It needs the extra ``frontend``."""
    from cellcolor.frontend.contact.obstacle import OBSTACLES
    from cellcolor.frontend.parts.surface import PARTS
    from cellcolor.frontend.reach.validity_tests import VALIDITY_TESTS
    from cellcolor.frontend.scene import Scene
    from cellcolor.frontend.setup import Setup
    from cellcolor.frontend.tables import FileTable

    model = Scene if file == "scene" else Setup
    schema: dict[str, Any] = model.model_json_schema(schema_generator=_Untitled)
    schema["title"] = f"{file} file (TOML)"
    definitions = schema["$defs"]
    for table in (schema, *definitions.values()):
        table["description"] = _plain(table["description"].partition("\n\n")[0])
        for name in FileTable.model_fields:  # what Python knows of a file, and no file has
            table["properties"].pop(name, None)
    if model is Scene:
        members = schema["properties"]
        members["setup"] = {"anyOf": [{"type": "string"}, members["setup"]]}
        members["object"] = _kinds(PARTS, "object", definitions)
        members["collision_object"] = members["object"]
        members["obstacle"] = {"type": "array", "items": _kinds(OBSTACLES, "obstacle", definitions)}
        tests = _kinds(VALIDITY_TESTS, "validity_test", definitions)
        members["validity_test"] = {"type": "array", "items": tests}
    return schema


def _kinds(registry: Any, prefix: str, definitions: dict[str, Any]) -> dict[str, Any]:
    """A table of one of this package's kinds, or of a kind that another package registers."""
    own = list(registry._own)
    for name in own:
        table = registry.find(name).model_json_schema(schema_generator=_Untitled)
        table["required"] = ["kind", *table.get("required", [])]
        definitions[f"{prefix}-{name}"] = table
    kind = {"type": "string", "not": {"enum": own}} if own else {"type": "string"}
    other = {
        "type": "object",
        "properties": {"kind": kind},
        "required": ["kind"],
    }
    ours = [{"$ref": f"#/$defs/{prefix}-{name}"} for name in own]
    return {"anyOf": [*ours, other]}


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
    for file in (*FORMATS, *TABLES):
        (FOLDER / f"{file}.schema.json").write_text(schema_text(file), encoding="utf-8")


if __name__ == "__main__":
    main()
