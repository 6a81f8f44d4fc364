"""The page's badges and its sections on the motion: verdict, proof, coverage, segments, reach."""

from __future__ import annotations

import numpy as np

from cellcolor.data.bounds import Bound, kind_of
from cellcolor.data.solution import Solution
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.wording import count, listed
from cellcolor.pictures.report_page.content import Answers, Card, MotionReport
from cellcolor.questions.answers import Explanation, Front
from cellcolor.questions.placements import Placements
from cellcolor.questions.set_ups import SetUpPlan

_SHOWN = 12  # faults


def cards_of(report: MotionReport) -> tuple[Card, ...]:
    """All of them, those with nothing to tell left out."""
    cards = (
        _verdict(report),
        # Likely mistakes in the scene, and what its numbers depend on.
        _lines("Warnings", report.built.report.warnings, None),
        _lines("What is not there", report.lacking, False),
        _proof(report),
        _feed(report),
        _coverage(report),
        _segments(report),
        _reach(report),
        _extra(report),
        _left_out(report),
        _programs(report),
    )
    answers = () if report.answered is None else report.answered.answers
    return (*(card for card in cards if card is not None), *map(_answer, answers))


def badges_of(report: MotionReport) -> list[tuple[str, bool | None]]:
    """What is to be seen first, each with whether that is as it should be."""
    verdict, trajectory = report.verdict, report.trajectory
    if verdict is None or trajectory is None:
        return [("no motion", False)]
    faults = sum(verdict.fault_counts.values())
    said = "judged valid" if verdict.valid else f"judged: {count(faults, 'fault')}"
    badges: list[tuple[str, bool | None]] = [(said, verdict.valid)]
    if report.solution is not None:
        badges.append(_lift_offs(trajectory, report.solution))
    if trajectory.unplanned:
        badges.append((f"{count(len(trajectory.unplanned), 'move')} not planned", False))
    if verdict.covered is not None:
        share = _percent(verdict.covered.covered_share)
        coverage = None if report.solution is None else report.solution.coverage
        given_up = 0.0 if coverage is None else coverage.given_up
        why = "as slivers" if report.built.left_alone is None else "on purpose or as slivers"
        more = f", {given_up:.1%} of the surface given up {why}" if given_up else ""
        badges.append((f"{share} of the area with a color covered{more}", None))
        badges.append((f"{verdict.covered.length_m:.2f} m of path", None))
    return badges


def _lift_offs(trajectory: Trajectory, solution: Solution) -> tuple[str, bool | None]:
    """The lift-offs of the trajectory against what is proved."""
    lift_offs, least = trajectory.lift_offs, solution.lift_offs
    said = count(lift_offs, "lift-off")
    if not solution.proved_for_surface or least is None:
        return f"{said}; the minimum is not proved", None
    if lift_offs == least:
        return f"{said}: the proved minimum", True
    if lift_offs < least:  # parts of the surface are left out
        return f"{said}, {least} proved for the whole surface", None
    return f"{said}: {least} proved, {lift_offs - least} more", False


def _verdict(report: MotionReport) -> Card:
    """What is wrong with the trajectory, or that nothing was found; or why there is none."""
    verdict = report.verdict
    if verdict is None:
        more = "Give a longer time limit, or none. The files beside this page are all there is."
        return Card("What is missing", (report.missing, more), (), False)
    samples = f"{count(verdict.samples, 'sample')}, tested at {count(verdict.tested, 'place')}"
    title = "Verdict of the judge"
    how = "The judge knows the scene and the trajectory, but nothing about the planner."
    if verdict.valid:
        text = f"Valid: no fault in {samples}."
        return Card(title, (text, how, *verdict.notes), (), True)
    kinds = ", ".join(f"{number} × {kind}" for kind, number in verdict.fault_counts.items())
    rows = [("at", "kind", "what")]
    shown = verdict.faults[:_SHOWN]
    for fault in shown:
        at = "–" if fault.time is None else f"{fault.time:.2f} s"
        rows.append((at, fault.kind, fault.text))
    texts = [f"Not valid, {samples}: {kinds}.", how, *verdict.notes]
    if len(verdict.faults) > _SHOWN:
        texts.append(f"The first {_SHOWN}; the rest are in verdict.json.")
    times = tuple(fault.time for fault in shown)
    if any(time is not None for time in times):
        texts.append("A click on a row, on its mark on the part or in the bar of time leads there.")
    return Card(title, tuple(texts), tuple(rows), False, times=times)


def _lines(title: str, lines: tuple[str, ...], good: bool | None) -> Card | None:
    return Card(title, lines, (), good) if lines else None


def _feed(report: MotionReport) -> Card | None:
    """How steadily the tool moves along each stroke."""
    verdict = report.verdict
    if verdict is None or not verdict.feeds:
        return None
    asked, window = verdict.feeds[0].asked_m_per_s, 1e3 * verdict.feeds[0].window_m
    text = (
        f"Asked for: {asked:g} m/s. The lowest is over {window:g} mm, the tool's footprint, away "
        "from the ends; slow is below 90 % of what is asked for."
    )
    rows = [("stroke", "mean m/s", "lowest m/s", "slow, of the time", "because of")]
    rows += [
        (
            str(number),
            f"{feed.mean_m_per_s:.3g}",
            f"{feed.lowest_m_per_s:.3g}",
            f"{feed.slow_share:.0%}",
            f"{feed.limited_by} of {feed.joint}" if feed.why and feed.joint else "–",
        )
        for number, feed in enumerate(verdict.feeds)
    ]
    good = None if "feed" not in verdict.fault_counts else False
    times = tuple(feed.time for feed in verdict.feeds)
    return Card("Feed", (text,), tuple(rows), good, times=times)


def _coverage(report: MotionReport) -> Card | None:
    """What is covered, as the judge measured it; and the tool paths, as their maker did."""
    covered = None if report.verdict is None else report.verdict.covered
    if covered is None:
        return None
    spacing = 1e3 * covered.spacing_m
    text = (
        "Measured by the judge along the surface, so the far side of a sheet does not count; "
        f"a visit is a pass within half the spacing of {spacing:g} mm."
    )
    rows = [
        ("of the area with a color", f"{1e4 * covered.reachable_m2:.0f} cm²"),
        (f"within {1.5 * spacing:g} mm of a pass", _percent(covered.covered_share)),
        (f"within {0.75 * spacing:g} mm of a pass", _percent(covered.closely_covered_share)),
        ("left out, the arm cannot reach it", _percent(covered.left_out_share)),
        ("uncovered without a reason", f"{1e4 * covered.uncovered_m2:.1f} cm²"),
        ("visits, mean and most", f"{covered.mean_visits:.2f}, {covered.most_visits}"),
        ("along earlier passes", f"{covered.repeated_m:.2f} of {covered.length_m:.2f} m"),
        ("length × spacing / area", f"{covered.length_times_spacing_per_area:.2f}"),
    ]
    return Card("Coverage", (text,), (("", ""), *rows))


def _percent(share: float) -> str:
    """One digit, and 100 only where nothing is left."""
    text = f"{100 * share:.1f} %"
    return "99.9 %" if text == "100.0 %" and share < 1 - 1e-9 else text


def _proof(report: MotionReport) -> Card | None:
    """Why there cannot be fewer lift-offs; or that this is open."""
    solution = report.solution
    if solution is None or solution.segments is None:
        return None
    segments = solution.segments or 0
    bounds = [b for b in solution.bounds or () if b.value == solution.surface_lower_bound]
    surface_bounds = [b for b in bounds if b.holds_for == "surface"]
    if not solution.proved_for_surface:
        text = (
            f"It is not proved that fewer are impossible: {count(segments, 'segment')} were found, "
            f"any division has at least {solution.surface_lower_bound}."
        )
        if solution.status == "optimal":
            by = "" if solution.proved_by is None else f", by {solution.proved_by}"
            text += f" They are proved to be the fewest in the search space paper{by}."
        return Card("Can there be fewer lift-offs?", (text,), _bound_rows(surface_bounds), False)
    if segments < 2:
        text = "The tool never has to lift off, so there cannot be fewer."
        return Card("Why not fewer lift-offs", (text,), (), True)
    because = solution.why_not_fewer(report.decomposition.instance)
    paragraphs = [
        f"However the surface is divided, {count(segments, 'segment')} are needed"
        + (f": {because}." if because else "."),
    ]
    if solution.witness:
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
    names, segment_of = painted.surface.colors, painted.segment_of
    color_of = dict(zip(segment_of.tolist(), painted.plan.vertex_colors, strict=True))
    # Shifted by one, so that what has no segment is counted first, and left out.
    areas = np.bincount(segment_of + 1, painted.surface.vertex_areas)[1:]
    rows: list[tuple[str, ...]] = []
    for number, area in enumerate(areas.tolist()):
        color = color_of.get(number)
        rows.append((str(number), "–" if color is None else names[color], f"{1e4 * area:.0f} cm²"))
    preference = None if report.solution is None else report.solution.preference
    texts = () if preference is None else (f"Posture: {preference}.",)
    if trajectory is None:
        return Card("Segments", texts, (("", "color", "area"), *rows))
    steps = np.linalg.norm(np.diff(trajectory.points, axis=0), axis=1)
    spent = np.diff(trajectory.times)
    touching = trajectory.contact[1:] & trajectory.contact[:-1]
    for number, row in enumerate(rows):
        own = touching & (trajectory.segment[1:] == number)
        rows[number] = (
            *row,
            f"{float(steps[own].sum()):.2f} m",
            f"{float(spent[own].sum()):.1f} s",
        )
    between = spent[~touching].sum()
    text = f"Moves between strokes, approaches and retracts take {between:.1f} s."
    return Card("Segments", (*texts, text), (("", "color", "area", "path", "in contact"), *rows))


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


def _programs(report: MotionReport) -> Card | None:
    """What is known of the programs for the arm's controller."""
    if not report.programs:
        return None
    text = (
        f"{listed(report.programs)}: joint moves as they were judged, and linear moves at the "
        "feed, which were not judged. No parser of the maker, nor any other foreign one, has read "
        "them: run them in simulation first."
    )
    return Card("Programs for the controller", (text,))


def _left_out(report: MotionReport) -> Card | None:
    """What the tool does not go to, by cause."""
    parts = () if report.trajectory is None else report.trajectory.left_out
    if not parts:
        return None
    rows = []
    for segment, reason in sorted({(part.segment, part.reason) for part in parts}):
        own = [part for part in parts if (part.segment, part.reason) == (segment, reason)]
        area, largest = sum(part.area_m2 for part in own), max(own, key=lambda part: part.area_m2)
        place = _place(largest.place)
        rows.append((str(segment), reason, str(len(own)), f"{1e4 * area:.2f} cm²", place))
    whole = 1e4 * sum(part.area_m2 for part in parts)
    text = (
        f"Parts of segments that the tool does not reach, {whole:.2f} cm² in all; red rings mark "
        "the largest."
    )
    head = ("segment", "cause", "parts", "area", "largest at [m]")
    return Card("Left out", (text,), (head, *rows))


_ANSWERS: dict[type[Answers], str] = {
    Front: "Lift-offs against area",
    Explanation: "What costs a lift-off",
    Placements: "Where the part could stand",
    SetUpPlan: "Several set-ups",
}


def _answer(answer: Answers) -> Card:
    """What the command prints; of a front a table, whose rows show what they cover."""
    title = _ANSWERS[type(answer)]
    if not isinstance(answer, Front):
        return Card(title, tuple(str(answer).splitlines()))
    texts = [
        "The most that each number of lift-offs can cover, of the area with a color. A click on a "
        "row shows it on the part."
    ]
    if not answer.complete:
        texts.append("The time limit came before everything was tried.")
    rows = [
        (str(point.lift_offs), f"{100 * point.covered_share:.1f} %", point.proof)
        for point in answer
    ]
    modes = tuple(point.in_short for point in answer)
    return Card(title, tuple(texts), (("lift-offs", "covered", "proof"), *rows), modes=modes)


def _place(place: tuple[float, float, float]) -> str:
    return ", ".join(f"{value:.3f}" for value in place)
