"""A surface by the reason why points are out of reach."""

from __future__ import annotations

import numpy as np

from cellcolor.data.candidate_table import VALID, CandidateTable
from cellcolor.data.shares import GIVEN_UP
from cellcolor.data.surface import LabelledSurface
from cellcolor.pictures.by_cell_and_color import shares
from cellcolor.pictures.interface import Given, Source
from cellcolor.pictures.mesh_picture import SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import FAINT, REASONS
from cellcolor.pictures.picture import Picture3D


class ReasonPicture:
    """Why vertices are out of reach."""

    needs: tuple[Source, ...] = ("surface", "reasons")
    takes: tuple[Source, ...] = ("branch",)

    def draw(self, given: Given) -> Picture3D:
        """At best, or in the branch that is given."""
        branch = given.branch if "branch" in given else None
        return draw_surface(given.surface, by_reason(given.surface, given.reasons, branch))


def by_reason(
    surface: LabelledSurface, reasons_of: CandidateTable, branch: int | None = None
) -> SurfaceView:
    """Why vertices are not reachable.

    Args:
        surface: the labelled surface.
        reasons_of: what became of its candidates.
        branch: look at this branch alone. None: at the branch that passed the most
            tests; a vertex is reachable if it has any color.
    """
    rows = slice(None) if branch is None else slice(branch, branch + 1)
    codes, colors = reasons_of.reasons[:, rows], reasons_of.node_color[:, rows]
    valid = (codes == VALID).any(axis=1)
    given_up = len(reasons_of.reason_names)
    # Codes are in the order of the tests; in old files a blocked tip came last, which is the same
    # here, as it is blocked for all branches that reach there.
    labels = np.where(valid, VALID, codes.max(axis=1)).astype(np.int64)
    # A sliver policy takes colors away from what is valid.
    labels[valid & (colors < 0).all(axis=1)] = given_up
    share = shares(surface, labels, given_up + 1)
    counts = np.bincount(labels, minlength=given_up + 1)
    names = [*reasons_of.reason_names, GIVEN_UP]
    names[VALID] = "reachable" if branch is None else "valid"
    fills = [REASONS[(code - 1) % len(REASONS)] for code in range(given_up + 1)]
    fills[VALID] = FAINT
    classes = [
        VertexClass(f"{names[code]}  {share[code]}, {counts[code]} vertices", fills[code])
        for code in range(given_up + 1)
    ]
    who = "any branch" if branch is None else reasons_of.branches[branch]
    notes = ["Shares of the surface."]
    if branch is None:
        notes.insert(0, "The reason of the branch that passed the most tests.")
    title = f"{surface.name}: reach of {who}"
    return SurfaceView(title, labels, classes, notes=tuple(notes))
