"""``cellcolor build``: from a scene or a labelled surface to an instance."""

from __future__ import annotations

import os
from pathlib import Path, PurePath

from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import build_scene, graph_of, is_scene, read_graph
from cellcolor.data.files import write_text
from cellcolor.data.instance import Instance
from cellcolor.errors import InputError


def build_instance(source: Path, output: Path) -> Exit:
    """Write the instance of a scene or surface; for a scene its labelled surface as well."""
    if output.is_dir():
        raise InputError(str(output), None, "is a folder, not a file to write")
    if not output.parent.is_dir():
        raise InputError(str(output), None, "its folder does not exist")
    if is_scene(source):
        scene = build_scene(source)
        surface = scene.surface
        surface_path = output.with_name(output.name.removesuffix(".json") + ".surface.json")
        instance = graph_of(surface, source, surface_path.name)
        write_text(surface_path, surface.to_json())
        print(scene.report)
        print(f"wrote {surface_path}")
    else:
        if output.exists() and output.samefile(source):
            raise InputError(str(output), None, "is the input itself")
        found = read_graph(source)
        if isinstance(found, Instance):
            raise InputError(str(source), "format", "is an instance already")
        surface = found
        relative = os.path.relpath(source.resolve(), output.parent.resolve())
        instance = graph_of(surface, source, PurePath(relative).as_posix())
    write_text(output, instance.to_json())
    print(
        f"wrote {output}: {len(instance.cells)} cells, {len(instance.edges)} edges, "
        f"{len(instance.colors)} colors"
    )
    return Exit.DONE
