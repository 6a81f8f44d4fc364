"""A unit box as a mesh, and meshes as OBJ texts.

Meshes with something wrong with them, made of simple shapes; in meters but for one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import trimesh

from cellcolor.arrays import Array, Index

BOX = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
OUTWARD = [
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
]  # fmt: skip


def obj(vertices: object, faces: list[list[int]]) -> str:
    lines = [f"v {x} {y} {z}" for x, y, z in np.asarray(vertices).tolist()]
    return "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]) + "\n"


Mesh = tuple[Array, Index]


def _mesh(mesh: trimesh.Trimesh) -> Mesh:
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64)


def _ball(subdivisions: int = 3, radius: float = 0.1) -> Mesh:
    return _mesh(trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius))


def _block() -> Mesh:
    box = trimesh.creation.box((0.2, 0.1, 0.06))
    return _mesh(box.subdivide_to_size(0.03))


def parts_with(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    first = np.cumsum([0, *[len(vertices) for vertices, _ in meshes]])
    faces = [own + start for (_, own), start in zip(meshes, first, strict=False)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(faces)


def holes() -> Mesh:
    """A ball without the faces around five of its vertices: borders of 6 edges or 5."""
    vertices, faces = _ball()
    far = [int(np.argmax(vertices @ way)) for way in np.vstack([np.eye(3), -np.eye(3)[:2]])]
    return vertices, faces[~np.isin(faces, far).any(axis=1)]


def duplicates() -> Mesh:
    """A block with 40 faces there twice, 10 of them the other way round."""
    vertices, faces = _block()
    again = faces[:40].copy()
    again[:10] = again[:10, ::-1]
    return vertices, np.concatenate([faces, again])


def mixed_winding() -> Mesh:
    """A torus of which every third face is turned."""
    vertices, faces = _mesh(trimesh.creation.torus(0.1, 0.03))
    faces[::3] = faces[::3, ::-1]
    return vertices, faces


def components() -> Mesh:
    """A ball and 499 specks of 1 mm around it."""
    random = np.random.default_rng(7)
    speck = _mesh(trimesh.creation.icosahedron())
    places = random.normal(size=(499, 3))
    places *= 0.2 / np.linalg.norm(places, axis=1, keepdims=True)
    return parts_with(_ball(), *((0.001 * speck[0] + place, speck[1]) for place in places))


def millimeters() -> Mesh:
    """A block in millimeters, each triangle with vertices of its own, as in STL."""
    vertices, faces = _block()
    return 1000 * vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)


def needles() -> Mesh:
    """A block whose edges carry vertices that only flat faces have, some nearly on a corner."""
    vertices, faces = _block()
    points, made = [*vertices], []
    for number, (a, b, c) in enumerate(faces.tolist()):
        if number % 5:
            made.append((a, b, c))
            continue
        # The face as before, but the side from a to b belongs to a flat face.
        share = (0.5, 0.3, 1e-5)[number // 5 % 3]
        middle = len(points)
        points.append((1 - share) * vertices[a] + share * vertices[b])
        made += [(a, middle, c), (middle, b, c), (a, b, middle)]
    return np.array(points), np.array(made)


def fin() -> Mesh:
    """A ball with a small sheet that stands on a row of its edges."""
    vertices, faces = _ball()
    tip, second = faces[0, :2]
    outward = vertices[[tip, second]] * 1.1
    count = len(vertices)
    sheet = [(tip, second, count), (second, count + 1, count)]
    return np.concatenate([vertices, outward]), np.concatenate([faces, sheet])


def crossing() -> Mesh:
    """Two blocks that were never united, one through the other."""
    vertices, faces = _block()
    return parts_with((vertices, faces), (vertices[:, [1, 2, 0]] + 0.011, faces))


def inverted() -> Mesh:
    """A ball inside out."""
    vertices, faces = _ball()
    return vertices, faces[:, ::-1]


def million() -> Mesh:
    """A wavy sheet of a square meter, 1,000,000 triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, 1001), np.linspace(0, 1, 501), indexing="ij")
    height = 0.05 * np.sin(6 * x) * np.cos(5 * y)
    number = np.arange(x.size).reshape(x.shape)
    a, b = number[:-1, :-1].ravel(), number[1:, :-1].ravel()
    c, d = number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return np.column_stack([x.ravel(), y.ravel(), height.ravel()]), faces


DIRTY: dict[str, Callable[[], Mesh]] = {
    "holes": holes,
    "duplicates": duplicates,
    "mixed-winding": mixed_winding,
    "components": components,
    "millimeters": millimeters,
    "needles": needles,
    "fin": fin,
    "crossing": crossing,
    "inverted": inverted,
    "million": million,
}
