"""Switches, what stands beside the patch, mesh obstacles, refinement and repair of meshes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from dirty import BOX, OUTWARD, obj
from reasons import Reason

from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.contact.obstacle import BoxObstacle, MeshObstacle
from cellcolor.frontend.parts.mesh_file import MeshObject
from cellcolor.frontend.parts.shapes import RectangleObject
from cellcolor.frontend.scene import Scene

Varied = Callable[..., Scene]
KINEMATIC = {
    Reason.JOINT_LIMITS,
    Reason.GROUND,
    Reason.SELF_COLLISION,
    Reason.OBSTACLE_COLLISION,
    Reason.OBJECT_COLLISION,
    Reason.TIP_BLOCKED,
}
CONDITIONING = {Reason.MANIPULABILITY, Reason.TASK_DETERMINANT}
OF = {"collision": KINEMATIC, "force": {Reason.TORQUE}, "conditioning": CONDITIONING}


def weak(text: str) -> str:
    return text.replace('effort="28"', 'effort="1.5"')


def switched(scene: Scene, **on: bool) -> set[Reason]:
    """The reasons that occur with some constraints switched off."""
    result = build_surface(scene.varied(setup={"constraints": on}))
    return {Reason(code) for code in np.unique(result.reasons)}


@pytest.mark.parametrize("alone", OF)
def test_each_constraint_binds_alone(scene: Varied, alone: str) -> None:
    """With weak joints and strict thresholds every constraint binds; the switches part them."""
    wok = scene(arm=weak, setup={"min_manipulability_m3": 0.05}, target_vertices=200, height_m=0.05)
    found = switched(wok, **{name: name == alone for name in OF})
    assert found & OF[alone]
    assert found <= OF[alone] | {Reason.VALID, Reason.NO_SOLUTION}


def test_switched_off_collisions_admit_an_object_in_the_base(scene: Varied) -> None:
    wok = scene(position_m=(0.0, 0.0, -0.12), target_vertices=50)
    with pytest.raises(InputError, match="'base_link'"):
        build_surface(wok)
    switched(wok, collision=False)


def test_patch_and_collision_object_are_two_things(scene: Varied) -> None:
    """A plate under a small patch takes away what the ground at its height does."""
    place = {"target_vertices": 60, "half_angle_rad": 0.3, "position_m": (0.465, -0.15, -0.14)}
    ground = build_surface(scene(height_m=-0.14, **place))
    patch = scene(height_m=-2.0, **place)
    alone = build_surface(patch)
    plate = RectangleObject(size_x_m=3.0, size_y_m=3.0, target_vertices=400)
    beside = build_surface(patch.with_object(patch.object, plate))
    changed = alone.reasons != beside.reasons
    assert changed.sum() > 100
    # The patch is what is covered, and no longer what is hit.
    freed = changed & (beside.reasons == Reason.VALID)
    assert (alone.reasons[freed] == Reason.OBJECT_COLLISION).all()
    assert (beside.reasons[changed & ~freed] == Reason.OBJECT_COLLISION).all()
    differ = (beside.reasons == Reason.VALID) != (ground.reasons == Reason.VALID)
    assert (ground.reasons[differ] == Reason.OBJECT_COLLISION).all()
    assert freed[differ].all()
    assert len(beside.surface.vertices) == len(alone.surface.vertices)


def test_maximum_edge_length_of_a_scene_is_in_meters(tmp_path: Path) -> None:
    (tmp_path / "box.obj").write_text(obj(100 * BOX, OUTWARD))
    surface = MeshObject(
        file=str(tmp_path / "box.obj"), meters_per_unit=0.001, max_edge_m=0.03
    ).surface()
    edges = surface.mesh.edges
    assert surface.lengths(edges).max() <= 0.03 and surface.vertices.max() == pytest.approx(0.1)


def test_mesh_obstacle_is_like_the_primitive(scene: Varied, tmp_path: Path) -> None:
    wok = scene(target_vertices=300)
    size, center = 0.08, (0.24, 0.0, 0.2)
    box = BoxObstacle(size_m=(size, size, size), position_m=center)
    primitive = build_surface(wok.with_obstacle(box))
    (tmp_path / "box.obj").write_text(obj((BOX - 0.5) * 1000 * size, OUTWARD))
    name = (tmp_path / "box.obj").as_posix()
    shell = MeshObstacle(file=name, meters_per_unit=0.001, position_m=center)
    mesh = build_surface(wok.with_obstacle(shell))
    assert (primitive.reasons == Reason.OBSTACLE_COLLISION).sum() > 100
    assert (primitive.reasons == mesh.reasons).all()


def test_repair_only_on_request(tmp_path: Path) -> None:
    """A box with a doubled vertex, a flat face, a loose vertex and a face turned over."""
    vertices = np.vstack([BOX, BOX[:1], [[0.5, 0, 0]], [[9, 9, 9]]])
    faces = [OUTWARD[0][::-1], *OUTWARD[1:6], *OUTWARD[6:8], [8, 2, 6], *OUTWARD[9:], [0, 4, 4]]
    file = tmp_path / "bad.obj"
    file.write_text(obj(vertices, faces))
    with pytest.raises(InputError):
        MeshObject(file=str(file), meters_per_unit=1.0).surface()
    mended = MeshObject(file=str(file), meters_per_unit=1.0, repair=True).surface()
    mesh = trimesh.Trimesh(mended.vertices, mended.faces, process=False)
    assert len(mended.vertices) == 8 and mesh.is_watertight
    assert mesh.volume == pytest.approx(1)
