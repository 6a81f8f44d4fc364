"""An inspected mesh: its facts and what a repair would do, as a value that prints itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.mesh_facts import FaultyPlaces, MeshFacts, facts_of
from cellcolor.frontend.parts.mesh_file import UNITS, likely_unit
from cellcolor.frontend.parts.repaired import check_known_size, in_words
from cellcolor.frontend.parts.repairing import Mending, Telling, counted, mended
from cellcolor.frontend.parts.surface import Faces

_SHOWN = 3  # places of one fault in a printed inspection
_STORED = 100  # places of one fault in a JSON document


@dataclass(frozen=True, eq=False)
class Inspection:
    """An inspected mesh.

    Attributes:
        name: of its file, or what it is.
        unit: of its coordinates: ``m``, ``mm``, ``cm`` or ``in``.
        unit_reason: why; for a given unit, that it was given.
        facts: what it has and what is wrong with it.
        repairs: what a repair would change, without filling holes or remeshing.
        refusal: why the mesh could not be used after that; None if it could.
        vertices: (n, 3) in m.
        faces: (m, 3).
    """

    name: str
    unit: str
    unit_reason: str
    facts: MeshFacts
    repairs: tuple[str, ...]
    refusal: str | None
    vertices: Array = field(repr=False)
    faces: Faces = field(repr=False)

    def to_dict(self) -> dict[str, Any]:
        """Everything except the mesh, JSON-able; the first hundred places of each kind."""
        facts = asdict(
            replace(self.facts, places=FaultyPlaces({}, {}, self.facts.places.sharp[:0]))
        )
        del facts["places"]
        counted = ("components", "holes", "non_manifold_edges", "non_manifold_vertices")
        for key in (*counted, "crossings"):
            found = facts[key]
            if found is not None:
                facts[key] = {"count": len(found), "first": list(found[:_STORED])}
        return {
            "name": self.name,
            "unit": self.unit,
            "unit_reason": self.unit_reason,
            **facts,
            "repairs": list(self.repairs),
            "refusal_after_repair": self.refusal,
        }

    def __str__(self) -> str:
        facts = self.facts
        size = " x ".join(
            f"{high - low:.4g}" for low, high in zip(facts.low_m, facts.high_m, strict=True)
        )
        low = ", ".join(f"{x:.4g}" for x in facts.low_m)
        edges = [f"{1e3 * length:.3g}" for length in facts.edge_lengths_m]
        rows = [
            ("triangles", f"{facts.triangles:,}, {facts.vertices:,} vertices"),
            ("unit", f"{self.unit}: {self.unit_reason}"),
            ("size", f"{size} m from ({low}) m, area {facts.area_m2:.4g} m^2"),
            (
                "edges",
                f"{edges[0]} to {edges[4]} mm, quartiles {edges[1]}, {edges[2]}, {edges[3]} mm",
            ),
            ("sharp edges", self._sharp()),
            ("components", self._components()),
            ("genus", "of a manifold only" if facts.genus is None else f"{facts.genus}"),
        ]
        rows += [(name, text) for name, text in self._faults() if text]
        ready = "yes" if facts.refusal is None else f"no: {facts.refusal}"
        rows.append(("usable as it is", ready))
        lines = [self.name, *(f"  {name:<16} {text}" for name, text in rows)]
        lines += [
            "  repair would",
            *(f"    {change}" for change in self.repairs or ("change nothing",)),
        ]
        end = "usable" if self.refusal is None else f"still not usable: {self.refusal}"
        return "\n".join([*lines, f"  and then it is {end}"])

    def _sharp(self) -> str:
        facts = self.facts
        if not facts.sharp_edges:
            return "none of 30 degrees or more"
        return f"{facts.sharp_edges:,} of 30 degrees or more, {facts.sharp_length_m:.3g} m"

    def _components(self) -> str:
        first = ", ".join(
            f"{own.faces:,} faces {'closed' if own.closed else 'open'}"
            for own in self.facts.components[:_SHOWN]
        )
        more = len(self.facts.components) - _SHOWN
        return (
            f"{len(self.facts.components):,}: {first}{f', and {more:,} more' if more > 0 else ''}"
        )

    def _faults(self) -> list[tuple[str, str]]:
        facts = self.facts
        holes = [f"{1e3 * hole.length_m:.3g} mm long at {_at(hole.place)}" for hole in facts.holes]
        crossing = "not looked for: too many faces, or too uneven"
        if facts.crossings is not None:
            crossing = _listed("pair", list(map(_at, facts.crossings)))
        return [
            ("holes", _listed("border", holes)),
            (
                "non-manifold",
                _listed("edge", list(map(_at, facts.non_manifold_edges)), " of 3 faces or more"),
            ),
            (
                "non-manifold",
                _listed("vertex", list(map(_at, facts.non_manifold_vertices)), " not manifold"),
            ),
            ("twins", _some(facts.merged_vertices, "vertex", "in the same place as another")),
            ("unused", _some(facts.unused_vertices, "vertex", "without a face")),
            ("duplicates", _some(facts.duplicate_faces, "face", "there twice")),
            ("flat", _some(facts.flat_faces, "face", "without area")),
            ("winding", _some(facts.mixed_winding, "face", "against those around")),
            (
                "one-sided",
                "a component has no outside, as a Moebius strip" if facts.one_sided else "",
            ),
            ("inside out", _some(facts.inside_out, "closed component", "with a negative volume")),
            ("crossings", crossing),
        ]


def inspect_mesh(
    name: str,
    vertices: Array,
    faces: Faces,
    unit: str | None = None,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> Inspection:
    """Inspect a mesh, and say what a repair would do.

    Args:
        name: of the file, or what it is.
        vertices: (n, 3) in its unit.
        faces: (m, 3).
        unit: ``m``, ``mm``, ``cm`` or ``in``; None takes the likely one, meters where that is open.
        tell: told what is being looked at.

    Raises:
        InputError: it cannot be looked through: coordinates that are not finite, a face of no
            vertex, no face with an area, too many faces, no such unit.
    """
    check_known_size(len(faces))
    if unit is not None and unit not in UNITS:
        raise InputError(None, "unit", f"must be one of {', '.join(UNITS)}, is {unit!r}")
    if not len(faces):
        raise InputError(None, "faces", "there are none")
    reason = "as given"
    if unit is None:
        with np.errstate(invalid="ignore"):
            likely, reason = likely_unit(float(np.ptp(vertices, axis=0).max()))
        unit = likely or "m"
    points = np.asarray(vertices, dtype=np.float64) * UNITS[unit]
    # First the repair: what makes it impossible makes an inspection impossible.
    refusal, repairs = None, []
    try:
        made, new, changes = mended(points, faces, Mending(), deadline, tell)
        repairs = [in_words(change) for change in changes]
        mesh_surface(made, new, deadline=deadline)
    except InputError as error:
        refusal = str(error)
    facts = facts_of(points, faces, deadline, tell)
    return Inspection(name, unit, reason, facts, tuple(repairs), refusal, points, faces)


def _at(place: Sequence[float]) -> str:
    return f"({', '.join(f'{x:.4g}' for x in place)})"


def _listed(one: str, places: list[str], what: str = "") -> str:
    """How many, and the first places."""
    if not places:
        return ""
    more = f", and {len(places) - _SHOWN:,} more" if len(places) > _SHOWN else ""
    return f"{counted(len(places), one)}{what}: {', '.join(places[:_SHOWN])}{more}"


def _some(number: int, one: str, what: str) -> str:
    return f"{counted(number, one)} {what}" if number else ""
