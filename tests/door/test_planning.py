"""``cellcolor.plan``, unmocked: a coarse part, from its scene to the folder."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from shipped import shipped

import cellcolor
import cellcolor.frontend.prepared
from cellcolor.arrays import Array
from cellcolor.door.planned import KINDS
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.motion.ways import Transfer, Ways

OTHER_ARMS = {name for name in KINDS if name.endswith((".mod", ".src", ".ls"))}


def test_a_scene_is_planned_and_judged(tmp_path: Path) -> None:
    stages: list[str] = []
    scene = shipped("square", 200)
    planned = cellcolor.plan(scene, spacing_m=0.05, progress=stages.append)
    assert planned.solution.segments == planned.painted.segments == 1
    assert planned.trajectory.lift_offs == planned.solution.lift_offs == 0
    assert planned.verdict.valid, planned.verdict.faults
    assert planned.verdict.minimum_lift_offs == 0
    assert planned.paths.spacing_m == planned.verdict.covered.spacing_m == 0.05
    assert set(planned.seconds) <= set(stages)
    said = str(planned)
    assert "1 segment, 0 lift-offs, optimal" in said
    assert "judge: square: valid" in said
    assert f"posture: {planned.solution.preference}" in said
    assert f"Posture: {planned.solution.preference}." in planned.page().decode()
    # A judge that is asked anew, of the files alone, says the same.
    planned.save(tmp_path / "folder")
    assert {file.name for file in (tmp_path / "folder").iterdir()} == set(KINDS) - OTHER_ARMS
    scene = scene.with_setup(scene.setup.varied(motion={"spacing_m": 0.05}))
    again = cellcolor.check(scene, tmp_path / "folder" / "trajectory.json")
    assert again.valid
    assert again.covered == planned.verdict.covered


@pytest.mark.second
def test_a_division_does_without_colors_that_no_way_leads_to(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The wok has a division with as few segments without each of its colors."""
    scene = shipped("wok", 200)
    plain = cellcolor.plan(scene, spacing_m=0.05)
    whole = plain.built.surface
    used = sorted({one for one in plain.painted.plan.vertex_colors if one is not None})
    color = used[1]
    known = plain.built.configurations[:, plain.built.color_branch[color]]
    known = known[np.isfinite(known[:, 0])]
    between = Ways.between

    def shut_off(ways: Ways, start: Array, end: Array, drawn: int) -> Transfer:
        for at in (start, end):
            if ways.space.largest(ways.space.step(known, at)).min() < 0.3:
                return Transfer(np.array([start, end]), 0, "a wall")
        return between(ways, start, end, drawn)

    monkeypatch.setattr(Ways, "between", shut_off)
    planned = cellcolor.plan(scene, spacing_m=0.05)
    assert not planned.trajectory.unplanned
    assert planned.verdict.valid, planned.verdict.faults
    assert planned.trajectory.lift_offs == planned.solution.lift_offs == 1
    assert planned.solution.proved_for_surface
    (note,) = [note for note in planned.solution.notes if "found no way" in note]
    assert whole.colors[color] in note


@pytest.mark.second
def test_a_scene_is_prepared_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a plan, and by a check of it; whatever follows uses the same."""
    made, prepare = [], cellcolor.frontend.prepared._prepared

    def counted(*given: object) -> PreparedScene:
        made.append(prepare(*given))
        return made[-1]

    monkeypatch.setattr(cellcolor.frontend.prepared, "_prepared", counted)
    scene = shipped("square", 100)
    planned = cellcolor.plan(scene, spacing_m=0.05)
    assert len(made) == 1
    assert planned.built.prepared.tip is made[0].tip
    scene = scene.with_setup(scene.setup.varied(motion={"spacing_m": 0.05}))
    assert cellcolor.check(scene, planned.trajectory).valid
    assert len(made) == 2


@pytest.mark.second
def test_what_was_given_up_is_said_beside_what_is_covered() -> None:
    """The share of the surface that slivers had, added up face by face."""
    planned = cellcolor.plan(shipped("square", 300), spacing_m=0.03)
    surface = planned.built.surface
    assert surface.given_up
    corners = surface.vertices[surface.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1) / 2
    lost = np.isin(surface.faces, surface.given_up).sum(axis=1) @ areas / 3
    share = f"{lost / areas.sum():.1%}"
    assert share != "0.0%"
    assert any(share in note and "sliver policy" in note for note in planned.verdict.notes)
    assert f"slivers: {planned.instance.coverage}" in str(planned)
    assert f"{share} of the surface given up as slivers" in planned.page().decode()


@pytest.mark.second
def test_what_is_left_alone_is_not_driven_and_not_missed(tmp_path: Path) -> None:
    """The judge asks for it unless it is told; a plan's surface tells."""
    scene = shipped("square", 200)
    points = cellcolor.build(scene).surface.vertices
    middle = float(points[:, 0].mean())
    box = cellcolor.WorldBox((middle, -9.0, -9.0), (9.0, 9.0, 9.0))
    planned = cellcolor.plan(scene, spacing_m=0.05, left_alone=box)
    assert planned.verdict.valid, planned.verdict.faults
    assert any("left alone on purpose" in note for note in planned.verdict.notes)
    trajectory = planned.trajectory
    touched = trajectory.points[trajectory.contact]
    assert touched[:, 0].max() < middle + 0.05
    planned.save(tmp_path / "folder")
    scene = scene.with_setup(scene.setup.varied(motion={"spacing_m": 0.05}))
    assert "uncovered" in cellcolor.check(scene, trajectory).fault_counts
    surface = cellcolor.LabelledSurface.read(tmp_path / "folder" / "instance.surface.json")
    assert cellcolor.check(scene, trajectory, left_alone=surface).valid


@pytest.mark.second
def test_the_feed_of_each_stroke_is_said_and_held(tmp_path: Path) -> None:
    """In the summary, on the page, in the verdict; by a judge that has only the files, too."""
    scene = shipped("square", 200)
    keys = {"spacing_m": 0.05, "speed_m_per_s": 0.4, "transfer_speed_m_per_s": 0.2}
    plain = cellcolor.plan(scene, **keys)
    (feed,) = plain.verdict.feeds
    assert plain.verdict.valid, plain.verdict.faults
    assert feed.limited_by == "acceleration" and feed.joint in plain.trajectory.joint_names
    assert 0.5 < feed.slow_share <= 1 and feed.mean_m_per_s < 0.3
    assert f"stroke 0: mean feed {feed.mean_m_per_s:.3g} m/s of 0.4" in str(plain)
    assert f"acceleration of {feed.joint}" in plain.page().decode()
    even = cellcolor.plan(scene, even_feed=True, **keys)
    (evenly,) = even.verdict.feeds
    assert evenly.lowest_m_per_s > 0.85 * evenly.mean_m_per_s
    assert feed.lowest_m_per_s < 0.6 * feed.mean_m_per_s
    # Slower than asked for, and a fault where that is not allowed.
    even.save(tmp_path / "folder")
    for least, faults in ((0.9, {"feed": 1}), (0.5 * evenly.lowest_m_per_s / 0.4, {})):
        setup = scene.setup.varied(motion=keys | {"least_feed": least})
        again = cellcolor.check(scene.with_setup(setup), tmp_path / "folder" / "trajectory.json")
        assert again.fault_counts == faults
        assert again.feeds == even.verdict.feeds
    setup = scene.setup.varied(motion=keys | {"transfer_speed_m_per_s": 0.1})
    again = cellcolor.check(scene.with_setup(setup), even.trajectory)
    assert set(again.fault_counts) == {"velocity"}
    assert "between strokes" in again.faults[0].text
