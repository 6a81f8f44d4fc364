"""An oracle for the test suites of other coverage planners.

A planner that paints every vertex of a labelled surface in one of its colors cannot have fewer
segments than the surface allows. :func:`~cellcolor.oracle.ranges.prove` says how few that is. The
front door has an object that compares plans with it
(:class:`cellcolor.Oracle <cellcolor.door.oracle.Oracle>`), and functions::

    import cellcolor

    surface = cellcolor.read("part.surface.json")
    verdict = cellcolor.judge(surface, my_planner(surface))
    assert verdict.valid, verdict.problems
    assert verdict.beatable_by == 0  # proved: no division of the surface has fewer segments

Where a test cannot wait for a proof, ``assert not verdict.beatable_by`` is enough to catch plans
that are proved to have too many; it passes as well if nothing is known.
"""

from cellcolor.data.verdicts import ProvenRange
from cellcolor.oracle.improvement import BetterPainting, Improvement
from cellcolor.oracle.ranges import Proof, prove
from cellcolor.oracle.verdict import JointViolation, PathVerdict, Verdict

__all__ = [
    "BetterPainting",
    "Improvement",
    "JointViolation",
    "PathVerdict",
    "Proof",
    "ProvenRange",
    "Verdict",
    "prove",
]
