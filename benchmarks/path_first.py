"""What planners pay that choose the path first: ``python benchmarks/path_first.py [SCENE …]``.

A raster path over the part of each scene's surface that a solution covers, in 18 directions; then
the best choice of inverse-kinematic branches along it. Prints, as Markdown, the best, the median
and the worst number of lift-offs of the directions, twice, beside the proven minimum:

- optimistic: only changes of branch count, whether an arm could go between samples or not;
- judged: the strokes that an arm can follow, as a trajectory whose contact is held against the
  scene by the judge of trajectories. A stroke is split wherever that finds a jump, an invalid
  sample, a joint beyond its limit, another branch or a crack.

The optimistic count takes going from one sample to the next in the same branch for continuous, and
passing what is out of reach for free; no planner that follows this path pays less.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import get_args

import numpy as np
from raster import Raster, raster

import cellcolor
from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import FaultKind
from cellcolor.frontend import BuildResult, Scene, build_surface
from cellcolor.trajectory_checker.check import check_trajectory

ROOT = Path(__file__).resolve().parents[1]
SCENES = [
    *sorted((ROOT / "instances" / "scenes").glob("*.toml")),
    *sorted((ROOT / "instances" / "parts").glob("*.toml")),
]
REFUSED = "torus_refused"  # no minimum to compare with
DIRECTIONS = 18
JUMP = 0.5  # rad between samples; what the judge takes for a jump
SPLITTING = ("jump", "joint limit", "invalid", "branch", "crack")
assert set(SPLITTING) <= set(get_args(FaultKind))
_FULL = 2 * np.pi


@dataclass(frozen=True)
class Stroke:
    """A stretch of a path in one branch without a lift-off.

    Attributes:
        first, after: its first sample, and the one after its last.
        branch: the branch's number.
        joints: (after - first, joints) in rad, unwound, inside the limits.
    """

    first: int
    after: int
    branch: int
    joints: Array


def fewest_lift_offs(valid: Mask) -> int:
    """The fewest changes of branch along a path.

    Staying in a branch for as long as any lasts is best: whoever changes earlier is not further on
    at the next change.

    Args:
        valid: (n, branches) which branches reach each point of the path, one at least.
    """
    lift_offs = 0
    left = valid[0]
    for here in valid:
        left = left & here
        if not left.any():
            lift_offs += 1
            left = here
    return lift_offs


def fewest_strokes(
    path: Raster, configurations: Array, valid: Mask, lower: Array, upper: Array, jump: float
) -> list[Stroke]:
    """The fewest strokes along a path that an arm can follow.

    In a stroke the branch is valid at every sample, no joint moves by more than ``jump`` from one
    sample to the next, and the angles, unwound, fit into the limits with some start. What holds
    for a stroke holds for each part of it, so staying as long as any branch lasts is best
    here too. Samples that no branch reaches are passed over in the air.

    Args:
        path: its samples, n of them.
        configurations: (n, branches, joints) in rad, modulo full circles; NaN without a solution.
        valid: (n, branches).
        lower, upper: (joints,) limits, rad.
        jump: rad.
    """
    found: list[Stroke] = []
    begins = np.zeros(len(valid), dtype=bool)
    begins[path.starts] = True
    sample = 0
    while sample < len(valid):
        if not valid[sample].any():
            sample += 1
            continue
        after, branch = _longest(sample, begins, configurations, valid, lower, upper, jump)
        joints = np.unwrap(configurations[sample:after, branch], axis=0)
        turns = np.ceil((lower - joints.min(axis=0)) / _FULL)
        found.append(Stroke(sample, after, branch, joints + _FULL * turns))
        sample = after
    return found


def _longest(
    first: int,
    begins: Mask,
    configurations: Array,
    valid: Mask,
    lower: Array,
    upper: Array,
    jump: float,
) -> tuple[int, int]:
    """The sample after the longest stroke from one on, and its branch."""
    alive = valid[first]
    here = np.nan_to_num(configurations[first])
    least, most = here.copy(), here.copy()
    after = first + 1
    while after < len(valid) and not begins[after]:
        step = configurations[after] - configurations[after - 1]
        step = np.nan_to_num(step - _FULL * np.round(step / _FULL), nan=np.inf)
        still = alive & valid[after] & (np.abs(step) <= jump).all(axis=1)
        here = here + np.where(still[:, None], step, 0.0)
        least, most = np.minimum(least, here), np.maximum(most, here)
        turned = _FULL * np.ceil((lower - least) / _FULL)
        still &= (most + turned <= upper).all(axis=1)
        if not still.any():
            break
        alive = still
        after += 1
    return after, int(np.flatnonzero(alive)[0])


@dataclass(frozen=True)
class Counted:
    """One direction: its path, its strokes, and both numbers of lift-offs.

    ``contact`` are the samples of the trajectory that are in contact, after splitting.
    """

    path: Raster
    strokes: list[Stroke]
    trajectory: Trajectory
    contact: Mask
    optimistic: int
    judged: int


def counted(built: BuildResult, angle: float, spacing: float) -> Counted:
    """The raster path in one direction, and what it costs.

    Args:
        built: the scene, without the keys of motions, so that no area is judged.
        angle: of the raster, rad.
        spacing: between its passes, m.
    """
    # Points that a sliver policy gave up are left out on both sides of the comparison.
    prepared = built.prepared
    covered = (built.node_color >= 0).any(axis=1)
    path = raster(built.surface, prepared.surface.normals, covered, angle, spacing)
    found = prepared.arm.inverse(path.points, -path.normals)
    verdicts = prepared.judge(found.reshape(-1, found.shape[2]))
    configurations = verdicts.configurations.reshape(found.shape)
    valid: Mask = (verdicts.reasons == VALID).reshape(found.shape[:2])
    robot = prepared.robot
    strokes = fewest_strokes(path, configurations, valid, robot.lower, robot.upper, JUMP)
    trajectory = as_trajectory(path, strokes, robot.joint_names)
    contact = accepted(built, trajectory)
    begins = np.count_nonzero(contact & ~np.concatenate([[False], contact[:-1]]))
    optimistic = fewest_lift_offs(valid[valid.any(axis=1)])
    return Counted(path, strokes, trajectory, contact, optimistic, begins - 1)


def accepted(built: BuildResult, trajectory: Trajectory) -> Mask:
    """The samples in contact that the judge lets pass."""
    verdict = check_trajectory(built, trajectory, timed=False)
    contact = trajectory.contact.copy()
    for kind in SPLITTING:
        faults = verdict.of_kind(kind)
        assert len(faults) == verdict.fault_counts.get(kind, 0), "more faults than a verdict lists"
        for fault in faults:
            assert fault.sample is not None and fault.last_sample is not None
            # What lies between two samples, as a jump does, ends the stroke at the first.
            contact[min(fault.sample + 1, fault.last_sample) : fault.last_sample + 1] = False
    return contact


def as_trajectory(
    path: Raster, strokes: Sequence[Stroke], joint_names: tuple[str, ...]
) -> Trajectory:
    """The strokes, and between each two a sample in the air, from which no move is planned."""
    parts: list[tuple[Array, Array, Array, Mask]] = []
    for stroke in strokes:
        rows = np.arange(stroke.first, stroke.after)
        rows = np.append(rows, rows[-1])
        contact = np.ones(len(rows), dtype=bool)
        contact[-1] = False
        joints = np.concatenate([stroke.joints, stroke.joints[-1:]])
        parts.append((joints, path.points[rows], path.normals[rows], contact))
    joints, points, normals, contact = (
        np.concatenate([part[k] for part in parts]) for k in range(4)
    )
    return Trajectory(
        name="raster",
        joint_names=joint_names,
        times=np.arange(len(joints), dtype=np.float64),
        joints=joints,
        points=points,
        normals=normals,
        contact=contact,
        segment=np.where(contact, 0, -1),
        unplanned=tuple(np.flatnonzero(~contact)[:-1].tolist()),
    )


def row(file: Path) -> str:
    """The table's row of one scene."""
    scene = Scene.read(file)
    motion = scene.setup.motion
    assert motion is not None
    built = build_surface(scene.with_setup(scene.setup.varied(motion=None)))
    angles = (np.arange(DIRECTIONS) * np.pi / DIRECTIONS).tolist()
    each = [counted(built, angle, motion.spacing_m) for angle in angles]
    proved = cellcolor.solve(built)
    assert proved.solution.proved_for_surface
    optimistic, judged = (
        f"{min(numbers)}, {median(numbers):g}, {max(numbers)}"
        for numbers in ([one.optimistic for one in each], [one.judged for one in each])
    )
    return f"| {file.stem} | {optimistic} | {judged} | {proved.solution.lift_offs} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", metavar="SCENE", nargs="*", type=Path)
    scenes = parser.parse_args().scenes or [file for file in SCENES if file.stem != REFUSED]
    print("| scene | path first, optimistic: best, median, worst | judged | fewest, proved |")
    print("|---|--:|--:|--:|")
    for scene in scenes:
        print(row(scene), flush=True)


if __name__ == "__main__":
    main()
