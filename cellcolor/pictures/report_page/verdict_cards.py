"""What an independent judge says: the page's badges, and its sections on verdict and coverage."""

from __future__ import annotations

from cellcolor.data.solution import Solution
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.wording import count
from cellcolor.pictures.report_page.content import Card, MotionReport

_SHOWN = 12  # faults


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


def verdict_card(report: MotionReport) -> Card:
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
    for fault in verdict.faults[:_SHOWN]:
        at = "–" if fault.time is None else f"{fault.time:.2f} s"
        rows.append((at, fault.kind, fault.text))
    texts = [f"Not valid, {samples}: {kinds}.", how, *verdict.notes]
    if len(verdict.faults) > _SHOWN:
        texts.append(f"The first {_SHOWN}; the rest are in verdict.json.")
    return Card(title, tuple(texts), tuple(rows), False)


def coverage_card(report: MotionReport) -> Card | None:
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
        ("left out, rightly", _percent(covered.left_out_share)),
        ("uncovered without a reason", f"{1e4 * covered.uncovered_m2:.1f} cm²"),
        ("visits, mean and most", f"{covered.mean_visits:.2f}, {covered.most_visits}"),
        ("along earlier passes", f"{covered.repeated_m:.2f} of {covered.length_m:.2f} m"),
        ("length × spacing / area", f"{covered.length_times_spacing_per_area:.2f}"),
    ]
    if report.measures:
        sharp = sum(own.sharp_turns * own.length_m for own in report.measures)
        length = sum(own.length_m for own in report.measures)
        longest = 1e3 * max(own.longest_step_m for own in report.measures)
        rows += [
            ("turns over 60°", f"{_percent(sharp / length if length else 0)} of path points"),
            ("longest step of a path", f"{longest:.1f} mm"),
        ]
    return Card("Coverage", (text,), (("", ""), *rows))


def _percent(share: float) -> str:
    """One digit, and 100 only where nothing is left."""
    text = f"{100 * share:.1f} %"
    return "99.9 %" if text == "100.0 %" and share < 1 - 1e-9 else text
