"""What a plan's page tells of questions that were asked besides."""

from __future__ import annotations

import html
import re
from pathlib import Path

import numpy as np
import pytest
from pages import DESKTOP, opened, page_data, unpacked
from stand_in import stand_in

import cellcolor
from cellcolor.pictures.report_page.content import AnsweredScene, MotionReport
from cellcolor.pictures.report_page.page import render_report

NAME = "wok_obstacle"


def page(*answers: object) -> str:
    made = stand_in(NAME, 260)
    subject = made.result.subject
    report = MotionReport(
        made.built,
        subject.decomposition,
        made.solution,
        made.painted,
        made.trajectory,
        made.verdict,
        answered=AnsweredScene(made.built.surface, subject.decomposition, answers),
    )
    return render_report(report).decode()


@pytest.fixture(scope="module")
def front() -> cellcolor.Front:
    return cellcolor.tradeoff(stand_in(NAME, 260).built)


def rows_of(text: str, title: str) -> list[list[str]]:
    """The cells of the table in the card with a title."""
    (card,) = re.findall(rf"<h2>{title}</h2>(.*?)</section>", text, re.DOTALL)
    rows = re.findall(r"<tr[^>]*>(.*?)</tr>", card)
    return [
        [html.unescape(cell) for cell in re.findall(r"<t[dh][^>]*>(.*?)</t", row)] for row in rows
    ]


def test_each_point_of_a_front_fills_what_it_covers(front: cellcolor.Front) -> None:
    """Areas of the classes, added up over vertices, are the shares of the front."""
    assert len(front.points) > 1
    text = page(front)
    assert [row[:2] for row in rows_of(text, "Lift-offs against area")[1:]] == [
        [str(point.lift_offs), f"{100 * point.covered_share:.1f} %"] for point in front
    ]
    data = page_data(text)
    modes = data["modes"][data["buttons"] :]
    linked = re.findall(r'<tr data-mode="([^"]*)"', text)
    assert [mode["name"] for mode in modes] == linked and len(linked) == len(front.points)
    painted = stand_in(NAME, 260).painted
    areas = stand_in(NAME, 260).built.surface.vertex_areas
    given = stand_in(NAME, 260).built.surface
    can_be = np.array([bool(own) for own in given.vertex_colors])
    for mode, point in zip(modes, front, strict=True):
        labels = unpacked(mode["labels"])
        assert len(labels) == len(painted.surface.vertices)
        own = labels[: len(areas)]  # a refined surface has the old vertices first
        names = [one["name"] for one in mode["classes"]]
        out = np.array([name.startswith("left out") for name in names])[own]
        covered = areas[can_be & ~out].sum() / areas[can_be].sum()
        assert covered == pytest.approx(point.covered_share)
        assert not out[~can_be].any()


@pytest.mark.second
def test_a_click_on_a_row_shows_it(front: cellcolor.Front, tmp_path: Path) -> None:
    file = tmp_path / "report.html"
    file.write_text(page(front), encoding="utf-8")
    with opened(file, DESKTOP) as (browser_page, faults):
        browser_page.wait_for_selector("#modes button")
        buttons = browser_page.locator("#modes button").count()
        assert buttons == 3  # points of a front have none
        for number, point in enumerate(front):
            browser_page.locator("#modes button").nth(0).click()
            assert "left out" not in browser_page.inner_text("#legend")
            browser_page.locator(".card tr[data-mode]").nth(number).click()
            assert ("left out" in browser_page.inner_text("#legend")) == bool(point.left_out)
        assert faults == []


def test_a_plan_is_asked_besides() -> None:
    from shipped import shipped

    planned = cellcolor.plan(shipped("square", 100), spacing_m=0.05, ask=["tradeoff"])
    assert planned.answered is not None
    (found,) = planned.answered.answers
    assert found.points[-1].covered_share == 1.0
    assert "Lift-offs against area" in planned.page().decode()
    assert "what lift-offs can cover" in str(planned)
    with pytest.raises(cellcolor.InputError, match="'why' is not one of"):
        cellcolor.plan("square", ask=["why"])
