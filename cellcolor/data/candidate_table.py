"""The result for every candidate of a surface, and the side file that contains it.

A candidate is a vertex and a branch of the arm's inverse kinematics. The side file lies beside a
surface that was built from a scene; its writer and its readers share this class.
"""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.value import WithArrays
from cellcolor.errors import InputError, naming
from cellcolor.files.writing import SIDE_MARKER

VALID = 0
"""The code of candidates that passed all tests, in every table."""


@dataclass(frozen=True, eq=False)
class CandidateTable(WithArrays):
    """The result for every candidate; ``n`` is the surface's number of vertices.

    Attributes:
        branches: names of the inverse-kinematic branches.
        reason_names: what each code means, in the order of the codes: the code 0 is valid, 1 has no
            solution, and the others are the tests in the order in which they were made. Codes
            differ from file to file, as tests come and go; names stay.
        reasons: (n, branches) uint8 codes, the first test that a candidate failed.
        configurations: (n, branches, joints) in rad, NaN where a branch has no solution.
        node_color: (n, branches) the color of the surface that each candidate has, -1 for none.
        surface_sha256: the fingerprint of the surface that the table belongs to; None in files
            older than fingerprints.
    """

    branches: tuple[str, ...]
    reason_names: tuple[str, ...]
    reasons: NDArray[np.uint8]
    configurations: Array
    node_color: NDArray[np.int64]
    surface_sha256: str | None

    def to_bytes(self) -> bytes:
        """The side file, an ``.npz`` archive with a member for each attribute.

        The same table gives the same bytes.
        """
        stream = io.BytesIO()
        np.savez_compressed(
            stream,
            branches=np.array(self.branches),
            reason_names=np.array(self.reason_names),
            reasons=self.reasons,
            configurations=self.configurations,
            node_color=self.node_color.astype(np.int32),
            surface_sha256=np.array(self.surface_sha256),
        )
        with zipfile.ZipFile(stream, "a") as archive:
            archive.comment = SIDE_MARKER
        return stream.getvalue()

    @classmethod
    def read(cls, side: Path) -> CandidateTable:
        """A side file.

        Raises:
            InputError: it cannot be read, or is none; names the file.
        """
        try:
            with np.load(side, allow_pickle=False) as archive:
                return cls(
                    tuple(map(str, archive["branches"])),
                    tuple(map(str, archive["reason_names"])),
                    archive["reasons"],
                    archive["configurations"],
                    archive["node_color"].astype(np.int64),
                    str(archive["surface_sha256"]) if "surface_sha256" in archive else None,
                )
        except OSError as error:
            reason = error.strerror or "cannot be read"
            message = f"{reason}; build the scene again or give it"
            raise InputError(side, None, message) from error
        except (KeyError, ValueError, EOFError, AttributeError, zipfile.BadZipFile) as error:
            raise InputError(side, None, f"is not a side file: {error}") from error

    @classmethod
    def beside(cls, surface: LabelledSurface, path: Path) -> CandidateTable:
        """The table in the side file that ``build`` writes beside a scene's surface.

        Args:
            path: its file, which the side file's name is relative to.

        Raises:
            InputError: the surface names no side file, or that cannot be used.
        """
        name = surface.meta.get("side_file")
        if not isinstance(name, str):
            message = "is missing; give the scene (.toml) instead"
            raise InputError(path, "meta.side_file", message)
        side = path.parent / name
        table = cls.read(side)
        with naming(side):
            table.check(surface)
        return table

    def check(self, surface: LabelledSurface) -> None:
        """Check that the table belongs to a surface.

        Raises:
            InputError: it is about another one, or has a code without a name.
        """
        if self.surface_sha256 is not None and self.surface_sha256 != surface.sha256:
            message = "belongs to another surface; build the scene again"
            raise InputError(None, "surface_sha256", message)
        shape = (len(surface.vertices), len(self.branches))
        if self.reasons.shape != shape or self.node_color.shape != shape:
            message = f"needs shape {shape}: it belongs to another surface"
            raise InputError(None, "reasons", message)
        if self.reasons.size and self.reasons.max() >= len(self.reason_names):
            raise InputError(None, "reasons", f"unknown code {self.reasons.max()}")
