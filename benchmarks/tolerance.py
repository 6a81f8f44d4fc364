"""How many displacements of the part a plan survives, with and without a tolerance.

    python benchmarks/tolerance.py [COUNT] [SCENE ...]

plans each scene twice, as it is and with a tolerance of 2 mm and 0.5 degrees, and displaces the
part COUNT times at random within that (500 without it). The drive is followed on the displaced
part: every place of contact, 5 mm apart, goes with the part, in the branch of its segment. The
displacement is survived if every test of the scene passes at each of these places, and no joint
moves by 0.5 rad more from one to the next than it does where the part should stand. Moves between
strokes are planned anew for a part that was measured, so they are not asked about. Bodies of the
part are where the part is.
"""

from __future__ import annotations

import sys
from math import radians

import numpy as np

import cellcolor
from cellcolor.data.candidate_table import VALID
from cellcolor.door.planned import PlannedScene
from cellcolor.door.shipped import find_file
from cellcolor.frontend.parts.placement import Tolerance, rotation_from_rpy
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.scene import Scene

SCENES = ("half_pipe", "hemisphere_flat", "hemisphere_tilted", "square", "wok", "wok_obstacle")
WITHIN = Tolerance(position_m=0.002, rotation_rad=radians(0.5))
APART = 0.005  # m; between places of contact that are asked about
JUMP = 0.5  # rad; a joint that moves so much farther from one place to the next is elsewhere


def main(count: int, names: list[str]) -> None:
    """Print a row for each scene."""
    print("| scene | lift-offs | covered, % | survived, % | lift-offs | covered, % | survived, % |")
    print("|---|--:|--:|--:|--:|--:|--:|", flush=True)
    for name in names:
        scene = Scene.read(find_file(name))
        cells = []
        for tolerance in (None, WITHIN):
            planned = cellcolor.plan(scene.varied(tolerance=tolerance))
            share = survived(planned, scene, count)
            covered = 100 * planned.instance.coverage.covered
            cells += [
                f"{planned.trajectory.lift_offs}{'' if planned.verdict.valid else ' (faults)'}",
                f"{covered:.1f}",
                f"{100 * share:.1f}",
            ]
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


def survived(planned: PlannedScene, scene: Scene, count: int) -> float:
    """The share of displacements at which the drive can be followed."""
    prepared = prepare(scene)
    points, normals, branches, begins = places(planned)
    vertices = prepared.surface.vertices
    center = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    rng = np.random.default_rng(1)
    before = scene.placement
    usual = steps(prepared, points, normals, branches)
    assert usual is not None
    well = 0
    for after in WITHIN.drawn(before, center, rng, count=count):
        turn = rotation_from_rpy(*after.rpy_rad) @ rotation_from_rpy(*before.rpy_rad).T
        there = (points - before.position_m) @ turn.T + np.array(after.position_m)
        found = steps(prepared.at(after), there, normals @ turn.T, branches)
        well += found is not None and bool((found <= usual + JUMP)[~begins[1:]].all())
    return well / count


def steps(
    prepared: PreparedScene, points: np.ndarray, normals: np.ndarray, branches: np.ndarray
) -> np.ndarray | None:
    """How far joints move from place to place in these branches; None if one is not valid."""
    verdicts = prepared.judge(prepared.arm.follow(points, -normals, branches))
    if (verdicts.reasons != VALID).any():
        return None
    moved = np.abs(np.diff(verdicts.configurations, axis=0))
    return np.minimum(moved, np.abs(2 * np.pi - moved))  # whole turns do not count


def places(planned: PlannedScene) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
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
            if far >= APART and drive.segment[row] >= 0:
                rows.append(row)
                first.append(np.isinf(far))
                far = 0.0
    own = np.array([branch[color[int(drive.segment[row])]] for row in rows])
    return drive.points[rows], drive.normals[rows], own, np.array(first)


if __name__ == "__main__":
    given = sys.argv[1:]
    main(int(given[0]) if given else 500, given[1:] or list(SCENES))
