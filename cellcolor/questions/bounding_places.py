"""What a placement covers at most, and how many segments it needs at least, without a whole build.

A whole build tests the arm between the vertices, which takes a hundred times as long as at them.
Each test only ever takes candidates and links away. So the area where a candidate is valid at the
vertices is the most that can be covered. A segment is painted in one branch, on vertices that are
joined by links without a jump: as many of these regions as cover enough are needed at least.
"""

from __future__ import annotations

from math import ceil

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_array, hstack, identity

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.build import StageClock, judged_at_vertices
from cellcolor.frontend.links import continuous_along
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.continuity import regions
from cellcolor.questions.placements import SAME_SHARE

_SLACK = 1e-6  # of a bound in floating point
_LONGEST = 10.0  # s for one bound; the best one known by then is a bound as well


def bounds_of(prepared: PreparedScene, cover: float, deadline: Deadline) -> tuple[float, int]:
    """The share that is covered at most, and the segments that are needed at least to cover enough.

    Args:
        cover: the share of the surface that is enough. Where less can be covered, no links are
            computed, and the second number is 1.

    Raises:
        OutOfTime: the deadline came first.
    """
    verdicts = judged_at_vertices(prepared, StageClock(deadline, None))
    areas = prepared.surface.vertex_areas()
    valid, edges = verdicts.valid, prepared.surface.edges()
    # Added up as a whole build adds: what is the same must not differ by rounding.
    most = float(areas[valid.any(axis=1)].sum() / areas.sum())
    if most < cover - SAME_SHARE or not most:
        return most, 1
    region = regions(valid, edges, continuous_along(prepared, edges, verdicts, deadline))
    # Slivers are given up, and what a tolerance refuses is not covered either: nobody knows yet
    # which. Without both all that is valid has to be covered.
    whole = prepared.setup.slivers is None and prepared.scene.tolerance is None
    return most, _fewest(region, valid, areas / areas.sum(), most if whole else cover, deadline)


def _fewest(region: Index, valid: Mask, weights: Array, cover: float, deadline: Deadline) -> int:
    """How many regions cover a share at least.

    Args:
        region: (n, branches) the number of each candidate's region.
        valid: (n, branches) the candidates that count.
        weights: (n,) of the vertices, of sum 1.
    """
    vertices, branches = np.nonzero(valid)
    names, column = np.unique(region[vertices, branches], return_inverse=True)
    member = np.zeros((len(weights), len(names)), dtype=bool)
    member[vertices, column] = True
    places, own = np.unique(member, axis=0, return_inverse=True)
    area = np.bincount(own.ravel(), weights)
    # A place counts as far as regions that have it are chosen.
    chosen = hstack([csr_array(places, dtype=float), -identity(len(places))])
    enough = np.concatenate([np.zeros(len(names)), area])
    price = np.concatenate([np.ones(len(names)), np.zeros(len(places))])
    found = milp(
        price,
        integrality=price,
        bounds=Bounds(0, 1),
        constraints=[
            LinearConstraint(chosen, 0, np.inf),
            LinearConstraint(enough, cover - SAME_SHARE, np.inf),
        ],
        options={"time_limit": min(deadline.left, _LONGEST)},
    )
    bound = found.mip_dual_bound
    return 1 if bound is None or not np.isfinite(bound) else max(1, ceil(bound - _SLACK))
