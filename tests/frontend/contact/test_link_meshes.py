"""Links with meshes: each verdict once more on shapes that the test has made, and by the judge."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin
import pytest
import trimesh
from meshed_arm import is_inside, link_meshes, write_package
from shipped import ROBOTS
from world import KINDS, NEIGHBORS, standing

from cellcolor.arrays import Array
from cellcolor.frontend.arm.body import Shape, Shapes
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, Pair, pairs_of, pairs_with
from cellcolor.frontend.contact.obstacle import BoxObstacle, CylinderObstacle, SphereObstacle
from cellcolor.frontend.contact.tip import HalfSpace
from cellcolor.frontend.parts.shapes import disc_mesh, spherical_cap
from cellcolor.trajectory_checker.validity import touching

pytestmark = pytest.mark.second

Standing = list[tuple[coal.ShapeBase, coal.Transform3s]]
GROUND, EXEMPT = -0.05, ("base_link", "shoulder_link")
ASIDE = np.array([0.35, -0.1, 0.35])
OBSTACLES = {
    "box": (BoxObstacle(size_m=(0.1, 0.4, 0.2), position_m=tuple(ASIDE)), coal.Box(0.1, 0.4, 0.2)),
    "sphere": (SphereObstacle(radius_m=0.2, position_m=tuple(ASIDE)), coal.Sphere(0.2)),
    "post": (CylinderObstacle(radius_m=0.1, height_m=0.5, position_m=tuple(ASIDE)),
             coal.Cylinder(0.1, 0.5)),
    # So small that it can be inside a link, which no surface notices.
    "bead": (SphereObstacle(radius_m=0.004, position_m=tuple(ASIDE)), coal.Sphere(0.004)),
}  # fmt: skip


def coal_mesh(mesh: trimesh.Trimesh) -> coal.BVHModelOBBRSS:
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(mesh.faces), len(mesh.vertices))
    model.addVertices(np.array(mesh.vertices))
    model.addTriangles(np.array(mesh.faces, dtype=np.int32))
    model.endModel()
    return model


def coal_hull(mesh: trimesh.Trimesh) -> coal.Convex:
    hull = mesh.convex_hull
    points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    points.extend(np.array(hull.vertices))
    triangles.extend([coal.Triangle(*map(int, face)) for face in hull.faces])
    return coal.Convex(points, triangles)


class Independent:
    """The arm once more: Pinocchio's frames, and coal's shapes of the meshes as they were made."""

    def __init__(self, robot: Robot, chosen: str, margin: float = 0.0) -> None:
        self.model, self.data = robot.model, robot.model.createData()
        self.meshes = link_meshes()
        make = coal_hull if chosen == "hull" else coal_mesh
        self.shapes = {link: make(mesh) for link, mesh in self.meshes.items()}
        tool = next(body for body in robot.bodies if body.link == "tool_body")
        self.shapes["tool_body"] = coal.Cylinder(tool.radius, tool.length)
        self.tool_middle = np.array([0.0, 0.0, 0.045])
        self.chosen, self.margin = chosen, margin

    def place(self, q: Array) -> None:
        pin.framesForwardKinematics(self.model, self.data, q)
        self.poses = {}
        for link in self.shapes:
            placed = self.data.oMf[self.model.getFrameId(link, pin.FrameType.BODY)]
            middle = self.tool_middle if link == "tool_body" else np.zeros(3)
            self.poses[link] = coal.Transform3s(placed.rotation, placed.act(middle))

    def touches(
        self,
        link: str,
        other: coal.CollisionGeometry,
        pose: coal.Transform3s,
        point: Array | None = None,
    ) -> bool:
        """Whether a link touches something or holds it; ``point`` of that, or its middle."""
        request, result = coal.CollisionRequest(), coal.CollisionResult()
        request.enable_contact, request.security_margin = True, self.margin
        coal.collide(self.shapes[link], self.poses[link], other, pose, request, result)
        if result.isCollision():
            return True
        if self.chosen == "hull" or link == "tool_body":
            return False
        point = pose.getTranslation() if point is None else point
        local = self.poses[link].getRotation().T @ (point - self.poses[link].getTranslation())
        return is_inside(link, local)

    def in_ground(self, link: str, height: float) -> bool:
        ground, here = coal.Halfspace(np.array([0.0, 0.0, 1.0]), height), coal.Transform3s()
        shape, pose = self.shapes[link], self.poses[link]
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        return float(coal.distance(shape, pose, ground, here, request, result)) < self.margin


def arm(folder: Path, chosen: str) -> Robot:
    package = write_package(folder, "toy_description")
    return load_robot(
        package / "urdf" / "arm.urdf",
        "wrist_3_link",
        ROBOTS / "polishing_tool.urdf",
        "tool_tip",
        shapes=Shapes(chosen),  # type: ignore[arg-type]
    )


@pytest.fixture(scope="module", params=["hull", "exact"])
def chosen(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def meshed(chosen: str, tmp_path_factory: pytest.TempPathFactory) -> Robot:
    return arm(tmp_path_factory.mktemp(chosen), chosen)


def configurations(count: int) -> Array:
    return np.random.default_rng(11).uniform(-np.pi, np.pi, (count, 6))


def check(
    robot: Robot,
    pairs: Sequence[Pair],
    joints: Array,
    world: Independent,
    ask: Callable[[], bool],
) -> None:
    """Verdicts are the same, by the judge's engine too, with enough of each kind among them."""
    found = Contacts(pairs, robot)(joints)
    by_fcl = touching(list(pairs), forward(robot, joints))
    expected = np.zeros(len(joints), dtype=bool)
    for row, q in enumerate(joints):
        world.place(q)
        expected[row] = ask()
    assert 0.01 < expected.mean() < 0.97
    different = np.flatnonzero(found != expected)
    assert not len(different), (len(different), joints[different[:3]])
    # Its distances are rough: beside what touches, it never errs by more than 0.6 mm.
    rough = 0.0006 if world.margin else 0.0
    surely = Contacts([(one, other, margin - rough) for one, other, margin in pairs], robot)(joints)
    assert not (surely & ~by_fcl).any() and not (by_fcl & ~found).any()


@pytest.mark.parametrize("count", [250, pytest.param(2000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("margin", [0.0, 0.006])
def test_verdicts_agree(
    meshed: Robot, chosen: str, tmp_path: Path, margin: float, count: int
) -> None:
    robot = meshed
    joints = configurations(count)
    poses = forward(robot, joints)
    world = Independent(robot, chosen, margin)
    pairs = [
        (one, other)
        for k, one in enumerate(world.shapes)
        for other in list(world.shapes)[:k]
        if {one, other} not in NEIGHBORS
    ]

    moving = [link for link in world.shapes if link != "base_link"]

    def itself() -> bool:
        return any(world.touches(a, world.shapes[b], world.poses[b]) for a, b in pairs)

    check(robot, pairs_of(robot, margin), joints, world, itself)
    here = coal.Transform3s()
    standing_there = {
        name: (obstacle, [(shape, coal.Transform3s(np.eye(3), ASIDE))])
        for name, (obstacle, shape) in OBSTACLES.items()
    } | {kind: standing(kind, ASIDE, tmp_path) for kind in KINDS}
    for name, (obstacle, shapes) in standing_there.items():
        tested = pairs_with(robot, [obstacle.solid()], margin)
        if name == "bead":
            joints_near = np.flatnonzero(np.linalg.norm(poses.tip - ASIDE, axis=1) < 0.35)
        else:
            joints_near = np.arange(count)

        def hit(shapes: Standing = shapes) -> bool:
            return any(world.touches(link, *each) for link in moving for each in shapes)

        check(robot, tested, joints[joints_near], world, hit)
    free = [link for link in world.shapes if link not in EXEMPT]
    ground = HalfSpace((0.0, 0.0, 1.0), GROUND).shape
    above: list[Pair] = [(body, ground, margin) for body in robot.bodies if body.link in free]
    check(robot, above, joints, world, lambda: any(world.in_ground(link, GROUND) for link in free))
    cap = spherical_cap(0.3, 1.2, *disc_mesh(400, 0.2, 3))
    vertices = cap.vertices + np.array([0.45, 0.0, 0.1])
    part = coal_mesh(trimesh.Trimesh(vertices, cap.faces, process=False))
    shell = Shape("mesh", vertices=vertices, faces=cap.faces)
    check(
        robot,
        pairs_with(robot, [shell], margin),
        joints,
        world,
        lambda: any(world.touches(link, part, here, vertices[0]) for link in moving),
    )
