"""Small valid documents of every format, to be broken by tests."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

from cellcolor.data import value
from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict

Document = dict[str, Any]

SURFACE: Document = {
    "format": "cellcolor/labelled-surface",
    "version": 2,
    "name": "square",
    "colors": ["red", "blue"],
    "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    "faces": [[0, 1, 2], [0, 2, 3]],
    "vertex_colors": [[0, 1], [0, 1], [0, 1], []],
    "cracks": [[0, 2, [0]]],
    "given_up": [3],
    "meta": {"made": "by hand"},
}

INSTANCE: Document = {
    "format": "cellcolor/instance",
    "version": 2,
    "name": "pair",
    "colors": ["red", "blue"],
    "cells": [
        {"id": 0, "colors": [0], "loops": [[1, 2]], "area": 0.5},
        {"id": 1, "colors": [0, 1], "loops": [[-1, 3], [4, -4]]},
    ],
    "edges": [
        {"id": 1, "left": 0, "right": 1, "length": 1.5},
        {"id": 2, "left": 0, "right": -1},
        {"id": 3, "left": 1, "right": -1},
        {"id": 4, "left": 1, "right": 1, "colors": [0]},
    ],
    "meta": {"source": "by hand"},
    "surface": {"path": "pair.surface.json", "vertex_cell": [0, 1, -1], "sha256": "0" * 64},
    "coverage": {"area_m2": 2.0, "unreachable": 0.25, "given_up": 0.125},
    "known": {"paper": {"segments": 1, "schemes": 1}, "surface": {"segments": 1}},
}

SOLUTION: Document = {
    "format": "cellcolor/solution",
    "version": 3,
    "instance": {"name": "pair", "sha256": "0" * 64},
    "search_space": "surface",
    "strands": 2,
    "solver": "cp-sat",
    "status": "optimal",
    "segments": 1,
    "lift_offs": 0,
    "lower_bound": 1,
    "surface_lower_bound": 1,
    "proved_for_surface": True,
    "bounds": [
        {"kind": "cover", "value": 1, "holds_for": "surface", "certificate": {"regions": []}}
    ],
    "model": {"variables": 40, "constraints": 90},
    "coverage": {"area_m2": 2.0, "unreachable": 0.25, "given_up": 0.125},
    "notes": ["The model was too large to be built."],
    "seams": [{"id": 5, "cell": 1, "from": 3, "to": -4, "strands": 2}],
    "cells": [
        {"id": 0, "subcells": [{"color": 0, "darts": [[1, 1], [1, 2]], "segment": 0}]},
        {"id": 1, "subcells": [{"color": 0, "darts": [[-1, 2], [-1, 1]], "segment": 0}]},
    ],
    "seconds": 0.25,
}

PLAN: Document = {
    "format": "cellcolor/plan",
    "version": 1,
    "vertex_colors": [0, 0, 1, None],
}

TRAJECTORY: Document = {
    "format": "cellcolor/trajectory",
    "version": 1,
    "name": "three samples",
    "joint_names": ["pan", "lift"],
    "times": [0.0, 0.5, 1.0],
    "joints": [[0.0, 1.0], [0.25, 1.5], [0.5, 1.0]],
    "points": [[0.0, 0.0, 1.0], [0.5, 0.0, 1.0], [1.0, 0.0, 1.0]],
    "normals": [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]],
    "contact": [True, False, True],
    "segment": [0, -1, 0],
    "unplanned": [1],
    "extra_lift_offs": [
        {
            "sample": 0,
            "segment": 0,
            "reason": "winding",
            "text": "pan would run out of its limits",
            "place": [0.0, 0.0, 1.0],
        }
    ],
    "left_out": [
        {"segment": 0, "area_m2": 0.5, "reason": "torque", "place": [0.5, 0.0, 1.0]},
    ],
    "repeated": [{"sample": 2, "last_sample": 2, "reason": "narrow"}],
    "meta": {"made": "by hand"},
}

VERDICT: Document = {
    "format": "cellcolor/trajectory-verdict",
    "version": 1,
    "valid": False,
    "name": "three samples",
    "samples": 3,
    "tested": 101,
    "timed": True,
    "seconds": 1.0,
    "strokes": 2,
    "lift_offs": 1,
    "claimed_extra": 1,
    "minimum_lift_offs": 0,
    "unclaimed_extra": 0,
    "fault_counts": {"jump": 1},
    "faults": [
        {
            "kind": "jump",
            "text": "pan moves by 6.283 rad to the next sample",
            "sample": 0,
            "last_sample": 1,
            "time": 0.0,
            "joint": "pan",
            "reason": None,
            "place": [0.0, 0.0, 1.0],
        }
    ],
    "covered": {
        "reachable_m2": 2.0,
        "spacing_m": 0.25,
        "covered_share": 0.5,
        "closely_covered_share": 0.25,
        "left_out_share": 0.125,
        "uncovered_m2": 0.75,
        "mean_visits": 1.5,
        "most_visits": 2,
        "visited_again_share": 0.25,
        "repeated_m": 0.25,
        "stated_repeated_m": 0.125,
        "length_m": 4.0,
        "length_times_spacing_per_area": 0.5,
    },
    "notes": ["The setup has no [motion], so accelerations are not judged."],
    "feeds": [
        {
            "segment": 0,
            "time": 0.5,
            "seconds": 2.0,
            "asked_m_per_s": 0.25,
            "mean_m_per_s": 0.125,
            "lowest_m_per_s": 0.0625,
            "window_m": 0.03125,
            "slow_share": 0.75,
            "joint": "pan",
            "limited_by": "acceleration",
        }
    ],
}


Change = Callable[[Document], object]


def broken(document: Document, change: Change) -> Document:
    """A copy with one change made to it."""
    changed = copy.deepcopy(document)
    change(changed)
    return changed


def put(*path: str | int, to: Any) -> Change:
    """Set one element, or add it."""

    def change(document: Document) -> None:
        place: Any = document
        for step in path[:-1]:
            place = place[step]
        place[path[-1]] = to

    return change


def drop(*path: str | int) -> Change:
    """Remove one element."""

    def change(document: Document) -> None:
        place: Any = document
        for step in path[:-1]:
            place = place[step]
        del place[path[-1]]

    return change


TOOL_PATHS: dict[str, Any] = {
    "format": "cellcolor/tool-paths",
    "version": 1,
    "name": "triangle",
    "pattern": "contour",
    "spacing_m": 0.01,
    "tool_radius_m": 0.015,
    "surface_sha256": "0" * 64,
    "paths": [
        {
            "segment": 0,
            "color": 1,
            "points": [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.3, 0.4, 0.0]],
            "normals": [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]],
            "faces": [0, 0],
        }
    ],
}

KINDS: dict[type[value.Document], Document] = {
    LabelledSurface: SURFACE,
    Instance: INSTANCE,
    Solution: SOLUTION,
    Plan: PLAN,
    Trajectory: TRAJECTORY,
    TrajectoryVerdict: VERDICT,
    ToolPaths: TOOL_PATHS,
}
