"""Comparing values that contain arrays: ``==`` of two arrays is neither true nor false."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


def same_members(one: Any, other: Any) -> bool:
    """Whether two dataclasses of one type hold the same; NaN in an array equals NaN."""
    return all(
        _same(getattr(one, field.name), getattr(other, field.name))
        for field in fields(one)
        if field.compare
    )


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    return bool(one == other)
