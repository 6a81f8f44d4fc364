"""The side file of a labelled surface: what became of every candidate, as NumPy arrays."""

from __future__ import annotations

import io
import zipfile

import numpy as np

from cellcolor.files.writing import SIDE_MARKER
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.reach.validity import Reason

__all__ = ["side_file"]


def side_file(result: BuildResult) -> bytes:
    """The bytes of an ``.npz`` archive; ``n`` is the surface's number of vertices.

    ``branches`` (8,) names; ``reason_names`` (11,) what the codes mean; ``reasons`` (n, 8) uint8
    codes; ``configurations`` (n, 8, 6) float64 in rad, NaN where a branch has no solution;
    ``node_color`` (n, 8) int32, the color of the surface file that each candidate has, -1 for
    none; ``surface_sha256`` the fingerprint of the surface that all this is about. The same
    result gives the same bytes.
    """
    stream = io.BytesIO()
    np.savez_compressed(
        stream,
        branches=np.array(result.branches),
        reason_names=np.array([reason.text for reason in Reason]),
        reasons=result.reasons,
        configurations=result.configurations,
        node_color=result.node_color.astype(np.int32),
        surface_sha256=np.array(result.surface.sha256),
    )
    with zipfile.ZipFile(stream, "a") as archive:
        archive.comment = SIDE_MARKER
    return stream.getvalue()
