"""An oracle that keeps what it proves on disk: for test suites, and for ``cellcolor check``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from cellcolor.deadline import Deadline
from cellcolor.door.oracle import Oracle
from cellcolor.door.subject import Solvable
from cellcolor.oracle import Proof, ProvenRange
from cellcolor.oracle.proof_cache import ProofCache

__all__ = ["KeepingOracle"]


class KeepingOracle(Oracle):
    """An oracle that keeps what it proves on disk, and proves nothing that is kept there."""

    def __init__(self, source: Solvable, time_limit: float, folder: Path | None) -> None:
        """Open the surface; nothing is proved yet.

        Args:
            source: a labelled surface, a scene, or an instance that names its surface.
            time_limit: seconds for the proof, and for building a scene before.
            folder: where proofs are kept; None keeps none.

        Raises:
            InputError: the source cannot be used, or has no surface.
            OutOfTime: the time limit came before there was a surface.
        """
        super().__init__(source, time_limit=time_limit)
        self._seconds = time_limit
        self._cache = None if folder is None else ProofCache(folder)
        self._kept: Proof | None = None

    def prove(self, deadline: Deadline) -> Proof:
        """What is kept, or else what is proved now.

        Where a kept bound has no certificate the surface is proved anew. Without time for as much
        as was kept, ``kept_lower`` says what nothing has verified.

        Raises:
            InputError: a cell of the surface is not planar, or the folder cannot be written to.
        """
        if self._kept is not None:
            return self._kept
        kept = (
            None if self._cache is None else self._cache.get(self.surface, self._seconds, deadline)
        )
        if kept is None or kept.kept_lower is not None:
            proved = super().prove(deadline)
            if kept is None or proved.bounds.lower >= (kept.kept_lower or 0):
                kept = proved
                if self._cache is not None:
                    self._cache.put(self.surface, self._seconds, kept)
            elif proved.solution is not None and proved.bounds.upper <= kept.bounds.upper:
                lower = max(kept.bounds.lower, proved.bounds.lower)
                bounds = ProvenRange(lower, proved.bounds.upper)
                kept = replace(proved, bounds=bounds, kept_lower=kept.kept_lower)
        self._kept = kept
        return kept
