"""``cellcolor.compare``: the same part before several arms, each with its best placement."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime, TimeLimit
from cellcolor.door.asking import tradeoff
from cellcolor.door.drawing import save_plot
from cellcolor.door.extras import extras_for
from cellcolor.door.parts import inspect
from cellcolor.door.placing import Range, place
from cellcolor.door.starting import FoundArm, arm_of, best_place, part_keys_of
from cellcolor.errors import InputError
from cellcolor.files.paths import path_of, shipped_folder
from cellcolor.questions.front import Front
from cellcolor.questions.placements import PlacedMinimum

if TYPE_CHECKING:
    from cellcolor.frontend import Scene

_FARTHER, _ASIDE, _HIGHER = (0.4, 0.8), (-0.3, 0.3), (0.0, 0.5)
"""Where a part may be put by default, as shares of the arm's reach: its middle before and beside
the robot, and its lowest point above the ground."""


@dataclass(frozen=True, eq=False)
class ComparedArm:
    """What one arm needs for a part.

    Attributes:
        arm: its name, or the file of its URDF, as it was given.
        best: the best placement that was found, on the part's own mesh; None if the part cannot be
            put anywhere before this arm.
        front: lift-offs against area there; None if the time limit came first.
        refused: why the part cannot be put anywhere, or "".
        torques_tested: whether its URDF has the masses and efforts for that.
        complete: whether the time limit left nothing out.
    """

    arm: str
    best: PlacedMinimum | None = None
    front: Front | None = None
    refused: str = ""
    torques_tested: bool = True
    complete: bool = True

    @property
    def shares(self) -> tuple[float, ...]:
        """The largest shares of the whole surface that 0, 1, 2, … lift-offs cover there."""
        if self.best is None or self.front is None:
            return ()
        return tuple(
            self.best.covered_share * max(p.covered_share for p in self.front if p.segments <= most)
            for most in range(1, self.front.points[-1].segments + 1)
            if any(point.segments <= most for point in self.front)
        )

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        nowhere = PlacedMinimum((0.0,) * 6, None, 0.0, False, 0, self.refused)
        row = (self.best or nowhere).to_document()
        if self.best is None:
            row |= {"position_m": None, "rpy_rad": None}
        front = None if self.front is None else [point.to_document() for point in self.front]
        return {"arm": self.arm} | row | {"front": front, "torques_tested": self.torques_tested}


@dataclass(frozen=True, eq=False)
class Comparison:
    """The same part before several arms.

    Attributes:
        name: of the part.
        cover: the share of the surface that every arm was to cover.
        arms: in the order in which they were given.
    """

    name: str
    cover: float
    arms: tuple[ComparedArm, ...]

    def __iter__(self) -> Iterator[ComparedArm]:
        return iter(self.arms)

    @property
    def complete(self) -> bool:
        """Whether the time limit left nothing out."""
        return all(row.complete for row in self.arms)

    def save(self, path: str | PathLike[str]) -> None:
        """Draw what each arm covers; see :func:`~cellcolor.door.drawing.save_plot`."""

        def render(form: str) -> bytes:
            from cellcolor.pictures.plots import render_arms

            return render_arms(self.name, {row.arm: row.shares for row in self.arms}, form)

        save_plot(path, render)

    def __str__(self) -> str:
        asked = f"{100 * self.cover:.1f} % of the area"
        lines = [f"{self.name}: {count(len(self.arms), 'arm')}, each to cover {asked}"]
        width = max(map(len, (row.arm for row in self.arms)), default=0)
        for row in self.arms:
            said = row.refused if row.best is None else str(row.best)
            if row.best is not None and row.best.rank(self.cover)[0]:
                said += ", which is too little"
            lines.append(f"  {row.arm:<{width}}  {said}")
            if row.shares:
                front = ", ".join(f"{100 * share:.1f}" for share in row.shares)
                lines.append(f"  {'':<{width}}  at 0, 1, … lift-offs it covers {front} %")
            if row.best is not None and not row.torques_tested:
                lines.append(f"  {'':<{width}}  torques are not tested: its URDF has no masses")
        if not self.complete:
            lines.append("  the time limit came before everything was tried")
        return "\n".join(lines)


@dataclass(frozen=True)
class _Candidate:
    """An arm with the part where most of it was found to be reachable.

    Attributes:
        scene: with the part there; None if it cannot be put anywhere.
        ranges: where it may be put.
        refused: why it cannot be put anywhere.
    """

    arm: str
    scene: Scene | None
    ranges: dict[str, Any]
    refused: str = ""


def compare(
    part: str | PathLike[str],
    arms: Sequence[str | PathLike[str]],
    *,
    x: Range | None = None,
    y: Range | None = None,
    z: Range | None = None,
    roll: Range | None = None,
    pitch: Range | None = None,
    yaw: Range | None = None,
    cover: float | None = None,
    points: int = 128,
    vertices: int = 300,
    unit: str | None = None,
    jobs: int = 1,
    time_limit: TimeLimit = None,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> Comparison:
    """For each arm the best placement of a part, its lift-offs, its area and its front.

    Every arm gets the setup that ``cellcolor.new`` begins with, so all have the same tool and the
    same thresholds. Needs the extra ``frontend``.

    Args:
        part: a mesh file (STL, OBJ, PLY).
        arms: each the name of a shipped one, such as ``ur5e``, or the file of a URDF.
        x, y, z, roll, pitch, yaw: from where to where the part may be put, as for
            ``cellcolor.place``; without any, x, y and z go over a box before each robot that is as
            large as the arm's reach asks for.
        cover: the share of the whole surface that each arm has to cover, 0 to 1; None for as much
            as the arm that covers most where the part is put at first.
        points, vertices: see ``cellcolor.place``.
        unit: ``m``, ``mm``, ``cm`` or ``in``, of the mesh; without it the likely one.
        jobs: processes at a time.
        time_limit: seconds for all of it, None for as long as it takes.
        seed: of everything random.
        progress: told what is being done.

    Raises:
        InputError: part, arm, range, share or number cannot be used, or no arm reaches the part.
        OutOfTime: the time limit came before anything was known of an arm.
    """
    deadline, report = Deadline.of(time_limit), progress or (lambda _: None)
    mesh, names = path_of(part), [str(arm) for arm in arms]
    if not names:
        raise InputError(None, "arms", "no arm is given")
    twice = next((name for at, name in enumerate(names) if name in names[:at]), None)
    if twice is not None:
        raise InputError(None, "arms", f"{twice} is given twice")
    given = {"x": x, "y": y, "z": z, "roll": roll, "pitch": pitch, "yaw": yaw}
    ranges = {name: pair for name, pair in given.items() if pair is not None}
    with extras_for("the front end"):
        from cellcolor.questions.placing import check_ranges, minima_at, pose_of

    if ranges:
        check_ranges(ranges)
    files = [_arm_file(arm) for arm in arms]
    found = [arm_of(file, None, "tip", Path.cwd()) for file in files]
    report("the part")
    keys = part_keys_of(mesh, Path.cwd(), inspect(mesh, unit=unit, time_limit=deadline))
    candidates = []
    for name, arm in zip(names, found, strict=True):
        report(f"{name}: where the part can stand")
        candidates.append(_candidate(name, arm, mesh, keys, ranges, deadline))
    there = [each for each in candidates if each.scene is not None]
    if not there:
        raise InputError(str(mesh), None, f"{names[0]}: {candidates[0].refused}")
    if cover is None:
        report("what the arms cover")
        rows = [
            row
            for each in there
            if each.scene is not None
            for row in minima_at(
                each.scene, [pose_of(each.scene.placement)], deadline.left, None, seed
            )
        ]
        cover = max((row.covered_share for row in rows), default=0.0)
    compared = []
    for number, each in enumerate(candidates):
        if each.scene is None:
            compared.append(ComparedArm(each.arm, refused=each.refused))
            continue
        share = deadline.share(1 / (len(candidates) - number))
        told = _prefixed(report, each.arm)
        placed = place(
            each.scene,
            **each.ranges,
            cover=cover,
            points=points,
            vertices=vertices,
            jobs=jobs,
            time_limit=share.share(0.8),
            seed=seed,
            progress=told,
        )
        best = min((placed.here, *placed.best), key=lambda row: row.rank(placed.cover))
        told("lift-offs against area")
        torques = each.scene.setup.constraints.force
        row = ComparedArm(each.arm, best, torques_tested=torques, complete=placed.complete)
        try:
            scene = each.scene.moved(position_m=best.pose[:3], rpy_rad=best.pose[3:])
            row = replace(row, front=tradeoff(scene, time_limit=share, seed=seed))
        except OutOfTime:
            row = replace(row, complete=False)
        compared.append(row)
    return Comparison(mesh.stem, cover, tuple(compared))


def _prefixed(report: Callable[[str], None], arm: str) -> Callable[[str], None]:
    return lambda text: report(f"{arm}: {text}")


def _arm_file(arm: str | PathLike[str]) -> Path:
    """The URDF that is meant; a file that is there goes before a shipped arm of that name."""
    path = path_of(arm)
    if path.is_file() or path.suffix or path.name != str(arm):
        return path
    shipped = {file.stem: file for file in (shipped_folder() / "models/robots").glob("*.urdf")}
    if str(arm) in shipped:
        return shipped[str(arm)]
    close = get_close_matches(str(arm), shipped, n=1)
    hint = f"; is {close[0]!r} meant?" if close else ""
    raise InputError(str(arm), None, f"is no URDF, and no arm of that name is shipped{hint}")


def _candidate(
    name: str,
    arm: FoundArm,
    mesh: Path,
    keys: dict[str, str],
    ranges: dict[str, Any],
    deadline: Deadline,
) -> _Candidate:
    """An arm with the part before it, and where else the part may be put."""
    try:
        prepared, _ = best_place(arm, mesh, keys, deadline)
    except InputError as error:  # such as a part that is out of reach, or much too large
        return _Candidate(name, None, {}, error.message)
    scene = prepared.scene
    if not ranges:
        points = prepared.part.surface.vertices
        low, middle = points.min(axis=0), (points.min(axis=0) + points.max(axis=0)) / 2
        reach = arm.reach
        ranges = {
            "x": (_FARTHER[0] * reach - middle[0], _FARTHER[1] * reach - middle[0]),
            "y": (_ASIDE[0] * reach - middle[1], _ASIDE[1] * reach - middle[1]),
            "z": (_HIGHER[0] * reach - low[2], _HIGHER[1] * reach - low[2]),
        }
    return _Candidate(name, scene, ranges)
