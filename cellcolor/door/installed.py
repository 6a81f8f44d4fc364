"""What is installed: shipped files by name, extras, and versions of all that is used."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cellcolor.data.wording import count, span
from cellcolor.errors import InputError
from cellcolor.files.writing import path_of, shipped_folder

if TYPE_CHECKING:
    from cellcolor.data.library_index import LibraryIndex

# Of several files of one name the first one's kind is meant: a scene leads to all the others.
_ENDINGS = (".toml", ".json", ".surface.json")
_SOLUTION = ".solution.json"
"""A stored solution is opened by its whole name: it is what ``check`` takes beside a graph."""
_INDEX = "index.json"


class Library(dict[str, str]):
    """What each shipped name stands for, one line each; printed as a table."""

    def __str__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:<{width}}  {line}" for name, line in self.items())

    @property
    def index(self) -> LibraryIndex:
        """All that is known of the graphs in it (docs/library.md)."""
        from cellcolor.data.library_index import LibraryIndex  # a name needs no validation

        return LibraryIndex.read(index_file())


def library() -> Library:
    """The names that can replace a file anywhere: ``cellcolor.solve("wok")``.

    The file that a name stands for is a scene if there is one, else a graph (an instance), else a
    labelled surface. The others have their ending added: ``wok.json`` is the graph of the scene
    ``wok``, ``wok.surface.json`` its labelled surface. Of graphs the line says what is known of the
    minimum in the search space paper; ``library().index`` has the rest.
    """
    files = _files()
    known = _entries()
    names = {name for name in files if "." not in name} | known.keys()
    return Library({name: _line(files.get(name), known.get(name)) for name in sorted(names)})


def index_file() -> Path:
    """The file of the index of the library's graphs."""
    return shipped_folder() / "instances" / _INDEX


def find_file(source: str | os.PathLike[str]) -> Path:
    """The file for a name: an existing file takes precedence over a shipped one.

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
    outside = _entries().get(source, {}).get("outside")
    if outside is not None:
        options = "".join(f" --correct {one}" for one in outside["corrections"])
        how = f"cellcolor import FILE -o {source}.json{options}"
        raise InputError(source, None, f"is not shipped; it is {outside['place']}, read by {how}")
    from difflib import get_close_matches

    close = get_close_matches(source, files, n=1)
    hint = f"; did you mean {close[0]!r}?" if close else ""
    raise InputError(source, None, f"is not a file, and nothing of that name is shipped{hint}")


def find_claim(source: str | os.PathLike[str]) -> Path:
    """The file of a claim; of shipped files only solutions, by their whole name.

    Raises:
        InputError: it is no path.
    """
    is_name = isinstance(source, str) and source.endswith(_SOLUTION)
    return find_file(source) if is_name else path_of(source)


def _files() -> dict[str, Path]:
    """Every shipped file by its name, and by its name without the ending."""
    found: dict[str, Path] = {}
    index = index_file()
    for place in ("instances", "models/robots"):
        for path in sorted((shipped_folder() / place).rglob("*")):
            if path.suffix in (".toml", ".json") and path != index:
                found[path.name] = path
    for ending in _ENDINGS:
        for name, path in list(found.items()):
            stem = name.removesuffix(ending)
            if "." not in stem:
                found.setdefault(stem, path)
    return found


def _entries() -> dict[str, dict[str, Any]]:
    """The entries of the index by name, as they are written."""
    document = json.loads(index_file().read_text(encoding="utf-8"))
    return {entry["name"]: entry for entry in document["entries"]}


def _line(path: Path | None, entry: dict[str, Any] | None) -> str:
    """A line about a name: the file's own words, and what the index knows of the graph."""
    if path is not None and path.suffix == ".toml":
        kind = "robot" if path.parent.name == "robots" else "scene"
        about = f"{kind}: {_comment(path).split('. ')[0].removesuffix('.')}."
        return about if entry is None else f"{about} Its graph: {_known(entry)}"
    if entry is None:
        return "graph or surface, not in the index"
    kind = "surface" if path is not None and path.name.endswith(_ENDINGS[-1]) else "graph"
    where = "" if path is not None else ", not here"
    return f"{kind}{where}, {entry['family']}: {_known(entry)}"


def _known(entry: dict[str, Any]) -> str:
    """How large a graph is, and where its minimum lies."""
    lower, upper = entry["paper"]["lower"]["value"], (entry["paper"]["upper"] or {}).get("value")
    minimum = count(upper, "segment") if lower == upper else f"{span(lower, upper)} segments, open"
    return f"{count(entry['cells'], 'cell')}, {minimum}."


def _comment(path: Path) -> str:
    """The comment that a TOML file begins with."""
    comment = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        comment.append(line.removeprefix("#").strip())
    return " ".join(comment)


DISTRIBUTION = "fewest-lift-offs"
"""What to install; ``cellcolor`` on the Python Package Index is somebody else's program."""

_EXTRAS = {
    "matplotlib": "viz",
    "coal": "frontend",
    "fcl": "frontend",
    "igl": "frontend",
    "pinocchio": "frontend",
    "scipy": "frontend",
    "trimesh": "frontend",
    "gpytoolbox": "parts",
    "potpourri3d": "motion",
}
DISTRIBUTIONS = (
    *("click", "networkx", "numpy", "ortools", "pydantic", "rich"),
    *("pin", "python-fcl", "libigl", "scipy", "trimesh", "EAIK", "potpourri3d"),
    *("gpytoolbox", "matplotlib"),
    *("clingo", "highspy", "pychoco", "pyscipopt", "python-sat"),
)
"""What the package and its extras need, except those for tests and docs."""


@contextmanager
def extras_for(path: Path | str) -> Iterator[None]:
    """Turn a missing extra into a line that says what to install for a file or a purpose."""
    try:
        yield
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing not in _EXTRAS:
            raise
        raise _lack(path, missing, _EXTRAS[missing]) from error


def require_motion(purpose: str, modules: Sequence[str]) -> None:
    """Fail at once if the extra ``motion`` is missing, not only when the first path is laid.

    Args:
        modules: of this extra, or of ``frontend``, which comes with it.

    Raises:
        InputError: one of them is not installed.
    """
    for module in modules:
        if find_spec(module) is None:
            raise _lack(purpose, module, "motion")


def _lack(purpose: Path | str, module: str, extra: str) -> InputError:
    line = f"needs {module}: pip install '{DISTRIBUTION}[{extra}]'"
    return InputError(purpose, None, line)


def show_versions() -> None:
    """Print the versions of cellcolor, of Python and of all that cellcolor uses."""
    from cellcolor.machine import this_machine

    machine = this_machine()
    rows = [
        ("cellcolor", machine.cellcolor),
        ("python", machine.python),
        ("system", platform.platform()),
        ("processor", f"{machine.cpu}, {machine.cores} cores, {machine.memory_mb} MB"),
        *((name, _version(name)) for name in DISTRIBUTIONS),
    ]
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        print(f"{name:<{width}}  {value}")


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
