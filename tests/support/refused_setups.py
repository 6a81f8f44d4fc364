"""Setups that a scene cannot be built with."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellcolor.errors import InputError
from cellcolor.frontend import Scene, build_surface


def refused_setup(path: Path, **changes: dict[str, object]) -> InputError:
    """The one line in which a scene is refused once its setup is changed."""
    scene = Scene.read(path).varied(object={"target_vertices": 20})
    with pytest.raises(InputError) as caught:
        build_surface(scene.with_setup(scene.setup.varied(**changes)))
    assert "\n" not in str(caught.value)
    return caught.value
