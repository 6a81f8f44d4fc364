"""A surface by the reason why points are out of reach."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellcolor.data.shares import GIVEN_UP
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.pictures.by_cell_and_color import shares
from cellcolor.pictures.interface import Given, Source
from cellcolor.pictures.mesh_picture import SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import FAINT, REASONS
from cellcolor.pictures.picture import Picture3D

__all__ = ["CandidateReasons", "ReasonPicture", "by_reason", "read_candidate_reasons"]

_VALID = 0


class ReasonPicture:
    """Why vertices are out of reach."""

    needs: tuple[Source, ...] = ("surface", "reasons")
    takes: tuple[Source, ...] = ("branch",)

    def draw(self, given: Given) -> Picture3D:
        """At best, or in the branch that is given."""
        branch = given.branch if "branch" in given else None
        return draw_surface(given.surface, by_reason(given.surface, given.reasons, branch))


@dataclass(frozen=True)
class CandidateReasons:
    """What became of every candidate.

    Attributes:
        branches: names of the inverse-kinematic branches.
        reason_names: what the codes mean; 0 is valid, higher ones came farther through the tests.
        reasons: (n, branches) codes.
        node_color: (n, branches) the color of each candidate, -1 for none.
    """

    branches: tuple[str, ...]
    reason_names: tuple[str, ...]
    reasons: NDArray[np.uint8]
    node_color: NDArray[np.int64]


def read_candidate_reasons(surface: LabelledSurface, path: Path) -> CandidateReasons:
    """The candidates' reasons in the side file that ``build`` writes beside a scene's surface.

    Args:
        surface: the labelled surface.
        path: its file, which the side file's name is relative to.

    Raises:
        InputError: the surface names no side file, or that cannot be used.
    """
    name = surface.meta.get("side_file")
    if not isinstance(name, str):
        raise InputError(str(path), "meta.side_file", "is missing; give the scene (.toml) instead")
    side = path.parent / name
    try:
        with np.load(side, allow_pickle=False) as archive:
            reasons_of = CandidateReasons(
                tuple(map(str, archive["branches"])),
                tuple(map(str, archive["reason_names"])),
                archive["reasons"],
                archive["node_color"].astype(np.int64),
            )
            about = str(archive["surface_sha256"]) if "surface_sha256" in archive else None
    except OSError as error:
        reason = error.strerror or "cannot be read"
        raise InputError(str(side), None, f"{reason}; build the scene again or give it") from error
    except (KeyError, ValueError, EOFError, AttributeError, zipfile.BadZipFile) as error:
        raise InputError(str(side), None, f"is no side file: {error}") from error
    if about is not None and about != surface.sha256:
        message = "is of another surface; build the scene again"
        raise InputError(str(side), "surface_sha256", message)
    shape = (len(surface.vertices), len(reasons_of.branches))
    if reasons_of.reasons.shape != shape or reasons_of.node_color.shape != shape:
        raise InputError(str(side), "reasons", f"needs shape {shape}: it is of another surface")
    if reasons_of.reasons.size and reasons_of.reasons.max() >= len(reasons_of.reason_names):
        raise InputError(str(side), "reasons", f"unknown code {reasons_of.reasons.max()}")
    return reasons_of


def by_reason(
    surface: LabelledSurface, reasons_of: CandidateReasons, branch: int | None = None
) -> SurfaceView:
    """Why vertices are not reachable.

    Args:
        surface: the labelled surface.
        reasons_of: what became of its candidates.
        branch: look at this branch alone. None: at the branch that came farthest through the
            tests; a vertex is reachable if it has any color.
    """
    rows = slice(None) if branch is None else slice(branch, branch + 1)
    codes, colors = reasons_of.reasons[:, rows], reasons_of.node_color[:, rows]
    valid = (codes == _VALID).any(axis=1)
    given_up = len(reasons_of.reason_names)
    # Numbered in the order of the tests; a blocked tip is so for all branches that reach there.
    labels = np.where(valid, _VALID, codes.max(axis=1)).astype(np.int64)
    # A sliver policy takes colors away from what is valid.
    labels[valid & (colors < 0).all(axis=1)] = given_up
    share = shares(surface, labels, given_up + 1)
    counts = np.bincount(labels, minlength=given_up + 1)
    names = [*reasons_of.reason_names, GIVEN_UP]
    names[_VALID] = "reachable" if branch is None else "valid"
    fills = [REASONS[(code - 1) % len(REASONS)] for code in range(given_up + 1)]
    fills[_VALID] = FAINT
    classes = [
        VertexClass(f"{names[code]}  {share[code]}, {counts[code]} vertices", fills[code])
        for code in range(given_up + 1)
    ]
    who = "any branch" if branch is None else reasons_of.branches[branch]
    notes = ["Shares of the surface."]
    if branch is None:
        notes.insert(0, "Reason of the branch that came farthest through the tests.")
    title = f"{surface.name}: reach of {who}"
    return SurfaceView(title, labels, classes, notes=tuple(notes))
