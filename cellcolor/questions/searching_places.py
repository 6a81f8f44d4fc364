"""The search of ``cellcolor.place``: many placements on a coarse mesh, the best ones proved.

First come placements all over the ranges, then some in smaller and smaller boxes around the best
ones. Those that are best then are built and proved on the scene's own mesh.

A placement is built whole only where its bounds
(:mod:`cellcolor.questions.placing`) leave it a chance to be among the best: which these are
is the same as if all were built.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import CellcolorError, InputError
from cellcolor.frontend.scene import Scene
from cellcolor.processes import Task, as_they_end
from cellcolor.questions.placements import PlacedMinimum, PlacementQuestion, Placements, Pose
from cellcolor.questions.placing import (
    around,
    coarse_scene,
    distance,
    is_inside,
    minima_at,
    pose_of,
    spread,
)

_CLOSER = (0.3, 0.15, 0.08, 0.04, 0.02)
"""Shares of the ranges, of the boxes around the best placements; by measure (docs/questions.md)."""
_AROUND = 3  # placements that get boxes
_NEXT = 0.05  # of the ranges; of placements nearer to each other one is enough
_BATCH = 32  # placements per task; reading the scene takes as long as one or two of them
_ATTEMPTS = 2  # how often a task is tried whose process was lost
_ENDING = 10.0  # s that a process may take beyond its time
_ALL_DAY = 86_400.0  # s, the limit of a process if there is no time limit


def search_places(
    scene: Scene,
    question: PlacementQuestion,
    jobs: int,
    deadline: Deadline,
    report: Callable[[str], None],
) -> Placements:
    """Look for placements with fewer lift-offs, and prove the best ones.

    Args:
        jobs: processes at a time.
        report: told what is being done.

    Raises:
        InputError: the part cannot stand where the scene has it, and no share is asked for.
        OutOfTime: the deadline came before the scene itself was solved.
        CellcolorError: a task failed, or its process was lost in every attempt.
    """
    report("where it stands")
    start = (0.0,) * 6 if question.base else pose_of(scene.placement)
    own = _OnMesh(scene, question, jobs, deadline, report)
    if not own.look([start], whole=True):
        raise OutOfTime
    here = own.rows[start]
    if question.cover is None and here.segments is None:
        message = (
            "say how much has to be covered: where the scene has it, the part cannot stand "
            f"({here.refused or 'not solved in time'})"
        )
        raise InputError(None, "cover", message)
    own.cover = here.covered_share if question.cover is None else question.cover
    coarse, complete = replace(own, rows={}), True
    best: list[PlacedMinimum] = []
    others: list[PlacedMinimum] = []
    try:
        report("a coarse mesh")
        coarse.scene = coarse_scene(scene, question.vertices, deadline)
        chosen = _best_on_coarse_mesh(coarse, start)
        report("proving the best ones")
        looked_at = [row.pose for row in own.look(chosen)]
        best = own.best_of(looked_at, question.best)
        others = [own.rows[pose] for pose in looked_at if own.rows[pose] not in best]
    except OutOfTime:
        complete = False
    return Placements(
        scene.name,
        own.cover,
        here,
        tuple(best),
        (*coarse.rows.values(), *others),
        complete and own.complete and coarse.complete,
        question.base,
    )


def _best_on_coarse_mesh(coarse: _OnMesh, start: Pose) -> list[Pose]:
    """Try placements all over the ranges, then around the best ones; twice as many as are asked."""
    asked = coarse.question
    if asked.cover is None:
        # The share of a coarse mesh is another one: like is compared with like.
        for row in coarse.look([start], whole=True):
            coarse.cover = row.covered_share
    coarse.look([start, *spread(asked.ranges, start, asked.points, asked.seed)])
    each = max(asked.points // 20, 1)
    for number, share in enumerate(_CLOSER, 1):
        near: list[Pose] = []
        for turn, row in enumerate(coarse.best_of(coarse.rows, _AROUND)):
            seed = asked.seed + 10 * number + turn
            near += around(asked.ranges, row.pose, share, each, seed)
        coarse.look(near)
    return [row.pose for row in coarse.best_of(coarse.rows, 2 * asked.best)]


@dataclass
class _OnMesh:
    """Placements of a scene on one mesh.

    Attributes:
        cover: the share that is enough.
        rows: what is known of each placement, in the order in which they were asked.
        complete: whether the deadline left nothing out.
    """

    scene: Scene
    question: PlacementQuestion
    jobs: int
    deadline: Deadline
    report: Callable[[str], None]
    cover: float = 0.0
    rows: dict[Pose, PlacedMinimum] = field(default_factory=dict)
    complete: bool = True

    def look(self, poses: Sequence[Pose], *, whole: bool = False) -> list[PlacedMinimum]:
        """A row for each placement, in order; fewer if the deadline comes first.

        Args:
            whole: build each; otherwise bounds are enough where nothing better is known.

        Raises:
            OutOfTime: the deadline came before the first.
        """
        self.deadline.check()
        known = {pose for pose, row in self.rows.items() if not (whole and row.at_least)}
        new = [pose for pose in dict.fromkeys(poses) if pose not in known]
        order = (*self.rows, *poses)
        for rows in self._computed(new, None if whole else self.cover):
            known |= {row.pose for row in rows}
            self.rows |= {row.pose: row for row in rows}
            self.report(f"{len(self.rows)} placements")
        self.rows = {pose: self.rows[pose] for pose in order if pose in self.rows}
        self.complete &= known >= set(poses)
        return [self.rows[pose] for pose in poses if pose in known]

    def _computed(
        self, poses: Sequence[Pose], cover: float | None
    ) -> Iterator[list[PlacedMinimum]]:
        """The rows of placements, some at a time, in the order in which they are done."""
        how = 1, self.question.seed, self.question.base, cover
        size = min(_BATCH, -(-len(poses) // self.jobs) or 1)
        lost = [poses[at : at + size] for at in range(0, len(poses), size)]
        if 1 in (self.jobs, len(poses)):  # this process does what there is one of
            for part in lost:
                yield minima_at(self.scene, part, self.deadline.left, *how)
            return
        for attempt in range(1, _ATTEMPTS + 1):
            left = self.deadline.left
            most = min(left, _ALL_DAY) + _ENDING
            tasks = [(part, Task(minima_at, (self.scene, part, left, *how), most)) for part in lost]
            lost = []
            for part, ended in as_they_end(self.jobs, tasks):
                if ended.end in ("done", "timeout", "stopped"):
                    yield ended.value or []
                elif ended.end == "failed" or attempt == _ATTEMPTS:
                    raise CellcolorError(f"placements could not be tried: {ended.error}")
                else:  # the process was lost; the work is repeated
                    lost.append(part)

    def best_of(self, poses: Iterable[Pose], count: int) -> list[PlacedMinimum]:
        """The best of some that were looked at, in the ranges, none next to a better one.

        Of those with bounds the ones that look best are built, until none that is left could be
        among the best.
        """
        ranges = self.question.ranges
        allowed = [pose for pose in poses if is_inside(ranges, pose)]  # the start may not be
        while True:
            chosen: list[PlacedMinimum] = []
            rows = [self.rows[pose] for pose in allowed]
            for row in sorted(rows, key=lambda row: row.rank(self.cover)):
                apart = all(distance(ranges, row.pose, one.pose) >= _NEXT for one in chosen)
                if (row.segments or row.at_least) and apart and len(chosen) < count:
                    chosen.append(row)
            open_ = [row.pose for row in chosen if row.at_least]
            if not open_:
                return chosen
            if len(self.look(open_, whole=True)) < len(open_):
                raise OutOfTime
