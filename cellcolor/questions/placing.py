"""``cellcolor.place``: the fewest lift-offs of a part in many places.

A part is read once and moved (:meth:`~cellcolor.frontend.prepared.PreparedScene.at`). Many
placements are tried on a coarse mesh, in batches that any process can do; the best ones are
then built and proved on the scene's own mesh. Points are Sobol's, which fill the ranges evenly:
some in the whole of them, then some in smaller and smaller boxes around the best ones.

Where a placement cannot be among the best, bounds replace a whole build, which tests the arm
between the vertices and takes a hundred times as long as at them. Each test only ever takes
candidates and links away. So the area where a candidate is valid at the vertices is the most that
can be covered. A segment is painted in one branch, on vertices that are joined by links without a
jump: as many of these regions as cover enough are needed at least.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from math import ceil

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_array, hstack, identity
from scipy.stats import qmc

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.frontend.build import StageClock, build_prepared, judged_at_vertices
from cellcolor.frontend.contact.engine import meet
from cellcolor.frontend.links import continuous_along
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.parts.remeshing import fold_angle, folds, length_for, remeshed
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.reach.colors import regions
from cellcolor.frontend.scene import Scene
from cellcolor.questions.placements import SAME_SHARE, VARIABLES, PlacedMinimum, Pose, Ranges
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options

_SLACK = 1e-6  # of a bound in floating point
_LONGEST = 10.0  # s for one bound; the best one known by then is a bound as well
_NOTHING = "the arm reaches nothing of it"
_FINE_ENOUGH = 1.5  # times the vertices that are wanted; a mesh up to there is not made coarser


def pose_of(placement: Placement) -> Pose:
    """A placement as six numbers."""
    return (*placement.position_m, *placement.rpy_rad)


def spread(ranges: Ranges, start: Pose, count: int, seed: int) -> list[Pose]:
    """Placements all over the ranges; a scrambled Sobol sequence."""
    # Sobol's balance is one of powers of two: the points after the last one are left out.
    whole = int(np.ceil(np.log2(max(count, 1))))
    points = qmc.Sobol(len(ranges), seed=seed).random_base2(whole)[:count]
    poses = np.tile(np.array(start), (len(points), 1))
    for column, (name, (low, high)) in enumerate(ranges.items()):
        poses[:, VARIABLES.index(name)] = low + (high - low) * points[:, column]
    return [tuple(pose) for pose in poses.tolist()]


def around(ranges: Ranges, best: Pose, share: float, count: int, seed: int) -> list[Pose]:
    """Placements in a box around one, whose sides are a share of the ranges."""
    near = {}
    for name, (low, high) in ranges.items():
        middle, half = best[VARIABLES.index(name)], share * (high - low) / 2
        near[name] = (max(low, middle - half), min(high, middle + half))
    return spread(near, best, count, seed)


def is_inside(ranges: Ranges, pose: Pose) -> bool:
    """Whether a placement is in all ranges."""
    return all(low <= pose[VARIABLES.index(name)] <= high for name, (low, high) in ranges.items())


def distance(ranges: Ranges, first: Pose, second: Pose) -> float:
    """How far two placements are apart: the largest difference, as a share of its range."""
    return max(
        abs(first[at] - second[at]) / (high - low)
        for name, (low, high) in ranges.items()
        for at in [VARIABLES.index(name)]
    )


def coarse_scene(scene: Scene, vertices: int, deadline: Deadline) -> Scene:
    """The scene with about this many vertices to be covered; bodies that can collide stay.

    A shape that says how many vertices it has gets fewer. Any other surface is remeshed; if it is
    so coarse that it folds over itself, it is remeshed to half as many vertices more, and so on up
    to the scene's own mesh.

    Raises:
        InputError: the scene cannot be used.
    """
    surface = scene.covered(deadline)
    if len(surface.vertices) <= _FINE_ENOUGH * vertices:
        return scene
    if hasattr(scene.object, "target_vertices") and scene.cover is None:
        solid = scene.solid_object or scene.object
        return scene.varied(object={"target_vertices": vertices}, collision_object=solid)
    angle = fold_angle(surface.mesh)
    own = len(folds(surface.vertices, surface.faces, angle))
    area, wanted = float(surface.mesh.vertex_areas.sum()), vertices
    while wanted * _FINE_ENOUGH < len(surface.vertices):
        length = length_for(area, wanted)
        wanted = math.ceil(wanted * _FINE_ENOUGH)
        try:
            points, faces, _ = remeshed(surface.vertices, surface.faces, length, deadline)
        except InputError:
            continue  # torn, for one
        if len(folds(points, faces, angle)) <= own:
            solid = scene.solid_object or scene.object
            return scene.varied(cover=None).with_object((points, faces), solid)
    return scene


def minima_at(
    scene: Scene,
    poses: Sequence[Pose],
    seconds: float,
    workers: int | None,
    seed: int,
    base: bool = False,
    cover: float | None = None,
) -> list[PlacedMinimum]:
    """The fewest lift-offs of a scene with its part in several places, a row for each.

    Where the part cannot stand the row says why.

    Args:
        scene: wherever it has its part.
        poses: where the part is put, or the arm's base.
        seconds: time limit; rows not reached by then are missing. Infinite for no limit.
        workers: of CP-SAT, None for its portfolio.
        base: whether the arm's base is moved instead of the part.
        cover: the share that is enough, for bounds instead of whole builds; None for these.

    Raises:
        InputError: the scene cannot be used, wherever the part stands.
    """
    deadline = Deadline.after(seconds)
    options = Options(deadline=deadline, workers=workers, seed=seed)
    prepared: PreparedScene | None = None
    rows = []
    for pose in poses:
        placement = Placement(position_m=pose[:3], rpy_rad=pose[3:])
        try:
            moved = scene.seen_from(placement) if base else scene.varied(placement=placement)
            if prepared is None:
                prepared = there = prepare(moved, deadline)
            else:
                there = prepared.at(moved)
            within = stands_in(there)
            if within is None and cover is None:
                rows.append(_minimum(there, pose, options))
            elif within is None:
                rows.append(_bounds(there, pose, cover or 0.0, deadline))
            else:
                rows.append(PlacedMinimum(pose, None, 0.0, False, 0, f"it would stand in {within}"))
        except OutOfTime:
            break
        except InputError as error:
            if prepared is None and not (error.field or "").startswith("placement"):
                raise  # it is the scene, wherever the part stands
            rows.append(PlacedMinimum(pose, None, 0.0, False, 0, error.message))
    return rows


def stands_in(prepared: PreparedScene) -> str | None:
    """What the part is in or touches: the ground or an obstacle; None if nothing."""
    vertices, ground = prepared.surface.vertices, prepared.ground
    if ground is not None and (ground.heights(vertices) < 0).any():
        return "the ground"
    for number, solid in enumerate(prepared.obstacles, 1):
        if meet(solid, prepared.target):
            return f"obstacle {number}"
    return None


def _bounds(prepared: PreparedScene, pose: Pose, cover: float, deadline: Deadline) -> PlacedMinimum:
    """The share that is covered at most, and the segments that covering enough takes at least.

    Where less can be covered no links are computed, and the second number is 1.
    """
    verdicts = judged_at_vertices(prepared, StageClock(deadline, None))
    areas, edges = prepared.surface.mesh.vertex_areas, prepared.surface.mesh.edges
    valid, count = verdicts.valid, len(areas)
    # Added up as a whole build adds: what is the same must not differ by rounding.
    most = float(areas[valid.any(axis=1)].sum() / areas.sum())
    if not most:
        return PlacedMinimum(pose, None, 0.0, False, count, _NOTHING)
    at_least = 1
    if most >= cover - SAME_SHARE:
        region = regions(valid, edges, continuous_along(prepared, edges, verdicts, deadline))
        # Slivers are given up, and what a tolerance refuses is not covered either: nobody knows yet
        # which. Without both all that is valid has to be covered.
        whole = prepared.setup.slivers is None and prepared.scene.tolerance is None
        weights = areas / areas.sum()
        at_least = _fewest(region, valid, weights, most if whole else cover, deadline)
    return PlacedMinimum(pose, None, most, False, count, at_least=at_least)


def _minimum(prepared: PreparedScene, pose: Pose, options: Options) -> PlacedMinimum:
    clock = StageClock(options.deadline, None)
    surface = build_prepared(prepared, clock).surface
    instance = decomposition_of(surface, deadline=options.deadline).instance
    areas = surface.vertex_areas
    share = float(areas[surface.colored].sum() / areas.sum())
    count = len(surface.vertices)
    if instance.nothing_to_cover:
        return PlacedMinimum(pose, None, 0.0, False, count, _NOTHING)
    solution = checked.solve(instance, options)
    return PlacedMinimum(pose, solution.segments, share, solution.proved_for_surface, count)


def _fewest(region: Index, valid: Mask, weights: Array, cover: float, deadline: Deadline) -> int:
    """How many regions cover a share at least.

    Args:
        region: (n, branches) the number of each candidate's region.
        valid: (n, branches) the candidates that count.
        weights: (n,) of the vertices, of sum 1.
    """
    vertices, branches = np.nonzero(valid)
    names, column = np.unique(region[vertices, branches], return_inverse=True)
    member = np.zeros((len(weights), len(names)), dtype=bool)
    member[vertices, column] = True
    places, own = np.unique(member, axis=0, return_inverse=True)
    area = np.bincount(own.ravel(), weights)
    # A place counts as far as regions that have it are chosen.
    chosen = hstack([csr_array(places, dtype=float), -identity(len(places))])
    enough = np.concatenate([np.zeros(len(names)), area])
    price = np.concatenate([np.ones(len(names)), np.zeros(len(places))])
    found = milp(
        price,
        integrality=price,
        bounds=Bounds(0, 1),
        constraints=[
            LinearConstraint(chosen, 0, np.inf),
            LinearConstraint(enough, cover - SAME_SHARE, np.inf),
        ],
        options={"time_limit": min(deadline.left, _LONGEST)},
    )
    bound = found.mip_dual_bound
    return 1 if bound is None or not np.isfinite(bound) else max(1, ceil(bound - _SLACK))
