"""Three ways to write the whole problem for CP-SAT, a readable file each (docs/encodings.md).

``pointers`` hangs trees up by pointers, ``ranks`` by numbers, ``contour`` walks round them. Each
file has all that is its own, and shares with the others what is no formulation (``problem``): what
is given, the time limit, and how a division is read off. They search the space ``paper``, in cells
with one live loop.
"""

from cellcolor.solvers.encodings.contour import ContourSolver
from cellcolor.solvers.encodings.pointers import PointersSolver
from cellcolor.solvers.encodings.ranks import RanksSolver

__all__ = ["ContourSolver", "PointersSolver", "RanksSolver"]
