"""Parts as a robot scene leaves them without a sliver policy: many cells, many local colors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.errors import InputError
from cellcolor.lab.families.meshes import sphere

BRANCH_COUNT = 8
CREASES = 4
ROUGHNESS = (0.3, 0.2, 0.15, 0.12, 0.1, 0.08, 0.06, 0.05, 0.04, 0.03, 0.02, 0.01, 0.0)
"""Noise on the fields, tried until what it makes leaves room for the specks."""

VERTICES_PER_CELL = 12

Pair = tuple[int, int]


@dataclass
class _Labels:
    """Where each branch reaches, and where it cannot continue.

    Attributes:
        reached: (n, 8), whether a branch reaches a vertex.
        cracked: the branches that are cracked along a mesh edge (i, j), i < j.
    """

    reached: Mask
    cracked: dict[Pair, set[int]]


def part(seed: int, cells: int = 1000, colors: int = 300) -> LabelledSurface:
    """A closed part with given numbers of cells and colors.

    Eight branches, in four pairs with nearly equal domains, reach where rough random fields are
    high. Along creases some of them are cracked. As in a front end the colors are the connected
    components of what the branches reach: a few large ones, broken by noise, and local ones of a
    cell or two. Specks then make up the numbers: a branch comes, goes or is cut off by a ring of
    cracks within a few vertices. Large cells get many loops and a hundred darts or more.

    Raises:
        InputError: too few cells or colors, or too many colors for so few cells.
    """
    if colors > cells / 2:
        raise InputError(None, None, f"no part has {colors} colors with {cells} cells")
    rng = np.random.default_rng([seed, cells, colors])
    vertices, faces = sphere(round((VERTICES_PER_CELL * cells / 4) ** 0.5))
    neighbors: list[list[int]] = [[] for _ in vertices]
    for a, b, c in faces.tolist():
        neighbors[a].append(b)
        neighbors[b].append(c)
        neighbors[c].append(a)
    labels = _labels(rng, vertices, neighbors, cells, colors)
    names, sets = _colors(labels, neighbors)
    cracks = _cracks(labels, names, sets)
    return LabelledSurface(
        f"part_{seed}_{cells}_{colors}",
        tuple(f"branch {branch} {number}" for branch, number in names),
        vertices,
        faces,
        tuple(sets),
        tuple(Crack(i, j, shared) for (i, j), shared in sorted(cracks.items())),
        {"family": "part", "seed": seed},
    )


def _labels(
    rng: np.random.Generator, vertices: Array, neighbors: list[list[int]], cells: int, colors: int
) -> _Labels:
    """Rough fields have many colors and cells of their own: calmer ones until there is room."""
    for creases in range(CREASES, -1, -1):
        frequency = 0.3 * (cells / 400) ** 0.7 * 0.6 ** (CREASES - creases)
        smooth = _Smooth(rng, vertices, neighbors, frequency, creases)
        for labels in map(smooth.labels, ROUGHNESS):
            if _filled(rng, labels, neighbors, cells, colors):
                return labels
    raise InputError(None, None, f"no part has as few as {cells} cells, {colors} colors")


class _Smooth:
    """The smooth fields behind a part: of each branch, of the creases, of cracks along them."""

    def __init__(
        self,
        rng: np.random.Generator,
        vertices: Array,
        neighbors: list[list[int]],
        frequency: float,
        creases: int,
    ) -> None:
        count = len(vertices)
        self._fields = np.empty((count, BRANCH_COUNT))
        for pair in range(0, BRANCH_COUNT, 2):
            common = _field(rng, vertices, frequency)
            for branch in (pair, pair + 1):
                self._fields[:, branch] = common + 0.2 * _field(rng, vertices, 2 * frequency)
        noise = rng.normal(size=(count, BRANCH_COUNT))
        # Averages over neighbors, so that what the noise makes is larger than a vertex.
        self._noise = noise + np.array([noise[others].sum(axis=0) for others in neighbors])
        self._coverage = rng.uniform(0.4, 0.7, BRANCH_COUNT)
        self._cracked: dict[Pair, set[int]] = {}
        for _ in range(creases):
            crease = _field(rng, vertices, 0.3)
            affected = np.stack(
                [_field(rng, vertices, 0.4) > 0 for _ in range(BRANCH_COUNT)], axis=1
            )
            for a, others in enumerate(neighbors):
                for b in others:
                    if a < b and (crease[a] > 0) != (crease[b] > 0):
                        both = np.flatnonzero(affected[a] & affected[b]).tolist()
                        self._cracked.setdefault((a, b), set()).update(both)

    def labels(self, roughness: float) -> _Labels:
        """What the branches reach when that much noise is added."""
        fields = self._fields + roughness * self._noise
        least = [np.quantile(fields[:, b], 1.0 - self._coverage[b]) for b in range(BRANCH_COUNT)]
        cracked = {edge: set(branches) for edge, branches in self._cracked.items() if branches}
        return _Labels(fields >= np.array(least), cracked)


def _field(rng: np.random.Generator, points: Array, frequency: float) -> Array:
    """A smooth random field of variance 1 or nearly: a dozen plane waves."""
    waves = rng.normal(0.0, 2 * np.pi * frequency, (12, 3))
    phases = rng.uniform(0, 2 * np.pi, 12)
    return np.asarray(np.cos(points @ waves.T + phases).sum(axis=1) / np.sqrt(6.0))


def _colors(
    labels: _Labels, neighbors: list[list[int]]
) -> tuple[list[Pair], list[tuple[int, ...]]]:
    """The colors, each as its branch and its number there, and those of each vertex."""
    names: list[Pair] = []
    sets: list[list[int]] = [[] for _ in neighbors]
    for branch in range(BRANCH_COUNT):
        open_nodes = set(np.flatnonzero(labels.reached[:, branch]).tolist())
        number = 0
        for first in sorted(open_nodes):
            if first not in open_nodes:
                continue
            open_nodes.remove(first)
            component = [first]
            for vertex in component:
                sets[vertex].append(len(names))
                for other in neighbors[vertex]:
                    edge = (vertex, other) if vertex < other else (other, vertex)
                    if other in open_nodes and branch not in labels.cracked.get(edge, ()):
                        open_nodes.remove(other)
                        component.append(other)
            number += 1
            names.append((branch, number))
    return names, [tuple(own) for own in sets]


def _cracks(
    labels: _Labels, names: list[Pair], sets: list[tuple[int, ...]]
) -> dict[Pair, tuple[int, ...]]:
    """The colors that both ends of a mesh edge have and that cannot continue along it."""
    found = {}
    for (i, j), branches in labels.cracked.items():
        shared = tuple(c for c in sets[i] if c in sets[j] and names[c][0] in branches)
        if shared:
            found[i, j] = shared
    return found


def _count_cells(
    sets: list[tuple[int, ...]], cracks: dict[Pair, tuple[int, ...]], neighbors: list[list[int]]
) -> int:
    """How many cells there are."""
    seen = [not own for own in sets]
    count = 0
    for first in range(len(sets)):
        if seen[first]:
            continue
        seen[first] = True
        count += 1
        cell = [first]
        for vertex in cell:
            for other in neighbors[vertex]:
                edge = (vertex, other) if vertex < other else (other, vertex)
                if not seen[other] and sets[other] == sets[vertex] and edge not in cracks:
                    seen[other] = True
                    cell.append(other)
    return count


def _filled(
    rng: np.random.Generator,
    labels: _Labels,
    neighbors: list[list[int]],
    cells: int,
    colors: int,
) -> bool:
    """Whether there is room for specks that make so many cells and colors; if so they are added."""
    names, sets = _colors(labels, neighbors)
    # A branch that comes or is cut off makes a color and a cell more, one that goes a cell.
    colored = colors - len(names)
    bare = cells - _count_cells(sets, _cracks(labels, names, sets), neighbors) - colored
    if colored < colors / 10 or bare < 0:
        return False
    used = {vertex for edge in labels.cracked for vertex in edge}
    for center in rng.permutation(len(neighbors)).tolist():
        if not colored and not bare:
            return True
        disc = {center, *neighbors[center]} if rng.random() < 0.3 else {center}
        ring = {other for vertex in disc for other in neighbors[vertex]} - disc
        if not sets[center] or used & (disc | ring):
            continue
        if len({sets[vertex] for vertex in disc | ring}) > 1:
            continue
        present = np.flatnonzero(labels.reached[center]).tolist()
        absent = sorted(set(range(BRANCH_COUNT)) - set(present))
        if int(rng.integers(colored + bare)) < colored:
            if absent and rng.random() < 0.6:
                labels.reached[sorted(disc), absent[int(rng.integers(len(absent)))]] = True
            else:
                branch = present[int(rng.integers(len(present)))]
                for a in disc:
                    for b in ring.intersection(neighbors[a]):
                        labels.cracked[min(a, b), max(a, b)] = {branch}
            colored -= 1
        elif len(present) > 1:
            labels.reached[sorted(disc), present[int(rng.integers(len(present)))]] = False
            bare -= 1
        else:
            continue
        used |= disc | ring
    return not colored and not bare
