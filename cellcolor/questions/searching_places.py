"""The search of ``cellcolor.place``: many placements on a coarse mesh, the best ones proved.

First come placements all over the ranges, then some in smaller and smaller boxes around the best
ones. Those that are best then are built and proved on the scene's own mesh.

A placement is built whole only where its bounds
(:mod:`cellcolor.questions.placing`) leave it a chance to be among the best: which these are
is the same as if all were built.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import CellcolorError, InputError
from cellcolor.frontend.scene import Scene
from cellcolor.processes import Task, as_they_end
from cellcolor.questions.placements import (
    PlacedMinimum,
    PlacementQuestion,
    Placements,
    Pose,
)
from cellcolor.questions.placing import (
    around,
    coarse_scene,
    distance,
    is_inside,
    minima_at,
    pose_of,
    spread,
)

_OWN = "own"  # the mesh of the scene itself
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
    search = _Search(scene, question, jobs, deadline, report)
    try:
        search.try_on_coarse_mesh()
        search.prove()
    except OutOfTime:
        search.complete = False
    return search.found()


class _Search:
    """What is known so far.

    Attributes:
        complete: whether the time limit left nothing out.
    """

    def __init__(
        self,
        scene: Scene,
        question: PlacementQuestion,
        jobs: int,
        deadline: Deadline,
        report: Callable[[str], None],
    ) -> None:
        """Solve the scene where it has its part."""
        self.complete = True
        self._scene, self._question, self._jobs = scene, question, jobs
        self._deadline, self._report = deadline, report
        self._known: dict[tuple[str, Pose], PlacedMinimum] = {}
        start = (0.0,) * 6 if question.base else pose_of(scene.placement)
        rows = self._minima(scene, _OWN, [start])
        if not rows:
            raise OutOfTime
        self._here = here = rows[0]
        if question.cover is None and here.segments is None:
            message = (
                "say how much has to be covered: where the scene has it, the part cannot stand "
                f"({here.refused or 'not solved in time'})"
            )
            raise InputError(None, "cover", message)
        self._cover = here.covered_share if question.cover is None else question.cover
        self._enough = self._cover  # on the coarse mesh
        self._tried: list[PlacedMinimum] = []
        self._listed: list[PlacedMinimum] = []
        self._others: list[PlacedMinimum] = []
        self._chosen: list[Pose] = []

    def try_on_coarse_mesh(self) -> None:
        """Try placements all over the ranges, then around the best ones."""
        asked = self._question
        self._report("a coarse mesh")
        coarse = coarse_scene(self._scene, asked.vertices, self._deadline)
        mesh = str(asked.vertices)
        if asked.cover is None:
            # The share of a coarse mesh is another one: like is compared with like.
            for row in self._minima(coarse, mesh, [self._here.pose]):
                self._enough = row.covered_share
        here = self._here.pose
        self._try(coarse, mesh, [here, *spread(asked.ranges, here, asked.points, asked.seed)])
        for number, share in enumerate(_CLOSER, 1):
            each = max(asked.points // 20, 1)
            best = self._best_of(coarse, mesh, self._tried, _AROUND, self._enough)
            near = [
                pose
                for turn, row in enumerate(best)
                for pose in around(
                    asked.ranges, row.pose, share, each, asked.seed + 10 * number + turn
                )
            ]
            self._try(coarse, mesh, near)
        last = self._best_of(coarse, mesh, self._tried, 2 * asked.best, self._enough)
        self._chosen = [row.pose for row in last]

    def prove(self) -> None:
        """Build and prove the best ones on the scene's own mesh."""
        asked = self._question
        self._report("proving the best ones")
        rows = self._minima(self._scene, _OWN, self._chosen, self._cover)
        self._listed = self._best_of(self._scene, _OWN, rows, asked.best, self._cover)
        self._others = [row for row in rows if row not in self._listed]

    def found(self) -> Placements:
        """The answer."""
        return Placements(
            self._scene.name,
            self._cover,
            self._here,
            tuple(self._listed),
            (*self._tried, *self._others),
            self.complete,
            self._question.base,
        )

    def _minima(
        self, scene: Scene, mesh: str, poses: Sequence[Pose], cover: float | None = None
    ) -> list[PlacedMinimum]:
        """A row for each placement, in order; fewer if the deadline comes first.

        Args:
            mesh: the name of this scene's mesh.
            cover: the share that is enough, for bounds where nothing better is known; the same for
                all placements of a mesh. None for whole builds.

        Raises:
            OutOfTime: the deadline came before the first.
        """
        self._deadline.check()
        known = {
            pose: row
            for (its, pose), row in self._known.items()
            if its == mesh and (cover is not None or not row.at_least)
        }
        new = [pose for pose in dict.fromkeys(poses) if pose not in known]
        for rows in self._computed(scene, new, cover):
            known |= {row.pose: row for row in rows}
            self._known |= {(mesh, row.pose): row for row in rows}
            self._report(f"{len(self._known)} placements")
        self.complete &= known.keys() >= set(poses)
        return [known[pose] for pose in poses if pose in known]

    def _computed(
        self, scene: Scene, poses: Sequence[Pose], cover: float | None
    ) -> Iterator[list[PlacedMinimum]]:
        """The rows of placements, some at a time, in the order in which they are done."""
        how = 1, self._question.seed, self._question.base, cover
        size = min(_BATCH, -(-len(poses) // self._jobs) or 1)
        lost = [poses[at : at + size] for at in range(0, len(poses), size)]
        if 1 in (self._jobs, len(poses)):  # this process does what there is one of
            for part in lost:
                yield minima_at(scene, part, self._deadline.left, *how)
            return
        for attempt in range(1, _ATTEMPTS + 1):
            left = self._deadline.left
            most = min(left, _ALL_DAY) + _ENDING
            tasks = [(part, Task(minima_at, (scene, part, left, *how), most)) for part in lost]
            lost = []
            for part, ended in as_they_end(self._jobs, tasks):
                if ended.end in ("done", "timeout", "stopped"):
                    yield ended.value or []
                elif ended.end == "failed" or attempt == _ATTEMPTS:
                    raise CellcolorError(f"placements could not be tried: {ended.error}")
                else:  # the process was lost; the work is repeated
                    lost.append(part)

    def _try(self, coarse: Scene, mesh: str, poses: Sequence[Pose]) -> None:
        self._tried += self._minima(coarse, mesh, poses, self._enough)

    def _best_of(
        self, scene: Scene, mesh: str, rows: list[PlacedMinimum], count: int, cover: float
    ) -> list[PlacedMinimum]:
        """The best ones in the ranges, none of them next to a better one.

        Of rows with bounds those that look best are built, and put in their places, until none that
        is left could be among the best.
        """
        while True:
            chosen = self._look_best(rows, count, cover)
            open_ = [row.pose for row in chosen if row.at_least]
            if not open_:
                return chosen
            built = {row.pose: row for row in self._minima(scene, mesh, open_)}
            rows[:] = [built.get(row.pose, row) for row in rows]
            if len(built) < len(open_):
                raise OutOfTime

    def _look_best(
        self, rows: Sequence[PlacedMinimum], count: int, cover: float
    ) -> list[PlacedMinimum]:
        ranges = self._question.ranges
        chosen: list[PlacedMinimum] = []
        allowed = [row for row in rows if is_inside(ranges, row.pose)]  # the start may not be
        for row in sorted(allowed, key=lambda row: row.rank(cover)):
            apart = all(distance(ranges, row.pose, other.pose) >= _NEXT for other in chosen)
            if (row.segments or row.at_least) and apart and len(chosen) < count:
                chosen.append(row)
        return chosen
