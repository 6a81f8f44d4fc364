"""Cards for the further questions of a plan: area, what costs a lift-off, places, set-ups."""

from __future__ import annotations

from cellcolor.pictures.report_page.content import Answers, Card
from cellcolor.questions.explanation import Explanation
from cellcolor.questions.front import Front
from cellcolor.questions.placements import Placements

_UNFINISHED = "The time limit came before everything was tried."


def answer_card(answer: Answers) -> Card:
    """The card of an answer, which says the same as the command."""
    if isinstance(answer, Front):
        return _front_card(answer)
    title = (
        "What costs a lift-off"
        if isinstance(answer, Explanation)
        else "Where the part could stand"
        if isinstance(answer, Placements)
        else "Several set-ups"
    )
    return Card(title, tuple(str(answer).splitlines()))


def _front_card(front: Front) -> Card:
    """A row for each point of the front; a click on it shows on the part what it covers."""
    text = (
        "The most that each number of lift-offs can cover, of the area with a color. A click on a "
        "row shows it on the part."
    )
    rows = [("lift-offs", "covered", "proof")]
    rows += [
        (str(point.lift_offs), f"{100 * point.covered_share:.1f} %", point.proof) for point in front
    ]
    modes = tuple(point.in_short for point in front)
    texts = (
        (text,) if front.complete else (text, "The time limit came before everything was tried.")
    )
    return Card("Lift-offs against area", texts, tuple(rows), modes=modes)
