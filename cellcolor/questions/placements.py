"""Where a part should stand, as a value: the placements that were tried, and the best of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from cellcolor.data.wording import count

__all__ = ["VARIABLES", "PlacedMinimum", "Placements", "Pose"]

VARIABLES = ("x", "y", "z", "roll", "pitch", "yaw")
"""Of a placement: the position in m, and extrinsic x, y, z angles in rad, as in a scene."""

Pose = tuple[float, float, float, float, float, float]
"""Position in m and angles in rad, in the order of :data:`VARIABLES`."""

_SAME_SHARE = 1e-9


@dataclass(frozen=True)
class PlacedMinimum:
    """The fewest lift-offs where a part stands.

    Attributes:
        pose: where it stands.
        segments: the fewest that were found; None if the part cannot stand there, or none were
            found in time.
        covered_share: the area with a color, as a share of the whole surface, 0 to 1.
        proved_for_surface: whether ``segments`` is the fewest of any division of the mesh that was
            solved.
        vertices: of that mesh.
        refused: why the part cannot stand there, or "".
    """

    pose: Pose
    segments: int | None
    covered_share: float
    proved_for_surface: bool
    vertices: int
    refused: str = ""

    @property
    def lift_offs(self) -> int | None:
        """One between each two segments."""
        return None if self.segments is None else max(0, self.segments - 1)

    def rank(self, cover: float) -> tuple[bool, float, bool, float]:
        """What a better placement has less of.

        Enough area comes first, then the number, then its proof, then the area left uncovered.
        """
        enough = self.segments is not None and self.covered_share >= cover - _SAME_SHARE
        number = float(self.segments) if enough and self.segments is not None else 0.0
        return not enough, number, not self.proved_for_surface, 1.0 - self.covered_share

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "position_m": list(self.pose[:3]),
            "rpy_rad": list(self.pose[3:]),
            "lift_offs": self.lift_offs,
            "segments": self.segments,
            "covered_share": self.covered_share,
            "proved_for_surface": self.proved_for_surface,
            "vertices": self.vertices,
            "refused": self.refused,
        }

    def __str__(self) -> str:
        x, y, z, roll, pitch, yaw = self.pose
        place = f"({x:.4g}, {y:.4g}, {z:.4g}) m"
        if roll or pitch or yaw:
            place += f" turned by ({roll:.4g}, {pitch:.4g}, {yaw:.4g}) rad"
        if self.lift_offs is None:
            return f"{place}: {self.refused or 'not solved in time'}"
        proof = "" if self.proved_for_surface else " (not proved)"
        number = count(self.lift_offs, "lift-off")
        return f"{place}: {number}{proof}, {100 * self.covered_share:.1f} % of the area"


@dataclass(frozen=True, eq=False)
class Placements:
    """Where a part may stand, with the fewest lift-offs of each place.

    Attributes:
        name: of the scene.
        cover: the share of the surface that has to be covered.
        here: where the scene has the part, on the scene's own mesh.
        best: the best placements that were found, on the scene's own mesh, the best first.
        tried: all others, most of them on a coarser mesh, in the order in which they were asked.
        complete: whether the time limit left nothing out.
    """

    name: str
    cover: float
    here: PlacedMinimum
    best: tuple[PlacedMinimum, ...]
    tried: tuple[PlacedMinimum, ...]
    complete: bool = True

    def __iter__(self) -> Iterator[PlacedMinimum]:
        yield self.here
        yield from self.best
        yield from self.tried

    def __str__(self) -> str:
        lines = [f"{self.name}: where it stands, {self.here}"]
        enough = [row for row in self.best if not row.rank(self.cover)[0]]
        lines += [f"  {number}. {row}" for number, row in enumerate(enough, 1)]
        asked = f"{100 * self.cover:.1f} % of the area"
        if not enough:
            lines.append(f"  no placement that was tried covers {asked}")
        refused = sum(bool(row.refused) for row in self.tried)
        tried = count(len(self.tried), "placement")
        lines.append(f"  {tried} tried that had to cover {asked}, {refused} of them refused")
        if not self.complete:
            lines.append("  the time limit came before everything was tried")
        return "\n".join(lines)
