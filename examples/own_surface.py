"""A surface without a robot: a mesh, and the colors that each of its vertices has."""

import numpy as np

import cellcolor

# A strip of 2 x 9 vertices. Its left third has color "a", its right third "c"; the middle has both.
columns = np.arange(9)
vertices = np.array([(0.01 * x, 0.01 * y, 0.0) for y in (0, 1) for x in columns])
faces = [(x, x + 1, x + 9) for x in columns[:-1]] + [(x + 1, x + 10, x + 9) for x in columns[:-1]]
colors = [(0,) if x < 3 else (1,) if x > 5 else (0, 1) for _ in (0, 1) for x in columns]

surface = cellcolor.LabelledSurface("strip", ("a", "c"), vertices, faces, tuple(colors))
print(cellcolor.decompose(surface))

result = cellcolor.solve(surface)
print(result)
assert result.segments == 2  # the two ends share no color

painted = cellcolor.paint(surface, result)
print(painted)
