"""The oracle of a scene on plans in joint angles: every kind of verdict, by every way in."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rasters
from hypothesis import given
from hypothesis import strategies as st
from joint_paths import joints_of, scene, walk_of
from meshes import drawn

import cellcolor
from cellcolor.data.plan import Plan
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.testing.surface_under_test import SurfaceUnderTest
from examples import examples


@cache
def the_oracle() -> cellcolor.Oracle:
    """Its surface is proved once for all tests."""
    return cellcolor.Oracle(scene(), workers=1)


def reached() -> list[int]:
    return [vertex for vertex, own in enumerate(scene().surface.vertex_colors) if own]


def best() -> Plan:
    """A plan with the fewest segments, which this mesh has."""
    found = the_oracle().best
    assert found is not None and found.segments_on_mesh == the_oracle().bounds.lower
    return found.on_mesh


def test_the_deadline_holds_for_the_joints_as_well() -> None:
    plan = cellcolor.JointPlan(joints_of(scene(), best()))
    with pytest.raises(OutOfTime):
        the_oracle().judge(plan, deadline=Deadline.after(0))


@examples(15)
@given(st.data())
def test_joints_are_judged_as_the_colors_they_come_to(data: st.DataObject) -> None:
    choices = [st.sampled_from(own) if own else st.none() for own in scene().surface.vertex_colors]
    plan = Plan(data.draw(st.tuples(*choices)))
    joints = joints_of(scene(), plan)
    verdict = the_oracle().judge(cellcolor.JointPlan(joints))
    assert verdict == the_oracle().judge(plan) and verdict.plan == plan
    assert str(verdict) == str(the_oracle().judge(plan))


def test_what_is_wrong_with_joints(tmp_path: Path) -> None:
    """A vertex without any, one aside, and one that nothing reaches, each drawn and in words."""
    joints = joints_of(scene(), best())
    lacking, aside, *_ = reached()
    beyond = scene().surface.vertex_colors.index(())
    joints[lacking] = np.nan
    joints[aside, 0] += 0.01
    branch = int(np.flatnonzero(~np.isnan(scene().configurations[beyond, :, 0]))[0])
    joints[beyond] = scene().configurations[beyond, branch]
    verdict = the_oracle().judge(cellcolor.JointPlan(joints))
    assert not verdict.valid and verdict.segments is None and verdict.optimal is None
    found = {violation.vertex: violation for violation in verdict.violations}
    assert sorted(found) == sorted([lacking, aside, beyond])
    colors = list(scene().surface.vertex_colors[lacking])
    assert found[lacking].reason == f"no configuration, but colors {colors} reach this vertex"
    assert found[lacking].joints is None
    assert found[aside].reason.startswith("the tip is ")
    assert found[aside].joints == tuple(joints[aside])
    assert found[aside].place == tuple(scene().surface.vertices[aside])
    name = scene().reason_names[scene().reasons[beyond, branch]]
    assert found[beyond].reason == f"{scene().branches[branch]!r} fails the test {name!r} there"
    angles = ", ".join(f"{angle:.4f}" for angle in joints[aside])
    assert str(found[aside]).endswith(f"allowed: 1; joints ({angles}) rad")
    assert verdict.problems == tuple(map(str, verdict.violations))
    assert str(verdict.plot(tmp_path / "plan.png")).endswith("no valid plan, 3 vertices wrong")


def test_a_path_with_the_fewest_lift_offs() -> None:
    path, _ = walk_of(scene(), best())
    verdict = the_oracle().judge(path)
    least = the_oracle().bounds.lower
    assert verdict.valid and verdict.optimal and verdict.beatable_by == 0
    assert verdict.strokes == verdict.runs == verdict.segments == verdict.needed == least
    assert (verdict.path_lift_offs, verdict.lift_offs) == (least - 1, least - 1)
    assert verdict.plan == best()
    assert str(verdict).startswith(
        f"path: {least} strokes, {least - 1} lift-offs between them\n"
        f"its colors: {least} segments, {least - 1} lift-offs, optimal: "
    )
    assert str(verdict.plot()).endswith(f"plan with {least} segments, {least - 1} lift-offs")


def test_a_path_that_lifts_off_within_its_segments() -> None:
    """Its colors cannot be beaten, and it can."""
    path, _ = walk_of(scene(), best())
    assert path.contact is not None
    joints = np.insert(path.joints, [3, 6], path.joints[[3, 6]], axis=0)
    contact = np.insert(path.contact, [3, 6], False)
    verdict = the_oracle().judge(cellcolor.ContactPath(joints, contact=contact))
    least = the_oracle().bounds.lower
    assert (verdict.strokes, verdict.segments, verdict.needed) == (least + 2, least, least + 2)
    assert verdict.of_colors.optimal and verdict.optimal is False and verdict.beatable_by == 2
    assert str(verdict).endswith("\nits colors need 2 lift-offs fewer than the path has")


def test_a_path_that_changes_its_color_in_contact() -> None:
    """It claims one stroke; the segments are as many as they were, and so are the lift-offs."""
    path, _ = walk_of(scene(), best())
    verdict = the_oracle().judge(cellcolor.ContactPath(path.joints))
    least = the_oracle().bounds.lower
    changes = verdict.color_changes
    assert (verdict.strokes, verdict.path_lift_offs, verdict.segments) == (1, 0, least)
    assert 0 < changes <= least - 1 and verdict.needed == max(1 + changes, least)
    said = str(verdict).splitlines()[0]
    assert said.startswith("path: 1 stroke, 0 lift-offs between them, ")
    assert said.endswith(" of color in contact")


def test_a_path_that_leaves_vertices_out_is_not_compared() -> None:
    path, vertices = walk_of(scene(), best())
    out = set(reached()[4:9])
    assert path.contact is not None
    contact = path.contact & ~np.isin(vertices, list(out))
    verdict = the_oracle().judge(cellcolor.ContactPath(path.joints, path.points, contact))
    assert not verdict.valid and verdict.optimal is None and verdict.needed is None
    assert {violation.vertex for violation in verdict.violations} == out
    assert (verdict.untouched, verdict.reachable) == (5, len(reached()))
    told = str(verdict).splitlines()[1]
    lacking = f"5 of {len(reached())} reachable vertices get no contact in one of their colors: "
    assert told.startswith(f"not comparable: {lacking}vertex {min(out)} at (")
    assert told.count("no contact nearer than ") == 3 and told.endswith(", …")
    assert str(verdict.plot()).endswith("no valid plan, 5 vertices wrong")
    nothing = the_oracle().judge(cellcolor.ContactPath(np.zeros((0, 6))))
    assert nothing.untouched == len(reached()) and nothing.strokes == 0
    assert nothing.violations[0].reason == "no contact"


def test_a_contact_in_no_color_is_none() -> None:
    path, vertices = walk_of(scene(), best())
    failed = scene().reason_names.index("obstacle collision")
    bad = [(v, b) for v, b in np.argwhere(scene().reasons == failed).tolist() if v in reached()]
    vertex, branch = bad[0]
    joints = path.joints.copy()
    samples = np.flatnonzero(np.array(vertices) == vertex)
    joints[samples] = scene().configurations[vertex, branch]
    (violation,) = the_oracle().judge(cellcolor.ContactPath(joints, None, path.contact)).violations
    assert violation.vertex == vertex and violation.joints == tuple(joints[samples[0]])
    assert violation.reason == (
        f"in contact at sample {samples[0]}, but {scene().branches[branch]!r} fails the test "
        "'obstacle collision' there"
    )


def test_points_that_the_joints_do_not_give() -> None:
    """As in millimeters, or in another frame."""
    path, _ = walk_of(scene(), best())
    assert path.points is not None
    verdict = the_oracle().judge(
        cellcolor.ContactPath(path.joints, path.points * 1000, path.contact)
    )
    assert not verdict.valid and verdict.untouched == 0
    assert "\nnot comparable: points[0]: the joints put the tip " in str(verdict)


def test_a_footprint_that_covers_from_beside_is_no_contact() -> None:
    """A raster of passes 9 mm apart, judged valid as a trajectory, is at hardly any vertex."""
    _, built, trajectory = rasters.cap()
    verdict = cellcolor.Oracle(built, workers=1).judge(trajectory)
    reachable = sum(map(bool, built.surface.vertex_colors))
    assert not verdict.valid and verdict.strokes == 2
    assert reachable / 2 < verdict.untouched < reachable == verdict.reachable
    assert "not comparable: " in str(verdict)


def as_trajectory(path: cellcolor.ContactPath, names: tuple[str, ...]) -> Trajectory:
    assert path.points is not None
    return Trajectory(
        name="walk",
        joint_names=names,
        times=np.arange(len(path.joints)),
        joints=path.joints,
        points=path.points,
        normals=np.tile([0.0, 0.0, 1.0], (len(path.joints), 1)),
        contact=path.contact,
        segment=path.stroke,
    )


def test_files_and_values_give_one_verdict(tmp_path: Path) -> None:
    path, _ = walk_of(scene(), best())
    expected = the_oracle().judge(path)
    trajectory = as_trajectory(path, scene().robot.joint_names)
    assert the_oracle().judge(trajectory) == expected
    (tmp_path / "walk.json").write_text(trajectory.to_json())
    assert the_oracle().judge(tmp_path / "walk.json") == expected
    assert path.contact is not None and path.points is not None
    header = "contact,q1,q2,q3,q4,q5,q6"
    plain = np.column_stack([path.contact, path.joints])
    np.savetxt(tmp_path / "walk.csv", plain, fmt="%.9g", delimiter=",", header=header, comments="")
    assert the_oracle().judge(str(tmp_path / "walk.csv")) == expected
    header += ",x,y,z,nx,ny,nz"
    poses = np.column_stack([plain, path.points, trajectory.normals])
    np.savetxt(tmp_path / "pose.csv", poses, fmt="%.9g", delimiter=",", header=header, comments="")
    assert the_oracle().judge(tmp_path / "pose.csv") == expected
    assert cellcolor.judge(scene(), path) == expected


def test_a_labelled_surface_alone_knows_no_joints(tmp_path: Path) -> None:
    oracle = cellcolor.Oracle(drawn("AA AA", {"A": [0]}))
    said = "format: only a scene (.toml) has an arm"
    for plan in (cellcolor.JointPlan(np.zeros((4, 6))), cellcolor.ContactPath(np.zeros((4, 6)))):
        with pytest.raises(InputError) as found:
            oracle.judge(plan)
        assert str(found.value) == said
    file = tmp_path / "motion.csv"
    file.write_text("contact,q1\n1,0.5\n")
    with pytest.raises(InputError) as found:
        oracle.judge(file)
    assert str(found.value) == f"{file}: {said}"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: np.zeros((len(scene().surface.vertices), 6)), "vertex_colors: is an array ("),
        (lambda: cellcolor.JointPlan(np.zeros((3, 6))), "joints: 3 rows for "),
        (lambda: cellcolor.JointPlan(np.zeros(6)), "joints: must be rows of numbers"),
        (lambda: cellcolor.JointPlan([[0.0, np.nan]]), "joints[0]: has NaN and numbers; "),
        (lambda: cellcolor.JointPlan([[0.0, np.inf]]), "joints[0][1]: is not a finite number"),
        (lambda: cellcolor.JointPlan([["a"]]), "joints[0][0]: Input should be a valid number"),
        (lambda: cellcolor.ContactPath([[0.0, np.nan]]), "joints[0][1]: is not a finite number"),
        (lambda: cellcolor.ContactPath([[0.0]], points=[]), "points: has 0 entries for 1 rows"),
        (
            lambda: cellcolor.ContactPath([[0.0]], contact=[1]),
            "contact[0]: Input should be ",
        ),
        (
            lambda: as_trajectory(walk_of(scene(), best())[0], tuple("abcdef")),
            "joint_names: must be shoulder_pan_joint, ",
        ),
    ],
)
def test_what_is_no_plan_in_joint_angles_is_refused(make: Any, message: str) -> None:
    with pytest.raises(InputError) as found:
        the_oracle().judge(make())
    assert str(found.value).startswith(message) and "\n" not in str(found.value)


def test_in_a_planners_test(tmp_path: Path) -> None:
    part = SurfaceUnderTest(scene(), 60.0, tmp_path, lambda *_: None)
    part.assert_optimal(cellcolor.JointPlan(joints_of(scene(), best())))
    path, _ = walk_of(scene(), best())
    part.assert_optimal(path)
    with pytest.raises(AssertionError, match=r"wok-obstacle.: path: 1 stroke.*\nnot comparable"):
        part.assert_valid(cellcolor.ContactPath(path.joints[:5]))
