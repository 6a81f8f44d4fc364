"""The names of files that callers hand over, and where the files are that come with the package."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from cellcolor.errors import InputError


def path_of(name: str | PathLike[str]) -> Path:
    """The path that a file's name stands for.

    Raises:
        InputError: it is neither a text nor a path, an empty text, or the content of a file.
    """
    if isinstance(name, str) and name.lstrip().startswith(("{", "[")):
        start = f"{name[:30]}…" if len(name) > 30 else name
        raise InputError(None, None, f"{start!r} is the content of a file, not its name")
    try:
        if isinstance(name, str) and not name:
            raise TypeError  # pathlib would take it for the folder that one is in
        return Path(name)
    except TypeError as error:
        raise InputError(None, None, f"{name!r:.100} is not a file name") from error


def shipped_folder() -> Path:
    """The folder that has ``instances`` and ``models``."""
    package = Path(__file__).parents[1]
    inside = package / "shipped"
    return inside if inside.is_dir() else package.parent
