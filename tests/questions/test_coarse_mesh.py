"""The coarse mesh on which placements are tried first."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import trimesh
from shipped import SCENES, shipped

from cellcolor.deadline import NEVER
from cellcolor.errors import InputError
from cellcolor.frontend import Scene
from cellcolor.frontend.parts.remeshing import expected_vertices
from cellcolor.questions import placing
from cellcolor.questions.placing import coarse_scene

pytestmark = pytest.mark.second


def test_a_mesh_file_is_made_coarser_and_collides_as_before() -> None:
    scene = Scene.read(SCENES.parent / "parts" / "bracket.toml")
    coarse = coarse_scene(scene, 150, NEVER)
    whole, surface = scene.covered(), coarse.covered()
    assert len(surface.vertices) < len(whole.vertices) / 1.5
    area, wanted = surface.mesh.vertex_areas.sum(), whole.vertex_areas().sum()
    assert area == pytest.approx(wanted, rel=0.05)
    assert coarse.solid_object == (scene.solid_object or scene.object)
    assert coarse_scene(scene, 10**5, NEVER).covered().vertices.shape == whole.vertices.shape


def test_a_mesh_so_coarse_that_it_folds_is_not_used(monkeypatch: pytest.MonkeyPatch) -> None:
    """The remesher, told to fold what is coarse: the first mesh without a fold; at last its own."""
    ball = trimesh.creation.icosphere(3, 0.05)
    scene = shipped("wok", 60).with_object((np.array(ball.vertices), np.array(ball.faces)))
    coarse = trimesh.creation.icosphere(1, 0.05)
    asked: list[float] = []

    def remeshed(_vertices: Any, _faces: Any, length: float, _deadline: Any) -> Any:
        asked.append(expected_vertices(ball.area, length))
        if len(asked) == 1:
            raise InputError(None, "edge_length_m", "torn")
        points = np.array(coarse.vertices)
        if len(asked) < never_folded:
            beside = next(corner for face in coarse.faces if 0 in face for corner in face if corner)
            points[0] = 2 * points[beside] - points[0]  # over its neighbor
        return points, np.array(coarse.faces), None

    monkeypatch.setattr(placing, "remeshed", remeshed)
    never_folded = 3
    surface = coarse_scene(scene, 100, NEVER).covered()
    assert len(surface.vertices) == len(coarse.vertices)
    assert asked == pytest.approx([100, 150, 225], rel=0.01)
    asked.clear()
    never_folded = 99
    assert len(coarse_scene(scene, 100, NEVER).covered().vertices) == len(ball.vertices)
