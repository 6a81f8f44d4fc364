"""Obstacles against distances by other code, in any place and turn, and as pictures show them."""

from __future__ import annotations

from pathlib import Path

import coal
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from shipped import ROBOTS
from world import in_coal

from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.obstacle import (
    BoxGridObstacle,
    BoxObstacle,
    CapsuleObstacle,
    ConeObstacle,
    HalfSpaceObstacle,
    Obstacle,
)
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.shapes import RectangleObject
from cellcolor.frontend.scene import Ground, Scene
from cellcolor.frontend.setup import Setup

SHAFT = 0.01  # m, from the tip to the body of the shipped tool
CELLS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (-2, 0, 3), (0, -1, 0), (2, 1, 1)]
CELL = 0.02

coordinates = st.floats(-0.05, 0.05)
angles = st.floats(-3.1, 3.1)
places = st.tuples(coordinates, coordinates, coordinates)
turns = st.tuples(angles, angles, angles)
lengths = st.floats(0.002, 0.08)


@pytest.fixture(scope="module")
def map_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("map")
    lines = [",".join(map(str, cell)) for cell in [*CELLS, CELLS[2]]]
    (folder / "map.csv").write_text("\n".join(["", *lines]) + "\n")
    return folder


def distance(obstacle: Obstacle, other: coal.ShapeBase, pose: coal.Transform3s) -> float:
    """Between the obstacle and another shape by coal, m."""
    asked = coal.DistanceRequest()
    return min(
        float(coal.distance(shape, there, other, pose, asked, coal.DistanceResult()))
        for shape, there in in_coal(obstacle, CELLS)
    )


@st.composite
def obstacles(draw: st.DrawFn) -> Obstacle:
    where = {"position_m": draw(places), "rpy_rad": draw(turns)}
    kind = draw(st.sampled_from(["box", "cone", "capsule", "half-space", "box-grid"]))
    if kind == "box":
        return BoxObstacle(size_m=(draw(lengths), draw(lengths), draw(lengths)), **where)
    if kind == "cone":
        return ConeObstacle(radius_m=draw(lengths), height_m=draw(lengths), **where)
    if kind == "capsule":
        return CapsuleObstacle(radius_m=draw(lengths), axis_m=draw(lengths), **where)
    if kind == "half-space":
        return HalfSpaceObstacle(**where)
    return BoxGridObstacle(file="map.csv", cell_m=CELL, **where)


@given(obstacles(), st.floats(0.001, 0.02), st.integers(0, 2**32 - 1))
def test_against_distances_by_other_code(
    robot: Robot, map_folder: Path, obstacle: Obstacle, radius: float, seed: int
) -> None:
    """The region at the tool's tip, a capsule, in random places near the obstacle."""
    solid = obstacle.solid(map_folder)
    tip = Tip(robot, radius, [solid], None)
    random = np.random.default_rng(seed)
    points, directions = random.uniform(-0.08, 0.08, (20, 3)), random.normal(size=(20, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    region = coal.Capsule(radius, SHAFT)
    found = zip(points, directions, tip.blocked(points, directions), strict=True)
    for point, along, blocked in found:
        x = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
        x /= np.linalg.norm(x)
        turn = np.column_stack([x, np.cross(along, x), along])
        gap = distance(obstacle, region, coal.Transform3s(turn, point - SHAFT / 2 * along))
        assert blocked == (gap <= 0) or abs(gap) < 1e-5


@given(obstacles())
def test_the_picture_is_the_outside_of_what_is_met(map_folder: Path, obstacle: Obstacle) -> None:
    """Its vertices lie on the solid, and but for the half space it encloses nearly all of it."""
    vertices, faces = obstacle.shell(map_folder)
    world = obstacle.placed(vertices)
    ball = coal.Sphere(1e-9)
    gaps = [distance(obstacle, ball, coal.Transform3s(np.eye(3), p)) for p in world[:40]]
    assert np.abs(gaps).max() < 1e-5
    volume = trimesh.Trimesh(vertices, faces, process=False).volume
    if isinstance(obstacle, ConeObstacle):
        assert 0.95 < volume / (np.pi * obstacle.radius_m**2 * obstacle.height_m / 3) < 1
    elif isinstance(obstacle, CapsuleObstacle):
        round_ends = 4 / 3 * np.pi * obstacle.radius_m**3
        whole = np.pi * obstacle.radius_m**2 * obstacle.axis_m + round_ends
        assert 0.9 < volume / whole < 1
    elif isinstance(obstacle, BoxObstacle):
        assert volume == pytest.approx(np.prod(obstacle.size_m))
    elif isinstance(obstacle, BoxGridObstacle):
        assert volume == pytest.approx(len(CELLS) * CELL**3)
    else:
        assert (vertices[:, 2] == 0).all()


def test_a_grid_is_filled(robot: Robot, tmp_path: Path) -> None:
    """What is inside of a block of cells touches none of its outer sides, and is met."""
    cells = [f"{i},{j},{k}" for i in range(9) for j in range(9) for k in range(9)]
    (tmp_path / "block.csv").write_text("\n".join(cells))
    block = BoxGridObstacle(file="block.csv", cell_m=0.02, position_m=(0.0, 0.0, 0.0))
    _, faces = block.shell(tmp_path)
    assert len(faces) == 6 * 9 * 9 * 2  # none between two cells
    tip = Tip(robot, 0.002, [block.solid(tmp_path)], None)
    middle, down = np.full((1, 3), 0.09), np.array([[0.0, 0.0, -1.0]])
    assert tip.blocked(middle, down)[0] and not tip.blocked(middle + 0.2, down)[0]


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("0,0,0\n1,2\n", "line 2", "three whole numbers"),
        ("0,0,0.5\n", "line 1", "three whole numbers"),
        ("\n\n", None, "no cell"),
        ("0,0,30001\n", "line 1", "within 30,000 of 0"),
    ],
)
def test_faulty_grids(tmp_path: Path, text: str, place: str | None, message: str) -> None:
    (tmp_path / "map.csv").write_text(text)
    grid = BoxGridObstacle(file="map.csv", cell_m=0.1, position_m=(0.0, 0.0, 0.0))
    with pytest.raises(InputError, match=message) as caught:
        grid.solid(tmp_path)
    assert caught.value.file == str(tmp_path / "map.csv") and caught.value.field == place


def test_a_grid_that_is_too_large(tmp_path: Path) -> None:
    """Cells that do not touch each other have six sides each."""
    (tmp_path / "map.csv").write_text(
        "\n".join(f"{2 * (i % 250)},{2 * (i // 250)},0" for i in range(62_501))
    )
    grid = BoxGridObstacle(file="map.csv", cell_m=0.001, position_m=(0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="375,006 sides to the outside, at most 375,000 fit"):
        grid.shell(tmp_path)


@pytest.mark.parametrize("normal", [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.1, -1.0)])
def test_a_ground_points_up(normal: tuple[float, float, float]) -> None:
    with pytest.raises(InputError, match="must point up; a wall or a ceiling") as caught:
        Ground(height_m=0.0, normal=normal)
    assert caught.value.field == "normal"


def test_the_tilted_ground_blocks_what_lies_in_it() -> None:
    """A level plane is blocked where the ground comes nearer to it than the contact radius."""
    plane = Scene(
        name="plane",
        setup=Setup.read(ROBOTS / "ur5_polishing.toml"),
        object=RectangleObject(size_x_m=0.3, size_y_m=0.3, target_vertices=400),
        placement=Placement(position_m=(0.45, 0.1, 0.1)),
        ground=Ground(height_m=0.0, normal=(-1.0, 0.0, 4.0)),
    )
    result = build_surface(plane)
    vertices = np.array(result.surface.vertices)
    # The ground rises by a quarter of x; its normal is (-1, 0, 4) / sqrt(17).
    gap = (4 * vertices[:, 2] - vertices[:, 0]) / np.sqrt(17)
    blocked = (result.reasons == result.reason_names.index("tip blocked")).any(axis=1)
    assert 50 < blocked.sum() < 350
    assert (blocked == (gap < 0.005)).all()
    assert result.surface.meta["scene"]["ground"] == {"height_m": 0.0, "normal": [-1.0, 0.0, 4.0]}
    level = plane.varied(ground=Ground(height_m=-1.0, normal=(0.0, 0.0, 1.0)))
    assert level.model_dump()["ground"] == {"height_m": -1.0}
    assert "ground at 0 m, tilted by 14.0362 degrees" in str(plane)
