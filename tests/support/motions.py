"""Scenes from file to trajectory, made once a session.

A flat ring about the robot's base, for an arm whose first joint hardly gets round.
"""

from __future__ import annotations

import re
from functools import cache

import numpy as np
from shipped import ROBOTS, WOK, shipped, with_keys

import cellcolor
from cellcolor.arrays import Array, Index
from cellcolor.frontend.scene import Scene


@cache
def planned(name: str, vertices: int) -> cellcolor.PlannedScene:
    """A motion over a shipped scene."""
    return cellcolor.plan(shipped(name, vertices))


_LIMIT = re.compile(r'lower="[^"]*" upper="[^"]*"')


def ring_mesh(around: int = 48) -> tuple[Array, Index]:
    """Vertices (n, 3) in m, and faces: three circles of vertices, joined."""
    vertices, faces = [], []
    for row, radius in enumerate((0.42, 0.47, 0.52)):
        for k in range(around):
            angle = 2 * np.pi * (k + row / 2) / around
            vertices.append([radius * np.cos(angle), radius * np.sin(angle), 0.0])
    for row in range(2):
        for k in range(around):
            a, b = row * around + k, row * around + (k + 1) % around
            faces += [[a, a + around, b], [b, a + around, b + around]]
    return np.array(vertices), np.array(faces)


def narrowed_arm(joint: str, limit: float) -> str:
    """The UR5's URDF with other limits of one joint, to both sides, rad."""
    text = (ROBOTS / "ur5.urdf").read_text()
    start = text.index(f'<joint name="{joint}"')
    limits = f'lower="{-limit}" upper="{limit}"'
    return text[:start] + _LIMIT.sub(limits, text[start:], count=1)


def ring_scene(limit: float) -> Scene:
    """The ring, 0.1 m above the base; the first joint turns so far to both sides, rad."""
    wok = Scene.read(WOK)
    setup = with_keys(wok.setup, spacing_m=0.02)
    setup = setup.varied(robot={"arm_urdf": narrowed_arm("shoulder_pan_joint", limit)})
    scene = wok.with_setup(setup).with_object(ring_mesh())
    scene = scene.moved(position_m=[0.0, 0.0, 0.1], rpy_rad=[0.0, 0.0, 0.0])
    return scene.varied(name="ring", ground={"height_m": -0.3})
