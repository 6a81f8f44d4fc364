"""Families of surfaces as hard as those of real scenes: they are what solvers are compared on.

Each is a function of a seed: :func:`~cellcolor.lab.families.blobs.blobs`, whose arguments are
explained there, with some of them chosen.
"""

from __future__ import annotations

from functools import partial

from cellcolor.lab.families.blobs import blobs

more_waves = partial(blobs, waves=1.0)
cracks = partial(blobs, cracks=4)
islands_and_holes = partial(blobs, holes=3, islands=3)
rim = partial(blobs, rim=8, coverage=(0.6, 0.9))
thin = partial(blobs, thin=True, colors=5)
points_48 = partial(blobs, size=48, colors=8, waves=1.2)
points_64 = partial(blobs, size=64, colors=10, waves=1.6)
