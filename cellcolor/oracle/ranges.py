"""The range that the fewest segments of a surface are proved to lie in, and proofs kept on disk.

Everything here is in the search space ``surface`` (any division of the physical surface,
docs/semantics.md, section 4): a bound of the search space ``paper`` may be beaten by a plan. What
kept solutions prove is checked again when they are read.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
import time
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import cellcolor
from cellcolor.checker.division import check_solution
from cellcolor.checker.groups import regions_on_surface
from cellcolor.data.bounds import greatest
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.verdicts import ProvenRange
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import Decomposition, decomposition_of
from cellcolor.errors import InputError
from cellcolor.files.documents import read_document, sha256_of
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import STRANDS, Options


@dataclass(frozen=True)
class Proof:
    """What is proved of the fewest segments of a surface, and what proves it.

    Attributes:
        bounds: the range that they lie in.
        decomposition: the topological graph on the surface; None if there was no time for it.
        found: all solutions that were found; their bounds are what the lower end rests on.
        kept_lower: a greater lower bound that was kept on disk and that nothing has verified.
    """

    bounds: ProvenRange
    decomposition: Decomposition | None = None
    found: tuple[Solution, ...] = ()
    kept_lower: int | None = None

    @property
    def solution(self) -> Solution | None:
        """The one with the fewest segments that was found; None without a division."""
        divided = [solution for solution in self.found if solution.cells is not None]
        return min(divided, key=lambda solution: solution.segments or 0, default=None)

    @cached_property
    def why_not_fewer(self) -> str | None:
        """Why there cannot be fewer segments than the minimum, a clause; None if not known."""
        if self.solution is None or self.decomposition is None:
            return None
        return self.solution.why_not_fewer(self.decomposition.instance)


def prove(
    surface: LabelledSurface,
    deadline: Deadline,
    *,
    workers: int | None = None,
    seed: int = 0,
) -> Proof:
    """Find the range that the fewest segments of a labelled surface lie in, and the proof of it.

    Args:
        deadline: when to return what is proved; both ends hold however early that is.
        workers: CP-SAT's search workers, None for its portfolio.

    Raises:
        InputError: a cell of the surface is not planar, or an option is out of its range.
    """
    started = time.monotonic()
    # The paper's search space is the smaller one: where its optimum meets a bound for any
    # division, there is nothing left to search.
    searches = (
        Options("paper", deadline=deadline, workers=workers, seed=seed),
        Options("surface", STRANDS["surface"], deadline, workers, seed),
    )
    try:
        decomposition = decomposition_of(surface, None, deadline)
    except OutOfTime:
        # A segment for each vertex is a division too, and without any nothing is covered.
        reached = sum(map(bool, surface.vertex_colors))
        return Proof(ProvenRange(min(reached, 1), reached))
    instance = decomposition.instance
    upper = len(instance.cells)  # one sub-cell a cell is a division as well
    lower = min(upper, 1)
    found: list[Solution] = []
    # A further search is not begun unless it has about the time that decomposing took.
    enough = deadline.earlier(time.monotonic() - started)
    for number, options in enumerate(searches if instance.cells else ()):
        if (enough if number else deadline).over or (number and lower == upper):
            break
        solution = solve(instance, options)
        found.append(solution)
        lower = max(lower, solution.surface_lower_bound)
        if solution.segments is not None:
            upper = min(upper, solution.segments)
    return Proof(ProvenRange(lower, upper), decomposition, tuple(found))


@dataclass(frozen=True)
class ProofCache:
    """A folder with a file for each surface, named by a fingerprint.

    The fingerprint covers the surface's content and cellcolor's own source. If one of them changes,
    the surface is proved again. A file holds solutions and the time limit under which they were
    found. It holds no bounds: those are computed when it is read.

    Attributes:
        folder: where; it is created if it does not exist.
        seconds: the time limit that a new proof would have.
    """

    folder: Path
    seconds: float

    def get(self, surface: LabelledSurface, deadline: Deadline) -> Proof | None:
        """What the kept solutions prove, or None if the surface has to be proved again.

        The checker counts the upper end of the range. The lower end is the best bound whose
        certificate the checker verifies; a larger bound without one goes into ``kept_lower``.

        The surface has to be proved again if there is no file that can be read in time, if the
        checker rejects one of its solutions, if a verified bound exceeds the upper end, so that one
        of the two is wrong, or if the ends differ, and that proof had less time.
        """
        file = self._file(surface)
        if not file.is_file():  # opening a pipe would block
            return None
        try:
            kept = read_document(file)
            solutions, earlier = kept.get("solutions"), kept.get("seconds")
            if type(earlier) is not float or not isinstance(solutions, list) or not solutions:
                return None
            if not all(isinstance(document, dict) for document in solutions):
                return None
            found = [Solution.from_document(document) for document in solutions]
            decomposition = decomposition_of(surface, None, deadline)
            instance = decomposition.instance
            regions = regions_on_surface(surface, decomposition.vertex_cell)
            upper = len(instance.cells)
            verified = claimed = min(upper, 1)
            for solution in found:
                report = check_solution(instance, solution, regions, deadline)
                if not report.valid:
                    return None
                claimed = max(claimed, solution.surface_lower_bound)
                proved = [one.bound for one in report.bounds if one.outcome == "verified"]
                verified = max(verified, greatest(proved, "surface"))
                if report.segments is not None:
                    upper = min(upper, report.segments)
        except (InputError, OutOfTime):
            return None
        if verified > upper or (max(verified, claimed) < upper and self.seconds > earlier):
            return None
        bounds = ProvenRange(verified, upper)
        kept_lower = min(claimed, upper) if claimed > verified else None
        return Proof(bounds, decomposition, tuple(found), kept_lower)

    def put(self, surface: LabelledSurface, proof: Proof) -> None:
        """Write what was found within the time limit.

        Raises:
            InputError: the folder cannot be written to, or something else has the file's name.
        """
        if not proof.found:
            return
        kept = {
            # JSON has no infinity; 1e300 is longer than any time limit.
            "seconds": min(float(self.seconds), 1e300),
            "solutions": [solution.to_document() for solution in proof.found],
        }
        place, written = self.folder, None
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            # Several processes may write at once. Renaming keeps the file whole, whoever is last.
            handle, name = tempfile.mkstemp(dir=self.folder)
            place, written = self._file(surface), Path(name)
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                json.dump(kept, file)
            written.replace(place)
        except OSError as error:
            reason = error.strerror or "cannot be written"
            raise InputError(str(place), None, reason) from error
        finally:
            if written is not None:
                written.unlink(missing_ok=True)

    def _file(self, surface: LabelledSurface) -> Path:
        depends_on = {"surface": surface.sha256, "code": _code()}
        return self.folder / f"{sha256_of(depends_on)}.json"


@cache
def _code() -> str:
    """The fingerprint of the package's source."""
    folder, digest = Path(cellcolor.__file__).parent, hashlib.sha256()
    for file in sorted(folder.rglob("*.py")):
        content = file.read_bytes()
        digest.update(f"{file.relative_to(folder).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()
