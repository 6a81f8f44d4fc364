"""The arm at a vertex: collision shapes of arm and tool, object, obstacles and ground."""

from __future__ import annotations

import numpy as np
from trimesh.util import append_faces

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import BuildResult
from cellcolor.frontend.arm.body import Body, Shape
from cellcolor.frontend.arm.kinematics import Poses, forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.pictures.mesh_picture import eye
from cellcolor.pictures.picture import FAINT, Layer, Picture3D, SpaceLines, Text

BESIDE = (28, 40)
"""The heights to look from, degrees, so that arm and part are seen side by side."""
_GRID = 13
OBSTACLE, BODY, GROUND = "#882255", "#C8C4B0", "#9AA3AF"
_LINKS = ("#AEB6C2", "#7F8A9B")  # alternating
_TOOL = "#4A5361"
_Mesh = tuple[Array, Index]


def draw_arm(build: BuildResult, vertex: int, branch: int) -> Picture3D:
    """The arm on a vertex, in the configuration that was found valid there.

    Raises:
        InputError: the branch has no valid configuration on the vertex.
    """
    reasons = build.reasons[vertex].tolist()
    if reasons[branch] != VALID:
        valid = [n for n, r in zip(build.branches, reasons, strict=True) if r == VALID]
        message = (
            f"{build.branches[branch]!r} is not valid on vertex {vertex}: "
            f"{build.reason_names[reasons[branch]]}; valid there: {', '.join(valid) or 'none'}"
        )
        raise InputError(None, "branch", message)
    scene, robot = build.scene, build.robot
    configuration = build.configurations[vertex, branch]
    poses = forward(robot, configuration[None])

    links: dict[str, list[_Mesh]] = {}
    for body in robot.bodies:
        links.setdefault(body.link, []).append(_placed(body, poses))
    fills = link_fills(robot)
    layers = [
        Layer(link, fills[link], *append_faces(*zip(*meshes, strict=True)))
        for link, meshes in links.items()
    ]
    arm = np.concatenate([layer.points for layer in layers])
    layers.append(Layer("object", FAINT, build.surface.vertices, build.surface.faces))
    layers += surroundings(build.prepared)
    target, normal = build.surface.vertices[vertex], build.surface.vertex_normals[vertex]
    ground: tuple[SpaceLines, ...] = ()
    if scene.ground is not None:
        points = np.concatenate([layer.points for layer in layers])
        ground = (grid(scene.ground.half_space, points),)
    joints = ", ".join(
        f"{1000 * value:.1f} mm" if slides else f"{np.degrees(value):.1f}°"
        for value, slides in zip(configuration, robot.slides, strict=True)
    )
    place = ", ".join(f"{value:.3f}" for value in target)
    return Picture3D(
        title=f"{scene.name}: vertex {vertex}, {build.branches[branch]}",
        mesh=None,
        layers=tuple(layers),
        lines=ground,
        texts=(Text(f"vertex {vertex}", target, normal),),
        notes=(
            "Collision shapes of the URDF files.",
            f"Joints: {joints}",
            f"Vertex [m]: {place}",
        ),
        towards=eye(build.surface, BESIDE, [(target, normal, arm)]),
    )


def link_fills(robot: Robot) -> dict[str, str]:
    """The fill of each link with bodies; the tool's is darker."""
    last = max(min(body.joint, robot.joints) for body in robot.bodies)
    links = list(dict.fromkeys(body.link for body in robot.bodies))
    tools = {body.link for body in robot.bodies if body.joint == last}
    return {
        link: _TOOL if link in tools else _LINKS[number % len(_LINKS)]
        for number, link in enumerate(links)
    }


def surroundings(prepared: PreparedScene) -> list[Layer]:
    """The body of the part, without what is covered of it, and the obstacles, in the world."""
    scene, layers = prepared.scene, []
    if scene.solid_object is not None:
        body = scene.solid_object.surface(scene.folder)
        faces = body.faces
        if scene.collision_object is None and scene.cover is not None:
            # What is covered lies in the same place, and would be hidden.
            faces = faces[~scene.cover.chosen(body)]
        body = body.placed(scene.placement)
        layers.append(Layer("collision object", BODY, body.vertices, faces))
    if scene.obstacle:
        shells = [(each, *each.shell(scene.folder)) for each in scene.obstacle]
        meshes = [(each.placed(points), triangles) for each, points, triangles in shells]
        layers.append(Layer("obstacles", OBSTACLE, *append_faces(*zip(*meshes, strict=True))))
    return layers


def arm_points(robot: Robot, joints: Array) -> Array:
    """Points (k, 3) of all bodies in a configuration (s,), in the world."""
    poses = forward(robot, joints[None])
    return np.concatenate([_placed(body, poses)[0] for body in robot.bodies])


def _placed(body: Body, poses: Poses) -> _Mesh:
    points, triangles = body.shape.shell()
    turned = points @ poses.rotation[0, body.joint].T + poses.origin[0, body.joint]
    return turned, triangles


def grid(ground: Shape, points: Array) -> SpaceLines:
    """The part of the ground below everything else as a grid, in pieces that sort by depth."""
    low, high = points.min(axis=0) - 0.05, points.max(axis=0) + 0.05
    x, y = (np.linspace(low[axis], high[axis], _GRID) for axis in (0, 1))
    x, y = np.meshgrid(x, y, indexing="ij")
    nx, ny, nz = ground.rotation[:, 2]
    off_m = ground.origin @ ground.rotation[:, 2]
    knots = np.stack([x, y, (off_m - nx * x - ny * y) / nz], axis=2)
    along_x = np.stack([knots[:-1], knots[1:]], axis=2).reshape(-1, 2, 3)
    along_y = np.stack([knots[:, :-1], knots[:, 1:]], axis=2).reshape(-1, 2, 3)
    return SpaceLines("ground", GROUND, np.concatenate([along_x, along_y]))
