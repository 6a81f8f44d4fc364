"""One page about several planned motions: a table, and their reports beside each other."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.data.solution import Solution
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.files.writing import MARKER

_HEAD = (
    "plan",
    "judged",
    "lift-offs",
    "proved minimum",
    "time",
    "in contact",
    "area covered",
    "left out",
    "not planned",
)
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 1rem; color: #1D2430; }
table { border-collapse: collapse; margin-bottom: 1rem; }
th, td { text-align: left; padding: 0.25rem 0.9rem 0.25rem 0; }
.pages { display: grid; grid-template-columns: repeat(auto-fit, minmax(36rem, 1fr)); gap: 1rem; }
figure { margin: 0; }
iframe { width: 100%; height: 60rem; border: 1px solid #D5DAE1; border-radius: 8px; }
"""


@dataclass(frozen=True)
class SavedPlan:
    """What a plan's folder has that is compared.

    Attributes:
        name: of the folder.
        solution: with the proved minimum.
        trajectory: the motion.
        verdict: the judge's.
        page: ``report.html``.
    """

    name: str
    solution: Solution
    trajectory: Trajectory
    verdict: TrajectoryVerdict
    page: str


def render_side_by_side(plans: Sequence[SavedPlan]) -> bytes:
    """The page, complete in itself; the same plans give the same bytes."""
    title = f"{len(plans)} plans: {', '.join(plan.name for plan in plans)}"
    lines = [_line("th", _HEAD), *(_line("td", _row(plan)) for plan in plans)]
    pages = [
        f"<figure><figcaption>{html.escape(plan.name)}</figcaption>"
        f'<iframe title="{html.escape(plan.name)}" srcdoc="{html.escape(plan.page)}"></iframe>'
        "</figure>"
        for plan in plans
    ]
    return (
        f'<!doctype html>\n<html lang="en">\n<head><meta name="generator" content="{MARKER}" />\n'
        f'<meta charset="utf-8" />\n<title>{html.escape(title)}</title>\n<style>{_STYLE}</style>\n'
        f"</head>\n<body>\n<table>\n{''.join(lines)}</table>\n"
        f'<div class="pages">\n{"".join(pages)}</div>\n</body>\n</html>\n'
    ).encode()


def _line(tag: str, cells: Sequence[str]) -> str:
    return f"<tr>{''.join(f'<{tag}>{html.escape(cell)}</{tag}>' for cell in cells)}</tr>\n"


def _row(plan: SavedPlan) -> tuple[str, ...]:
    trajectory, verdict, covered = plan.trajectory, plan.verdict, plan.verdict.covered
    steps = np.linalg.norm(np.diff(trajectory.points, axis=0), axis=1)
    touching = trajectory.contact[1:] & trajectory.contact[:-1]
    proved = plan.solution.lift_offs if plan.solution.proved_for_surface else None
    return (
        plan.name,
        "valid" if verdict.valid else f"{sum(verdict.fault_counts.values())} faults",
        str(verdict.lift_offs),
        "–" if proved is None else str(proved),
        f"{trajectory.seconds:.1f} s",
        f"{steps[touching].sum():.2f} m",
        "–" if covered is None else f"{100 * covered.covered_share:.2f} %",
        f"{1e4 * sum(part.area_m2 for part in trajectory.left_out):.2f} cm²",
        str(len(trajectory.unplanned)),
    )
