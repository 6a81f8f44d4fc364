"""Scenes with the arm in a picture: the collision object, and the arm itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
from assembled import load_robot
from library import INSTANCES
from numpy.typing import NDArray
from pages import page_data, show, small_wok, solids
from pinocchio_reading import geometry_of
from shipped import shipped

from cellcolor.frontend import build_surface
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene
from cellcolor.pictures.arm import draw_arm, surroundings


def test_collision_object(tmp_path: Path) -> None:
    """A smaller cap in the same frame is what must not be hit."""
    cap = {"kind": '"spherical-cap"', "radius_m": 0.15, "half_angle_rad": 1.0}
    keys = [f"{key} = {value}" for key, value in (cap | {"target_vertices": 61}).items()]
    scene = small_wok(tmp_path, "\n".join(["[collision_object]", *keys]))
    show(
        scene,
        "--vertex",
        0,
        "--branch",
        valid_at_the_top(scene),
        "-o",
        tmp_path / "x.html",
    )
    found, _ = solids(tmp_path / "x.html")["collision object"]
    center = np.array([0.465, -0.15, -0.04])
    distances = np.linalg.norm(found - center, axis=1)
    np.testing.assert_allclose(distances, 0.15, atol=1e-7)
    assert len(found) == 61


def test_what_is_covered_of_a_part_is_not_hidden_by_the_whole() -> None:
    """The two would lie in one place: the segments of a door looked like bare metal."""
    scene = Scene.read(INSTANCES / "scenes" / "square.toml")
    half = {"box": {"low_m": [-1.0, -1.0, -1.0], "high_m": [0.0, 1.0, 1.0]}}
    prepared = prepare(scene.varied(cover=half))
    (rest,) = surroundings(prepared)
    whole = len(scene.object.surface(scene.folder).faces)
    assert len(rest.triangles) == whole - len(prepared.surface.faces) > 0


def valid_at_the_top(scene: Path) -> str:
    result = build_surface(scene)
    return result.branches[int(np.flatnonzero(result.reasons[0] == 0)[0])]


def test_arm(tmp_path: Path) -> None:
    """Every link where Pinocchio has it, on the surface of its shapes."""
    scene = small_wok(tmp_path)
    result = build_surface(scene)
    vertex, branch = (int(k) for k in np.argwhere(result.node_color >= 0)[40])
    name = result.branches[branch]
    show(scene, "--vertex", vertex, "--branch", name, "-o", tmp_path / "x.html")
    drawn = solids(tmp_path / "x.html")
    found = {name: points for name, (points, _) in drawn.items()}

    robots = INSTANCES.parent / "models" / "robots"
    robot = load_robot(
        robots / "ur5.urdf", "wrist_3_link", robots / "polishing_tool.urdf", "tool_tip"
    )
    data, geometry = robot.model.createData(), geometry_of(robot)
    shapes = geometry.createData()
    q = result.configurations[vertex, branch]
    pin.updateGeometryPlacements(robot.model, data, geometry, shapes, q)
    depth: dict[str, list[NDArray[np.float64]]] = {}
    for number, shape in enumerate(geometry.geometryObjects):
        link = robot.model.frames[shape.parentFrame].name
        pose = shapes.oMg[number]
        local = (found[link] - pose.translation) @ pose.rotation
        if hasattr(shape.geometry, "halfLength"):
            half, radius = shape.geometry.halfLength, shape.geometry.radius
            side = np.hypot(local[:, 0], local[:, 1]) - radius
            depth.setdefault(link, []).append(np.maximum(side, np.abs(local[:, 2]) - half))
        else:
            off = np.linalg.norm(local, axis=1) - shape.geometry.radius
            depth.setdefault(link, []).append(off)
    for link, distances in depth.items():
        # On the surface of at least one shape, or inside another of the same link.
        # Pages have single precision.
        assert np.max(np.min(distances, axis=0)) < 1e-6, link
        assert np.min(np.abs(distances)) < 1e-6, link
        assert np.percentile(np.min(np.abs(distances), axis=0), 95) < 1e-6, link
        points, triangles = drawn[link]
        a, b, c = points[triangles].transpose(1, 0, 2)
        # Wound outward, or light would fall on the inside.
        assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
    assert set(found) == {*depth, "object", "obstacles"}
    (mark,) = page_data((tmp_path / "x.html").read_text())["marks"]
    assert (mark["text"], mark["kind"]) == (f"vertex {vertex}", "mark")
    assert mark["at"] == result.surface.vertices[vertex].tolist()
    box, corner = found["obstacles"][:8], found["obstacles"][8:]
    np.testing.assert_allclose(np.ptp(box, axis=0), [0.1, 0.2, 0.3], atol=1e-7)
    np.testing.assert_allclose(box.mean(axis=0), [-0.5, 0.0, 0.2], atol=1e-7)
    expected = np.array([-0.6, 0.5, 0.1]) + np.vstack([np.zeros(3), 0.1 * np.eye(3)])
    assert sorted(corner.round(6).tolist()) == sorted(expected.round(6).tolist())
    assert found["object"].shape == result.surface.vertices.shape


def test_the_ground_is_drawn_where_it_is() -> None:
    """A grid on the tilted plane: it rises by half of x, from -0.5 m over the origin."""
    ground = {"height_m": -0.5, "normal": (-1.0, 0.0, 2.0)}
    result = build_surface(shipped("square", 100).varied(ground=ground))
    vertex, branch = (int(k) for k in np.argwhere(result.node_color >= 0)[0])
    (lines,) = draw_arm(result, vertex, branch).lines
    ends = lines.ends.reshape(-1, 3)
    np.testing.assert_allclose(ends[:, 2], -0.5 + 0.5 * ends[:, 0], atol=1e-12)
