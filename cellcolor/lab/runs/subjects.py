"""What solvers run on: instances of random families, or of files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import partial
from itertools import zip_longest

from cellcolor.data.instance import Instance
from cellcolor.decomposition import decompose
from cellcolor.lab.families.registry import GROWING, LARGE, MEDIUM, SMALL, Family

SETS: Mapping[str, Mapping[str, Family]] = {
    "small": SMALL,
    "medium": MEDIUM,
    "large": LARGE,
    "growing": GROWING,
}
"""The families, by the name of their set and their own."""


@dataclass(frozen=True, slots=True)
class Specimen:
    """An instance that is made when its turn comes.

    Attributes:
        family: what it is from.
        seed: within the family, None for a file.
        name: for messages.
        make: makes it, and may raise a :class:`~cellcolor.errors.CellcolorError`.
    """

    family: str
    seed: int | None
    name: str
    make: Callable[[], Instance]


def family_names() -> list[str]:
    """All families, as ``set/family``."""
    return [f"{group}/{name}" for group, families in SETS.items() for name in families]


def families_like(pattern: str) -> list[str]:
    """The families meant by the name of a set, or by ``set/family`` with ``*`` and ``?`` in it."""
    wanted = f"{pattern}/*" if pattern in SETS else pattern
    return [name for name in family_names() if fnmatchcase(name, wanted)]


def of_family(name: str, seeds: Iterable[int]) -> list[Specimen]:
    """Instances of a family, such as ``medium/thin``."""
    group, _, family = name.partition("/")
    recipe = SETS[group][family]
    return [
        Specimen(name, seed, f"{name}, seed {seed}", partial(_made, recipe, seed)) for seed in seeds
    ]


def taking_turns(groups: Sequence[Sequence[Specimen]]) -> Iterator[Specimen]:
    """The first of each group, then the second of each, …: a part of the runs is of use as well."""
    for turn in zip_longest(*groups):
        yield from (subject for subject in turn if subject is not None)


def _made(family: Family, seed: int) -> Instance:
    made = family(seed)
    return made if isinstance(made, Instance) else decompose(made)
