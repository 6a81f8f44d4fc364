"""How many displacements of the part a plan survives, with and without a tolerance.

    python benchmarks/tolerance.py [COUNT] [--judged N] [SCENE ...]

plans each scene twice, as it is and with a tolerance of 2 mm and 0.5 degrees, and displaces the
part COUNT times at random within that (500 without it). The drive is followed on the displaced
part: every place of contact, 5 mm apart, goes with the part, in the branch of its segment. The
displacement is survived if every test of the scene passes at each of these places, and no joint
moves by 0.5 rad more from one to the next than it does where the part should stand. Moves between
strokes are planned anew for a part that was measured, so they are not asked about. Bodies of the
part are where the part is. With ``--judged`` the judge of trajectories is asked as well about the
first N of them: it gets every sample of contact, and says of how many it agrees.
"""

from __future__ import annotations

import argparse
from math import radians

import numpy as np

import cellcolor
from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import Trajectory
from cellcolor.door.planned import PlannedScene
from cellcolor.door.shipped import find_file
from cellcolor.frontend.parts.placement import Placement, Tolerance, rotation_from_rpy
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.scene import Scene
from cellcolor.trajectory_checker.check import check_trajectory

SCENES = ("half_pipe", "hemisphere_flat", "hemisphere_tilted", "square", "wok", "wok_obstacle")
WITHIN = Tolerance(position_m=0.002, rotation_rad=radians(0.5))
APART = 0.005  # m; between places of contact that are asked about
JUMP = 0.5  # rad; a joint that moves so much farther from one place to the next is elsewhere
OF_CONTACT = ("jump", "joint limit", "off surface", "tilted", "invalid", "branch", "crack")


def main(count: int, judged: int, names: list[str]) -> None:
    """Print a row for each scene."""
    print("| scene | lift-offs | covered, % | survived, % | lift-offs | covered, % | survived, % |")
    print("|---|--:|--:|--:|--:|--:|--:|", flush=True)
    for name in names:
        scene = Scene.read(find_file(name))
        cells = []
        for tolerance in (None, WITHIN):
            planned = cellcolor.plan(scene.varied(tolerance=tolerance))
            well = survived(planned, scene, count)
            share = sum(well) / count
            covered = 100 * planned.instance.coverage.covered
            cells += [
                f"{planned.trajectory.lift_offs}{'' if planned.verdict.valid else ' (faults)'}",
                f"{covered:.1f}",
                f"{100 * share:.1f}",
            ]
            if judged:
                told = [followed(planned, scene, after) for after in drawn(scene, count)[:judged]]
                agreed = sum(a == b for a, b in zip(well, told, strict=False))
                print(
                    f"{name}: judged valid {sum(told)} of {judged}, {agreed} as below", flush=True
                )
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


def drawn(scene: Scene, count: int) -> list[Placement]:
    """Where the displaced part stands."""
    vertices = prepare(scene).surface.vertices
    center = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    rng = np.random.default_rng(1)
    return list(WITHIN.drawn(scene.placement, center, rng, count=count))


def shifted(
    scene: Scene, after: Placement, points: np.ndarray, normals: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Points and normals (k, 3) that go with the part to another place."""
    before = scene.placement
    turn = rotation_from_rpy(*after.rpy_rad) @ rotation_from_rpy(*before.rpy_rad).T
    return (points - before.position_m) @ turn.T + np.array(after.position_m), normals @ turn.T


def survived(planned: PlannedScene, scene: Scene, count: int) -> list[bool]:
    """At which displacements the drive can be followed."""
    prepared = prepare(scene)
    points, normals, branches, begins = places(planned, APART)
    usual = steps(prepared, points, normals, branches)
    assert usual is not None
    well = []
    for after in drawn(scene, count):
        found = steps(prepared.at(after), *shifted(scene, after, points, normals), branches)
        well.append(found is not None and bool((found <= usual + JUMP)[~begins[1:]].all()))
    return well


def followed(planned: PlannedScene, scene: Scene, after: Placement) -> bool:
    """Whether the judge finds no fault in contact where the part is displaced."""
    built = cellcolor.build(scene.varied(placement=after))
    points, normals, branches, begins = places(planned, 0.0)
    points, normals = shifted(scene, after, points, normals)
    joints = built.prepared.arm.follow(points, -normals, branches)
    if np.isnan(joints).any():
        return False
    usual = planned.trajectory.joints[planned.trajectory.contact]
    joints += 2 * np.pi * np.round((usual - joints) / (2 * np.pi))
    # After each stroke a sample without contact, from where the way on is not planned.
    rows = np.insert(np.arange(len(points)), np.flatnonzero(begins)[1:], -1)
    off = rows < 0
    rows[off] = rows[np.flatnonzero(off) - 1]
    drive = Trajectory(
        name=scene.name,
        joint_names=planned.trajectory.joint_names,
        times=np.arange(len(rows), dtype=float),
        joints=joints[rows],
        points=points[rows],
        normals=normals[rows],
        contact=~off,
        segment=np.where(off, -1, planned.trajectory.segment[planned.trajectory.contact][rows]),
        unplanned=tuple(np.flatnonzero(off).tolist()),
    )
    faults = check_trajectory(built, drive, timed=False).faults
    return not any(fault.kind in OF_CONTACT for fault in faults)


def steps(
    prepared: PreparedScene, points: np.ndarray, normals: np.ndarray, branches: np.ndarray
) -> np.ndarray | None:
    """How far joints move from place to place in these branches; None if one is not valid."""
    verdicts = prepared.judge(prepared.arm.follow(points, -normals, branches))
    if (verdicts.reasons != VALID).any():
        return None
    moved = np.abs(np.diff(verdicts.configurations, axis=0))
    return np.minimum(moved, np.abs(2 * np.pi - moved))  # whole turns do not count


def places(
    planned: PlannedScene, apart: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Places of contact some way apart: points, normals, branches, and whether a stroke begins."""
    drive, plan = planned.trajectory, planned.painted.plan
    first_of = {int(s): np.argmax(planned.painted.segment_of == s) for s in drive.segment if s >= 0}
    color = {segment: plan.vertex_colors[vertex] for segment, vertex in first_of.items()}
    branch = planned.built.stages.cleaned.coloring.branch
    rows, first = [], []
    for begin, end in drive.strokes:
        far = np.inf
        for row in range(begin, end + 1):
            far += np.linalg.norm(drive.points[row] - drive.points[row - 1]) if row > begin else 0
            if far >= apart and drive.segment[row] >= 0:
                rows.append(row)
                first.append(np.isinf(far))
                far = 0.0
    own = np.array([branch[color[int(drive.segment[row])]] for row in rows])
    return drive.points[rows], drive.normals[rows], own, np.array(first)


if __name__ == "__main__":
    given = argparse.ArgumentParser(description=__doc__)
    given.add_argument("count", nargs="?", type=int, default=500)
    given.add_argument("--judged", type=int, default=0)
    given.add_argument("scene", nargs="*", default=SCENES)
    asked = given.parse_intermixed_args()
    main(asked.count, asked.judged, asked.scene)
