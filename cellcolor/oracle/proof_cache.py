"""Proofs kept on disk, by what they depend on."""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

from cellcolor.checker.division import check_solution
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.files.fingerprint import sha256_of
from cellcolor.oracle.ranges import Proof, ProvenRange
from cellcolor.solvers.interface import STRANDS
from cellcolor.version import __version__

__all__ = ["ProofCache"]


@dataclass(frozen=True)
class ProofCache:
    """A folder with a file for each surface, named by a fingerprint.

    The fingerprint is that of the surface's content, the version of cellcolor and the search space,
    so whatever changes one of them is proved anew.

    Attributes:
        folder: where the files are.
    """

    folder: Path

    def get(self, surface: LabelledSurface, seconds: float) -> Proof | None:
        """The proof that is kept, if there is any reason to be content with it.

        One whose range is not exact was ended by a time limit: with more time than it had the
        surface is proved anew. So it is where the file cannot be read, or the checker refuses the
        solution in it.

        Args:
            surface: the labelled surface.
            seconds: the time limit of now.
        """
        try:
            kept = json.loads(self._file(surface).read_text(encoding="utf-8"))
            bounds = ProvenRange(kept["lower"], kept["upper"])
            if not bounds.exact and seconds > kept["seconds"]:
                return None
            if kept["solution"] is None:
                return Proof(bounds)
            solution = Solution.from_document(kept["solution"])
        except (OSError, ValueError, KeyError, TypeError, InputError):
            return None
        decomposition = decomposition_of(surface)
        if not check_solution(decomposition.instance, solution).valid:
            return None
        return Proof(bounds, decomposition, solution)

    def put(self, surface: LabelledSurface, seconds: float, proof: Proof) -> None:
        """Keep what was proved within a time limit; the folder is made if there is none.

        Raises:
            InputError: the folder cannot be written to.
        """
        solution = None if proof.solution is None else proof.solution.to_document()
        bounds = {"lower": proof.bounds.lower, "upper": proof.bounds.upper}
        kept = bounds | {"seconds": seconds, "solution": solution}
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            # Several processes may write at once: each file is whole whoever is last.
            handle, name = tempfile.mkstemp(dir=self.folder)
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                json.dump(kept, file)
            Path(name).replace(self._file(surface))
        except OSError as error:
            reason = error.strerror or "cannot be written"
            raise InputError(str(self.folder), None, reason) from error

    def _file(self, surface: LabelledSurface) -> Path:
        depends_on = {
            "surface": surface.sha256,
            "version": __version__,
            "search_space": "surface",
            "strands": STRANDS["surface"],
        }
        return self.folder / f"{sha256_of(depends_on)}.json"
