"""No crack where an independent continuation finds a smooth and valid motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from continuation import smooth_and_valid, unlinked_pairs
from shipped import ROBOTS, at_resolution

from cellcolor.arrays import Array
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.frontend import build_surface
from cellcolor.frontend.scene import CapObject
from cellcolor.frontend.stage import prepare
from cellcolor.frontend.target.shapes import make_surface
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

CORNERS = [(x, y, z) for x in (-0.12, 0.12) for y in (-0.1, 0.1) for z in (-0.08, 0.08)]
SIDES = ["2 4 1", "5 2 1", "1 4 3", "3 5 1", "2 8 4", "6 2 5"]
SIDES += ["6 8 2", "4 8 3", "7 5 3", "3 8 7", "7 6 5", "8 6 7"]
SCENE = """
name = "part"
setup = "ur5_polishing.toml"
[object]
kind = "mesh"
file = "part.obj"
meters_per_unit = 1.0
{refine}
[placement]
position_m = {position}
rpy_rad = {rpy}
[ground]
height_m = {ground}
"""


def setup_beside(folder: Path, slivers: bool) -> None:
    """The shipped robot, with the shipped sliver policy or none."""
    for name in ("ur5.urdf", "polishing_tool.urdf", "ur5_polishing.toml"):
        text = (ROBOTS / name).read_text()
        if not slivers and name.endswith(".toml"):
            text = text[: text.index("[slivers]")]
        (folder / name).write_text(text)


def box(folder: Path, edge_mm: float, slivers: bool) -> Path:
    """A box whose normals turn by 45 degrees on the first edge beside each of its edges."""
    setup_beside(folder, slivers)
    lines = ["v {} {} {}".format(*corner) for corner in CORNERS] + [f"f {side}" for side in SIDES]
    (folder / "part.obj").write_text("\n".join(lines) + "\n")
    file = folder / "box.toml"
    file.write_text(
        SCENE.format(
            refine=f"max_edge_m = {edge_mm / 1000}",
            position=[0.45, 0.05, 0.15],
            rpy=[0.1, 0.2, 0.4],
            ground=-0.1,
        )
    )
    return file


def noisy_cap(folder: Path, vertices: int, radius: float, position: list[float]) -> Path:
    """A cap as a scanner sees it, with 0.2 mm of noise."""
    setup_beside(folder, slivers=False)
    cap = CapObject(
        kind="spherical-cap",
        radius_m=radius,
        half_angle_rad=1.13,
        target_vertices=vertices,
        jitter=0.15,
        seed=1,
    )
    smooth = make_surface(cap, folder)
    noise = np.random.default_rng(3).normal(size=(len(smooth.vertices), 1)) * 0.0002
    lines = ["v {:.9f} {:.9f} {:.9f}".format(*p) for p in smooth.vertices + noise * smooth.normals]
    lines += ["f {} {} {}".format(*face) for face in smooth.faces + 1]
    (folder / "part.obj").write_text("\n".join(lines) + "\n")
    file = folder / "cap.toml"
    file.write_text(SCENE.format(refine="", position=position, rpy=[0.0, 0.0, 0.0], ground=-0.3))
    return file


def check(file: Path, most: int) -> Array:
    """Ask about so many of the pairs of neighbors that are not linked, and return all of them."""
    result, stage = build_surface(file), prepare(file)
    pairs = unlinked_pairs(result)
    some = np.random.default_rng(1).permutation(pairs)[:most]
    wrong = [pair.tolist() for pair in some if smooth_and_valid(stage, result, pair)]
    assert not wrong, f"{len(wrong)} of {len(some)} are smooth and valid"
    return pairs


def test_box(tmp_path: Path) -> None:
    # Its true cracks run where a wrist is aligned.
    assert len(check(box(tmp_path, 20, slivers=False), most=40)) > 5


@pytest.mark.parametrize(
    ("radius", "position"),
    [
        (0.06, [0.403, 0.183, 0.326]),
        (0.045, [0.41, 0.16, 0.33]),
        (0.05, [0.45, 0.1, 0.2]),
        (0.05, [0.5, 0.0, 0.0]),
    ],
)
def test_noisy_caps(radius: float, position: list[float], tmp_path: Path) -> None:
    check(noisy_cap(tmp_path, 1200, radius, position), most=40)


def test_shipped_scene_with_cracks(tmp_path: Path) -> None:
    file = at_resolution("hemisphere_tilted", tmp_path, 1000)
    setup_beside(tmp_path, slivers=False)
    text = file.read_text().splitlines()
    changed = ['setup = "ur5_polishing.toml"' if s.startswith("setup") else s for s in text]
    file.write_text("\n".join(changed))
    assert len(check(file, most=40)) > 0


def segments(file: Path) -> int:
    surface = build_surface(file).surface
    solution = solve(decompose(surface), Options(deadline=Deadline.after(60), workers=2))
    assert solution.status == "optimal" and solution.proved_for_surface
    return solution.segments


def test_the_minimum_of_the_box(tmp_path: Path) -> None:
    """Three, as found with probes 0.02 mm apart, far closer than asked for here."""
    assert segments(box(tmp_path, 20, slivers=True)) == 3


@pytest.mark.slow
@pytest.mark.parametrize("edge_mm", [8, 4, 2])
def test_the_minimum_does_not_hang_on_the_size_of_triangles(edge_mm: float, tmp_path: Path) -> None:
    assert segments(box(tmp_path, edge_mm, slivers=True)) == 3


@pytest.mark.slow
@pytest.mark.parametrize("edge_mm", [8, 4])
def test_finer_boxes(edge_mm: float, tmp_path: Path) -> None:
    check(box(tmp_path, edge_mm, slivers=False), most=400)


@pytest.mark.slow
@pytest.mark.parametrize("vertices", [3000, 30_000])
def test_finer_noisy_caps(vertices: int, tmp_path: Path) -> None:
    check(noisy_cap(tmp_path, vertices, 0.2, [0.465, -0.15, -0.04]), most=400)
    check(noisy_cap(tmp_path, vertices, 0.105, [0.403, 0.183, 0.326]), most=400)
