"""Cards for the further questions of a plan: area, what costs a lift-off, places, set-ups."""

from __future__ import annotations

from cellcolor.data.wording import count
from cellcolor.pictures.report_page.content import Answers, Card
from cellcolor.questions.explanation import Explanation
from cellcolor.questions.front import Front
from cellcolor.questions.placements import Placements, Pose, pose_in_words
from cellcolor.questions.set_ups import SetUpPlan

_MOST_PLACES = 5
_UNFINISHED = "The time limit came before everything was tried."


def answer_card(answer: Answers) -> Card:
    """The card of an answer."""
    if isinstance(answer, Front):
        return _front_card(answer)
    if isinstance(answer, Explanation):
        return _explanation_card(answer)
    if isinstance(answer, SetUpPlan):
        return _set_ups_card(answer)
    return _placements_card(answer)


def _front_card(front: Front) -> Card:
    """A row for each point of the front; a click on it shows on the part what it covers."""
    text = (
        "The most that each number of lift-offs can cover, of the area with a color. A click on a "
        "row or on a point shows it on the part."
    )
    rows = [("lift-offs", "covered", "proof")]
    rows += [
        (str(point.lift_offs), f"{100 * point.covered_share:.1f} %", point.proof) for point in front
    ]
    modes = tuple(point.in_short for point in front)
    curve = tuple((float(point.lift_offs), 100 * point.covered_share) for point in front)
    texts = (text,) if front.complete else (text, _UNFINISHED)
    return Card("Lift-offs against area", texts, tuple(rows), modes=modes, curve=curve)


def _explanation_card(found: Explanation) -> Card:
    """A row for each relaxation that changes the lift-offs or the area, the best first."""
    base = found.base
    rows = [("without, or with less asked for", "lift-offs", "area")]
    rows += [
        (
            " and ".join(row.relaxed) + (f" ({row.note})" if row.note else ""),
            f"{_number(base.lift_offs, True)} → {_number(row.lift_offs, row.proved_for_surface)}",
            f"{100 * base.surface_share:.1f} → {100 * row.surface_share:.1f} %",
        )
        for row in (*found.alone, *found.amounts, *found.sets)
        if not row.same_as(base)
    ]
    same = sum(row.same_as(base) for row in found.alone)
    texts = [
        "Each is relaxed alone unless two are named; shares are of the whole surface.",
        f"{count(same, 'other limit, test or body', 'other limits, tests and bodies')} "
        f"{'was' if same == 1 else 'were'} tried and "
        f"{'changes' if same == 1 else 'change'} nothing.",
    ]
    texts += [] if found.complete else [_UNFINISHED]
    return Card("What costs a lift-off", tuple(texts), tuple(rows) if len(rows) > 1 else ())


def _placements_card(found: Placements) -> Card:
    """Where the part stands, and better places."""
    rows = [("the part at", "lift-offs", "area")]
    rows += [
        (
            _place(row.pose) + (", as it stands" if row is found.here else ""),
            _number(row.lift_offs, row.proved_for_surface),
            f"{100 * row.covered_share:.1f} %",
        )
        for row in (found.here, *found.best[:_MOST_PLACES])
    ]
    texts = [
        f"{count(len(found.tried), 'placement')} tried; shares are of the whole surface, and "
        f"{100 * found.cover:.1f} % had to be covered."
    ]
    texts += [] if found.complete else [_UNFINISHED]
    return Card("Where the part could stand", tuple(texts), tuple(rows))


def _set_ups_card(found: SetUpPlan) -> Card:
    """The set-ups to use, and what the best one alone covers."""
    rows = [("the part at", "segments", "covered")]
    rows += [
        (said + _place(one.pose), str(one.segments), f"{100 * one.covered_share:.1f} %")
        for said, one in (
            *(("", one) for one in found.set_ups),
            ("for comparison one set-up alone: ", found.alone),
        )
    ]
    proof = "No choice among them is better." if found.proved else "That is not proved."
    text = (
        f"Of {count(found.candidates, 'candidate')}, {count(len(found.set_ups), 'set-up')} with "
        f"{count(found.lift_offs, 'lift-off')} within them cover "
        f"{100 * found.covered_share:.1f} % of what any candidate reaches. {proof}"
    )
    texts = (text,) if found.complete else (text, _UNFINISHED)
    return Card("Several set-ups", texts, tuple(rows))


def _place(pose: Pose) -> str:
    return pose_in_words(pose, ", turned by", ".3f")


def _number(lift_offs: int | None, proved: bool) -> str:
    return ("none found" if lift_offs is None else str(lift_offs)) + " (not proved)" * (not proved)
