"""The model in hand: ``cellcolor.formulation``."""

from __future__ import annotations

from collections.abc import Collection

from cellcolor.data.solution import Solution
from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.subject import Solvable, open_subject
from cellcolor.errors import InputError
from cellcolor.solvers import checked
from cellcolor.solvers.cpsat import CompleteModel, CpSolver
from cellcolor.solvers.interface import Answer, Options


class Formulation(CompleteModel):
    """The complete CP-SAT model of an instance, to be extended and solved (docs/formulation.md).

    Constraints of your own go to ``model`` and refer to ``variables``; ``model`` minimizes
    ``segments``. The redundant groups ``undivided``, ``connections`` and ``zeros`` hold for some
    division with the fewest segments, not for all. Leave out those that your constraints may
    contradict.
    """

    def division(self, solver: CpSolver) -> Solution:
        """The division that a solver has found, after the checker has seen it.

        It claims no bound, because constraints of your own may exclude better divisions.

        Raises:
            InputError: the solver has found none.
            RefusedResult: the checker refuses it.
        """
        if not solver.response_proto.solution:
            raise InputError(None, "solver", "has found no solution")
        division, seams = self.read(solver)
        space = Options("paper" if self.strands == 1 else "surface", self.strands)
        answer = Answer(division, seams, (), model=self.size)
        seconds = solver.wall_time
        return checked.checked_solution(self.instance, space, "cp-sat-model", answer, seconds)


def formulation(
    source: Solvable,
    *,
    strands: int = 1,
    groups: Collection[str] | None = None,
    time_limit: TimeLimit = None,
) -> Formulation:
    """The complete CP-SAT model of a scene, a labelled surface or an instance.

    Args:
        source: its file, its shipped name, or the value.
        strands: corridors of a color that may cross an edge; 1 is the paper's search space.
        groups: the redundant groups of constraints that the model is to have, by name; None for
            all of them (``cellcolor.solvers.cpsat.formulation.REDUNDANT``).
        time_limit: seconds for building it, None for no limit.

    Raises:
        InputError: the source cannot be used, or there is no such group.
        TooLarge: the model would have too many variables.
        OutOfTime: the time limit came first.
    """
    deadline = Deadline.of(time_limit)
    graph = open_subject(source, deadline).graph(deadline)
    return Formulation(graph, strands, groups, deadline)
