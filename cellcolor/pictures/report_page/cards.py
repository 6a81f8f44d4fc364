"""The page's sections, those on proof, segments, reach and what is not covered made here."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from cellcolor.data.bound import Bound
from cellcolor.data.bounds.kinds import kind_of
from cellcolor.data.proof_wording import reason_of, witness_in_words
from cellcolor.data.wording import count, listed
from cellcolor.pictures.report_page.answers import answer_cards
from cellcolor.pictures.report_page.content import Card, MotionReport
from cellcolor.pictures.report_page.verdict_cards import coverage_card, verdict_card


def cards_of(report: MotionReport) -> tuple[Card, ...]:
    """All of them, those with nothing to tell left out."""
    cards = (
        verdict_card(report),
        _proof(report),
        coverage_card(report),
        _segments(report),
        _reach(report),
        _extra(report),
        _left_out(report),
    )
    found = [card for card in cards if card is not None]
    answers = [] if report.answered is None else answer_cards(report.answered)
    return (*found, *answers)


def _proof(report: MotionReport) -> Card | None:
    """Why there cannot be fewer lift-offs; or that this is open."""
    solution = report.solution
    if solution is None or solution.segments is None:
        return None
    segments = solution.segments or 0
    bounds = [b for b in solution.bounds or () if b.value == solution.surface_lower_bound]
    surface_bounds = [bound for bound in bounds if bound.holds_for == "surface"]
    if not solution.proved_for_surface:
        text = (
            f"It is not proved that fewer are impossible: {count(segments, 'segment')} were found, "
            f"any division has at least {solution.surface_lower_bound}."
        )
        return Card("Can there be fewer lift-offs?", (text,), _bound_rows(surface_bounds), False)
    if segments < 2:
        text = "The tool never has to lift off, so there cannot be fewer."
        return Card("Why not fewer lift-offs", (text,), (), True)
    witness = witness_in_words(report.decomposition.instance, solution.witness)
    because = witness or reason_of(solution)
    paragraphs = [
        f"However the surface is divided, {count(segments, 'segment')} are needed"
        + (f": {because}." if because else "."),
    ]
    if witness is not None:
        shown = "The button “Cells of the proof” shows them on the part."
        paragraphs.append(f"Each needs its own segment. {shown}")
    paragraphs.append(
        "This holds for the surface with the colors (classes of postures) found at its vertices; "
        "between two vertices only what was tested is known."
    )
    return Card("Why not fewer lift-offs", tuple(paragraphs), _bound_rows(surface_bounds), True)


def _bound_rows(bounds: list[Bound]) -> tuple[tuple[str, ...], ...]:
    if not bounds:
        return ()
    rows = [(str(bound.value), bound.kind, str(kind_of(bound))) for bound in bounds]
    return (("at least", "bound", "why"), *rows)


def _segments(report: MotionReport) -> Card | None:
    """Each segment with its color, and with its path and its time if there is a motion."""
    trajectory, painted = report.trajectory, report.painted
    if painted is None:
        return None
    rows = []
    areas = painted.surface.vertex_areas
    for segment in range(int(painted.segment_of.max(initial=-1)) + 1):
        vertices = np.flatnonzero(painted.segment_of == segment)
        color = painted.plan.vertex_colors[int(vertices[0])] if len(vertices) else None
        rows.append(
            (
                str(segment),
                "–" if color is None else painted.surface.colors[color],
                f"{1e4 * float(areas[vertices].sum()):.0f} cm²",
            )
        )
    if trajectory is None:
        return Card("Segments", (), (("", "color", "area"), *rows))
    steps = np.linalg.norm(np.diff(trajectory.points, axis=0), axis=1)
    spent = np.diff(trajectory.times)
    touching = trajectory.contact[1:] & trajectory.contact[:-1]
    driven = []
    for segment in range(len(rows)):
        own = touching & (trajectory.segment[1:] == segment)
        driven.append((f"{float(steps[own].sum()):.2f} m", f"{float(spent[own].sum()):.1f} s"))
    between = float(spent[~touching].sum())
    text = f"Moves between strokes, approaches and retracts take {between:.1f} s."
    table = [row + more for row, more in zip(rows, driven, strict=True)]
    return Card("Segments", (text,), (("", "color", "area", "path", "in contact"), *table))


def _reach(report: MotionReport) -> Card:
    """How much can be reached, and which tests the other vertices fail."""
    found = report.built.report
    share = 100 * found.reachable_area_m2 / found.area_m2
    text = (
        f"{share:.1f} % of the area can be reached: {found.reachable} of {found.vertices} vertices "
        "have a valid configuration."
    )
    unreachable = {name: number for name, number in found.unreachable.items() if number}
    if not unreachable:
        return Card("Out of reach", (text, "No vertex is out of reach."))
    explained = (
        "For each vertex: the first failed test of the branch that passed the most tests. "
        "The button “Out of reach” shows where."
    )
    rows = [(name, str(number)) for name, number in unreachable.items()]
    return Card("Out of reach", (text, explained), (("test that fails", "vertices"), *rows))


def _extra(report: MotionReport) -> Card | None:
    """Lift-offs beyond the proven minimum, and moves that were not planned."""
    trajectory = report.trajectory
    if trajectory is None or not (trajectory.extra_lift_offs or trajectory.unplanned):
        return None
    texts, rows = [], []
    if trajectory.unplanned:
        moments = listed([f"{trajectory.times[sample]:.1f} s" for sample in trajectory.unplanned])
        moves = count(len(trajectory.unplanned), "move")
        texts.append(
            f"{moves} could not be planned, and the arm must not drive them: at {moments}."
        )
    if trajectory.extra_lift_offs:
        texts.append(f"{count(len(trajectory.extra_lift_offs), 'lift-off')} beyond the minimum:")
        rows = [("at", "segment", "reason", "place [m]")]
        rows += [
            (
                f"{trajectory.times[min(extra.sample, len(trajectory.times) - 1)]:.1f} s",
                str(extra.segment),
                extra.text,
                _place(extra.place),
            )
            for extra in trajectory.extra_lift_offs
        ]
    return Card("Beyond the minimum", tuple(texts), tuple(rows), False)


def _left_out(report: MotionReport) -> Card | None:
    """What the tool does not go to, by cause."""
    areas: dict[tuple[int, str], list[float]] = defaultdict(list)
    largest: dict[tuple[int, str], tuple[float, tuple[float, float, float]]] = {}
    for part in report.trajectory.left_out if report.trajectory is not None else ():
        key = (part.segment, part.reason)
        areas[key].append(part.area_m2)
        largest[key] = max(largest.get(key, (0.0, part.place)), (part.area_m2, part.place))
    if not areas:
        return None
    rows = [
        (str(segment), reason, str(len(own)), f"{1e4 * sum(own):.2f} cm²", _place(largest[key][1]))
        for key, own in sorted(areas.items())
        for segment, reason in [key]
    ]
    whole = 1e4 * sum(map(sum, areas.values()))
    text = (
        f"Parts of segments that the tool does not reach, {whole:.2f} cm² in all; rings with a red "
        "rim mark the largest."
    )
    head = ("segment", "cause", "parts", "area", "largest at [m]")
    return Card("Left out", (text,), (head, *rows))


def _place(place: tuple[float, float, float]) -> str:
    return ", ".join(f"{value:.3f}" for value in place)
