"""The result of ``cellcolor.solve``: the answer, its subject, and ways to look at both."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.value import Drawn
from cellcolor.door.subject import Subject
from cellcolor.files.paths import path_of
from cellcolor.files.writing import Output, write


@dataclass(frozen=True, repr=False)
class Result(Drawn):
    """The fewest segments that were found, and what is proved about them.

    Attributes:
        solution: the solver's answer, which the checker has passed.
        subject: what was solved, opened.
        covered_share: what was solved, as a share of the area that can be covered and is not left
            alone, 0 to 1.
    """

    solution: Solution
    subject: Subject = field(hash=False)
    covered_share: float = 1.0

    @property
    def instance(self) -> Instance:
        """The topological graph that was solved."""
        return self.subject.graph()

    @property
    def surface(self) -> LabelledSurface | None:
        """The labelled surface; None for an instance without one.

        Raises:
            InputError: the file that the instance names cannot be read, or is another surface.
        """
        return self.subject.surface if self.subject.names_surface else None

    @property
    def segments(self) -> int | None:
        """How many there are; None when no division was found."""
        return self.solution.segments

    @property
    def lift_offs(self) -> int | None:
        """``max(0, segments - 1)``; None when no division was found."""
        return self.solution.lift_offs

    @property
    def optimal(self) -> bool:
        """Proved to be the fewest in the search space."""
        return self.solution.status == "optimal"

    def save(self, path: str | PathLike[str]) -> None:
        """Write the solution to a file; only an older solution is overwritten.

        Raises:
            InputError: there is something else, or it cannot be written.
        """
        write([Output.of(path_of(path), self.solution)])

    def __str__(self) -> str:
        return self.solution.in_words(self.instance)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.instance.name!r}: {self}>"
