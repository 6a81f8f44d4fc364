"""Plans, one color a vertex, on the mesh alone."""

from __future__ import annotations

from dataclasses import replace

from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import Crack, LabelledSurface


def surface() -> LabelledSurface:
    """A strip of four vertices a side; red everywhere, blue on the right half."""
    return LabelledSurface.from_document(
        {
            "format": "cellcolor/labelled-surface",
            "version": 1,
            "name": "strip",
            "colors": ["red", "blue"],
            "vertices": [[x, y, 0] for x in range(4) for y in range(2)],
            "faces": [
                f
                for x in range(3)
                for f in ([2 * x, 2 * x + 2, 2 * x + 3], [2 * x, 2 * x + 3, 2 * x + 1])
            ],
            "vertex_colors": [[0], [0], [0], [0], [0, 1], [0, 1], [0, 1], []],
        }
    )


def test_segments_of_a_plan_are_counted_on_the_mesh() -> None:
    assert check_plan(surface(), Plan((0, 0, 0, 0, 0, 0, 0, None))).segments == 1
    assert check_plan(surface(), Plan((0, 0, 0, 0, 1, 1, 1, None))).segments == 2
    # Vertices 4 and 5 are neighbours, 4 and 6 too; painting 4 red leaves 6 and 5 apart.
    assert check_plan(surface(), Plan((0, 0, 0, 0, 0, 1, 1, None))).segments == 3


def test_cracks_separate_segments_of_a_plan() -> None:
    cracks = (Crack(2, 4, (0,)), Crack(2, 5, (0,)), Crack(3, 5, (0,)))
    plan = Plan((0, 0, 0, 0, 0, 0, 0, None))
    assert check_plan(replace(surface(), cracks=cracks), plan).segments == 2
    assert check_plan(replace(surface(), cracks=cracks[:2]), plan).segments == 1
