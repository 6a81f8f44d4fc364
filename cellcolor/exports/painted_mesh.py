"""The painted surface as PLY and as GLB (binary glTF), each vertex in the color of its segment.

Vertices and faces are those of the painted surface, in the same order. Both formats interpolate the
colors of vertices, so between two segments there is a row of triangles with mixed colors.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from cellcolor.exports.interface import PlannedMotion
from cellcolor.files.writing import FileKind

_MARK = "cellcolor/painted-mesh"

# glTF has +y up; the world of a scene has +z up.
_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])

PLY = FileKind(
    "a painted mesh written by cellcolor",
    re.compile(rb"ply\nformat [^\n]*\ncomment " + _MARK.encode()),
)
GLB = FileKind(
    "a painted mesh written by cellcolor", re.compile(rb"glTF.*" + _MARK.encode(), re.DOTALL)
)


def ply(planned: PlannedMotion) -> bytes:
    """Binary PLY with vertex colors, m, in the world of the scene."""
    content: bytes = _mesh(planned).export(file_type="ply", vertex_normal=False)
    head, _, rest = content.partition(b"\n")
    form, _, rest = rest.partition(b"\n")
    return b"\n".join([head, form, b"comment " + _MARK.encode(), rest])


def glb(planned: PlannedMotion) -> bytes:
    """Binary glTF with vertex colors, m; a node turns the scene's +z into glTF's +y."""
    import trimesh

    scene = trimesh.Scene(metadata={"made_by": _MARK})
    scene.add_geometry(_mesh(planned), geom_name="painted", node_name="painted", transform=_UP)
    content: bytes = scene.export(file_type="glb")
    return content


def _mesh(planned: PlannedMotion) -> Any:
    import trimesh

    return trimesh.Trimesh(
        planned.surface.vertices,
        planned.surface.faces,
        vertex_colors=planned.colors,
        process=False,
    )
