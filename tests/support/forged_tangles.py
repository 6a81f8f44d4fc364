"""True certificates forged in one place of a tangle; where there is none, one is made up first."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from forged_certificates import Original

Certificate = dict[str, Any]


def _tangle_of(chance: random.Random, original: Original, forged: Certificate) -> list[Any]:
    """The segments of a tangle of the certificate, or of one that is made up and put there."""
    part = chance.choice(forged["parts"])
    if not part.get("tangles") or chance.random() < 0.2:
        made = [_tangled_segment(chance, original) for _ in range(chance.randint(1, 3))]
        part.setdefault("tangles", []).append({"segments": made})
        part.pop("hubs", None)
        return made
    return chance.choice(part["tangles"])["segments"]


def _tangled_segment(chance: random.Random, original: Original) -> dict[str, Any]:
    """A segment of a made-up tangle, from two cells of a color or more, some of them avoided."""
    color = chance.randrange(len(original.instance.colors))
    own = [cell.id for cell in original.instance.cells if color in cell.colors] or [0]
    cells = chance.sample(own, min(len(own), chance.randint(2, 4)))
    return {"color": color, "groups": [[[c]] for c in cells[:2]], "avoided": cells[2:]}


def _wrong_color_in_tangle(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A segment of a tangle has another color."""
    segment = chance.choice(_tangle_of(chance, original, forged))
    segment["color"] = chance.randrange(-1, len(original.instance.colors) + 1)
    return 0


def _dropped_segment(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A segment of a tangle is missing."""
    segments = _tangle_of(chance, original, forged)
    segments.pop(chance.randrange(len(segments)))
    return 0


def _changed_group(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A segment of a tangle touches an area more, another one, a larger one, or a group less."""
    segment = chance.choice(_tangle_of(chance, original, forged))
    group = chance.choice(segment["groups"])
    own = [c.id for c in original.instance.cells if segment["color"] in c.colors] or [0]
    match chance.randrange(4):
        case 0:
            group.append([chance.choice(own)])
        case 1:
            group[chance.randrange(len(group))] = [chance.choice(own)]
        case 2:
            chance.choice(group).append(chance.choice(own))
        case _:
            segment["groups"].remove(group)
    return 0


def _changed_avoided(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A segment of a tangle avoids a cell less, or one more."""
    segments = _tangle_of(chance, original, forged)
    segment = chance.choice([own for own in segments if own["avoided"]] or segments)
    if segment["avoided"] and chance.random() < 0.7:
        segment["avoided"].pop(chance.randrange(len(segment["avoided"])))
    else:
        own = [c.id for c in original.instance.cells if segment["color"] in c.colors] or [0]
        segment["avoided"].append(chance.choice(own))
    return 0


def _another_region(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A tangle names a cell that does not lie in the segment's color region, or anywhere."""
    segment = chance.choice(_tangle_of(chance, original, forged))
    cells = chance.choice([*(a for group in segment["groups"] for a in group), segment["avoided"]])
    others = [c.id for c in original.instance.cells if segment["color"] not in c.colors]
    cells.append(chance.choice([*others, len(original.instance.cells)]))
    return 0


def _empty_tangle(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A tangle without segments, groups, areas or cells."""
    segments = _tangle_of(chance, original, forged)
    groups = chance.choice(segments)["groups"]
    chance.choice([segments, groups, chance.choice(groups), chance.choice(groups)[0]]).clear()
    return 0


def _no_tangle(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A tangle of made-up segments, beside the others."""
    made = [_tangled_segment(chance, original) for _ in range(chance.randint(1, 3))]
    part = chance.choice(forged["parts"])
    part.setdefault("tangles", []).append({"segments": made})
    part.pop("hubs", None)
    return 0


def _long_tangle(chance: random.Random, original: Original, forged: Certificate) -> int:
    """A tangle with thousands of segments, groups, areas or avoided cells."""
    segments = _tangle_of(chance, original, forged)
    segment = chance.choice(segments)
    listed = [segments, segment["groups"], segment["groups"][0], segment["avoided"]]
    longer = chance.choice(listed)
    longer.extend(copy.deepcopy(longer[:2]) * 2_000)
    chance.choice(forged["parts"])["value"] += 1
    return 1


FORGERIES_OF_TANGLES: dict[str, Callable[[random.Random, Original, Certificate], int]] = {
    "a wrong color in a tangle": _wrong_color_in_tangle,
    "a segment of a tangle dropped": _dropped_segment,
    "a changed group of a tangle": _changed_group,
    "a cell avoided less or more": _changed_avoided,
    "a tangle in another region": _another_region,
    "an empty tangle": _empty_tangle,
    "a tangle that is none": _no_tangle,
    "a long tangle": _long_tangle,
}
"""Each changes a certificate and says how many segments more the bound claims."""
