"""``cellcolor build``: from a scene or a labelled surface to an instance."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path, PurePath

from cellcolor.cli.exits import Exit
from cellcolor.cli.inputs import open_file
from cellcolor.cli.tables import nothing_to_cover
from cellcolor.cli.terminal import apart_from, complain, say
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
from cellcolor.door.subject import Subject, is_scene
from cellcolor.errors import InputError
from cellcolor.files.writing import (
    SIDE_FILE,
    Output,
    check_output,
    is_stream,
    kind_of_format,
    write,
)

_INSTANCE = kind_of_format(Instance.FORMAT)
_SURFACE = kind_of_format(LabelledSurface.FORMAT)


def build_instance(source: Path, output: Path) -> Exit:
    """Write an instance; for a scene its labelled surface and side file as well."""
    check_output(output, _INSTANCE, [source])
    if is_scene(output):
        message = "must not end in .toml: the other commands would take it for a scene"
        raise InputError(str(output), None, message)
    with apart_from(output):
        instance = (_build_scene if is_scene(source) else _build_surface)(source, output)
        say(
            f"wrote {output}: {count(len(instance.cells), 'cell')}, "
            f"{count(len(instance.edges), 'edge')}, {count(len(instance.colors), 'color')}"
        )
    if instance.nothing_to_cover:
        complain(f"{source}: {nothing_to_cover(instance)}")
        return Exit.STOPPED
    return Exit.DONE


def _build_scene(source: Path, output: Path) -> Instance:
    stem = output.name.removesuffix(".json")
    surface_path = output.with_name(f"{stem}.surface.json")
    side_path = output.with_name(f"{stem}.reasons.npz")
    alone = is_stream(output)  # nothing lies beside a pipe, and nothing can be named from there
    if not alone:
        check_output(surface_path, _SURFACE, [source])
        check_output(side_path, SIDE_FILE, [source])
    built = open_file(source).built
    assert built is not None
    surface = replace(built.surface, meta=built.surface.meta | {"side_file": side_path.name})
    named = Subject(source, built, surface)
    instance = named.decomposed(None if alone else surface_path.name).instance
    files = [Output(output, _INSTANCE, [instance.to_json().encode()])]
    if not alone:
        # The instance last: it carries the fingerprint of its surface.
        files = [
            Output(side_path, SIDE_FILE, [built.candidates.to_bytes()]),
            Output(surface_path, _SURFACE, [surface.to_json().encode()]),
            *files,
        ]
    write(files, [source])
    for line in str(built.report).split("\n"):
        say(line)
    for file in files[:-1]:
        say(f"wrote {file.path}")
    return instance


def _build_surface(source: Path, output: Path) -> Instance:
    found = open_file(source)
    if found.given_instance is not None:
        raise InputError(str(source), "format", "is an instance already")
    relative = os.path.relpath(source.resolve(), output.parent.resolve())
    reference = None if is_stream(output) else PurePath(relative).as_posix()
    instance = found.decomposed(reference).instance
    write([Output(output, _INSTANCE, [instance.to_json().encode()])], [source])
    return instance
