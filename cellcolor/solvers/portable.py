"""The problem written for solvers from outside, by the name of the format."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.files.writing import FileKind
from cellcolor.solvers.clingo import asp_facts
from cellcolor.solvers.linear.coloring import Coloring
from cellcolor.solvers.linear.model import Model, mps, opb, wcnf
from cellcolor.solvers.minizinc import minizinc_data
from cellcolor.solvers.seamed import Seamed


@dataclass(frozen=True, slots=True)
class Portable:
    """A format in which a solver from outside can be given an instance.

    Attributes:
        about: what reads it.
        kind: how such a file is distinguished from other files, which are not overwritten.
        write: makes its lines; raises InputError and TooLarge for what the model cannot have.
    """

    about: str
    kind: FileKind
    write: Callable[[Instance], Iterator[str]]


def _title(instance: Instance) -> str:
    name = re.sub(r"[^\x20-\x7e]", "?", instance.name)
    return f"fewest segments of {name}, fingerprint {instance.sha256}"


def _linear(lines: Callable[[Model, str], Iterator[str]]) -> Callable[[Instance], Iterator[str]]:
    def write(instance: Instance) -> Iterator[str]:
        return lines(Coloring(Seamed(instance).instance).model, _title(instance))

    return write


def _text(mark: str, text: Callable[[Instance], str]) -> Callable[[Instance], Iterator[str]]:
    def write(instance: Instance) -> Iterator[str]:
        body = text(Seamed(instance).instance)
        return iter([f"{mark} cellcolor: {_title(instance)}", *body.splitlines()])

    return write


def _portable(about: str, begin: bytes, write: Callable[[Instance], Iterator[str]]) -> Portable:
    kind = FileKind(f"a file for {about} written by cellcolor", re.compile(begin))
    return Portable(about, kind, write)


PORTABLE = {
    "opb": _portable(
        "pseudo-Boolean solvers", rb"\* #variable=[^\n]*\n\* cellcolor: ", _linear(opb)
    ),
    "wcnf": _portable("MaxSAT solvers", b"c cellcolor: ", _linear(wcnf)),
    "mps": _portable("solvers of mixed-integer programs", rb"\* cellcolor: ", _linear(mps)),
    "dzn": _portable(
        "the MiniZinc model (models/constraints/coloring.mzn)",
        b"% cellcolor: ",
        _text("%", minizinc_data),
    ),
    "lp": _portable(
        "the answer set program (models/constraints/coloring.lp)",
        b"% cellcolor: ",
        _text("%", asp_facts),
    ),
}
"""Each is the ending of its files as well."""
