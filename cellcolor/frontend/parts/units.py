"""The unit of a mesh file, which says nothing of it, guessed from its size."""

from __future__ import annotations

__all__ = ["UNITS", "likely_unit"]

UNITS = {"m": 1.0, "mm": 0.001}
_METERS, _MILLIMETERS = 3.0, 10.0  # greatest extent; up to it meters, from it on millimeters


def likely_unit(extent: float) -> tuple[str | None, str]:
    """``m`` or ``mm`` or None, and why, for the greatest extent of a mesh in its own unit."""
    size = f"its greatest extent is {extent:.4g}"
    if extent <= _METERS:
        return "m", f"{size}: in millimeters it would be smaller than the tip of a tool"
    if extent >= _MILLIMETERS:
        return "mm", f"{size}: in meters it would be larger than what an arm covers"
    return None, f"{size}, which could be meters as well as millimeters: say which, --unit"
