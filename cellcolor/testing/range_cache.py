"""Proven ranges kept on disk, by what they depend on."""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.files.fingerprint import sha256_of
from cellcolor.oracle import ProvenRange
from cellcolor.solvers.interface import STRANDS
from cellcolor.version import __version__

__all__ = ["RangeCache"]


@dataclass(frozen=True)
class RangeCache:
    """A folder with a small file for each surface, named by a fingerprint.

    The fingerprint is that of the surface's content, the version of cellcolor and the search space,
    so whatever changes one of them is proved anew.

    Attributes:
        folder: where the files are.
    """

    folder: Path

    def get(self, surface: LabelledSurface, seconds: float) -> ProvenRange | None:
        """The range that is kept, if there is any reason to be content with it.

        One that is not exact was ended by a time limit: with more time than it had it is proved
        anew. What cannot be read is proved anew as well.

        Args:
            surface: the labelled surface.
            seconds: the time limit of now.
        """
        try:
            kept = json.loads(self._file(surface).read_text(encoding="utf-8"))
            found = ProvenRange(kept["lower"], kept["upper"])
            return found if found.exact or seconds <= kept["seconds"] else None
        except (OSError, ValueError, KeyError, TypeError, InputError):
            return None

    def put(self, surface: LabelledSurface, seconds: float, bounds: ProvenRange) -> None:
        """Keep a range that was proved within a time limit."""
        kept = {"lower": bounds.lower, "upper": bounds.upper, "seconds": seconds}
        # Several test processes may write at once: each file is whole whoever is last.
        handle, name = tempfile.mkstemp(dir=self.folder)
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            json.dump(kept, file)
        Path(name).replace(self._file(surface))

    def _file(self, surface: LabelledSurface) -> Path:
        depends_on = {
            "surface": surface.sha256,
            "version": __version__,
            "search_space": "surface",
            "strands": STRANDS["surface"],
        }
        return self.folder / f"{sha256_of(depends_on)}.json"
