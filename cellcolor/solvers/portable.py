"""Writes the problem for external solvers and reads their answers, by format."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from cellcolor.data.instance import Instance
from cellcolor.data.solution import count_segments
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.writing import FileKind
from cellcolor.solvers.clingo import asp_facts
from cellcolor.solvers.interface import Answer
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.linear.coloring import Coloring, joined_and_linked, require_solution
from cellcolor.solvers.linear.model import Model, mps, opb, wcnf
from cellcolor.solvers.minizinc import minizinc_data
from cellcolor.solvers.seamed import Seamed


@dataclass(frozen=True, slots=True)
class Portable:
    """A format in which an external solver can be given an instance.

    Attributes:
        about: what reads it.
        begin: a pattern that such a file begins with; other files are not overwritten.
        write: makes its content; raises InputError and TooLarge for what the model cannot have.
    """

    about: str
    begin: bytes
    write: Callable[[Instance], Iterator[bytes]]

    @property
    def kind(self) -> FileKind:
        """How such a file is distinguished from others."""
        return FileKind(f"a file for {self.about} written by cellcolor", re.compile(self.begin))


def _title(instance: Instance) -> str:
    name = re.sub(r"[^\x20-\x7e]", "?", instance.name)
    return f"fewest segments of {name}, fingerprint {instance.sha256}"


def _linear(lines: Callable[[Model, str], Iterator[str]], instance: Instance) -> Iterator[bytes]:
    written = lines(Coloring(Seamed(instance).instance).model, _title(instance))
    return (f"{line}\n".encode() for line in written)


def _text(mark: str, text: Callable[[Instance], str], instance: Instance) -> Iterator[bytes]:
    body = text(Seamed(instance).instance)
    lines = [f"{mark} cellcolor: {_title(instance)}", *body.splitlines()]
    return (f"{line}\n".encode() for line in lines)


def _cp_sat(ending: str, instance: Instance) -> Iterator[bytes]:
    """The complete model, as OR-Tools writes it."""
    from cellcolor.solvers.cpsat import CompleteModel

    model = CompleteModel(instance).model
    model.name = f"cellcolor: {_title(instance)}"
    with TemporaryDirectory() as folder:
        path = Path(folder, f"model.{ending}")
        if not model.export_to_file(str(path)):
            raise InputError(None, "format", "OR-Tools could not write the model")
        yield path.read_bytes()


PORTABLE = {
    "pbtxt": Portable("CP-SAT", b'name: "cellcolor: ', partial(_cp_sat, "pbtxt")),
    "pb": Portable("CP-SAT", rb"\n[\x00-\xff]{1,2}cellcolor: ", partial(_cp_sat, "pb")),
    "opb": Portable(
        "pseudo-Boolean solvers", rb"\* #variable=[^\n]*\n\* cellcolor: ", partial(_linear, opb)
    ),
    "wcnf": Portable("MaxSAT solvers", b"c cellcolor: ", partial(_linear, wcnf)),
    "mps": Portable("solvers of mixed-integer programs", rb"\* cellcolor: ", partial(_linear, mps)),
    "dzn": Portable(
        "the MiniZinc model (models/constraints/coloring.mzn)",
        b"% cellcolor: ",
        partial(_text, "%", minizinc_data),
    ),
    "lp": Portable(
        "the answer set program (models/constraints/coloring.lp)",
        b"% cellcolor: ",
        partial(_text, "%", asp_facts),
    ),
}
"""The formats by name; the name is also the ending of the files."""


@dataclass(frozen=True, slots=True)
class _Parsed:
    """What an answer says: also how many segments there are, None if it does not, and whether it
    says that there are no fewer."""

    color: dict[int, int]
    after: dict[int, int]
    segments: int | None
    claims_optimum: bool


def read_answer(instance: Instance, text: str, kind: str) -> Answer:
    """The best division in a text of a kind in ``ANSWERS``, about an instance that was exported.

    The checker has not seen it. What the text claims besides is not verified: it proves no bound.

    Raises:
        InputError: there is no solution in it, or it is not one of this instance's model, or has
            more segments than it says.
        TooLarge: the instance's model is too large to be compared with the answer.
    """
    seamed = Seamed(instance)
    parsed = ANSWERS[kind](seamed.instance, text)
    _require_chains(seamed.instance, parsed)
    division = division_of_chains(seamed.instance, parsed.color, parsed.after)
    if seamed.seams:
        division = seamed.division(division)
    segments = count_segments(division)
    if parsed.segments is not None and segments > parsed.segments:
        message = f"says {parsed.segments}, its division has {count(segments, 'segment')}"
        raise InputError(None, "objective", message)
    claim = "The external solver claims that no division has fewer segments; this is not a proof."
    return Answer(division, seamed.seams, (), (claim,) if parsed.claims_optimum else ())


def _opb(instance: Instance, text: str) -> _Parsed:
    """``v x1 -x2 …`` in one or several lines; ``s OPTIMUM FOUND`` claims the optimum."""
    words = [word for line in _value_lines(text) for word in line.split()]
    values = {}
    for word in words:
        found = re.fullmatch(r"(-?)x(\d+)", word)
        if not found:
            raise InputError(None, "v", f"{word!r} is not a literal such as x1 or -x1")
        values[int(found[2])] = not found[1]
    return _of_competition(instance, values, text)


def _wcnf(instance: Instance, text: str) -> _Parsed:
    """``v 0110…`` since 2022, ``v 1 -2 …`` before; ``s OPTIMUM FOUND`` claims the optimum."""
    words = [word for line in _value_lines(text) for word in line.split()]
    if len(words) == 1 and re.fullmatch("[01]+", words[0]):
        values = {at: bit == "1" for at, bit in enumerate(words[0], start=1)}
    else:
        if not all(re.fullmatch(r"-?\d+", word) for word in words):
            raise InputError(None, "v", "must be bits, or literals such as 1 and -1")
        values = {abs(int(word)): int(word) > 0 for word in words if int(word)}
    return _of_competition(instance, values, text)


def _sol(instance: Instance, text: str) -> _Parsed:
    """A name and a value a line, as HiGHS and SCIP write; what is not there is 0."""
    values = {}
    for name, number in re.findall(r"^x(\d+)[ \t]+(\S+)", text, re.MULTILINE):
        try:
            value = float(number)
        except ValueError as error:
            raise InputError(None, f"x{name}", f"{number!r} is not a number") from error
        if not min(abs(value), abs(value - 1)) < 1e-4:
            raise InputError(None, f"x{name}", f"{number} is neither 0 nor 1")
        values[int(name)] = value > 0.5
    if not values:
        raise InputError(None, None, "has no line with a variable, such as 'x1 1'")
    given = re.search(r"^(?:Objective|objective value:)\s+(\S+)", text, re.MULTILINE)
    try:
        segments = round(float(given[1])) if given else None
    except (ValueError, OverflowError) as error:
        raise InputError(None, "objective", "is not a number") from error
    said = re.search(r"^(?:Model status\s*:?\s*|solution status: )optimal\b", text, re.M | re.I)
    zeros = dict.fromkeys(range(1, Coloring(instance).model.variables + 1), False)
    return _of_values(instance, zeros | values, segments, bool(said))


def _dzn(_instance: Instance, text: str) -> _Parsed:
    """What ``coloring.mzn`` prints: the last solution; ``==========`` claims the optimum."""
    solutions = re.split(r"^-{10}$", text, flags=re.MULTILINE)[:-1]
    if not solutions:
        raise InputError(None, None, "has no solution that ends with a line of ten '-'")
    last = solutions[-1]
    color = {int(e): int(c) for e, c in re.findall(r"^joined (\d+) (\d+)$", last, re.MULTILINE)}
    after = {int(a): int(b) for a, b in re.findall(r"^link (-?\d+) (-?\d+)$", last, re.MULTILINE)}
    given = re.search(r"^segments (\d+)$", last, re.MULTILINE)
    done = re.search(r"^={10}$", text, re.MULTILINE)
    return _Parsed(color, after, int(given[1]) if given else None, bool(done))


def _lp(_instance: Instance, text: str) -> _Parsed:
    """What clingo prints: the last answer set; ``OPTIMUM FOUND`` claims the optimum."""
    sets = re.findall(r"^Answer:.*\n(.*)$", text, re.MULTILINE)
    if not sets:
        raise InputError(None, None, "has no line 'Answer: n' with an answer set after it")
    color = {int(e): int(c) for e, c in re.findall(r"\bjoined\((\d+),(\d+)\)", sets[-1])}
    after = {int(a): int(b) for a, b in re.findall(r"\blink\((-?\d+),(-?\d+)\)", sets[-1])}
    given = re.findall(r"^Optimization: (\d+)$", text, re.MULTILINE)
    done = re.search(r"^OPTIMUM FOUND", text, re.MULTILINE)
    return _Parsed(color, after, int(given[-1]) if given else None, bool(done))


ANSWERS: dict[str, Callable[[Instance, str], _Parsed]] = {
    "opb": _opb,
    "wcnf": _wcnf,
    "mps": _sol,
    "dzn": _dzn,
    "lp": _lp,
}
"""A reader for what comes back for each format of ``PORTABLE``."""


def _value_lines(text: str) -> list[str]:
    """The last run of successive ``v`` lines: solvers print better solutions later."""
    runs = re.findall(r"(?:^v\b.*(?:\n|\Z))+", text, re.MULTILINE)
    if not runs:
        raise InputError(None, "v", "has no line 'v …' with values")
    return [line[1:] for line in runs[-1].splitlines()]


def _of_competition(instance: Instance, values: dict[int, bool], text: str) -> _Parsed:
    """With the last line ``o N``."""
    given = re.findall(r"^o (\d+)\s*$", text, re.MULTILINE)
    done = re.search(r"^s OPTIMUM FOUND\s*$", text, re.MULTILINE)
    return _of_values(instance, values, int(given[-1]) if given else None, bool(done))


def _of_values(
    instance: Instance, values: dict[int, bool], segments: int | None, claims: bool
) -> _Parsed:
    coloring = Coloring(instance)
    missing = next((v for v in range(1, coloring.model.variables + 1) if v not in values), None)
    if missing is not None:
        raise InputError(None, f"x{missing}", "has no value: is this the answer to this instance?")
    true = frozenset(variable for variable, value in values.items() if value)
    require_solution(coloring, true)
    return _Parsed(*joined_and_linked(coloring, true), segments, claims)


def _require_chains(instance: Instance, parsed: _Parsed) -> None:
    """Refuse an answer that is no division: wrong colors of joins, or links of other darts."""
    for edge, color in parsed.color.items():
        if edge not in instance.live_edges or color not in instance.joinable(edge):
            raise InputError(None, f"joined {edge}", f"color {color} does not continue there")
    place = {
        dart: (cell, at)
        for cell, loops in enumerate(instance.live_loops)
        for loop in loops
        for at, dart in enumerate(loop)
    }
    if len(set(parsed.after.values())) < len(parsed.after):
        raise InputError(None, "link", "two darts are linked to one")
    for dart, other in parsed.after.items():
        where = f"link {dart} {other}"
        if dart not in place or other not in place:
            raise InputError(None, where, "is not between live darts of this instance")
        if place[dart][0] != place[other][0] or place[dart][1] >= place[other][1]:
            raise InputError(None, where, "is not from a dart to a later one of its cell")
        colors = parsed.color.get(abs(dart)), parsed.color.get(abs(other))
        if None in colors or colors[0] != colors[1]:
            raise InputError(None, where, "is not between darts that are joined in one color")
