"""No crack where an independent continuation finds a smooth and valid motion."""

from __future__ import annotations

import numpy as np
import pytest
from continuation import smooth_and_valid, unlinked_pairs
from shipped import shipped

from cellcolor.arrays import Array
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.frontend import build_surface
from cellcolor.frontend.parts.shapes import CapObject
from cellcolor.frontend.parts.surface import refine
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

pytestmark = pytest.mark.slow

CORNERS = [(x, y, z) for x in (-0.12, 0.12) for y in (-0.1, 0.1) for z in (-0.08, 0.08)]
SIDES = ["2 4 1", "5 2 1", "1 4 3", "3 5 1", "2 8 4", "6 2 5"]
SIDES += ["6 8 2", "4 8 3", "7 5 3", "3 8 7", "7 6 5", "8 6 7"]


def part(mesh: object, slivers: bool, position: list[float], **keys: object) -> Scene:
    """A part in the shipped robot's hands, with the shipped sliver policy or none."""
    wok = shipped("wok").with_object(mesh).moved(position_m=position)
    return wok.varied(**keys) if slivers else without_slivers(wok.varied(**keys))


def without_slivers(scene: Scene) -> Scene:
    return scene.with_setup(scene.setup.varied(slivers=None))


def box(edge_mm: float, slivers: bool) -> Scene:
    """A box whose normals turn by 45 degrees on the first edge beside each of its edges."""
    faces = np.array([[int(corner) for corner in side.split()] for side in SIDES]) - 1
    mesh, _ = refine(TriangleMesh(np.array(CORNERS), faces), edge_mm / 1000)
    ground, turn = {"height_m": -0.1}, {"rpy_rad": (0.1, 0.2, 0.4)}
    return part(
        (mesh.points, mesh.corners), slivers, [0.45, 0.05, 0.15], ground=ground, placement=turn
    )


def noisy_cap(vertices: int, radius: float, position: list[float]) -> Scene:
    """A cap as a scanner sees it, with 0.2 mm of noise."""
    smooth = CapObject(
        radius_m=radius, half_angle_rad=1.13, target_vertices=vertices, jitter=0.15, seed=1
    ).surface()
    noise = np.random.default_rng(3).normal(size=(len(smooth.vertices), 1)) * 0.0002
    points = (smooth.vertices + noise * smooth.normals).round(9)
    return part((points, smooth.faces), False, position, ground={"height_m": -0.3})


def check(scene: Scene, most: int) -> Array:
    """Ask about so many of the pairs of neighbors that are not linked, and return all of them."""
    result, prepared = build_surface(scene), prepare(scene)
    pairs = unlinked_pairs(result)
    some = np.random.default_rng(1).permutation(pairs)[:most]
    wrong = [pair.tolist() for pair in some if smooth_and_valid(prepared, result, pair)]
    assert not wrong, f"{len(wrong)} of {len(some)} are smooth and valid"
    return pairs


def test_box() -> None:
    # Its true cracks run where a wrist is aligned.
    assert len(check(box(20, slivers=False), most=15)) > 5


@pytest.mark.parametrize(
    ("radius", "position"),
    [
        (0.06, [0.403, 0.183, 0.326]),
        (0.045, [0.41, 0.16, 0.33]),
        (0.05, [0.45, 0.1, 0.2]),
        (0.05, [0.5, 0.0, 0.0]),
    ],
)
def test_noisy_caps(radius: float, position: list[float]) -> None:
    check(noisy_cap(1200, radius, position), most=15)


def segments(scene: Scene) -> int:
    surface = build_surface(scene).surface
    solution = solve(decompose(surface), Options(deadline=Deadline.after(60), workers=2))
    assert solution.status == "optimal" and solution.proved_for_surface
    return solution.segments


def test_the_minimum_of_the_box() -> None:
    """Three, as found with probes 0.02 mm apart, far closer than asked for here."""
    assert segments(box(20, slivers=True)) == 3
