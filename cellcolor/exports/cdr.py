"""ROS 2 messages as bytes (CDR, little-endian), many of one type at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

_BEGIN = b"\x00\x01\x00\x00"  # plain CDR, little-endian; numbers are aligned from here on


class Messages:
    """Messages of one layout, field by field: texts and sizes are the same in all of them."""

    def __init__(self, count: int) -> None:
        self._count, self._alike = count, bytearray()
        self._numbers: list[tuple[int, NDArray[np.uint8]]] = []

    def numbers(self, kind: str, values: ArrayLike) -> None:
        """Numbers of a NumPy type: one row for each message (count, m), or the same (m,) in all."""
        values = np.asarray(values, dtype=np.dtype(kind).newbyteorder("<"))
        if not values.size:
            return
        self._alike += bytes(-len(self._alike) % values.dtype.itemsize)
        if values.ndim < 2:
            self._alike += values.tobytes()
            return
        columns = np.ascontiguousarray(values).view(np.uint8).reshape(self._count, -1)
        self._numbers.append((len(self._alike), columns))
        self._alike += bytes(columns.shape[1])

    def sequence(self, kind: str, values: ArrayLike) -> None:
        """The same after their number."""
        values = np.asarray(values)
        self.numbers("u4", values.shape[-1])
        self.numbers(kind, values)

    def text(self, text: str) -> None:
        """A string, its end marked by a zero."""
        data = text.encode() + b"\0"
        self.numbers("u4", len(data))
        self._alike += data

    def each(self) -> list[bytes]:
        """The messages."""
        rows = np.tile(np.frombuffer(bytes(self._alike), dtype=np.uint8), (self._count, 1))
        for first, columns in self._numbers:
            rows[:, first : first + columns.shape[1]] = columns
        return [_BEGIN + row.tobytes() for row in rows]
