"""An instance as data for the MiniZinc model ``models/constraints/coloring.mzn``."""

from __future__ import annotations

from collections.abc import Iterable

from cellcolor.data.instance import Instance
from cellcolor.errors import InputError, TooLarge

_MOST_PAIRS = 30_000
"""The most pairs of darts of one cell: the model has a constraint for each, and MiniZinc takes a
second and 10 MB to write down some thousand of them."""


def minizinc_data(instance: Instance) -> str:
    """The parameters of the model, which says what each of them is; one a line.

    Cells, darts and colors are counted from 1.

    Raises:
        InputError: a cell has several loops with live darts, which the model cannot divide.
        TooLarge: the cells have so many live darts that MiniZinc would not be done with it in time.
    """
    loops = [_only_loop(instance, cell.id) for cell in instance.cells]
    pairs = sum(len(loop) * (len(loop) - 1) // 2 for loop in loops)
    if pairs > _MOST_PAIRS:
        raise TooLarge(f"{pairs} pairs of darts are too many for the MiniZinc model")
    darts = [dart for loop in loops for dart in loop]
    number = {dart: place for place, dart in enumerate(darts, start=1)}
    region = _regions(instance, loops)
    colors = len(instance.colors)
    cell_of = {dart: cell for cell, loop in enumerate(loops) for dart in loop}
    first = [1 + sum(map(len, loops[:cell])) for cell in range(len(loops))]
    region_of = [
        region[cell_of[dart], color] if color in instance.joinable(dart) else 0
        for dart in darts
        for color in range(colors)
    ]
    of_cell = [
        {region[cell.id, color] for color in cell.colors if (cell.id, color) in region}
        for cell in instance.cells
    ]
    return "".join(
        f"{name} = {value};\n"
        for name, value in (
            ("cells", len(loops)),
            ("colors", colors),
            ("darts", len(darts)),
            ("first", _array(first)),
            ("last", _array(at + len(loop) - 1 for at, loop in zip(first, loops, strict=True))),
            ("twin", _array(number[-dart] for dart in darts)),
            ("joinable", _array(_set(c + 1 for c in instance.joinable(dart)) for dart in darts)),
            ("id", _array(darts)),
            ("regions", len(set(region.values()))),
            ("region", f"array2d(1..{len(darts)}, 1..{colors}, {_array(region_of)})"),
            ("regions_of", _array(map(_set, of_cell))),
        )
    )


def _only_loop(instance: Instance, cell: int) -> tuple[int, ...]:
    live = instance.live_loops[cell]
    if len(live) > 1:
        message = f"the model knows one live loop, here are {len(live)}"
        raise InputError(None, f"cells[{cell}].loops", message)
    return live[0] if live else ()


def _regions(instance: Instance, loops: list[tuple[int, ...]]) -> dict[tuple[int, int], int]:
    """Color regions by cell and color, numbered from 1; those of a single cell are left out."""
    number: dict[tuple[int, int], int] = {}
    for cell in instance.cells:
        for color in cell.colors:
            begin = (cell.id, color)
            if begin in number or not any(color in instance.joinable(d) for d in loops[cell.id]):
                continue
            name = len(set(number.values())) + 1
            number[begin] = name
            waiting = [cell.id]
            while waiting:
                for dart in loops[waiting.pop()]:
                    other = instance.across(dart), color
                    if color in instance.joinable(dart) and other not in number:
                        number[other] = name
                        waiting.append(other[0])
    return number


def _array(values: Iterable[object]) -> str:
    return f"[{', '.join(map(str, values))}]"


def _set(values: Iterable[int]) -> str:
    return f"{{{', '.join(map(str, sorted(values)))}}}"
