"""An oracle for the test suites of other coverage planners.

A planner that paints every vertex of a labelled surface in one of its colors cannot have fewer
segments than the surface allows. :func:`~cellcolor.oracle.ranges.prove` says how few that is.
:class:`cellcolor.Oracle <cellcolor.door.oracle.Oracle>` and ``cellcolor.judge`` compare plans with
it (docs/how-to/test-a-planner.md).
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
