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
from cellcolor.frontend.between import at_domain_border, longest_steps, remains_valid
from cellcolor.frontend.collision import Mask
from cellcolor.frontend.continuity import (
    Coloring,
    color,
    find_cracks,
    link,
    node_links,
    stays_in_limits,
)
from cellcolor.frontend.kinematics import (
    forward,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.prepare import Stage, prepare
from cellcolor.frontend.report import BuildReport, make_report
from cellcolor.frontend.robot import Array, Robot
from cellcolor.frontend.scene import Scene, Setup
from cellcolor.frontend.slivers import SliverReport, clean
from cellcolor.frontend.survey import survey
from cellcolor.frontend.ur import BRANCHES
from cellcolor.frontend.validity import Candidates, Reason

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
    started = time.perf_counter()
    stage = prepare(scene_path)
    try:
        return _build(stage, {"preparation": time.perf_counter() - started})
    except InputError as error:
        if error.file:
            raise
        raise error.in_file(str(scene_path)) from error


def _build(stage: Stage, seconds: dict[str, float]) -> BuildResult:
    scene, setup, robot, surface, judge = (
        stage.scene,
        stage.setup,
        stage.robot,
        stage.surface,
        stage.judge,
    )
    started = time.perf_counter()

    def lap(name: str) -> None:
        nonlocal started
        now = time.perf_counter()
        seconds[name] = now - started
        started = now

    solutions = stage.inverse(surface.vertices, -surface.normals)
    lap("inverse kinematics")
    edges = surface.edges()
    verdicts = judge(solutions.reshape(-1, solutions.shape[2]))
    seconds |= judge.seconds  # a copy: the judge goes on being asked
    candidates = Candidates(
        verdicts.configurations.reshape(solutions.shape),
        verdicts.reasons.reshape(solutions.shape[:2]),
        verdicts.determinants.reshape(solutions.shape[:2]),
    )
    valid, configurations = candidates.valid, candidates.configurations

    def probe(points: Array, directions: Array, branch: NDArray[np.intp]) -> tuple[Array, Mask]:
        between = stage.follow(points, directions, branch)
        return between, _well_conditioned(robot, setup, between)

    def test(points: Array, directions: Array, branch: NDArray[np.intp]) -> tuple[Mask, Array]:
        found = judge(stage.follow(points, directions, branch))
        return np.asarray(found.reasons == Reason.VALID), found.ends

    started = time.perf_counter()
    linked = link(surface, edges, candidates, setup.continuity, probe)
    i, j = edges.T
    if setup.constraints.collision:
        rows, branches = np.nonzero(linked)
        first, second = (configurations[ends[rows], branches] for ends in (i, j))
        linked[rows, branches] = stays_in_limits(robot.lower, robot.upper, first, second)
    lap("continuity")
    spacing = setup.continuity.validity_spacing_m
    if spacing is not None:
        rows, branches = np.nonzero(linked)
        near_border = at_domain_border(edges, valid)[rows, branches]
        parts = np.maximum(np.ceil(surface.lengths(edges[rows]) / spacing).astype(int), 2)
        pieces = np.where(near_border, parts, 1)
        ends = verdicts.ends.reshape(-1, *valid.shape, 3)
        longest = longest_steps(judge.end_radii)
        linked[rows, branches] &= remains_valid(
            surface, edges[rows], branches, pieces, ends, longest, test
        )
        lap("validity between vertices")
    coloring = color(valid, configurations, node_links(edges, linked), BRANCHES)
    slivers = None
    if setup.slivers is not None:
        areas = surface.vertex_areas()
        kept, slivers = clean(edges, linked, coloring, areas, setup.slivers)
        linked &= kept[i] & kept[j]
        coloring = color(kept, configurations, node_links(edges, linked), BRANCHES)
    cracks = find_cracks(edges, linked, coloring)
    lap("colors and cracks")

    labelled = LabelledSurface(
        name=scene.name,
        colors=coloring.names,
        vertices=surface.vertices,
        faces=surface.faces,
        vertex_colors=_vertex_colors(coloring),
        cracks=cracks,
        meta=_meta(scene, setup, seconds, slivers),
        given_up=_given_up(valid, coloring),
    )
    where = survey(surface, stage.geometry)
    report = make_report(
        where, surface, candidates, coloring, BRANCHES, len(cracks), seconds, slivers
    )
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
    if not setup.constraints.conditioning:
        return good
    good[good] = (manipulability(linear) >= setup.thresholds.min_manipulability_m3) & (
        determinant >= setup.thresholds.min_task_determinant_m3
    )
    return good


def _vertex_colors(coloring: Coloring) -> tuple[tuple[int, ...], ...]:
    return tuple(
        tuple(sorted(int(number) for number in row if number >= 0)) for row in coloring.node_color
    )


def _given_up(valid: Mask, coloring: Coloring) -> tuple[int, ...]:
    """The vertices that are reachable and were left without any color."""
    lost = valid.any(axis=1) & (coloring.node_color < 0).all(axis=1)
    return tuple(np.flatnonzero(lost).tolist())


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
