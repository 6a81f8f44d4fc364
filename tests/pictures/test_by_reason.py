"""Surfaces by the reason why points are out of reach."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pages import (
    DRAWN,
    meshes,
    needs_frontend,
    show,
    side_file,
    small_wok,
    vertices_in,
)

pytest.importorskip("matplotlib")
pytest.importorskip("plotly")


class TestReasons:
    def test_of_a_side_file(self, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--reason", "-o", tmp_path / "x.html")
        found = {n: vertices_in(t, DRAWN) for n, t in meshes(tmp_path / "x.html").items()}
        valid = {v for v, row in enumerate(arrays["node_color"]) if (row >= 0).any()}
        assert found == {
            "reachable": valid,
            "ground": set(range(30)) - valid - {29},
            "given up": {29},
        }

    @pytest.mark.parametrize("branch", ["right arm", "1"])
    def test_of_one_branch(self, branch: str, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--reason", "--branch", branch, "-o", tmp_path / "x.html")
        found = {n: vertices_in(t, DRAWN) for n, t in meshes(tmp_path / "x.html").items()}
        codes = arrays["reasons"][:, 1]
        names = {"valid": 0, "torque": 2, "ground": 3}
        assert found == {n: set(np.flatnonzero(codes == c).tolist()) for n, c in names.items()}

    @needs_frontend
    def test_of_a_scene(self, tmp_path: Path) -> None:
        from reasons import Reason

        from cellcolor.frontend import build_surface

        scene = small_wok(tmp_path)
        show(scene, "--reason", "--branch", "0", "-o", tmp_path / "x.html")
        result = build_surface(scene)
        found = meshes(tmp_path / "x.html")
        taken = result.node_color[:, 0] < 0
        for reason in Reason:
            if reason != Reason.VALID:
                own = set(np.flatnonzero(result.reasons[:, 0] == reason).tolist())
                trace = found.get(reason.text)
                assert own == (vertices_in(trace, result.surface) if trace else set())
        valid = np.flatnonzero((result.reasons[:, 0] == Reason.VALID) & ~taken)
        assert vertices_in(found["valid"], result.surface) == set(valid.tolist())
