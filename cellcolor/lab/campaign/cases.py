"""Which instance a campaign looks at next: a function of its seed and a number."""

from __future__ import annotations

import random
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families import SMALL

KINDS = tuple(SMALL)
"""What a campaign takes its instances from, in turn."""


@dataclass(frozen=True, slots=True)
class Case:
    """One instance of a campaign.

    Attributes:
        seed: of the campaign.
        number: within the campaign; with the seed it is all that this was made from.
        kind: one of ``KINDS``.
        instance: what to solve.
        surface: the mesh behind it, None for abstract graphs.
    """

    seed: int
    number: int
    kind: str
    instance: Instance
    surface: LabelledSurface | None


def draw_case(seed: int, number: int) -> Case:
    """Instance ``number`` of the campaign with a seed, of a size that every solver can bear."""
    kind = KINDS[number % len(KINDS)]
    made = SMALL[kind](random.Random(f"campaign {seed} {number}").randrange(2**31))
    if isinstance(made, Instance):
        return Case(seed, number, kind, made, None)
    return Case(seed, number, kind, decompose(made), made)
