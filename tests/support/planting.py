"""What a planted fault in a plan is, and whether the oracle catches it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

import cellcolor
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError

Random = np.random.Generator


@dataclass(frozen=True)
class Case:
    """A surface that plans are broken on.

    Attributes:
        surface: it has a vertex with a color.
        other: another surface, whose plans are none of this one.
        folder: for files of plans.
    """

    surface: LabelledSurface
    other: LabelledSurface
    folder: Path

    @cached_property
    def oracle(self) -> cellcolor.Oracle:
        """Without a search: of plans that are not valid nothing has to be proved."""
        return cellcolor.Oracle(self.surface, workers=1, time_limit=20.0)

    @cached_property
    def solved(self) -> cellcolor.Result:
        """A valid solution, and the graph that it is of."""
        return cellcolor.solve(self.surface, workers=1, time_limit=20.0)

    @property
    def solution(self) -> Solution:
        """The solution alone."""
        return self.solved.solution

    @cached_property
    def other_solution(self) -> Solution:
        """A valid one of the other surface."""
        return cellcolor.solve(self.other, workers=1, time_limit=20.0).solution


@dataclass(frozen=True)
class Planted:
    """What is not valid, and how it has to be refused.

    Attributes:
        plan: in any of the forms that an oracle takes.
        said: each of these is one of the problems, or all that the error says.
        vertices: where the violations are, all of them.
    """

    plan: Any
    said: tuple[str, ...]
    vertices: tuple[int, ...] = ()


def caught(case: Case, planted: Planted) -> bool:
    """Whether the oracle refuses it with kind and place."""
    try:
        verdict = case.oracle.judge(planted.plan)
    except InputError as error:
        (said,) = planted.said
        return str(error).removeprefix(f"{planted.plan}: ") == said
    if (
        verdict.valid
        or verdict.segments is not None
        or not set(planted.said) <= {*verdict.problems}
    ):
        return False
    if verdict.violations and tuple(map(str, verdict.violations)) != verdict.problems:
        return False
    places = [tuple(case.surface.vertices[vertex].tolist()) for vertex in planted.vertices]
    return (
        tuple(violation.vertex for violation in verdict.violations) == planted.vertices
        and [violation.place for violation in verdict.violations] == places
    )


Planter = Callable[[Case, Random], Planted | None]
"""None where the surface has no place for such a fault."""
