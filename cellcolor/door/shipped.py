"""The library of scenes, robots, surfaces and instances that comes with the package, by name.

In a repository it lies in the folders ``instances`` and ``models``; a wheel has the same two
folders inside the package, so that the files' references to each other hold there as well.
"""

from __future__ import annotations

import os
from pathlib import Path

from cellcolor.errors import InputError
from cellcolor.files.paths import path_of

__all__ = ["Library", "find_file", "library"]

# Of several files of one name the first one's kind is meant: a scene leads to all the others.
_ENDINGS = (".toml", ".json", ".surface.json")
_KINDS = {".toml": "scene", ".json": "graph", ".surface.json": "surface"}


class Library(dict[str, str]):
    """What each shipped name stands for, a line each; printed as a table."""

    def __str__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:<{width}}  {line}" for name, line in self.items())


def library() -> Library:
    """The names that can be given wherever a file can: ``cellcolor.solve("wok")``.

    The file that a name stands for is a scene if there is one, else a graph (an instance), else a
    labelled surface. The others have their ending added: ``wok.json`` is the graph of the scene
    ``wok``, ``wok.surface.json`` its labelled surface.
    """
    files = _files()
    names = sorted(name for name in files if not name.endswith(_ENDINGS))
    return Library({name: _described(files[name]) for name in names})


def find_file(source: str | os.PathLike[str]) -> Path:
    """The file that is meant: one that is there goes before a shipped one of the same name.

    Only a text can be a shipped name; a path is a path, whether the file is there or not.

    Raises:
        InputError: neither a path, nor a file or a name that is known.
    """
    path = path_of(source)
    try:
        there = path.exists() and not path.is_dir()
    except (OSError, ValueError):  # a name that is too long, say
        return path  # whoever reads it says what is wrong
    if there or not isinstance(source, str):
        return path
    files = _files()
    if source in files:
        return files[source]
    if path.suffix or path.name != source or path.is_dir():
        return path
    from difflib import get_close_matches

    close = get_close_matches(source, files, n=1)
    hint = f"; is {close[0]!r} meant?" if close else ""
    raise InputError(source, None, f"is no file, and nothing of that name is shipped{hint}")


def _folder() -> Path:
    """The folder that has ``instances`` and ``models``."""
    package = Path(__file__).parents[1]
    inside = package / "shipped"
    return inside if inside.is_dir() else package.parent


def _files() -> dict[str, Path]:
    """Every shipped file by its name, and by its name without the ending."""
    found: dict[str, Path] = {}
    for place in ("instances", "models/robots"):
        for path in sorted((_folder() / place).rglob("*")):
            if path.suffix in (".toml", ".json"):
                found[path.name] = path
    for ending in _ENDINGS:
        for name, path in list(found.items()):
            if _ending(name) == ending:
                found.setdefault(name.removesuffix(ending), path)
    return found


def _ending(name: str) -> str:
    return next((end for end in reversed(_ENDINGS) if name.endswith(end)), "")


def _described(path: Path) -> str:
    """A line about a shipped file, from its own words."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".toml":
        comment = []
        for line in text.splitlines():
            if not line.startswith("#"):
                break
            comment.append(line.removeprefix("#").strip())
        kind = "robot" if path.parent.name == "robots" else "scene"
        return f"{kind}: {_first_sentence(' '.join(comment))}"
    import json

    document = json.loads(text)
    meta = document.get("meta") or {}
    size = (
        f"{len(document['cells'])} cells"
        if "cells" in document
        else f"{len(document['vertices'])} vertices"
    )
    words = meta.get("why") or meta.get("source")
    about = f": {_first_sentence(words)}" if words else ""
    return f"{_KINDS[_ending(path.name)]}, {size}{about}"


def _first_sentence(text: str) -> str:
    return text.split(". ")[0].removesuffix(".") + "."
