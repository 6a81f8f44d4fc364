"""``cellcolor build``: from a scene or a labelled surface to an instance."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path, PurePath

from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import build_scene, graph_of, is_scene, read_graph
from cellcolor.data.files import write_text
from cellcolor.data.instance import Instance
from cellcolor.errors import InputError


def build_instance(source: Path, output: Path) -> Exit:
    """Write an instance; for a scene its labelled surface and side file as well."""
    if output.is_dir():
        raise InputError(str(output), None, "is a folder, not a file to write")
    if not output.parent.is_dir():
        raise InputError(str(output), None, "its folder does not exist")
    if is_scene(source):
        scene = build_scene(source)
        stem = output.name.removesuffix(".json")
        surface_path = output.with_name(f"{stem}.surface.json")
        side_path = output.with_name(f"{stem}.reasons.npz")
        surface = replace(scene.surface, meta=scene.surface.meta | {"side_file": side_path.name})
        instance = graph_of(surface, source, surface_path.name)
        # The side file first: a surface never names one that is not there.
        scene.write_side(side_path)
        write_text(surface_path, surface.to_json())
        print(scene.report)
        print(f"wrote {surface_path}\nwrote {side_path}")
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
