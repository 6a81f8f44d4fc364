"""The tool's turn about its axis, by the rule that a setup has for it (docs/frontend.md)."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.setup import Turn

__all__ = ["angle_about", "turn_at", "turned_about"]

_LEAST_SHARE = 1e-6  # of a vector's length that its projection has to have, for a direction
_LEAST_LENGTH = 1e-6  # m; the same of the way to a point


def turn_at(turn: Turn, points: Array, directions: Array) -> Array:
    """Where the rule wants the tool's x axis, (n, 3) unit vectors across the tool.

    Args:
        turn: the rule; the first of its turns is not added.
        points: (n, 3) the tip, in the world, m.
        directions: (n, 3) unit vectors of the tool's z axis.

    Returns:
        NaN where the rule says nothing, since what it points along is along the tool.
    """
    if turn.along is not None:
        wanted = np.broadcast_to(np.array(turn.along) / np.linalg.norm(turn.along), points.shape)
        least = _LEAST_SHARE
    else:
        wanted, least = np.array(turn.towards_m) - points, _LEAST_LENGTH
    across = wanted - np.einsum("ni,ni->n", wanted, directions)[:, None] * directions
    lengths = np.linalg.norm(across, axis=1, keepdims=True)
    return np.asarray(np.where(lengths > least, across / np.maximum(lengths, least), np.nan))


def turned_about(directions: Array, across: Array, angles: Array) -> Array:
    """Vectors (n, 3) across unit vectors (n, 3), turned about these by angles (n,) in rad."""
    cosine, sine = np.cos(angles)[:, None], np.sin(angles)[:, None]
    return np.asarray(cosine * across + sine * np.cross(directions, across))


def angle_about(directions: Array, first: Array, second: Array) -> Array:
    """By which angle (n,) in rad, in (-pi, pi], second follows from first about unit vectors.

    All (n, 3); the first and the second may have parts along the unit vectors, which do not count.
    """
    sine = np.einsum("ni,ni->n", directions, np.cross(first, second))
    along = np.einsum("ni,ni->n", directions, first) * np.einsum("ni,ni->n", directions, second)
    return np.asarray(np.arctan2(sine, np.einsum("ni,ni->n", first, second) - along))
