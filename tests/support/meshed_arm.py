"""The UR5 with meshes as collision shapes, written as vendors do it: in a package, in mm."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import trimesh
from shipped import ROBOTS

from cellcolor.arrays import Array

# In the frames of the links; boxes by size and middle, tubes along x by radii, length and middle.
_BOXES = {
    "shoulder_link": [((0.1, 0.16, 0.1), (0, -0.04, 0))],
    # Bent like a U, so that its hull is far from it.
    "forearm_link": [
        ((0.36, 0.07, 0.06), (-0.196, 0, 0.016)),
        ((0.05, 0.07, 0.13), (-0.39, 0, 0.05)),
        ((0.05, 0.07, 0.13), (-0.01, 0, 0.05)),
    ],
    "wrist_1_link": [((0.07, 0.12, 0.07), (0, -0.03, 0))],
    "wrist_2_link": [((0.07, 0.1, 0.07), (0, 0.02, 0))],
    "wrist_3_link": [((0.06, 0.06, 0.03), (0, 0, -0.02))],
}
_TUBES = {"upper_arm_link": (0.03, 0.055, 0.5, (-0.2125, 0, 0.13585))}


def link_meshes() -> dict[str, trimesh.Trimesh]:
    """The mesh of each link, in its frame, m."""
    found = {"base_link": trimesh.creation.cylinder(radius=0.07, height=0.11, sections=24)}
    for link, boxes in _BOXES.items():
        parts = []
        for size, middle in boxes:
            part = trimesh.creation.box(size)
            part.apply_translation(middle)
            parts.append(part)
        found[link] = trimesh.util.concatenate(parts)
    for link, (inner, outer, length, middle) in _TUBES.items():
        tube = trimesh.creation.annulus(inner, outer, length, sections=20)
        tube.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0)))
        tube.apply_translation(middle)
        found[link] = tube
    return found


def write_package(folder: Path, name: str, suffix: str = ".stl") -> Path:
    """A package with the arm; returns the folder of the package, the arm is urdf/arm.urdf."""
    package = folder / name
    for part in ("urdf", "meshes"):
        (package / part).mkdir(parents=True)
    (package / "package.xml").write_text(f"<package><name>{name}</name></package>")
    text = (ROBOTS / "ur5.urdf").read_text()
    for link, mesh in link_meshes().items():
        in_millimeters = mesh.copy()
        in_millimeters.apply_scale(1000)
        in_millimeters.export(package / "meshes" / f"{link}{suffix}")
        text = with_collision(
            text,
            link,
            f'<mesh filename="package://{name}/meshes/{link}{suffix}" scale="1e-3 1e-3 1e-3"/>',
        )
    (package / "urdf" / "arm.urdf").write_text(text)
    return package


def with_collision(text: str, link: str, geometry: str, origin: str = "") -> str:
    """A URDF's text with one collision shape for a link in the place of its own."""

    def changed(found: re.Match[str]) -> str:
        bare = re.sub(r"\s*<collision>.*?</collision>", "", found.group(), flags=re.DOTALL)
        own = f"<collision>{origin}<geometry>{geometry}</geometry></collision>"
        return bare.replace("</link>", f"{own}</link>")

    return re.sub(rf'<link name="{link}">.*?</link>', changed, text, flags=re.DOTALL)


def is_inside(link: str, point: Array) -> bool:
    """Whether a point (3,) of a link's frame is in its material, but for slivers at round sides."""
    if link in _BOXES:
        return any((abs(point - at) <= np.array(size) / 2).all() for size, at in _BOXES[link])
    if link in _TUBES:
        inner, outer, length, middle = _TUBES[link]
        along, *across = point - middle
        return bool(abs(along) <= length / 2 and inner <= np.hypot(*across) <= outer)
    return bool(np.hypot(point[0], point[1]) <= 0.07 and abs(point[2]) <= 0.055)
