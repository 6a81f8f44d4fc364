"""Reading whatever can be solved: an instance, a labelled surface or a robot scene."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from cellcolor.data import instance as instance_file
from cellcolor.data import surface as surface_file
from cellcolor.data.files import read_document
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError

_FRONTEND_PACKAGES = {"coal", "fcl", "pinocchio", "scipy", "trimesh"}


@dataclass(frozen=True, slots=True)
class Scene:
    """A robot scene, built.

    Attributes:
        surface: what the front end made of it.
        report: what it has to say about that, several lines, warnings among them.
        warnings: what is probably not meant, a sentence each.
        write_side: writes the surface's side file, reasons and configurations (``.npz``).
    """

    surface: LabelledSurface
    report: str
    warnings: tuple[str, ...]
    write_side: Callable[[Path], None]


def is_scene(path: Path) -> bool:
    """Scenes are told by their suffix, everything else by its ``format``."""
    return path.suffix == ".toml"


def build_scene(path: Path) -> Scene:
    """Run the front end.

    Raises:
        InputError: the scene cannot be used, or the front end is not installed.
    """
    try:
        from cellcolor.frontend import build_surface
        from cellcolor.frontend.sidefile import write_side_file
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing not in _FRONTEND_PACKAGES:
            raise
        raise InputError(
            str(path), None, f"scenes need {missing}: pip install 'cellcolor[frontend]'"
        ) from error
    result = build_surface(path)
    report = result.report
    return Scene(result.surface, str(report), report.warnings, partial(write_side_file, result))


def read_graph(path: Path) -> Instance | LabelledSurface:
    """An instance or a labelled surface, whichever the file says it is.

    Raises:
        InputError: the file cannot be read, is neither, or holds something forbidden.
    """
    document = read_document(path)
    try:
        match document.get("format"):
            case instance_file.FORMAT:
                return Instance.from_document(document)
            case surface_file.FORMAT:
                return LabelledSurface.from_document(document)
            case other:
                expected = f"{instance_file.FORMAT!r} or {surface_file.FORMAT!r}"
                raise InputError(None, "format", f"must be {expected}, is {other!r}")
    except InputError as error:
        raise error.in_file(str(path)) from error


def graph_of(surface: LabelledSurface, path: Path, reference: str) -> Instance:
    """The topological graph of a surface.

    Args:
        surface: the labelled surface.
        path: the file it came from, for errors.
        reference: where the instance's file will say that the surface is.
    """
    try:
        return decompose(surface, reference)
    except InputError as error:
        raise error.in_file(str(path)) from error


def read_instance(path: Path) -> Instance:
    """An instance from anything that can be solved.

    A surface or scene becomes the instance that ``build`` writes beside it. What the front end
    warns of goes to standard error.

    Raises:
        InputError: with the file named.
    """
    if is_scene(path):
        scene = build_scene(path)
        for warning in scene.warnings:
            print(f"cellcolor: {path}: warning: {warning}", file=sys.stderr)
        return graph_of(scene.surface, path, f"{path.stem}.surface.json")
    found = read_graph(path)
    return found if isinstance(found, Instance) else graph_of(found, path, path.name)
