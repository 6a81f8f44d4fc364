"""The picture of a refinement."""

from __future__ import annotations

from cellcolor.door.drawing import Drawing
from cellcolor.door.result import Result
from cellcolor.errors import InputError


def draw_steps(result: Result) -> Drawing:
    """The meshes that a result's ``refinement`` went through, side by side.

    Raises:
        InputError: it was not refined.
    """
    from cellcolor.pictures.by_refinement import draw_refinement

    if result.refinement is None:
        raise InputError(None, "refinement", "the result has none: solve with refine_until_stable")
    return Drawing(draw_refinement(result.refinement))
