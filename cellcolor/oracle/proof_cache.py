"""Solutions kept on disk for each surface; what they prove is checked again when they are read."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cellcolor
from cellcolor.checker.division import check_solution
from cellcolor.checker.groups import regions_on_surface
from cellcolor.data.bounds import greatest
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.verdicts import ProvenRange
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.files.documents import read_document, sha256_of
from cellcolor.oracle.ranges import Proof


@dataclass(frozen=True)
class ProofCache:
    """A folder with a file for each surface, named by a fingerprint.

    The fingerprint covers the surface's content and cellcolor's own source. If one of them changes,
    the surface is proved again. A file holds solutions and the time limit under which they were
    found. It holds no bounds: those are computed when it is read.
    """

    folder: Path

    def get(self, surface: LabelledSurface, seconds: float, deadline: Deadline) -> Proof | None:
        """What the kept solutions prove, or None if the surface has to be proved again.

        The checker counts the upper end of the range. The lower end is the best bound whose
        certificate the checker verifies; a larger bound without one goes into ``kept_lower``.

        The surface has to be proved again if there is no file that can be read in time, if the
        checker rejects one of its solutions, if a verified bound exceeds the upper end, so that one
        of the two is wrong, or if the ends differ, and that proof had less time.

        Args:
            seconds: the time limit that a new proof would have.
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
            best: Solution | None = None
            for solution in found:
                report = check_solution(instance, solution, regions, deadline)
                if not report.valid:
                    return None
                claimed = max(claimed, solution.surface_lower_bound)
                proved = [one.bound for one in report.bounds if one.outcome == "verified"]
                verified = max(verified, greatest(proved, "surface"))
                if report.segments is not None and (best is None or report.segments < upper):
                    best, upper = solution, min(upper, report.segments)
        except (InputError, OutOfTime):
            return None
        if verified > upper or (max(verified, claimed) < upper and seconds > earlier):
            return None
        bounds = ProvenRange(verified, upper)
        kept_lower = min(claimed, upper) if claimed > verified else None
        return Proof(bounds, decomposition, best, tuple(found), kept_lower)

    def put(self, surface: LabelledSurface, seconds: float, proof: Proof) -> None:
        """Write what was found within a time limit; creates the folder.

        Raises:
            InputError: the folder cannot be written to, or something else has the file's name.
        """
        if not proof.found:
            return
        kept = {
            # JSON has no infinity; 1e300 is longer than any time limit.
            "seconds": min(float(seconds), 1e300),
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
