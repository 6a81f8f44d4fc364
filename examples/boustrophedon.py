"""Cells from elsewhere: a boustrophedon decomposition, and the fewest lift-offs that obey it."""

import numpy as np

import cellcolor

# A plate of points 1 cm apart, with a slot and a round hole.
x, y = np.meshgrid(np.arange(40), np.arange(20), indexing="ij")
slot = (x >= 10) & (x < 18) & (y >= 6) & (y < 14)
free = ~slot & ((x - 29.5) ** 2 + (y - 9.5) ** 2 > 16)


def boustrophedon(free):
    """The cell of each free point, -1 elsewhere (Choset and Pignon 1998).

    A line sweeps along x. Each of its pieces in the free region goes on in the cell of the piece
    before, unless pieces divide or join there: then cells begin.
    """
    cell, count, before = np.full(free.shape, -1), 0, []
    for column, line in enumerate(free):
        ends = np.flatnonzero(np.diff(line.astype(int), prepend=0, append=0))
        pieces = list(zip(ends[::2], ends[1::2], strict=True))
        met = np.array([[a < d and c < b for c, d in before] for a, b in pieces])
        for number, (first, end) in enumerate(pieces):
            old = np.flatnonzero(met[number])
            if len(old) == 1 and met[:, old[0]].sum() == 1:
                cell[column, first:end] = cell[column - 1, before[old[0]][0]]
            else:
                cell[column, first:end], count = count, count + 1
        before = pieces
    return cell


cell = boustrophedon(free)
assert cell.max() == 6  # 7 cells: before, between and behind the holes, above and below each

# What each posture of an arm reaches. A posture is a color of the cells that it reaches entirely.
reached = {"left": x < 16, "middle": (x >= 8) & (x < 27), "right": x >= 14}
offered = {
    name: np.isin(cell, [number for number in range(7) if mask[cell == number].all()])
    for name, mask in reached.items()
}


def surface(name, masks):
    """The plate as a labelled surface: triangles between neighboring free points."""
    number = np.where(free, np.cumsum(free).reshape(free.shape) - 1, -1)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    faces = np.stack([[a, b, c], [a, c, d]], axis=-1).reshape(3, -1).T
    points = np.stack([0.01 * x[free], 0.01 * y[free], np.zeros(free.sum())], axis=1)
    colors = zip(*(mask[free] for mask in masks.values()), strict=True)
    own = tuple(tuple(np.flatnonzero(row).tolist()) for row in colors)
    return cellcolor.LabelledSurface(name, tuple(masks), points, faces[faces.min(1) >= 0], own)


given = cellcolor.solve(surface("plate in given cells", offered))
print(given)
assert given.segments == 3  # some cells have left alone, some middle, and some right

own = cellcolor.solve(surface("plate", reached))
print(own)
assert own.segments == 2  # no cells given: left and right reach everything, neither does alone
