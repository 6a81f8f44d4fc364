"""``report.html``: what is said of a planned motion, around the viewer."""

from __future__ import annotations

import html

from cellcolor.data.wording import count
from cellcolor.pictures.report_page.cards import badges_of, cards_of
from cellcolor.pictures.report_page.content import Card, MotionReport
from cellcolor.pictures.report_page.motion_data import report_data
from cellcolor.pictures.viewer.page import render_page

_SHORT = 14  # characters


def render_report(report: MotionReport) -> bytes:
    """``report.html``; the same report gives the same bytes."""
    badges = "".join(
        f"<li{_verdict_class(good)}>{html.escape(text)}</li>" for text, good in badges_of(report)
    )
    proof = html.escape(_proof(report))
    return render_page(
        _title(report),
        report_data(report),
        header=f'<p class="proof">{proof}</p>\n<ul class="badges">{badges}</ul>',
        cards="\n".join(map(_card, cards_of(report))),
    )


def _title(report: MotionReport) -> str:
    trajectory = report.trajectory
    if trajectory is None:
        return f"{report.built.surface.name}: not planned to the end"
    strokes, lift_offs = count(len(trajectory.strokes), "stroke"), trajectory.lift_offs
    return (
        f"{trajectory.name}: {strokes}, {count(lift_offs, 'lift-off')}, {trajectory.seconds:.0f} s"
    )


def _proof(report: MotionReport) -> str:
    if report.solution is None:
        return report.missing
    text = report.solution.in_words(report.decomposition.instance)
    return text[:1].upper() + text[1:] + "."


def _verdict_class(good: bool | None, first: str = "") -> str:
    names = [name for name in (first, "" if good is None else "good" if good else "bad") if name]
    return f' class="{" ".join(names)}"' if names else ""


def _card(card: Card) -> str:
    parts = [f"<h2>{html.escape(card.title)}</h2>"]
    parts += [f"<p>{html.escape(text)}</p>" for text in card.paragraphs]
    if card.rows:
        head, *rows = card.rows
        lines = []
        if any(head):
            lines.append(f"<tr>{''.join(f'<th>{html.escape(cell)}</th>' for cell in head)}</tr>")
        shown = map(_shows, card.modes or [""] * len(rows), card.times or [None] * len(rows))
        lines += [
            f"<tr{mode}>{''.join(map(_cell, row))}</tr>"
            for row, mode in zip(rows, shown, strict=True)
        ]
        parts.append(f"<table>{''.join(lines)}</table>")
    return f"<section{_verdict_class(card.good, 'card')}>{''.join(parts)}</section>"


def _cell(text: str) -> str:
    """A table's cell; what is short is not broken into lines."""
    short = ' class="short"' if len(text) <= _SHORT else ""
    return f"<td{short}>{html.escape(text)}</td>"


def _shows(mode: str, time: float | None = None) -> str:
    """The attributes by which the scripts know what a click shows."""
    if time is not None:
        return f' data-time="{time}" class="link" tabindex="0"'
    return f' data-mode="{html.escape(mode)}" tabindex="0"' if mode else ""
