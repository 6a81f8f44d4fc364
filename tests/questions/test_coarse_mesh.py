"""The coarse mesh on which placements are tried first."""

from __future__ import annotations

import pytest
from shipped import SCENES

from cellcolor.deadline import NEVER
from cellcolor.frontend import Scene
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
