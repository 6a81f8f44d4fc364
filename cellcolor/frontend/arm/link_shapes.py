"""What a URDF says of the collision shapes of its links."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from cellcolor.errors import InputError
from cellcolor.frontend.arm.urdf_fields import check_origin, number, triple

_SIZES = {"cylinder": ("radius", "length"), "sphere": ("radius",), "capsule": ("radius", "length")}
_KINDS = ("box", "capsule", "cylinder", "mesh", "sphere")


@dataclass(frozen=True)
class LinkShape:
    """One ``<collision>`` of a link.

    Attributes:
        kind: box, capsule, cylinder, mesh or sphere.
        sizes: of a box along x, y and z; radius and, between the round ends of a capsule, length
            of the others; how many meters a unit of a mesh is along x, y and z.
        file: the name of the mesh as the URDF has it, empty for the others.
    """

    kind: str
    sizes: tuple[float, ...]
    file: str = ""


def shapes_of(file: Path, name: str, link: ET.Element) -> tuple[LinkShape, ...]:
    """The collision shapes of a link, in their order.

    Raises:
        InputError: one is of another kind, or its numbers cannot be used.
    """
    return tuple(
        _shape(file, f"link[{name}].collision[{index}]", collision)
        for index, collision in enumerate(link.findall("collision"))
    )


def _shape(file: Path, field: str, collision: ET.Element) -> LinkShape:
    check_origin(file, field, collision)
    geometry = collision.find("geometry")
    shapes = [] if geometry is None else list(geometry)
    if len(shapes) != 1 or shapes[0].tag not in _KINDS:
        found = ", ".join(f"<{shape.tag}>" for shape in shapes) or "nothing"
        message = f"must be one box, capsule, cylinder, mesh or sphere, is {found}"
        raise InputError(str(file), field, message)
    shape, kind = shapes[0], shapes[0].tag
    if kind == "mesh":
        named = shape.get("filename")
        if not named:
            raise InputError(str(file), f"{field}.mesh", "'filename' is missing")
        scale = triple(file, f"{field}.mesh.scale", shape.get("scale", "1 1 1"))
        if 0 in scale:
            raise InputError(str(file), f"{field}.mesh.scale", "must not be zero")
        return LinkShape(kind, tuple(scale), named)
    if kind == "box":
        size = triple(file, f"{field}.box.size", shape.get("size", ""))
        if min(size) <= 0:
            raise InputError(str(file), f"{field}.box.size", "must be positive")
        return LinkShape(kind, tuple(size))
    sizes = []
    for attribute in _SIZES[kind]:
        sizes.append(number(file, field, shape, attribute))
        if sizes[-1] <= 0:
            raise InputError(str(file), f"{field}.{attribute}", "must be positive")
    return LinkShape(kind, tuple(sizes))
