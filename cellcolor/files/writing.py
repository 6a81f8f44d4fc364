"""Writing files: whole or not at all, together or not at all, and never over something else."""

from __future__ import annotations

import os
import re
import secrets
import signal
import stat
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import ClassVar, Protocol

from cellcolor.errors import InputError
from cellcolor.signals import handled_by


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


MARKER = "cellcolor/picture"
"""The mark of every picture of ours: the ``generator`` of an HTML page, the ``Creator`` of a PNG or
SVG file. It tells pictures that may be overwritten from those of other programs."""
SIDE_MARKER = b"cellcolor/reasons"
"""The mark of a side file, which says what became of each candidate of a surface. A side file is a
ZIP archive, and this is the archive's comment."""

_LOOKED_AT = 4096  # bytes at each end of a file that are searched for our mark


@dataclass(frozen=True, slots=True)
class FileKind:
    """A kind of file that cellcolor writes, and may therefore overwrite.

    Attributes:
        name: for messages, like ``a file of the format cellcolor/instance``.
        pattern: what the first and last bytes of each such file match, searched from the start.
    """

    name: str
    pattern: re.Pattern[bytes]


def kind_of_format(name: str) -> FileKind:
    """The kind of JSON document with this ``format``, which is its first member.

    JSON Lines are of the same kind if their first line is such a document.
    """
    begin = rb'\s*\{\s*"format"\s*:\s*"' + re.escape(name.encode()) + rb'"'
    return FileKind(f"a file of the format {name}", re.compile(begin))


def _kind(name: str, pattern: bytes) -> FileKind:
    return FileKind(f"{name} written by cellcolor", re.compile(pattern, re.DOTALL))


HTML = _kind(
    "a page",
    rb'(?:<!doctype html>)?\s*<html(?: lang="en")?>\s*'
    rb'<head><meta name="generator" content="cellcolor/picture"',
)
PNG = _kind("a picture", rb"\x89PNG\r\n.*tEXtCreator\0cellcolor/picture")
SVG = _kind("a picture", rb"<\?xml.*<dc:title>cellcolor/picture</dc:title>")
SIDE_FILE = _kind("a side file", rb"PK.*cellcolor/reasons\Z")


class Writable(Protocol):
    """A value with a file format."""

    FORMAT: ClassVar[str]

    def to_json(self) -> str:
        """The file's text."""


@dataclass(frozen=True, slots=True)
class Output:
    """A file to be written.

    Attributes:
        path: where; a symbolic link stands for what it leads to.
        kind: what it will be.
        content: its bytes in pieces, taken once.
    """

    path: Path
    kind: FileKind
    content: Iterable[bytes]

    @classmethod
    def of(cls, path: Path, value: Writable) -> Output:
        """The file of a value."""
        return cls(path, kind_of_format(value.FORMAT), [value.to_json().encode()])


def is_stream(path: Path) -> bool:
    """Whether a path leads to a device, a pipe or the like, which nothing can replace."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return False
    return is_standard_output(path) or not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def is_standard_output(path: Path) -> bool:
    """Whether a path leads to this process's standard output.

    A device that is no terminal does not count, above all the null device.
    """
    try:
        own, other = os.fstat(1), path.stat()
    except (OSError, ValueError):
        return False
    return os.path.samestat(own, other) and (not stat.S_ISCHR(own.st_mode) or os.isatty(1))


def check_output(path: Path, kind: FileKind, inputs: Iterable[Path] = ()) -> None:
    """Refuse a place where writing would destroy something, or cannot succeed.

    An existing file is replaced only if it is no input, and either is empty or has the kind that is
    about to be written. So no file of another kind is lost, such as a mesh that an input refers to.

    Args:
        inputs: files that the same command reads.

    Raises:
        InputError: with the reason.
    """
    try:
        place = _place(path)
        if is_stream(path):
            if stat.S_ISBLK(path.stat().st_mode):
                raise InputError(str(path), None, "is a disk, not a file")
            return
        if place.is_dir():
            raise InputError(str(path), None, "is a folder, not a file")
        if not place.parent.is_dir():
            raise InputError(str(path), None, "its folder does not exist")
        if not place.exists():
            return
        if any(_same(place, source) for source in inputs):
            raise InputError(str(path), None, "is an input, which would be overwritten")
        if place.stat().st_size and not kind.pattern.match(_ends(place)):
            message = f"exists and is not {kind.name}; it is not overwritten"
            raise InputError(str(path), None, message)
        if not os.access(place, os.W_OK):
            raise InputError(str(path), None, "is write-protected")
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from error


def is_folder(path: Path) -> bool:
    """Whether a folder is there.

    Raises:
        InputError: no file can have this name, or this process may not look there.
    """
    try:
        return path.is_dir()
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from error


def is_folder_or_nothing(path: Path) -> bool:
    """Whether a folder is there; False if nothing is, so that one can be made.

    Raises:
        InputError: something else is there, or stands where a folder above it has to be.
    """
    if is_folder(path):
        return True
    nearest = next(place for place in (path, *path.parents) if os.path.lexists(place))
    if not nearest.is_dir():
        raise InputError(str(nearest), None, "must be a folder")
    return False


def write(outputs: Sequence[Output], inputs: Sequence[Path] = ()) -> None:
    """Write files that belong together: all of them or, after any failure or signal, none.

    Every file is written to a temporary name first; then all are renamed in the order given,
    which no signal but SIGKILL interrupts. A file that refers to the others has to be the last, so
    that it is never there before them. Devices and pipes are written to directly, before any file
    is renamed.

    Args:
        inputs: files that the same command reads; :func:`check_output` is called with them again.

    Raises:
        InputError: a file cannot be written, or two files would have the same path.
    """
    for output in outputs:
        check_output(output.path, output.kind, inputs)
    places = [_place(o.path) for o in outputs if not is_stream(o.path)]
    if len(set(places)) < len(places):
        twice = next(place for place in places if places.count(place) > 1)
        raise InputError(str(twice), None, "two files would be written there")
    staged: list[tuple[Path, Path]] = []  # temporary names and places
    try:
        for output in outputs:
            try:
                if is_stream(output.path):
                    _stream(output)
                    continue
                place = _place(output.path)
                # A short name, whatever that of the place: names have a greatest length.
                file = place.with_name(f".cellcolor-{secrets.token_hex(8)}.tmp")
                staged.append((file, place))
                with file.open("xb") as stream:
                    stream.writelines(output.content)
            except (OSError, ValueError) as error:
                raise _unwritable(output.path, error) from error
        with undisturbed():
            for file, place in staged:
                try:
                    file.replace(place)
                except OSError as error:
                    raise _unwritable(place, error) from error
    finally:
        with undisturbed():
            for file, _ in staged:
                with suppress(OSError):
                    file.unlink(missing_ok=True)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let signals wait until the end."""
    waiting: list[int] = []
    try:
        with handled_by(lambda number, _frame: waiting.append(number)):
            yield
    finally:
        if waiting:
            signal.raise_signal(waiting[0])


def _place(path: Path) -> Path:
    """What a path leads to, through symbolic links."""
    try:
        return path.resolve()
    except RuntimeError as error:  # Python before 3.13
        raise InputError(str(path), None, "symbolic links lead in a circle") from error


def _same(place: Path, source: Path) -> bool:
    try:
        return place.samefile(source)
    except OSError:  # there is no such input; whoever reads it says so
        return False


def _ends(path: Path) -> bytes:
    """The first and the last bytes of a file; all of a small one."""
    with path.open("rb") as stream:
        head = stream.read(_LOOKED_AT)
        size = stream.seek(0, os.SEEK_END)
        stream.seek(max(len(head), size - _LOOKED_AT))
        return head + stream.read()


def _stream(output: Output) -> None:
    if is_standard_output(output.path):
        sys.stdout.flush()
        handle = os.dup(1)
    else:
        handle = os.open(output.path, os.O_WRONLY)
    with os.fdopen(handle, "wb") as stream:
        stream.writelines(output.content)


def _unwritable(path: Path, error: Exception) -> InputError:
    reason = error.strerror if isinstance(error, OSError) else str(error)
    return InputError(str(path), None, reason or "cannot be written")
