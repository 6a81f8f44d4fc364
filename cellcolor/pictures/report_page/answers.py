"""What was asked besides: cards on lift-offs against area, on what costs one, on where to stand."""

from __future__ import annotations

import numpy as np

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
from cellcolor.decomposition import Decomposition
from cellcolor.pictures.by_cell_and_color import bare_classes, bare_labels, neighboring, shares
from cellcolor.pictures.mesh_picture import VertexClass
from cellcolor.pictures.palette import assign
from cellcolor.pictures.report_page.content import AnsweredScene, Answers, Card
from cellcolor.pictures.report_page.surface_modes import SurfaceMode
from cellcolor.questions.explanation import Explanation
from cellcolor.questions.front import Front, FrontPoint
from cellcolor.questions.placements import Placements, Pose
from cellcolor.questions.set_ups import SetUpPlan

_LEFT_OUT, _DIVIDED = "#CC3311", "#666666"
_MOST_PLACES = 5


def answer_cards(answered: AnsweredScene) -> list[Card]:
    """A card for each answer."""
    return [_card(answer) for answer in answered.answers]


def _card(answer: Answers) -> Card:
    if isinstance(answer, Front):
        return _front_card(answer)
    if isinstance(answer, Explanation):
        return _explanation_card(answer)
    if isinstance(answer, SetUpPlan):
        return _set_ups_card(answer)
    return _placements_card(answer)


def _front_card(front: Front) -> Card:
    """Each point a row, which shows on the part what it covers."""
    text = (
        "The most that so many lift-offs cover, of the area that some color reaches. A click on a "
        "row or on a point shows it on the part."
    )
    rows = [("lift-offs", "covered", "proof")]
    for point in front:
        proof = "proved for any division of the surface"
        if not point.proved_for_surface:
            proof = "proved in the search space paper" if point.proved else _at_most(point)
        rows.append((str(point.lift_offs), f"{100 * point.covered_share:.1f} %", proof))
    modes = tuple(_mode_name(point) for point in front)
    return Card("Lift-offs against area", (text,), tuple(rows), modes=modes, curve=_curve(front))


def _at_most(point: FrontPoint) -> str:
    return f"at most {100 * point.at_most_share:.1f} %"


def _curve(front: Front) -> tuple[tuple[float, float], ...]:
    return tuple((float(point.lift_offs), 100 * point.covered_share) for point in front)


def _mode_name(point: FrontPoint) -> str:
    return f"{count(point.lift_offs, 'lift-off')}: {100 * point.covered_share:.1f} %"


def _explanation_card(found: Explanation) -> Card:
    """What changes the number or the area, the best first."""
    base = found.base
    rows = [("without, or with less asked for", "lift-offs", "area")]
    rows += [
        (
            " and ".join(row.relaxed) + (f" ({row.note})" if row.note else ""),
            f"{_number(base.lift_offs)} → {_number(row.lift_offs)}"
            + ("" if row.proved_for_surface else " (not proved)"),
            f"{100 * base.covered_share:.1f} → {100 * row.covered_share:.1f} %",
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
    if not found.complete:
        texts.append("The time limit came before everything was tried.")
    return Card("What costs a lift-off", tuple(texts), tuple(rows) if len(rows) > 1 else ())


def _placements_card(found: Placements) -> Card:
    """Where the part stands, and better places."""
    rows = [("the part at", "lift-offs", "area")]
    for said, row in (("as it stands", found.here), *(("", row) for row in found.best)):
        rows.append(
            (
                f"{_place(row.pose)}{f', {said}' if said else ''}",
                _number(row.lift_offs) + ("" if row.proved_for_surface else " (not proved)"),
                f"{100 * row.covered_share:.1f} %",
            )
        )
    rows = rows[: 2 + _MOST_PLACES]
    texts = [
        f"{count(len(found.tried), 'placement')} tried; shares are of the whole surface, and "
        f"{100 * found.cover:.1f} % had to be covered."
    ]
    if not found.complete:
        texts.append("The time limit came before everything was tried.")
    return Card("Where the part could stand", tuple(texts), tuple(rows))


def _set_ups_card(found: SetUpPlan) -> Card:
    """The set-ups to use, and what the best one alone covers."""
    rows = [("the part at", "segments", "covered")]
    rows += [
        (_place(one.pose), str(one.segments), f"{100 * one.covered_share:.1f} %")
        for one in found.set_ups
    ]
    alone = found.alone
    rows.append(
        (
            f"for comparison one set-up alone: {_place(alone.pose)}",
            str(alone.segments),
            f"{100 * alone.covered_share:.1f} %",
        )
    )
    proof = "No choice among them is better." if found.proved else "That is not proved."
    text = (
        f"Of {count(found.candidates, 'candidate')}, {count(len(found.set_ups), 'set-up')} with "
        f"{count(found.lift_offs, 'lift-off')} within them cover "
        f"{100 * found.covered_share:.1f} % of what any candidate reaches. {proof}"
    )
    return Card("Several set-ups", (text,), tuple(rows))


def _place(pose: Pose) -> str:
    x, y, z, roll, pitch, yaw = pose
    place = f"({x:.3f}, {y:.3f}, {z:.3f}) m"
    if roll or pitch or yaw:
        place += f", turned by ({roll:.3f}, {pitch:.3f}, {yaw:.3f}) rad"
    return place


def _number(lift_offs: int | None) -> str:
    return "none found" if lift_offs is None else str(lift_offs)


def answer_modes(answered: AnsweredScene) -> list[SurfaceMode]:
    """What each point of a front covers, on the part."""
    return [
        _front_mode(answered.surface, answered.decomposition, point)
        for answer in answered.answers
        if isinstance(answer, Front)
        for point in answer
    ]


def _front_mode(
    surface: LabelledSurface, decomposition: Decomposition, point: FrontPoint
) -> SurfaceMode:
    """Each cell by its segment; where a cut would run within a cell is not drawn."""
    segments = point.segments
    divided, left_out = segments, segments + 1
    left = set(point.left_out)
    kept = [cell.id for cell in decomposition.instance.cells if cell.id not in left]
    of_cell = np.full(len(decomposition.instance.cells) + 1, left_out)
    colors: dict[int, int] = {}
    for division in point.solution.cells or ():
        own = {sub.segment for sub in division.subcells}
        colors |= {sub.segment: sub.color for sub in division.subcells}
        of_cell[kept[division.id]] = own.pop() if len(own) == 1 else divided
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    bare = bare_labels(surface, segments + 2)
    labels = np.where(cells == OUTSIDE, bare, of_cell[np.where(cells == OUTSIDE, 0, cells)])
    share = shares(surface, labels, segments + 4)
    fills = assign(neighboring(surface, np.where(labels < segments, labels, -1), segments))
    classes = [
        VertexClass(
            f"segment {number}: {surface.colors[colors[number]]}, {share[number]}",
            fills[number],
            str(number),
        )
        for number in range(segments)
    ]
    classes.append(VertexClass(f"divided between segments, {share[divided]}", _DIVIDED))
    classes.append(VertexClass(f"left out, {share[left_out]}", _LEFT_OUT))
    classes += bare_classes(*share[segments + 2 :])
    return SurfaceMode(_mode_name(point), tuple(classes), labels, button=False)
