"""Where the mesh files are that a URDF names: ``package://``, ``file://`` and relative names.

A package is a folder with a ``package.xml`` that has its name, or, without such a file, a folder of
that name.
"""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import unquote, urlsplit

from cellcolor.errors import InputError

__all__ = ["find_mesh"]

_ROS = "ROS_PACKAGE_PATH"
_DEEPEST = 4  # folders below a given one that packages are looked for in


def find_mesh(
    named: str, file: Path, field: str, folder: Path, package_folders: Sequence[Path]
) -> Path:
    """The file of a mesh.

    Args:
        named: what the URDF calls it.
        file, field: the URDF and the element, for errors.
        folder: of the URDF.
        package_folders: packages, or folders that have some, asked first.

    Raises:
        InputError: there is no such file; says what was tried.
    """
    parts = urlsplit(named)
    tried: list[str] = []
    if parts.scheme == "package":
        package, inside = parts.netloc, unquote(parts.path.lstrip("/"))
        for root in _roots(package, folder, package_folders):
            path = root / inside
            if path.is_file():
                return path
            tried.append(str(path))
        if not tried:
            tried = [_searched(package, folder, package_folders)]
    elif parts.scheme == "file":
        path = Path(unquote(parts.path))
        tried.append(str(path))
    elif parts.scheme and len(parts.scheme) > 1:  # one letter is a drive of Windows
        message = f"{named!r}: only package://, file:// and names of files are known"
        raise InputError(str(file), field, message)
    else:
        path = folder / named
        tried.append(str(path))
    if parts.scheme != "package" and path.is_file():
        return path
    raise InputError(
        str(file), field, f"no mesh {named!r}; tried {'; '.join(dict.fromkeys(tried))}"
    )


def _searched(package: str, folder: Path, package_folders: Sequence[Path]) -> str:
    given = ", ".join(map(str, package_folders)) or "none"
    return (
        f"to find the package {package!r} in robot.package_folders ({given}), in the folders "
        f"above {folder.resolve()}, and in ROS_PACKAGE_PATH ({os.environ.get(_ROS, 'not set')})"
    )


def _roots(package: str, folder: Path, package_folders: Sequence[Path]) -> Iterator[Path]:
    """Folders of the package, in the order in which they are asked."""
    for given in package_folders:
        yield from _below(given, package, _DEEPEST)
    here = folder.resolve()
    for above in (here, *here.parents):
        yield from _below(above, package, 1)
    for entry in os.environ.get(_ROS, "").split(os.pathsep):
        if entry:
            yield from _below(Path(entry), package, _DEEPEST)


def _below(folder: Path, package: str, depth: int) -> Iterator[Path]:
    """The folder and those in it, as far as they are the package; packages hold no others."""
    manifest = folder / "package.xml"
    if manifest.is_file():
        if _name(manifest) == package:
            yield folder
        return
    if folder.name == package and folder.is_dir():
        yield folder
    if depth == 0:
        return
    try:
        inner = sorted(entry.path for entry in os.scandir(folder) if entry.is_dir())
    except OSError:
        return
    for path in inner:
        yield from _below(Path(path), package, depth - 1)


def _name(manifest: Path) -> str | None:
    try:
        found = ET.parse(manifest).find("name")
    except (ET.ParseError, OSError):
        return None
    return None if found is None or found.text is None else found.text.strip()
