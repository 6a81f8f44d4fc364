"""Curves and points to draw on two axes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Curve:
    """Points that belong together.

    Attributes:
        label: for the legend.
        points: x and y of each, in the order in which they are joined.
    """

    label: str
    points: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Plot:
    """What is to be drawn.

    Attributes:
        title: above it.
        x, y: what the axes are.
        curves: one color each.
        log_x, log_y: whether an axis is logarithmic.
        joined: how points are joined: by lines, by steps that go up at their points, or not at all.
        diagonal: whether to draw the line on which both are equal.
        note: below it, in a sentence.
    """

    title: str
    x: str
    y: str
    curves: tuple[Curve, ...]
    log_x: bool = False
    log_y: bool = False
    joined: str = "lines"
    diagonal: bool = False
    note: str = ""
