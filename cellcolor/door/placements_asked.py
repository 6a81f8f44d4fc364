"""Computes the minima of many placements, possibly in other processes; keeps them in a table."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from annotated_types import Ge, Le

from cellcolor.deadline import Deadline
from cellcolor.errors import CellcolorError, InputError
from cellcolor.lab.runs.table import TableFile
from cellcolor.lab.workers import Task, Workers, as_they_end
from cellcolor.questions.placements import PlacedMinimum, PlacementQuestion, Pose
from cellcolor.version import __version__

if TYPE_CHECKING:
    from cellcolor.frontend import Scene

_BATCH = 32  # placements per task; reading the scene takes as long as one or two of them
_ATTEMPTS = 2  # how often a task is tried whose process was lost
_ENDING = 10.0  # s that a process may take beyond its time
_ALL_DAY = 86_400.0  # s, the limit of a process if there is no time limit


@dataclass(frozen=True, slots=True)
class PlacementRow:
    """One row of a table of placements.

    Attributes:
        scene: fingerprint of the scene without its placement.
        mesh: ``own``, or the number of vertices wanted for the coarse mesh.
        x, y, z, roll, pitch, yaw: where the part stands, m and rad.
        segments, covered_share, proved_for_surface, vertices, refused: see
            :class:`~cellcolor.questions.placements.PlacedMinimum`.
    """

    scene: str
    mesh: str
    x: float
    y: float
    z: float
    roll: float
    pitch: float
    yaw: float
    segments: Annotated[int, Ge(1)] | None
    covered_share: Annotated[float, Ge(0), Le(1 + 1e-9)]
    proved_for_surface: bool
    vertices: Annotated[int, Ge(0)]
    refused: str | None

    @property
    def minimum(self) -> PlacedMinimum:
        """The row as a value."""
        return PlacedMinimum(
            pose=(self.x, self.y, self.z, self.roll, self.pitch, self.yaw),
            segments=self.segments,
            covered_share=self.covered_share,
            proved_for_surface=self.proved_for_surface,
            vertices=self.vertices,
            refused=self.refused or "",
        )


class AskedPlacements(AbstractContextManager["AskedPlacements"]):
    """Computes minima of placements, and keeps them, in a file row by row if there is one.

    Args:
        scene: the scene of the placements; its own placement does not matter.
        path: the file; an existing table is continued. None writes no file.
        question: whether the arm's base is moved instead of the part, and the seed.
        deadline: for everything together.
        report: is told how many placements are done.

    Raises:
        InputError: the file is no such table, is damaged, or belongs to another scene.
    """

    def __init__(
        self,
        scene: Scene,
        path: Path | None,
        question: PlacementQuestion,
        deadline: Deadline,
        report: Callable[[str], None],
    ) -> None:
        self._question, self._deadline, self._report = question, deadline, report
        self._done = 0
        self._known: dict[tuple[str, Pose], PlacedMinimum] = {}
        self._file: TableFile[PlacementRow] | None = None
        if path is None:
            return
        self._scene = _fingerprint(scene, question.base)
        self._file = TableFile(path, PlacementRow)
        for number, row in enumerate(self._file.rows, 2):
            if row.scene != self._scene:
                self.__exit__()
                message = "is a placement of another scene, or of one that has changed since"
                raise InputError(str(path), f"line {number}", message)
            self._known[row.mesh, row.minimum.pose] = row.minimum

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            self._file.__exit__()

    def minima(
        self,
        workers: Workers | None,
        scene: Scene,
        mesh: str,
        poses: Sequence[Pose],
        cover: float | None = None,
    ) -> list[PlacedMinimum]:
        """A row for each placement, in order; fewer if the deadline comes first.

        Args:
            workers: the processes that compute; None for this one.
            scene: its own placement does not matter.
            mesh: what the table calls this scene's mesh.
            cover: the share that is enough, for bounds where nothing better is known; the same for
                all placements of a mesh. None for whole builds.

        Raises:
            OutOfTime: the deadline came before the first.
            CellcolorError: a task failed, or its process was lost in every attempt.
        """
        self._deadline.check()
        slots = 1 if workers is None else workers.slots
        known = {
            pose: row
            for (its, pose), row in self._known.items()
            if its == mesh and (cover is not None or not row.at_least)
        }
        new = [pose for pose in dict.fromkeys(poses) if pose not in known]
        size = min(_BATCH, -(-len(new) // slots) or 1)
        parts = [new[at : at + size] for at in range(0, len(new), size)]
        for rows in self._asked(workers, scene, parts, cover):
            for row in rows:
                known[row.pose] = row
                self._keep(mesh, row)
            self._done += len(rows)
            self._report(f"{self._done} placements")
        return [known[pose] for pose in poses if pose in known]

    def _keep(self, mesh: str, row: PlacedMinimum) -> None:
        """Keep a row; write it to the file only if another run could not improve it."""
        self._known[mesh, row.pose] = row
        if self._file is not None and (row.proved_for_surface or row.refused):
            found = row.segments, row.covered_share, row.proved_for_surface, row.vertices
            self._file.append(PlacementRow(self._scene, mesh, *row.pose, *found, row.refused))

    def _asked(
        self,
        workers: Workers | None,
        scene: Scene,
        parts: Sequence[Sequence[Pose]],
        cover: float | None,
    ) -> Iterator[list[PlacedMinimum]]:
        """The rows of each part, in the order in which the parts are done."""
        from cellcolor.questions.placing import minima_at

        how = 1, self._question.seed, self._question.base, cover
        if workers is None:
            for part in parts:
                yield minima_at(scene, part, self._deadline.left, *how)
            return
        lost = list(parts)
        for attempt in range(1, _ATTEMPTS + 1):
            left = self._deadline.left
            most = min(left, _ALL_DAY) + _ENDING
            tasks = [(part, Task(minima_at, (scene, part, left, *how), most)) for part in lost]
            lost = []
            for part, ended in as_they_end(workers, tasks):
                if ended.end in ("done", "timeout", "stopped"):
                    yield ended.value or []
                elif ended.end == "failed" or attempt == _ATTEMPTS:
                    raise CellcolorError(f"placements could not be tried: {ended.error}")
                else:  # the process was lost; the work is repeated
                    lost.append(part)


def _fingerprint(scene: Scene, base: bool) -> str:
    """A fingerprint of scene and setup, without the placement, and of the files that they name.

    Meshes named in a URDF are not included.
    """
    whole = hashlib.sha256(__version__.encode())
    if base:  # the part keeps its placement, so that belongs to the question
        whole.update(scene.placement.model_dump_json().encode())
    for table, folder in ((scene, scene.folder), (scene.setup, scene.setup.folder)):
        content = table.model_dump(mode="json", exclude={"placement"})
        whole.update(json.dumps(content, sort_keys=True).encode())
        for text in _texts(content):
            try:
                whole.update((folder / text).read_bytes())
            except (OSError, ValueError):  # not the name of a file
                continue
    return whole.hexdigest()[:16]


def _texts(content: Any) -> Iterator[str]:
    """All strings in JSON content."""
    open_ = [content]
    while open_:
        value = open_.pop()
        if isinstance(value, str):
            yield value
        elif isinstance(value, dict):
            open_ += value.values()
        elif isinstance(value, list):
            open_ += value
