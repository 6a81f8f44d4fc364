"""``cellcolor.place``: where a part should stand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING

from cellcolor.data.prices import check_price
from cellcolor.deadline import NEVER, Deadline, OutOfTime, TimeLimit
from cellcolor.door.drawing import save_plot
from cellcolor.door.extras import extras_for
from cellcolor.door.placements_asked import AskedPlacements, PlacementTable
from cellcolor.door.subject import scene_or_file
from cellcolor.errors import InputError
from cellcolor.files.paths import path_of
from cellcolor.lab.workers import LocalWorkers, Workers
from cellcolor.questions.placements import Leeway, PlacedMinimum, PlacementMap, Placements

if TYPE_CHECKING:
    from cellcolor.frontend import Scene

Range = tuple[float, float]

_CLOSER = (0.3, 0.15, 0.08, 0.04, 0.02)
"""Shares of the ranges, of the boxes around the best placements; by measure (docs/questions.md)."""

_AROUND = 3  # placements that get boxes
_NEXT = 0.05  # of the ranges; of placements nearer to each other one is enough
_MOST_TILES = 1000
_BESIDE = 64  # samples of how far a placement may be off
_TOGETHER = 16  # of them, before it is asked whether they hold


def place(
    scene: str | PathLike[str] | Scene,
    *,
    x: Range | None = None,
    y: Range | None = None,
    z: Range | None = None,
    roll: Range | None = None,
    pitch: Range | None = None,
    yaw: Range | None = None,
    cover: float | None = None,
    points: int = 128,
    best: int = 3,
    vertices: int = 300,
    base: bool = False,
    uncovered_price: float = 0.0,
    tiles: int | None = None,
    leeway: float | None = None,
    table: str | PathLike[str] | None = None,
    jobs: int | Workers = 1,
    time_limit: TimeLimit = None,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> Placements:
    """Look for placements of a scene's part that need fewer lift-offs, and prove the best ones.

    Needs the extra ``frontend``. The result is the same with any number of jobs.

    Args:
        scene: its file, its shipped name, or the value.
        x, y, z: from where to where the part may be moved, m; what is not given stays.
        roll, pitch, yaw: the same of its angles (extrinsic x, y, z), rad.
        cover: the share of the whole surface that has to be covered, 0 to 1; None for as much as
            where the part stands, and for any share if ``uncovered_price`` is given.
        points: placements that are tried all over the ranges; about three quarters as many, 15 at
            least, are tried around the best of them.
        best: how many are proved on the scene's own mesh and listed.
        vertices: about how many the coarse mesh has on which placements are tried.
        base: move the arm's base instead of the part, upright; its ranges are those of the base in
            the scene's world, where it stands in the origin.
        uncovered_price: in lift-offs, of the whole surface: the sum of lift-offs and of this price
            times the uncovered share is least. With 0 lift-offs come first, then the area.
        tiles: of one or two ranges a map is made, with so many tiles along each: the placements
            tried all over the ranges are the middles of its tiles, whatever ``points`` says.
        leeway: tell how far the best ones may be off before their lift-offs rise, tried up to so
            many m.
        table: a CSV file in which each row is kept as it is proved; one that is there is continued,
            and what it has is not asked again.
        jobs: processes at a time, or who does the work.
        time_limit: seconds for all of it, None for no limit.
        seed: for all random choices.
        progress: told what is being done.

    Raises:
        InputError: the scene cannot be used; a range, a share or a number is none; or the table is
            damaged or of another scene.
        OutOfTime: the time limit came before the scene itself was solved.
    """
    deadline = Deadline.of(time_limit)
    scene = scene_or_file(scene)
    counts = {"points": points, "best": best, "vertices": vertices}
    for name, number in (counts | ({"jobs": jobs} if isinstance(jobs, int) else {})).items():
        if number < 1:
            raise InputError(None, name, f"must be 1 or more, is {number}")
    if cover is not None and not 0 <= cover <= 1:
        raise InputError(None, "cover", f"must be from 0 to 1, is {cover:g}")
    check_price("uncovered_price", uncovered_price)
    if base and leeway is not None:
        raise InputError(None, "leeway", "is asked of a part only, not of a moved base")
    if cover is None and uncovered_price:
        cover = 0.0
    if leeway is not None and not 0 < leeway < 1:
        raise InputError(None, "leeway", f"must be from 0 to 1 m, is {leeway:g}")
    with extras_for("the front end"):
        from cellcolor.frontend.scene import Scene as SceneValue
        from cellcolor.questions.placing import (
            around,
            check_ranges,
            coarse_scene,
            distance,
            is_inside,
            middles,
            pose_of,
            spread,
        )

    given = {"x": x, "y": y, "z": z, "roll": roll, "pitch": pitch, "yaw": yaw}
    ranges = {name: pair for name, pair in given.items() if pair is not None}
    check_ranges(ranges, base)
    own: Scene = scene if isinstance(scene, SceneValue) else SceneValue.read(scene)
    if tiles is not None and not (len(ranges) <= 2 and 1 <= tiles <= _MOST_TILES):
        message = f"a map needs one or two ranges, and 1 to {_MOST_TILES} tiles along each"
        raise InputError(None, "tiles", message)
    report = progress or (lambda _: None)
    start = (0.0,) * 6 if base else pose_of(own.placement)
    tried: list[PlacedMinimum] = []
    listed: list[PlacedMinimum] = []
    others: list[PlacedMinimum] = []
    complete = True

    def best_of(found: Sequence[PlacedMinimum], count: int, enough: float) -> list[PlacedMinimum]:
        """The best ones in the ranges, none of them next to a better one."""
        chosen: list[PlacedMinimum] = []
        allowed = [row for row in found if is_inside(ranges, row.pose)]  # the start may not be
        for row in sorted(allowed, key=lambda row: row.rank(enough, uncovered_price)):
            apart = all(distance(ranges, row.pose, other.pose) >= _NEXT for other in chosen)
            if row.segments is not None and apart and len(chosen) < count:
                chosen.append(row)
        return chosen

    given_workers = LocalWorkers(jobs) if isinstance(jobs, int) and jobs > 1 else jobs
    with (
        PlacementTable(own, None if table is None else path_of(table), base) as known,
        nullcontext() if isinstance(given_workers, int) else given_workers as workers,
    ):
        report("where it stands")
        alone = AskedPlacements(None, known, deadline, seed, report, base)
        rows = alone.minima(own, "own", [start])
        if not rows:
            raise OutOfTime
        here = rows[0]
        if cover is None and here.segments is None:
            message = (
                f"say how much has to be covered: where the scene has it, the part cannot stand "
                f"({here.refused or 'not solved in time'})"
            )
            raise InputError(None, "cover", message)
        asked = here.covered_share if cover is None else cover
        many = AskedPlacements(workers, known, deadline, seed, report, base)
        whole = spread(ranges, start, points, seed)
        if tiles is not None:
            whole = middles(ranges, start, tiles)
        try:
            report("a coarse mesh")
            coarse, mesh = coarse_scene(own, vertices, deadline), str(vertices)
            tried += many.minima(coarse, mesh, [start, *whole])
            # The share of a coarse mesh is another one: like is compared with like.
            enough = asked if cover is not None or not tried else tried[0].covered_share
            for number, share in enumerate(_CLOSER, 1):
                each = max(points // 20, 1)
                near = [
                    pose
                    for turn, row in enumerate(best_of(tried, _AROUND, enough))
                    for pose in around(ranges, row.pose, share, each, seed + 10 * number + turn)
                ]
                tried += many.minima(coarse, mesh, near)
            report("proving the best ones")
            chosen = [row.pose for row in best_of(tried, 2 * best, enough)]
            proved = many.minima(own, "own", chosen)
            listed = best_of(proved, best, asked)
            others = [row for row in proved if row not in listed]
            for number, row in enumerate(listed if leeway is not None else ()):
                report(f"how far placement {number + 1} may be off")
                listed[number] = replace(row, leeway=_leeway(many, own, row, leeway or 0.0, seed))
        except OutOfTime:
            complete = False
    tiled = None
    if tiles is not None:
        by_pose = {row.pose: row for row in tried}
        tiled = PlacementMap(ranges, tiles, tuple(by_pose.get(pose) for pose in whole))
    complete &= many.complete
    rest = (*tried, *others)
    best_ones = tuple(listed)
    return Placements(
        own.name, asked, here, best_ones, rest, complete, tiled, base, uncovered_price
    )


def save_map(found: Placements, path: str | PathLike[str]) -> None:
    """Draw the map of ``place(..., tiles=…)`` to a file .png or .svg.

    Raises:
        InputError: no map was asked for; or as of :func:`~cellcolor.door.drawing.save_plot`.
    """
    tiled = found.map
    if tiled is None:
        raise InputError(None, "tiles", "no map was asked for")

    def render(form: str) -> bytes:
        from cellcolor.pictures.plots import render_map

        return render_map(found.name, tiled, found.here, found.best, form)

    save_plot(path, render)


def _leeway(
    many: AskedPlacements, scene: Scene, placed: PlacedMinimum, up_to_m: float, seed: int
) -> Leeway:
    """How far the part may be off a placement before its lift-offs rise."""
    from cellcolor.questions.placing import displaced

    own = scene.covered(NEVER).vertices
    beside = displaced(own, placed.pose, up_to_m, _BESIDE, seed)
    holds, least = 0.0, placed.covered_share
    for first in range(0, _BESIDE, _TOGETHER):
        some = beside[first : first + _TOGETHER]
        rows = many.minima(scene, "own", [pose for _, pose in some])
        if len(rows) < len(some):
            raise OutOfTime
        for number, ((off, _), row) in enumerate(zip(some, rows, strict=True), first + 1):
            if row.segments is None or row.segments > (placed.segments or 0):
                return Leeway(holds, off, number, least)
            holds, least = off, min(least, row.covered_share)
    return Leeway(holds, None, _BESIDE, least)
