"""From a scene file to a labelled surface."""

from __future__ import annotations

import importlib.metadata
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import cellcolor
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.frontend.collision import Mask
from cellcolor.frontend.continuity import Coloring, color, find_cracks, link, node_links
from cellcolor.frontend.generators import make_surface
from cellcolor.frontend.kinematics import (
    forward,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.report import BuildReport, make_report
from cellcolor.frontend.robot import Array, Robot, load_robot
from cellcolor.frontend.scene import Scene, Setup, load_scene, load_setup
from cellcolor.frontend.slivers import SliverReport, clean
from cellcolor.frontend.ur import BRANCHES, UrGeometry, solve_inverse, ur_geometry
from cellcolor.frontend.validity import judge

__all__ = ["BuildResult", "build_surface"]


@dataclass(frozen=True)
class BuildResult:
    """A labelled surface and all that was found on the way to it.

    Attributes:
        surface: what the decomposition takes.
        branches: names of the eight inverse-kinematic branches.
        configurations: (n, 8, 6) in rad, NaN where a branch has no solution.
        reasons: (n, 8) uint8 codes of :class:`~cellcolor.frontend.validity.Reason`, the first
            test that a candidate fails.
        node_color: (n, 8) the color of each valid candidate, -1 for the others and for those
            that a sliver policy took away.
        report: the same in numbers for people.
    """

    surface: LabelledSurface
    branches: tuple[str, ...]
    configurations: Array
    reasons: NDArray[np.uint8]
    node_color: NDArray[np.int64]
    report: BuildReport


def build_surface(scene_path: Path) -> BuildResult:
    """Compute which colors reach each point of a scene's object.

    Raises:
        InputError: the scene, its setup, a URDF or a mesh cannot be used; names file and field.
    """
    scene_path = Path(scene_path)
    scene = load_scene(scene_path)
    setup_path = scene_path.parent / scene.setup
    setup = load_setup(setup_path)
    robot = _load_robot(setup, setup_path)
    geometry = ur_geometry(robot)
    try:
        return _build(scene, setup, robot, geometry, scene_path)
    except InputError as error:
        if error.file:
            raise
        raise error.in_file(str(scene_path)) from error


def _load_robot(setup: Setup, setup_path: Path) -> Robot:
    files = setup.robot
    folder = setup_path.parent
    robot = load_robot(
        folder / files.arm_urdf, files.flange_link, folder / files.tool_urdf, files.tip_link
    )
    if not robot.lower[5] <= files.locked_joint_6_rad <= robot.upper[5]:
        raise InputError(
            str(setup_path), "robot.locked_joint_6_rad", "outside the limits of the sixth joint"
        )
    unknown = set(files.may_touch_ground) - {body.link for body in robot.bodies}
    if unknown:
        raise InputError(
            str(setup_path), "robot.may_touch_ground", f"no solid link {min(unknown)!r}"
        )
    return robot


def _build(
    scene: Scene, setup: Setup, robot: Robot, geometry: UrGeometry, scene_path: Path
) -> BuildResult:
    seconds: dict[str, float] = {}
    locked = setup.robot.locked_joint_6_rad

    def lap(stage: str, started: float) -> None:
        seconds[stage] = time.perf_counter() - started

    started = time.perf_counter()
    surface = make_surface(scene.object, scene_path.parent).placed(scene.placement)
    lap("surface", started)

    started = time.perf_counter()
    solutions = solve_inverse(geometry, surface.vertices, -surface.normals, locked)
    lap("inverse kinematics", started)

    candidates = judge(robot, setup, scene, surface, solutions)
    seconds |= candidates.seconds

    def probe(points: Array, directions: Array, branch: NDArray[np.intp]) -> tuple[Array, Mask]:
        solutions = solve_inverse(geometry, points, directions, locked)
        between = solutions[np.arange(len(branch)), branch]
        return between, _well_conditioned(robot, setup, between)

    started = time.perf_counter()
    edges = surface.edges()
    linked = link(surface, edges, candidates, setup.continuity, probe)
    valid, configurations = candidates.valid, candidates.configurations
    coloring = color(valid, configurations, node_links(edges, linked), BRANCHES)
    slivers = None
    if setup.slivers is not None:
        areas = surface.vertex_areas()
        kept, slivers = clean(edges, linked, coloring, areas, setup.slivers)
        linked &= kept[edges[:, 0]] & kept[edges[:, 1]]
        coloring = color(kept, configurations, node_links(edges, linked), BRANCHES)
    cracks = find_cracks(edges, linked, coloring)
    lap("continuity", started)

    labelled = LabelledSurface(
        name=scene.name,
        colors=coloring.names,
        vertices=surface.vertices,
        faces=surface.faces,
        vertex_colors=_vertex_colors(coloring),
        cracks=cracks,
        meta=_meta(scene, setup, seconds, slivers),
    )
    report = make_report(surface, candidates, coloring, BRANCHES, len(cracks), seconds, slivers)
    return BuildResult(
        surface=labelled,
        branches=BRANCHES,
        configurations=candidates.configurations,
        reasons=candidates.reasons,
        node_color=coloring.node_color,
        report=report,
    )


def _well_conditioned(robot: Robot, setup: Setup, configurations: Array) -> Mask:
    """Whether configurations (k, 6) exist and keep both conditioning thresholds, (k,)."""
    good = ~np.isnan(configurations[:, 0])
    poses = forward(robot, configurations[good])
    linear, angular = tip_jacobian(poses)
    determinant = task_determinant(linear, angular, poses.tool_axis)
    good[good] = (manipulability(linear) >= setup.thresholds.min_manipulability_m3) & (
        determinant >= setup.thresholds.min_task_determinant_m3
    )
    return good


def _vertex_colors(coloring: Coloring) -> tuple[tuple[int, ...], ...]:
    return tuple(
        tuple(sorted(int(number) for number in row if number >= 0)) for row in coloring.node_color
    )


def _meta(
    scene: Scene, setup: Setup, seconds: dict[str, float], slivers: SliverReport | None
) -> dict[str, Any]:
    packages = {"pin": "pin", "trimesh": "trimesh", "fcl": "python-fcl", "numpy": "numpy"}
    versions = {name: importlib.metadata.version(package) for name, package in packages.items()}
    done = {} if slivers is None else {"slivers": asdict(slivers)}
    return {
        "scene": scene.model_dump(mode="json"),
        "setup": setup.model_dump(mode="json"),
        "versions": {"cellcolor": cellcolor.__version__} | versions,
        "seconds": {stage: round(value, 4) for stage, value in seconds.items()},
    } | done
