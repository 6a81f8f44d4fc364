"""Each kind of fault, made one at a time in a trajectory that has none."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rasters
from honest_drives import Honest
from world import KINDS, World, standing

from cellcolor.arrays import Array
from cellcolor.data.surface import Crack
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.errors import InputError
from cellcolor.frontend.prepared import prepare
from cellcolor.trajectory_checker import area
from cellcolor.trajectory_checker.check import check_trajectory


def judged(trajectory: Trajectory, **options: Any) -> TrajectoryVerdict:
    _, built, _ = rasters.cap()
    return check_trajectory(built, trajectory, **options)


def moved(points: Array, normals: Array, samples: slice) -> Trajectory:
    """The cap's trajectory with other poses at some samples, in the same branch."""
    prepared, _, trajectory = rasters.cap()
    joints = trajectory.joints.copy()
    joints[samples] = Honest(prepared, trajectory, 1).reached(points, normals, joints[samples])
    all_points, all_normals = trajectory.points.copy(), trajectory.normals.copy()
    all_points[samples], all_normals[samples] = points, normals
    return replace(trajectory, joints=joints, points=all_points, normals=all_normals)


def middle() -> int:
    """A sample in the middle of the first stroke."""
    first, after = rasters.cap()[2].strokes[0]
    return (first + after) // 2


def test_a_move_that_was_not_planned() -> None:
    trajectory = rasters.cap()[2]
    after = trajectory.strokes[0][1] + 60
    verdict = judged(replace(trajectory, unplanned=(after,)))
    assert [(fault.kind, fault.sample) for fault in verdict.faults] == [("unplanned", after)]


@pytest.mark.parametrize(
    ("height", "degrees", "kinds", "said"),
    [
        (0.0009, 0.0, set(), ""),
        (0.0012, 0.0, {"off surface"}, "1.2 mm"),
        (0.0, 0.8, set(), ""),
        (0.0, 1.2, {"tilted"}, "1.2 degrees"),
    ],
)
def test_a_millimeter_and_a_degree_are_allowed(
    height: float, degrees: float, kinds: set[str], said: str
) -> None:
    trajectory, at = rasters.cap()[2], slice(middle(), middle() + 1)
    normal, turn = trajectory.normals[middle()], math.radians(degrees)
    across = np.cross(normal, [1.0, 0.0, 0.0])
    turned = math.cos(turn) * normal + math.sin(turn) * across / np.linalg.norm(across)
    points = trajectory.points[at] + height * normal
    verdict = judged(moved(points, turned[None], at), timed=False)
    assert set(verdict.fault_counts) == kinds
    for fault in verdict.faults:
        assert (fault.sample, fault.last_sample) == (middle(), middle()) and said in fault.text


def test_between_distant_samples_too() -> None:
    """Without the samples on a bend of the path the joints cut it short, off the surface."""
    _, _, trajectory = rasters.cap()
    first, after = trajectory.strokes[0]
    kept = np.ones(len(trajectory.times), dtype=bool)
    kept[first + 1 : after - 1] = False
    names = ("times", "joints", "points", "normals", "contact", "segment")
    short = replace(trajectory, **{name: getattr(trajectory, name)[kept] for name in names})
    verdict = judged(short)
    (fault, *_) = verdict.of_kind("off surface")
    assert (fault.sample, fault.last_sample) == (first, first)
    assert "between it and the next sample" in fault.text
    assert verdict.tested > len(short.times)


def test_a_change_of_branch_in_contact() -> None:
    prepared, _, trajectory = rasters.cap()
    at = slice(middle(), trajectory.strokes[0][1])
    found = prepared.arm.inverse(trajectory.points[at], -trajectory.normals[at])
    off = np.abs(np.remainder(found - trajectory.joints[at][:, None] + np.pi, 2 * np.pi) - np.pi)
    own = np.nanargmin(off.max(axis=2), axis=1)
    joints = trajectory.joints.copy()
    joints[at] = found[np.arange(len(own)), own ^ 1]  # the wrist flipped
    verdict = judged(replace(trajectory, joints=joints))
    (fault,) = verdict.of_kind("branch")
    assert (fault.sample, fault.last_sample) == (middle() - 1, middle())
    assert "flipped" in fault.text


def crossings(path: Array, walls: Array) -> int:
    """How often a path (k, 2) crosses walls (w, 2, 2), by signs of areas."""
    a, b = path[:-1, None], path[1:, None]
    c, d = walls[None, :, 0], walls[None, :, 1]

    def side(p: Array, q: Array, r: Array) -> Array:
        u, v = q - p, r - p
        return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0] > 0)

    hit = (side(a, b, c) != side(a, b, d)) & (side(c, d, a) != side(c, d, b))
    return int(hit.sum())


def test_cracks_that_are_crossed() -> None:
    """Seen from above, a crack is a wall from the middle of one triangle over that of the edge to
    that of the other one.
    """
    prepared, built, trajectory = rasters.cap()
    vertices, faces = prepared.surface.vertices[:, :2], prepared.surface.faces
    (color,) = {
        int(color)
        for color, branch in enumerate(built.coloring.branch)
        if (built.node_color[:, branch] == color).all()
        and prepared.arm.kinematics.branches[branch] == on_the_way(trajectory)
    }
    random = np.random.default_rng(0)
    expected, cracks = 0, []
    for i, j in random.permutation(prepared.surface.mesh.edges)[:60].tolist():
        middles = vertices[faces[(faces == i).any(axis=1) & (faces == j).any(axis=1)]].mean(axis=1)
        edge = (vertices[i] + vertices[j]) / 2
        walls = np.array([[middle, edge] for middle in middles])
        cracks.append(Crack(i, j, (color,)))
        for first, after in trajectory.strokes:
            expected += crossings(trajectory.points[first:after, :2], walls)
    torn = replace(built, surface=replace(built.surface, cracks=tuple(cracks)))
    verdict = check_trajectory(torn, trajectory)
    assert expected > 20
    assert verdict.fault_counts == {"crack": expected}
    colors = built.surface.vertex_colors
    shared = [set(colors[c.i]) & set(colors[c.j]) - {color} for c in cracks]
    other = tuple(
        Crack(c.i, c.j, tuple(sorted(own))) for c, own in zip(cracks, shared, strict=True) if own
    )
    assert other
    torn = replace(built, surface=replace(built.surface, cracks=other))
    assert check_trajectory(torn, trajectory).valid


def on_the_way(trajectory: Trajectory) -> str:
    """The name of the branch of the first sample."""
    prepared = rasters.cap()[0]
    found = prepared.arm.inverse(trajectory.points[:1], -trajectory.normals[:1])[0]
    off = np.abs(np.remainder(found - trajectory.joints[0] + np.pi, 2 * np.pi) - np.pi)
    return prepared.arm.kinematics.branches[int(np.nanargmin(off.max(axis=1)))]


def test_the_tip_may_not_pass_through_the_object_on_the_way() -> None:
    """The stroke goes on as a transfer 6 mm under the surface: the tool's body stays above."""
    _, _, trajectory = rasters.cap()
    at = slice(middle(), middle() + 20)
    points = trajectory.points[at] - 0.006 * trajectory.normals[at]
    contact, segment = trajectory.contact.copy(), trajectory.segment.copy()
    contact[at], segment[at] = False, -1
    under = replace(moved(points, trajectory.normals[at], at), contact=contact, segment=segment)
    verdict = judged(under, timed=False)
    faults = verdict.of_kind("invalid")
    assert {fault.reason for fault in faults} == {"object collision"}
    assert any(
        fault.sample == middle() - 1 and fault.last_sample == middle() + 19 for fault in faults
    )
    over = replace(trajectory, contact=contact, segment=segment)
    assert not judged(over, timed=False).of_kind("invalid")


def test_force_and_conditioning_are_not_asked_on_the_way() -> None:
    """An arm too weak for anything fails in contact only."""
    scene = rasters.cap()[0].scene
    weak = scene.with_setup(scene.setup.varied(task={"normal_force_n": 1e4}))
    from cellcolor.frontend.prepared import prepare

    _, built, trajectory = rasters.cap()
    verdict = check_trajectory(replace(built, prepared=prepare(weak)), trajectory)
    faults = verdict.of_kind("invalid")
    assert {fault.reason for fault in faults} == {"torque"}
    assert [(f.sample, f.last_sample) for f in faults] == [
        (first, after - 1) for first, after in trajectory.strokes
    ]


def test_velocities_and_accelerations() -> None:
    """The raster is at 0.9 of the greatest acceleration, far below the greatest velocity."""
    trajectory = rasters.cap()[2]
    faster = replace(trajectory, times=trajectory.times * 0.97)
    verdict = judged(faster)
    assert verdict.fault_counts == {}
    faster = replace(trajectory, times=trajectory.times * 0.9)
    verdict = judged(faster)
    assert set(verdict.fault_counts) == {"acceleration"}
    assert all(fault.joint is not None for fault in verdict.faults)
    faster = replace(trajectory, times=trajectory.times * 0.01)
    verdict = judged(faster)
    assert {"velocity", "acceleration"} == set(verdict.fault_counts)
    fault = verdict.of_kind("velocity")[0]
    joint = trajectory.joint_names.index(str(fault.joint))
    assert fault.sample is not None
    step = trajectory.joints[fault.sample + 1] - trajectory.joints[fault.sample]
    time = faster.times[fault.sample + 1] - faster.times[fault.sample]
    assert abs(step[joint] / time) > math.pi  # what the URDF allows


def test_without_times_only_geometry_is_judged() -> None:
    trajectory = rasters.cap()[2]
    nonsense = replace(trajectory, times=trajectory.times[::-1])
    verdict = judged(nonsense, timed=False)
    assert verdict.valid
    assert verdict.seconds is None
    assert verdict.notes == ("There are no times, so velocities and accelerations are not judged.",)


@pytest.mark.second
def test_each_limit_is_held(monkeypatch: pytest.MonkeyPatch) -> None:
    trajectory = rasters.cap()[2]
    missing = replace(trajectory, contact=trajectory.contact & (trajectory.segment != 1))
    for most, kinds in ((1.1, {"repeated"}), (1.2, set())):
        monkeypatch.setattr(area, "_MOST_MEAN_VISITS", most)
        assert set(judged(trajectory).fault_counts) == kinds
    # A part larger than a footprint is a fault whatever the shares are.
    for least, faults in ((1.0, 3), (0.0, 1)):
        monkeypatch.setattr(area, "_LEAST_COVERED", least)
        monkeypatch.setattr(area, "_LEAST_CLOSELY_COVERED", least)
        assert len(judged(missing).of_kind("uncovered")) == faults


def test_the_area_of_a_flat_raster() -> None:
    """Lines 8.57 mm apart: as many visits as bands of 10 mm make of the area between them."""
    _, built, trajectory = rasters.square()
    covered = check_trajectory(built, trajectory).covered
    assert covered is not None
    assert covered.reachable_m2 == pytest.approx(0.16 * 0.12)
    assert (covered.covered_share, covered.closely_covered_share) == pytest.approx((1.0, 1.0))
    assert covered.mean_visits == pytest.approx(10 / (120 / 14), rel=0.03)
    # A place between two lines is visited by both where these are nearer than 10 mm.
    assert covered.visited_again_share == pytest.approx(covered.mean_visits - 1, abs=0.01)
    assert covered.repeated_m == 0
    steps = np.linalg.norm(np.diff(trajectory.points, axis=0), axis=1)
    both = trajectory.contact[1:] & trajectory.contact[:-1]
    assert covered.length_m == pytest.approx(steps[both].sum(), rel=1e-6)


def test_another_arms_trajectory_is_refused() -> None:
    trajectory = rasters.cap()[2]
    other = replace(trajectory, joint_names=tuple("abcdef"))
    with pytest.raises(InputError, match="joint_names: must be shoulder_pan_joint"):
        judged(other)
    with pytest.raises(InputError, match=r"unplanned\[0\]: there is no sample 99999"):
        judged(replace(trajectory, unplanned=(99999,)))


def test_an_empty_trajectory_covers_nothing() -> None:
    trajectory = rasters.cap()[2]
    names = ("times", "joints", "points", "normals", "contact", "segment")
    empty = replace(trajectory, **{name: getattr(trajectory, name)[:0] for name in names})
    verdict = judged(empty)
    assert (verdict.strokes, verdict.lift_offs, verdict.samples) == (0, 0, 0)
    assert set(verdict.fault_counts) == {"uncovered"}


@pytest.mark.second
@pytest.mark.parametrize(("margin", "kept"), [(0.0095, True), (0.0105, False)])
def test_the_tool_keeps_its_margin_to_the_object(margin: float, kept: bool) -> None:
    """Its body ends 10 mm above the tip, which is on a flat square, and is flat itself."""
    prepared, built, trajectory = rasters.square()
    setup = prepared.setup.varied(margins={"to_object_m": margin})
    wide = prepare(prepared.scene.with_setup(setup))
    verdict = check_trajectory(replace(built, prepared=wide), trajectory)
    faults = [f for f in verdict.of_kind("invalid") if f.reason == "object collision"]
    assert bool(faults) != kept
    if not kept:
        invalid = np.zeros(len(trajectory.times), dtype=bool)
        for fault in faults:
            invalid[fault.sample : fault.last_sample + 1] = True
        assert invalid[trajectory.contact].all()


@pytest.mark.parametrize(
    ("key", "reason"), [("to_ground_m", "ground"), ("between_links_m", "self collision")]
)
def test_other_margins_are_asked_for_as_well(key: str, reason: str) -> None:
    prepared, built, trajectory = rasters.square()
    setup = prepared.setup.varied(margins={key: 0.4})
    scene = prepared.scene.with_setup(setup).varied(ground={"height_m": -0.2})
    verdict = check_trajectory(replace(built, prepared=prepare(scene)), trajectory)
    assert {f.reason for f in verdict.of_kind("invalid")} == {reason}


@pytest.mark.parametrize("kind", KINDS)
def test_an_obstacle_in_the_way_is_found(kind: str, tmp_path: Path) -> None:
    prepared, built, trajectory = rasters.square()
    middle = trajectory.points[len(trajectory.points) // 2] + np.array([0.0, 0.0, 0.15])
    obstacle, shapes = standing(kind, middle, tmp_path)
    blocked = prepare(prepared.scene.with_obstacle(obstacle))
    world = World(prepared.robot, prepared.surface.vertices, prepared.surface.faces)

    def hits(q: Array) -> bool:
        world.place(q)
        return any(world.to_solid(*shape) < 0 for shape in shapes)

    first = next(sample for sample, q in enumerate(trajectory.joints) if hits(q))
    verdict = check_trajectory(replace(built, prepared=blocked), trajectory)
    found = [f for f in verdict.of_kind("invalid") if f.reason == "obstacle collision"]
    assert found and abs(min(fault.sample for fault in found) - first) <= 1
