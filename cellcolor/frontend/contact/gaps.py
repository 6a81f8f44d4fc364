"""Gaps between bodies of the arm: lower bounds of their distances, all configurations at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import Poses, turned
from cellcolor.frontend.arm.robot import Robot

__all__ = ["gap_between"]


def gap_between(
    robot: Robot, pair: tuple[int, int], ends: Array, poses: Poses, rows: NDArray[np.intp]
) -> Array:
    """Lower bounds (rows,) of the distance between two bodies, m; at most 0 where they may touch.

    A solid stands in a box around it. The bound is the widest gap that two bodies leave along a
    line, of some lines: between the middles, and along the edges of the boxes (after Gottschalk,
    Lin and Manocha, OBBTree, 1996, who take nine more).

    Args:
        ends: of all bodies' axes, see :func:`~cellcolor.frontend.contact.collision.body_ends`.
        poses: of the joints.
        rows: of the configurations that are asked about.
    """
    bodies = [robot.bodies[index] for index in pair]
    sides = [
        _middle_and_edges(robot.bodies[index], ends[index][:, rows], poses, rows) for index in pair
    ]
    between = sides[1][0] - sides[0][0]
    solid = [edges for body, (_, edges) in zip(bodies, sides, strict=True) if body.solid]
    lines = np.concatenate([between[:, None], *solid], axis=1)
    lengths = np.sqrt(np.einsum("nlx,nlx->nl", lines, lines))
    lines /= np.where(lengths > 0, lengths, 1.0)[:, :, None]
    gaps = np.abs(np.einsum("nlx,nx->nl", lines, between))
    for body, (_, edges) in zip(bodies, sides, strict=True):
        along = np.abs(np.einsum("nlx,nkx->nlk", lines, edges))
        gaps -= along.sum(axis=2)
        if body.solid is not None:
            gaps -= body.skin
        elif body.flat:
            upright = 2 * along[:, :, 0] / body.length
            gaps -= body.radius * np.sqrt(np.maximum(1 - upright**2, 0.0))
        else:
            gaps -= body.radius
    return np.asarray(gaps.max(axis=1))


def _middle_and_edges(
    body: Body, ends: Array, poses: Poses, rows: NDArray[np.intp]
) -> tuple[Array, Array]:
    """Middle (n, 3) and halved edges (n, 3 or 1, 3) of a solid's box or another body's axis."""
    if body.solid is None:
        return ends.mean(axis=0), (ends[1:] - ends[:1]).swapaxes(0, 1) / 2
    corners, rotation = body.solid.corners, poses.body_rotation[rows, body.joint]
    middle = turned(rotation, corners.mean(axis=0)) + poses.body_origin[rows, body.joint]
    # The first corner's neighbors along the edges of the box.
    return middle, turned(rotation, (corners[[1, 2, 4]] - corners[0]).T / 2).swapaxes(1, 2)
