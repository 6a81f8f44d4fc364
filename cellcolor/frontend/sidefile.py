"""The side file of a labelled surface: what became of every candidate, as NumPy arrays."""

from __future__ import annotations

import io
import os
from pathlib import Path

import numpy as np

from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.validity import Reason

__all__ = ["write_side_file"]


def write_side_file(result: BuildResult, path: Path) -> None:
    """Write an ``.npz`` archive, whole or not at all; ``n`` is the surface's number of vertices.

    ``branches`` (8,) names; ``reason_names`` (10,) what the codes mean; ``reasons`` (n, 8) uint8
    codes; ``configurations`` (n, 8, 6) float64 in rad, NaN where a branch has no solution;
    ``node_color`` (n, 8) int16, the color of the surface file that each candidate has, -1 for
    none. The same result gives the same bytes.

    Raises:
        InputError: the place cannot be written to.
    """
    stream = io.BytesIO()
    np.savez_compressed(
        stream,
        branches=np.array(result.branches),
        reason_names=np.array([reason.text for reason in Reason]),
        reasons=result.reasons,
        configurations=result.configurations,
        node_color=result.node_color.astype(np.int16),
    )
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        temporary.write_bytes(stream.getvalue())
        temporary.replace(path)
    except OSError as error:
        raise InputError(str(path), None, error.strerror or "cannot be written") from error
    finally:
        temporary.unlink(missing_ok=True)
