"""A planner under test: is what it paints valid, and could it need fewer lift-offs?

Run it with ``pytest examples/test_my_planner.py``. The oracle proves the minimum once.
"""

import cellcolor

ORACLE = cellcolor.Oracle("half_pipe.surface.json", time_limit=60)


def careful(surface):
    """A planner that asks for the best painting; put yours here."""
    return cellcolor.Oracle(surface, time_limit=60).best.on_mesh


def hasty(surface):
    """A planner that takes the first color that each vertex has."""
    return [colors[0] if colors else None for colors in surface.vertex_colors]


def test_the_careful_one_needs_no_more_than_is_proved():
    verdict = ORACLE.judge(careful(ORACLE.surface))
    assert verdict.valid, verdict
    assert verdict.optimal, verdict


def test_the_hasty_one_can_be_beaten():
    verdict = ORACLE.judge(hasty(ORACLE.surface))
    assert verdict.valid, verdict
    assert verdict.beatable_by, verdict
    print(verdict)
