"""A KUKA KR 6 R900 as vendors describe arms: a package, meshes, neither masses nor efforts."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import trimesh
from shipped import ROBOTS

from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup

PACKAGE = "kuka_kr6_support"


def write_package(folder: Path) -> Path:
    """The package ``kuka_kr6_support``; returns its URDF."""
    package = folder / PACKAGE
    (package / "urdf").mkdir(parents=True)
    (package / "meshes").mkdir()
    (package / "package.xml").write_text(f"<package><name>{PACKAGE}</name></package>")
    robot = prepare_arm(Setup.read(ROBOTS / "kr6_polishing.toml")).robot
    of_link: dict[str, list[Body]] = {}
    for body in robot.bodies:
        of_link.setdefault(body.link, []).append(body)
    text = (ROBOTS / "kr6.urdf").read_text(encoding="utf-8")
    text = re.sub(r"\s*<collision>.*?</collision>", "", text, flags=re.DOTALL)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"(<limit [^/]*)/>", r'\1 effort="0"/>', text)
    for link, bodies in of_link.items():
        if link == "tool_body":
            continue
        trimesh.util.concatenate([_mesh(body) for body in bodies]).export(
            package / "meshes" / f"{link}.stl"
        )
        shape = f'<geometry><mesh filename="package://{PACKAGE}/meshes/{link}.stl"/></geometry>'
        text = text.replace(
            f'<link name="{link}">',
            f'<link name="{link}"><visual>{shape}</visual><collision>{shape}</collision>',
        )
    file = package / "urdf" / "kr6r900sixx.urdf"
    file.write_text(text, encoding="utf-8")
    return file


def _mesh(body: Body) -> trimesh.Trimesh:
    segment = np.array([body.start, body.end])
    if body.flat:
        return trimesh.creation.cylinder(radius=body.radius, segment=segment, sections=16)
    mesh = trimesh.creation.capsule(height=body.length, radius=body.radius, count=[12, 12])
    mesh.apply_translation([0, 0, -mesh.bounds.mean(axis=0)[2]])
    along = (body.end - body.start) / body.length
    turn = trimesh.geometry.align_vectors([0, 0, 1], along)
    turn[:3, 3] = segment.mean(axis=0)
    return mesh.apply_transform(turn)
