"""Where a tool path touches the vertices of a labelled surface, and in which colors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class VertexContacts:
    """Contacts of a path with vertices, in the order of the path, each in a color of its vertex.

    Attributes:
        stroke: (c,) the stroke that each is in.
        vertex: (c,) the vertex that is touched.
        color: (c,) the color, which the vertex has.
    """

    stroke: NDArray[np.int64]
    vertex: NDArray[np.int64]
    color: NDArray[np.int64]
