"""The page on a planned motion, in a real browser and as text."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from joint_paths import SLIDE, driven_scara
from pages import DESKTOP, PHONE, opened, page_data, unpacked
from stand_in import stand_in

from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import Fault
from cellcolor.files.writing import HTML
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.pictures.report_page.cards import badges_of, cards_of
from cellcolor.pictures.report_page.content import MotionReport
from cellcolor.pictures.report_page.motion_data import OFF, OFF_SHARE, frames_of
from cellcolor.pictures.report_page.page import render_report

HOSTILE = "</script><b>&\"'$DATA"


def report(**changes: object) -> MotionReport:
    made = stand_in()
    whole = MotionReport(
        made.built,
        made.result.subject.decomposition,
        made.solution,
        made.painted,
        made.trajectory,
        made.verdict,
    )
    return replace(whole, **changes)


@pytest.fixture(scope="module")
def page_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_bytes(render_report(report()))
    return file


def wait_for_time(page: Any, seconds: float) -> None:
    """Until the page shows a later time. Asked from here: its policy lets nothing evaluate text."""
    for _ in range(300):
        if float(page.input_value("#time")) > seconds:
            return
        page.wait_for_timeout(100)
    raise AssertionError(f"still at {page.input_value('#time')} s after half a minute")


def test_warnings_of_the_scene_are_on_the_page() -> None:
    built = report().built
    for notes in ((), ("the tool points back",)):
        noted = replace(built, prepared=replace(built.prepared, notes=notes))
        cards = [card for card in cards_of(report(built=noted)) if card.title == "Warnings"]
        assert [card.paragraphs for card in cards] == ([notes] if notes else [])


def test_the_page_is_known_again_and_the_same_each_time(page_file: Path) -> None:
    page = page_file.read_bytes()
    assert HTML.pattern.match(page[:4096])
    assert render_report(report()) == page
    vendored = rb"<script>\nvar THREE=.*?</script>|<script type=.*?</script>"
    ours = re.sub(vendored, b"", page, flags=re.DOTALL).replace(b"http://www.w3.org/2000/svg", b"")
    assert len(ours) < 60_000 < len(page) < 1_500_000
    assert not re.search(rb"""(?:src|href)=|url\(|https?:|@import""", ours)
    assert b"default-src 'none'" in page


def test_texts_stay_texts() -> None:
    made = stand_in()
    fault = Fault("jump", HOSTILE, sample=3, time=1.0)
    verdict = replace(made.verdict, faults=(fault,), fault_counts={"jump": 1})
    odd = replace(made.trajectory, name=HOSTILE)
    page = render_report(report(trajectory=odd, verdict=verdict)).decode()
    assert "<b>" not in page
    assert page.count("&lt;/script&gt;&lt;b&gt;&amp;&quot;&#x27;$DATA") == 3
    assert len(page_data(page)["motion"]["names"]) == 6


def test_the_ground_is_at_its_height() -> None:
    made = stand_in()
    assert made.prepared.scene.ground is not None
    (ground,) = page_data(render_report(report()).decode())["lines"]
    assert ground["name"] == "ground"
    height = made.prepared.scene.ground.height_m
    assert np.allclose(unpacked(ground["ends"]).reshape(-1, 3)[:, 2], height, atol=1e-6)


@pytest.mark.second
def test_a_page_without_a_motion_shows_what_there_is(tmp_path: Path) -> None:
    made = stand_in()
    nothing = {"trajectory": None, "verdict": None, "missing": "The time limit came <first>."}
    stages = (
        ({"solution": None, "painted": None}, 1, 0),
        ({"painted": None}, 2, 0),
        ({"paths": made.paths}, 3, sum(len(path.points) for path in made.paths.paths)),
    )
    for there, modes, points in stages:
        file = tmp_path / "report.html"
        file.write_bytes(render_report(report(**nothing, **there)))
        text = file.read_text(encoding="utf-8")
        assert "The time limit came &lt;first&gt;." in text
        data = page_data(text)
        assert len(data["modes"]) == modes and data["motion"] is None
        drawn = [len(unpacked(own["ends"])) // 6 for own in data["lines"][1:]]
        assert drawn == ([points - len(made.paths.paths)] if points else [])
        with opened(file, DESKTOP) as (page, faults):
            page.wait_for_selector("#legend button")
            # One mode alone needs no button.
            assert page.locator("#modes button").count() == (modes if modes > 1 else 0)
            assert page.locator("#space").is_visible()
            for hidden in ("#play", "#charts", "#clock"):
                assert not page.locator(hidden).is_visible(), hidden
            assert faults == []


@pytest.mark.second
@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_slider_and_play_move_the_arm(page_file: Path, size: tuple[int, int]) -> None:
    """What the page's own kinematics says of the tip is where the trajectory has it."""
    trajectory = stand_in().trajectory
    assert trajectory.times[0] == 0
    stroke = trajectory.strokes[0]
    samples = [0, stroke[0], (stroke[0] + stroke[1]) // 2, stroke[1], len(trajectory.times) - 1]
    with opened(page_file, size) as (page, faults):
        assert page.evaluate("document.documentElement.scrollWidth") <= size[0]
        for sample in samples:
            move = "([id, at]) => { const s = document.getElementById(id); s.value = at;"
            move += " s.dispatchEvent(new Event('input')); return Number(s.value); }"
            shown = page.evaluate(move, ["time", float(trajectory.times[sample])])
            assert shown == pytest.approx(trajectory.times[sample], abs=1e-3)
            tip = re.findall(r"-?\d+\.\d+", page.inner_text("#tip"))
            own = forward(stand_in().prepared.robot, trajectory.joints[sample : sample + 1]).tip[0]
            assert np.allclose(np.array(tip, dtype=float), own, atol=2e-4)
            state = page.inner_text("#state")
            between = sample + 1 < len(trajectory.times) and not trajectory.contact[sample + 1]
            if sample in trajectory.unplanned:
                assert state == "this move was not planned"
            elif trajectory.contact[sample] and not between:
                assert state == f"in contact, segment {trajectory.segment[sample]}"
            else:
                assert state == "between strokes"
        # At the end, play begins again, at once.
        page.click("#play")
        wait_for_time(page, 1)
        page.click("#play")
        page.wait_for_selector("#play[aria-label=Play]")
        stopped = page.input_value("#time")
        page.wait_for_timeout(100)
        assert page.input_value("#time") == stopped
        assert float(stopped) < 0.9 * trajectory.times[-1]  # not played to the end
        for button in page.locator("#eyes button").all() + page.locator("#legend button").all():
            button.dispatch_event("click")
        legends = set()
        for number in range(page.locator("#modes button").count()):
            page.locator("#modes button").nth(number).dispatch_event("click")
            legends.add(page.inner_text("#legend"))
        assert len(legends) == 3
        assert faults == []


@pytest.mark.second
def test_faults_are_found_by_a_click_and_the_space_bar_plays(tmp_path: Path) -> None:
    """From the list, from the mark on the part, and from the bar of time."""
    made = stand_in()
    times = made.trajectory.times
    number = int(np.flatnonzero(made.trajectory.contact)[len(times) // 3])
    moment, place = float(times[number]), tuple(made.trajectory.points[number].tolist())
    found = (
        Fault("invalid", "here", sample=number, time=moment, place=place),
        Fault("jump", "at the end", sample=len(times) - 1, time=float(times[-1])),
        Fault("uncovered", "nowhere", place=place),
    )
    verdict = replace(made.verdict, faults=found, fault_counts={"invalid": 1, "jump": 2})
    file = tmp_path / "faults.html"
    file.write_bytes(render_report(report(verdict=verdict)))

    def at(page: Any) -> float:
        return float(page.input_value("#time")) + float(times[0])

    with opened(file, DESKTOP) as (page, faults):
        card = page.locator(".card", has_text="Verdict of the judge")
        rows = card.locator("tr[data-time]")
        assert rows.count() == 2  # the third has no time
        rows.nth(1).click()
        assert at(page) == pytest.approx(times[-1], abs=1e-3)
        rows.nth(0).click()
        assert at(page) == pytest.approx(moment, abs=1e-3)
        page.keyboard.press(" ")
        wait_for_time(page, moment - float(times[0]) + 0.01)
        page.keyboard.press(" ")
        assert page.get_attribute("#play", "aria-label") == "Play"
        first = page.locator("#phases .fault").nth(0)
        label = f"fault at {moment:.2f} s: invalid"
        assert first.get_attribute("aria-label") == label
        first.click()
        assert at(page) == pytest.approx(moment, abs=1e-3)
        bar = page.locator("#phases").bounding_box()
        page.mouse.click(bar["x"] + 0.1 * bar["width"], bar["y"] + bar["height"] / 2)
        assert at(page) < moment
        mark = page.locator("#overlay .fault")
        assert mark.count() == 1
        mark.dispatch_event("click")
        assert at(page) == pytest.approx(moment, abs=1e-3)
        assert faults == []


@pytest.mark.second
def test_a_joint_that_slides_is_drawn_sliding(tmp_path: Path) -> None:
    """The tip that the page computes in a few configurations is that of forward kinematics."""
    made = driven_scara()
    (tmp_path / "slides.html").write_bytes(made.page())
    rows = np.linspace(0, len(made.trajectory.times) - 1, 7).astype(int)
    asked = made.trajectory.joints[rows]
    tips = forward(made.built.robot, asked).tip
    with opened(tmp_path / "slides.html", DESKTOP) as (page, faults):
        poses = page.evaluate(
            "(asked) => { const data = JSON.parse(document.getElementById('data').textContent);"
            " return asked.map((q) => armPoses(data.motion.arm, q).at(-1).elements); }",
            asked.tolist(),
        )
        assert faults == []
    drawn = np.array(poses).reshape(-1, 4, 4)[:, 3, :3]  # column by column
    assert np.ptp(asked[:, SLIDE]) > 0.02
    assert np.abs(drawn - tips).max() < 1e-9


@pytest.mark.second
def test_without_webgl_the_rest_works(page_file: Path, tmp_path: Path) -> None:
    page = page_file.read_text(encoding="utf-8").replace("WebGLRenderer({", "None({")
    (tmp_path / "plain.html").write_text(page, encoding="utf-8")
    with opened(tmp_path / "plain.html", DESKTOP) as (browser_page, faults):
        assert "cannot draw in 3D" in browser_page.inner_text("#overlay")
        browser_page.click("#play")
        wait_for_time(browser_page, 0)
        assert faults == []


def test_the_arrays_are_those_of_the_motion(page_file: Path) -> None:
    made, data = stand_in(), page_data(page_file.read_text(encoding="utf-8"))
    surface, trajectory = made.painted.surface, made.trajectory
    vertices = unpacked(data["mesh"]["points"]).reshape(-1, 3)
    assert np.allclose(vertices, surface.vertices, atol=1e-6)
    assert np.array_equal(unpacked(data["mesh"]["triangles"]).reshape(-1, 3), surface.faces)
    labels, painted = unpacked(data["modes"][0]["labels"]), made.painted.segment_of >= 0
    assert np.array_equal(labels[painted], made.painted.segment_of[painted])
    motion = data["motion"]
    assert np.allclose(unpacked(motion["joints"]).reshape(-1, 6), trajectory.joints, atol=1e-5)
    states = unpacked(motion["states"])
    assert (states == 2).sum() == len(trajectory.unplanned)
    both = trajectory.contact[:-1] & trajectory.contact[1:]
    assert np.array_equal(states[:-1] == 1, both & (states[:-1] != 2))
    # Pieces in contact are as long as the tool path: nothing of it is left undrawn.
    places = unpacked(motion["trace"]).reshape(-1, 3)
    lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert lengths[states[:-1] == 1].sum() == pytest.approx(made.paths.length, rel=0.03)


@pytest.mark.parametrize(
    ("solution", "expected"),
    [
        ({}, "However the surface is divided, 2 segments are needed: cells"),
        (
            {"surface_lower_bound": 1, "proved_for_surface": False},
            "It is not proved that fewer are impossible",
        ),
    ],
)
def test_the_page_claims_what_is_proved(solution: dict[str, object], expected: str) -> None:
    changed = replace(stand_in().solution, **solution)
    page = render_report(report(solution=changed)).decode()
    assert expected in page
    assert page.count("optimal: proved for any division") == (0 if solution else 1)


@given(st.integers(1, 60), st.randoms(use_true_random=False))
def test_frames_keep_the_ends_of_strokes_and_what_is_not_straight(count: int, rng: Any) -> None:
    contact = [rng.random() < 0.7 for _ in range(count)]
    joints = np.cumsum([[rng.choice((0.0, 0.0, 0.01)), 0.0] for _ in range(count)], axis=0)
    measure = np.cumsum([[rng.choice((0.0, 1.0))] for _ in range(count)], axis=0)
    unplanned = (count - 2,) if count > 1 else ()
    rows = np.zeros((count, 3))
    trajectory = Trajectory(
        "any", ("a", "b"), np.arange(count), joints, rows, rows, contact, [0] * count, unplanned
    )
    frames = frames_of(trajectory, measure)
    assert (np.diff(frames) > 0).all()
    wanted = {0, count - 1, *unplanned, *(sample + 1 for sample in unplanned)}
    wanted |= {end for first, after in trajectory.strokes for end in (first, after - 1)}
    assert wanted <= set(frames.tolist())
    for values, off in ((joints[:, 0], OFF), (measure[:, 0], OFF_SHARE * np.ptp(measure))):
        drawn = np.interp(np.arange(count), frames, values[frames])
        assert np.abs(drawn - values).max() <= off + 1e-9


def test_badges_count_against_the_proof() -> None:
    made = stand_in()
    strokes = made.trajectory.strokes
    contact = made.trajectory.contact.copy()
    contact[(strokes[0][0] + strokes[0][1]) // 2] = False  # one lift-off more
    parted = replace(made.trajectory, contact=contact)
    open_solution = replace(made.solution, surface_lower_bound=1, proved_for_surface=False)
    cases = [
        (report(), ("1 lift-off: the proved minimum", True)),
        (report(trajectory=parted), ("2 lift-offs: 1 proved, 1 more", False)),
        (report(solution=open_solution), ("1 lift-off; the minimum is not proved", None)),
    ]
    for case, expected in cases:
        assert expected in badges_of(case)
    faultless = replace(made.verdict, valid=True, faults=(), fault_counts={})
    assert ("judged valid", True) in badges_of(report(verdict=faultless))
    assert ("judged valid", True) not in badges_of(report())
    assert ("1 move not planned", False) in badges_of(report())
