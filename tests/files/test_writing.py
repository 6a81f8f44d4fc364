"""What is written: over nothing foreign, through links, whole, together, and without traces."""

from __future__ import annotations

import json
import os
import signal
import stat
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from commands import run
from documents import INSTANCE, PLAN, SOLUTION, SURFACE
from library import INSTANCES, PAPER
from pages import DRAWN, saved, small_wok

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.errors import InputError
from cellcolor.files.writing import (
    HTML,
    PNG,
    SIDE_FILE,
    SVG,
    FileKind,
    Output,
    check_output,
    kind_of_format,
    write,
)

RING = PAPER / "ring.json"
RING_SURFACE = PAPER / "ring.surface.json"
Capture = pytest.CaptureFixture[str]

INSTANCE_KIND = kind_of_format("cellcolor/instance")
KINDS = {
    "instance": INSTANCE_KIND,
    "surface": kind_of_format("cellcolor/labelled-surface"),
    "solution": kind_of_format("cellcolor/solution"),
    "html": HTML,
    "png": PNG,
    "svg": SVG,
    "side file": SIDE_FILE,
}
FOREIGN = {
    "scene": (INSTANCES / "scenes" / "wok.toml").read_bytes(),
    "urdf": (INSTANCES.parent / "models" / "robots" / "ur5.urdf").read_bytes(),
    "stl": b"solid x\nendsolid x\n",
    "plan": json.dumps(PLAN).encode(),
    "page": b"<!doctype html>\n<html>\n<head><title>cellcolor/picture</title></head></html>",
    "png": b"\x89PNG\r\n\x1a\n" + bytes(100),
    "svg": b'<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg"/>',
    "archive": b"PK\x05\x06" + bytes(18),
    "text": b"cellcolor/instance cellcolor/solution cellcolor/picture cellcolor/reasons",
    "a format as a value": b'{"title": {"format": "cellcolor/instance"}}',
    "binary": bytes(range(256)) * 40,
    "one byte": b"\n",
}


def refused(arguments: list[object], capsys: Capture, *named: str) -> None:
    capsys.readouterr()
    assert run(*arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    for text in named:
        assert text in line


def instance_at(path: Path, text: bytes | Iterable[bytes] = b"{}") -> Output:
    return Output(path, INSTANCE_KIND, [text] if isinstance(text, bytes) else text)


OLD = json.dumps(INSTANCE).encode()


class TestForeignFiles:
    @pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS.keys())
    @pytest.mark.parametrize("content", FOREIGN.values(), ids=FOREIGN.keys())
    def test_refused(self, content: bytes, kind: FileKind, tmp_path: Path) -> None:
        path = tmp_path / "there"
        path.write_bytes(content)
        with pytest.raises(InputError, match="not overwritten"):
            check_output(path, kind)
        with pytest.raises(InputError, match="not overwritten"):
            write([Output(path, kind, [b"new"])])
        assert path.read_bytes() == content
        assert list(tmp_path.iterdir()) == [path]

    @pytest.mark.parametrize("document", [INSTANCE, SURFACE, SOLUTION], ids=lambda d: d["format"])
    def test_each_format_by_itself_only(self, document: object, tmp_path: Path) -> None:
        path = tmp_path / "x.json"
        path.write_text(json.dumps(document), encoding="utf-8")
        own = kind_of_format(json.loads(path.read_text(encoding="utf-8"))["format"])
        for kind in KINDS.values():
            if kind == own:
                check_output(path, kind)
                continue
            with pytest.raises(InputError, match="not overwritten"):
                check_output(path, kind)

    def test_empty_file(self, tmp_path: Path) -> None:
        """As ``mktemp`` makes them: there is nothing to lose."""
        path = tmp_path / "empty"
        path.touch()
        write([instance_at(path, b"new")])
        assert path.read_bytes() == b"new"

    def test_write_protected(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        path = tmp_path / "x.json"
        path.write_bytes(OLD)
        monkeypatch.setattr(os, "access", lambda *_: False)  # root may write everything
        with pytest.raises(InputError, match="write-protected"):
            write([instance_at(path)])
        assert path.read_bytes() == OLD

    def test_inputs(self, tmp_path: Path, capsys: Capture) -> None:
        """An input is not overwritten, whatever name it has."""
        given = tmp_path / "given.json"
        assert run("build", RING_SURFACE, "-o", given) == 0
        before = given.read_bytes()
        link = tmp_path / "link.json"
        link.symlink_to(given)
        for output in (given, link):
            refused(["export", given, "-o", output, "--format", "opb"], capsys, "is an input")
        assert given.read_bytes() == before
        assert link.is_symlink()

    def test_surface_that_an_instance_names(self, tmp_path: Path, capsys: Capture) -> None:
        surface = saved(DRAWN, tmp_path)
        before = surface.read_bytes()
        instance = tmp_path / "i.json"
        assert run("build", surface, "-o", instance) == 0
        refused(["solve", instance, "-o", surface], capsys, str(surface), "not overwritten")
        assert surface.read_bytes() == before


class TestPictures:
    @pytest.mark.parametrize("kind", ["html", "png", "svg"])
    def test_own_ones_are_overwritten(self, kind: str, tmp_path: Path, capsys: Capture) -> None:
        surface, path = saved(DRAWN, tmp_path), tmp_path / f"x.{kind}"
        assert run("show", surface, "-o", path) == 0
        first = path.read_bytes()
        assert run("show", surface, "-o", path, "--color", 0) == 0
        assert path.read_bytes() != first
        path.write_bytes(first.replace(b"cellcolor", b"otherpaint"))
        foreign = path.read_bytes()
        refused(["show", surface, "-o", path], capsys, str(path), "not overwritten")
        assert path.read_bytes() == foreign


class TestPlaces:
    def test_links(self, tmp_path: Path) -> None:
        folder = tmp_path / "elsewhere"
        folder.mkdir()
        real, link, chain = folder / "real.json", tmp_path / "link.json", tmp_path / "chain.json"
        link.symlink_to("elsewhere/real.json")
        chain.symlink_to("link.json")
        for text in (b"{}", OLD):  # the first time there is nothing at the end of the links
            write([instance_at(chain, text)])
            assert chain.is_symlink() and link.is_symlink()
            assert real.read_bytes() == text
            real.write_bytes(OLD)
        assert list(folder.iterdir()) == [real]

    def test_links_in_a_circle(self, tmp_path: Path) -> None:
        one, other = tmp_path / "one", tmp_path / "other"
        one.symlink_to(other)
        other.symlink_to(one)
        with pytest.raises(InputError, match=r"circle|symbolic links"):
            write([instance_at(one)])

    def test_null_device(self) -> None:
        before = Path(os.devnull).stat()
        assert run("build", RING_SURFACE, "-o", os.devnull) == 0
        assert run("solve", RING, "-o", os.devnull) == 0
        after = Path(os.devnull).stat()
        assert stat.S_ISCHR(after.st_mode) and after.st_ino == before.st_ino

    def test_fifo(self, tmp_path: Path) -> None:
        fifo = tmp_path / "fifo"
        os.mkfifo(fifo)
        read: list[bytes] = []
        reader = threading.Thread(target=lambda: read.append(fifo.read_bytes()))
        reader.start()
        assert run("solve", RING, "-o", fifo) == 0
        reader.join()
        assert json.loads(read[0])["segments"] == 2
        assert list(tmp_path.iterdir()) == [fifo]

    @pytest.mark.second
    @pytest.mark.parametrize("redirected", [False, True], ids=["pipe", "file"])
    def test_standard_output(self, redirected: bool, tmp_path: Path) -> None:
        """The file alone goes there; what is printed goes to standard error."""
        command = [sys.executable, "-m", "cellcolor", "solve", str(RING), "-o", "/dev/stdout"]
        if redirected:
            path = tmp_path / "out.json"
            with path.open("wb") as stream:
                done = subprocess.run(command, stdout=stream, stderr=subprocess.PIPE)
            out = path.read_bytes()
        else:
            done = subprocess.run(command, capture_output=True)
            out = done.stdout
        assert done.returncode == 0
        assert Solution.from_document(json.loads(out)).segments == 2
        assert b"1 lift-off, optimal" in done.stderr

    def test_what_goes_to_a_pipe_names_no_surface(self) -> None:
        command = [sys.executable, "-m", "cellcolor", "build", str(RING_SURFACE)]
        done = subprocess.run([*command, "-o", "/dev/stdout"], capture_output=True, check=True)
        assert Instance.from_document(json.loads(done.stdout)).surface is None

    def test_full_device(self, capsys: Capture) -> None:
        refused(["solve", RING, "-o", "/dev/full"], capsys, "/dev/full", "No space left")

    @pytest.mark.parametrize("length", [244, 255, 256, 300, 5000])
    def test_long_names(self, length: int, tmp_path: Path, capsys: Capture) -> None:
        path = tmp_path / ("x" * (length - 5) + ".json")
        if length <= 255:
            assert run("solve", RING, "-o", path) == 0
            assert list(tmp_path.iterdir()) == [path]
        else:
            refused(["solve", RING, "-o", path], capsys, "File name too long")
            refused(["build", RING_SURFACE, "-o", path], capsys, "File name too long")
            refused(["solve", path], capsys, "File name too long")
            refused(["show", RING, "-o", path.with_suffix(".json.png")], capsys, "name too long")
            assert list(tmp_path.iterdir()) == []


class TestTogether:
    def test_all_or_none(self, tmp_path: Path) -> None:
        """Whichever file fails, all are as before."""
        paths = [tmp_path / name for name in "abc"]
        for path in paths[:2]:
            path.write_bytes(OLD)

        def fails() -> Iterator[bytes]:
            yield b"new" * 100_000
            raise OSError(28, "No space left on device")

        for broken in paths:
            with pytest.raises(InputError, match=rf"{broken.name}: No space"):
                write([instance_at(p, fails() if p == broken else b"{}") for p in paths])
            assert [path.read_bytes() for path in paths[:2]] == [OLD, OLD]
            assert sorted(tmp_path.iterdir()) == paths[:2]
        write([instance_at(path, b"new") for path in paths])
        assert [path.read_bytes() for path in paths] == [b"new"] * 3

    @pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
    def test_signals_wait_for_the_last_rename(
        self, number: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        rename = Path.replace

        def interrupted(path: Path, target: Path) -> Path:
            signal.raise_signal(number)
            return rename(path, target)

        monkeypatch.setattr(Path, "replace", interrupted)
        before = signal.signal(number, signal.default_int_handler)
        paths = [tmp_path / name for name in "abc"]
        try:
            with pytest.raises(KeyboardInterrupt):
                write([instance_at(path, b"new") for path in paths])
            assert signal.getsignal(number) is signal.default_int_handler
        finally:
            signal.signal(number, before)
        assert sorted(tmp_path.iterdir()) == paths

    def test_foreign_file_beside_the_instance(self, tmp_path: Path, capsys: Capture) -> None:
        scene, out = small_wok(tmp_path), tmp_path / "w.json"
        assert run("build", scene, "-o", out) == 0
        assert run("build", scene, "-o", out) == 0  # its own files it may replace
        for name in ("w.surface.json", "w.reasons.npz"):
            before = (tmp_path / name).read_bytes()
            (tmp_path / name).write_text("mine")
            refused(["build", scene, "-o", out], capsys, name, "not overwritten")
            assert (tmp_path / name).read_text() == "mine"
            (tmp_path / name).write_bytes(before)
