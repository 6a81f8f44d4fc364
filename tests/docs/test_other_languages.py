"""The guide for planners in C++ and Rust, followed to the letter."""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from guides import ROOT, Block, blocks, follow

import cellcolor
from cellcolor.cli import main
from cellcolor.data.plan import Plan

GUIDE = "test-a-planner"
(SURFACE,) = (block for block in blocks(GUIDE, "Any language") if "part.surface" in block.text)
*CPP, CPP_RUN, CPP_SAID = blocks(GUIDE, "C++")
*RUST, RUST_RUN = blocks(GUIDE, "Rust")
(FAILURE,) = (block for block in blocks(GUIDE, "Python") if "can be beaten:" in block.text)


@pytest.fixture
def shell(tmp_path: Path) -> dict[str, str]:
    """An environment that has this ``cellcolor``, and Rust where rustup puts it."""
    programs = tmp_path / "programs"
    programs.mkdir()
    for name, arguments in (("cellcolor", "-m cellcolor"), ("python", "")):
        program = programs / name
        text = f'#!/bin/sh\nexec "{sys.executable}" {arguments} "$@"\n'
        program.write_text(text, encoding="utf-8")
        program.chmod(0o755)
    places = [str(programs), os.environ["PATH"], str(Path.home() / ".cargo" / "bin")]
    return os.environ | {"PATH": os.pathsep.join(places), "PYTHONPATH": str(ROOT)}


def needs(*programs: str) -> None:
    path = os.pathsep.join([os.environ["PATH"], str(Path.home() / ".cargo" / "bin")])
    missing = [name for name in programs if shutil.which(name, path=path) is None]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")


def run(block: Block, folder: Path, shell: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["sh", "-c", block.text],
        cwd=folder,
        env=shell,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )


def fails_and_passes(
    files: list[Block], command: Block, folder: Path, shell: dict[str, str]
) -> None:
    """On the surface of the guide, and on the other one that it names."""
    for block in files:
        follow(block, folder)
    tilted = SURFACE.text.replace("hemisphere_flat", "hemisphere_tilted")
    for surface in (SURFACE, replace(SURFACE, text=tilted)):
        made = run(surface, folder, shell)
        assert made.returncode == 0, made.stdout
        done = run(command, folder, shell)
        assert (done.returncode == 0) == (surface is not SURFACE), done.stdout
        assert (CPP_SAID.text.strip() in done.stdout) == (surface is SURFACE), done.stdout


def test_the_messages(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """What the guide says that is printed, without compilers: of each vertex's first color."""
    surface = cellcolor.read("hemisphere_flat.surface.json")
    plan = Plan([own[0] if own else None for own in surface.vertex_colors])
    for options in ([], ["--json"]):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(plan.to_json().encode())))
        command = ["check", "hemisphere_flat.surface.json", "-", "--require-optimal", *options]
        assert main(command) == 1
        printed = capsys.readouterr().out
        if options:
            _, _, said = FAILURE.text.partition("can be beaten: ")
            assert json.loads(printed)["text"] == said.strip()
        else:
            assert printed.strip() == CPP_SAID.text.strip()


@pytest.mark.slow
def test_cpp(tmp_path: Path, shell: dict[str, str]) -> None:
    needs("cmake", "g++", "sh")
    header = subprocess.run(
        ["g++", "-E", "-x", "c++", "-"], input=b"#include <nlohmann/json.hpp>", capture_output=True
    )
    if header.returncode:
        pytest.skip("not installed: nlohmann/json.hpp")
    folder = tmp_path / "cpp"
    folder.mkdir()
    fails_and_passes(CPP, CPP_RUN, folder, shell)


@pytest.mark.slow
def test_rust(tmp_path: Path, shell: dict[str, str]) -> None:
    needs("cargo", "sh")
    folder = tmp_path / "rust"
    folder.mkdir()
    fails_and_passes(RUST, RUST_RUN, folder, shell | {"CARGO_NET_OFFLINE": "true"})
