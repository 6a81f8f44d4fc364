"""``cellcolor.place``: where a part should stand."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from os import PathLike
from typing import TYPE_CHECKING

from cellcolor.deadline import Deadline, OutOfTime, TimeLimit
from cellcolor.door.extras import extras_for
from cellcolor.door.subject import scene_or_file
from cellcolor.errors import CellcolorError, InputError
from cellcolor.lab.executors.alone import Limits
from cellcolor.lab.executors.local import LocalWorkers
from cellcolor.lab.executors.work import Task, Workers, as_they_end
from cellcolor.questions.placements import PlacedMinimum, Placements, Pose

if TYPE_CHECKING:
    from cellcolor.frontend import Scene

__all__ = ["place"]

Range = tuple[float, float]

_BATCH = 32  # placements a process; reading the scene takes as long as one or two of them
_CLOSER = (0.25, 0.0625)  # shares of the ranges, of the boxes around the best placements
_AROUND = 3  # placements that get boxes
_NEXT = 0.05  # of the ranges; of placements nearer to each other one is enough
_ATTEMPTS = 2  # at placements whose process broke down
_ENDING = 10.0  # s that a process may take beyond its time
_ALL_DAY = 86_400.0  # s, where there is no limit


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
            where the part stands.
        points: placements that are tried all over the ranges; three quarters as many are tried
            around the best of them.
        best: how many are proved on the scene's own mesh and listed.
        vertices: about so many has the coarse mesh that placements are tried on.
        jobs: processes at a time, or who does the work.
        time_limit: seconds for all of it, None for as long as it takes.
        seed: of everything random.
        progress: told what is being done.

    Raises:
        InputError: the scene cannot be used, or a range, a share or a number is none.
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
    with extras_for("the front end"):
        from cellcolor.frontend.scene import Scene as SceneValue
        from cellcolor.questions.placing import (
            around,
            check_ranges,
            coarse_scene,
            distance,
            minima_at,
            pose_of,
            spread,
        )

    given = {"x": x, "y": y, "z": z, "roll": roll, "pitch": pitch, "yaw": yaw}
    ranges = {name: pair for name, pair in given.items() if pair is not None}
    check_ranges(ranges)
    own: Scene = scene if isinstance(scene, SceneValue) else SceneValue.read(scene)
    report = progress or (lambda _: None)
    report("where it stands")
    start = pose_of(own.placement)
    rows = minima_at(own, [start], deadline.left, None, seed)
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
    tried: list[PlacedMinimum] = []
    proved: list[PlacedMinimum] = []
    complete = True

    def best_of(found: Sequence[PlacedMinimum], count: int, enough: float) -> list[PlacedMinimum]:
        """The best ones, none of them next to a better one."""
        chosen: list[PlacedMinimum] = []
        for row in sorted(found, key=lambda row: row.rank(enough)):
            apart = all(distance(ranges, row.pose, other.pose) >= _NEXT for other in chosen)
            if row.segments is not None and apart and len(chosen) < count:
                chosen.append(row)
        return chosen

    given_workers = LocalWorkers(jobs) if isinstance(jobs, int) and jobs > 1 else jobs
    with nullcontext() if isinstance(given_workers, int) else given_workers as workers:
        many = _Asked(workers, deadline, seed, report)
        try:
            report("a coarse mesh")
            coarse = coarse_scene(own, vertices, deadline)
            tried += many.minima(coarse, [start, *spread(ranges, start, points, seed)])
            # The share of a coarse mesh is another one: like is compared with like.
            enough = asked if cover is not None or not tried else tried[0].covered_share
            for number, share in enumerate(_CLOSER, 1):
                each = max(points // 8, 1)
                near = [
                    pose
                    for turn, row in enumerate(best_of(tried, _AROUND, enough))
                    for pose in around(ranges, row.pose, share, each, seed + 10 * number + turn)
                ]
                tried += many.minima(coarse, near)
            report("proving the best ones")
            chosen = [row.pose for row in best_of(tried, 2 * best, enough)]
            proved = many.minima(own, chosen)
        except OutOfTime:
            complete = False
    listed = best_of(proved, best, asked)
    others = [row for row in proved if row not in listed]
    return Placements(
        own.name, asked, here, tuple(listed), (*tried, *others), complete and many.complete
    )


class _Asked:
    """Who is asked for the minima of many placements: this process, or others."""

    def __init__(
        self,
        workers: Workers | None,
        deadline: Deadline,
        seed: int,
        report: Callable[[str], None],
    ) -> None:
        self._workers, self._deadline, self._seed, self._report = workers, deadline, seed, report
        self._done = 0
        self.complete = True

    def minima(self, scene: Scene, poses: Sequence[Pose]) -> list[PlacedMinimum]:
        """A row for each placement, in their order; fewer if the time ends.

        Raises:
            OutOfTime: the deadline came before the first.
            CellcolorError: a process could not do its work.
        """
        self._deadline.check()
        slots = 1 if self._workers is None else self._workers.slots
        size = min(_BATCH, -(-len(poses) // slots) or 1)
        parts = [poses[at : at + size] for at in range(0, len(poses), size)]
        found: dict[int, list[PlacedMinimum]] = {}
        for number, rows in self._asked(scene, parts):
            found[number] = rows
            self._done += len(rows)
            self._report(f"{self._done} placements")
        rows = [row for number in sorted(found) for row in found[number]]
        self.complete &= len(rows) == len(poses)
        return rows

    def _asked(
        self, scene: Scene, parts: Sequence[Sequence[Pose]]
    ) -> Iterator[tuple[int, list[PlacedMinimum]]]:
        """The rows of each part, as they come."""
        from cellcolor.questions.placing import minima_at

        if self._workers is None:
            for number, part in enumerate(parts):
                yield number, minima_at(scene, part, self._deadline.left, 1, self._seed)
            return
        lost = list(enumerate(parts))
        for attempt in range(1, _ATTEMPTS + 1):
            left = self._deadline.left
            limits = Limits(min(left, _ALL_DAY) + _ENDING)
            tasks = [
                (number, Task(minima_at, (scene, part, left, 1, self._seed), limits))
                for number, part in lost
            ]
            lost = []
            for number, ended in as_they_end(self._workers, tasks):
                if ended.end in ("done", "timeout", "stopped"):
                    yield number, ended.value or []
                elif ended.end == "failed" or attempt == _ATTEMPTS:
                    raise CellcolorError(f"placements could not be tried: {ended.error}")
                else:  # the process was lost, not the work
                    lost.append((number, parts[number]))
