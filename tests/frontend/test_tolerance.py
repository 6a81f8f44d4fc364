"""A part that may stand off: displacements, and colors that hold at all of them."""

from __future__ import annotations

import numpy as np
import pytest
from commands import run
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped import shipped

import cellcolor
from cellcolor.deadline import NEVER
from cellcolor.frontend import Scene
from cellcolor.frontend.build import OFF, StageClock, build_prepared
from cellcolor.frontend.parts.placement import Placement, Tolerance
from cellcolor.frontend.prepared import prepare
from examples import examples

NUMBERS = st.floats(-1, 1)
THREE = st.tuples(NUMBERS, NUMBERS, NUMBERS)
OFTEN = {"position_m": 0.01, "rotation_rad": 0.05, "samples": 4}


def frame(placement: Placement) -> tuple[Rotation, np.ndarray]:
    return Rotation.from_euler("xyz", placement.rpy_rad), np.array(placement.position_m)


@examples(50)
@given(
    position=THREE,
    rpy=THREE,
    center=THREE,
    shift=st.floats(0, 0.1),
    turn=st.floats(0, 3),
)
def test_displacements_are_within_the_tolerance_about_the_center(
    position: tuple[float, ...],
    rpy: tuple[float, ...],
    center: tuple[float, ...],
    shift: float,
    turn: float,
) -> None:
    """By scipy's rotations: where the center goes, and by what angle the part is turned."""
    before = Placement(position_m=position, rpy_rad=rpy)
    tolerance = Tolerance(position_m=shift + 1e-6, rotation_rad=turn, samples=6)
    rotation, at = frame(before)
    displaced = tolerance.displaced(before, np.array(center))
    assert len(displaced) == 6
    for after in displaced:
        turned, there = frame(after)
        motion = turned * rotation.inv()
        moved = motion.apply(np.array(center) - at) + there - center
        far, angle = np.linalg.norm(moved), motion.magnitude()
        assert far == pytest.approx(shift + 1e-6, abs=1e-9)
        assert angle == pytest.approx(turn, abs=1e-6)


def test_the_sample_is_always_the_same_and_favors_no_side() -> None:
    tolerance = Tolerance(position_m=0.1, samples=8)
    before = Placement(position_m=(0, 0, 0))
    found = tolerance.displaced(before, np.zeros(3))
    assert found == tolerance.displaced(before, np.zeros(3))
    assert np.allclose(np.sum([one.position_m for one in found], axis=0), 0)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return shipped("wok_obstacle", 60)


@pytest.mark.second
def test_colors_hold_wherever_the_part_may_stand(scene: Scene) -> None:
    """Against the scene with each displacement written in, built by itself."""
    asked = prepare(scene.varied(tolerance=OFTEN))
    built = build_prepared(asked, StageClock(NEVER, None))
    own = build_prepared(prepare(scene), StageClock(NEVER, None))
    valid, linked = own.verdicts.valid.copy(), own.all_colors.linked.copy()
    places = [there.scene.placement for there in asked.displaced()]
    assert len(places) == OFTEN["samples"]
    for placement in places:
        there = build_prepared(prepare(scene.varied(placement=placement)), StageClock(NEVER, None))
        valid &= there.verdicts.valid
        linked &= there.all_colors.linked
    assert (built.verdicts.valid == valid).all()
    assert (built.all_colors.linked == linked).all()
    lost = own.verdicts.valid & ~valid
    assert lost.any()
    off = built.verdicts.reason_names.index(OFF)
    assert ((built.verdicts.reasons == off) == lost).all()
    assert (built.verdicts.reasons[~lost] == own.verdicts.reasons[~lost]).all()


def test_the_note_says_that_it_is_a_sample(scene: Scene) -> None:
    result = cellcolor.solve(scene.varied(tolerance=OFTEN))
    assert any("a sample of 4 displacements by 10 mm" in note for note in result.solution.notes)
    assert not any("displacements" in note for note in cellcolor.solve(scene).solution.notes)


def test_a_scene_without_a_tolerance_is_written_as_before(scene: Scene) -> None:
    assert "tolerance" not in scene.model_dump(mode="json")
    assert scene.varied(tolerance=OFTEN).model_dump(mode="json")["tolerance"] == OFTEN


@pytest.mark.parametrize("table", [{}, {"position_m": -1}, {"rotation_rad": float("nan")}])
def test_what_is_no_tolerance_is_refused(scene: Scene, table: dict[str, float]) -> None:
    with pytest.raises(cellcolor.InputError, match="tolerance"):
        scene.varied(tolerance=table)


def test_the_option_has_units(capsys: pytest.CaptureFixture[str]) -> None:
    for wrong in ("2", "2mm,0.5", "2mm,3mm", "mm", "2 furlongs", "--2mm", ""):
        assert run("solve", "wok", f"--tolerance={wrong}") == 2
        said = capsys.readouterr().err
        assert "with units, such as 2mm,0.5deg" in said and "Traceback" not in said
    assert run("solve", "wok.json", "--tolerance=2mm") == 2
    assert "is no scene" in capsys.readouterr().err
    from cellcolor.cli.inputs import with_tolerance
    from cellcolor.door.installed import find_file

    both = with_tolerance(find_file("wok"), "2mm,0.5deg").tolerance
    same = with_tolerance(find_file("wok"), "0.00872664625997rad, 0.002m").tolerance
    assert both is not None and same is not None
    assert both.position_m == same.position_m == 0.002
    assert both.rotation_rad == pytest.approx(same.rotation_rad)
    # What is not given is 0: the part is shifted only, or turned only.
    shifted = with_tolerance(find_file("wok"), "2mm").tolerance
    turned = with_tolerance(find_file("wok"), "0.5deg").tolerance
    assert shifted is not None and turned is not None
    assert (shifted.position_m, shifted.rotation_rad) == (0.002, 0)
    assert (turned.position_m, turned.rotation_rad) == (0, both.rotation_rad)
