"""URDF text, checked before any robotics library sees it.

Pinocchio answers most URDF faults with the same sentence, reads a missing limit as [0, 0] and a
missing inertial as no mass, and drops collision shapes it does not know with a remark on standard
error. So the XML is held to what the front end relies on here, and every fault is named.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass, replace
from pathlib import Path

from cellcolor.errors import InputError
from cellcolor.files.documents import read_text

__all__ = ["Urdf", "load_urdf", "mount", "parse_urdf"]

_SHAPES = {"cylinder": ("radius", "length"), "sphere": ("radius",)}
_THING = ("inertial", "visual")  # what a link that is more than a frame has


@dataclass(frozen=True)
class Urdf:
    """A checked URDF tree.

    Attributes:
        root: the link that nothing carries.
        parent: the link that carries each other link.
        joint_above: the name of the joint between a link and its parent.
        moving: names of the revolute joints, in the order of the file.
        shapes: number of collision shapes of each link that has any.
        shapeless: the links without one that are things all the same: they have a mass or a
            picture, or a joint moves them.
        locked: joints that would follow another one (``<mimic>``); they are fixed where they
            stand at zero.
    """

    file: Path
    xml: ET.Element
    root: str
    parent: dict[str, str]
    joint_above: dict[str, str]
    moving: tuple[str, ...]
    shapes: dict[str, int]
    shapeless: tuple[str, ...]
    locked: tuple[str, ...]

    def chain(self, link: str) -> tuple[str, ...]:
        """The links from the root to ``link``, both included."""
        links = [link]
        while links[-1] in self.parent:
            links.append(self.parent[links[-1]])
        return tuple(reversed(links))

    def text(self) -> str:
        """The XML as one string."""
        return ET.tostring(self.xml, encoding="unicode")


def load_urdf(file: Path) -> Urdf:
    """Read and check a URDF file.

    Raises:
        InputError: not readable, or what :func:`parse_urdf` refuses.
    """
    return parse_urdf(read_text(file), file)


def parse_urdf(text: str, file: Path) -> Urdf:
    """Check a URDF text.

    Args:
        text: the XML.
        file: what errors name; it is not read.

    Raises:
        InputError: not XML, not one tree, a moving joint that is not revolute or
            has no usable limits, a solid link without mass, a collision shape other than
            cylinder or sphere, numbers that are not finite.
    """
    try:
        xml = ET.fromstring(text)
    except ET.ParseError as error:
        raise InputError(str(file), None, f"not XML: {error}") from error
    if xml.tag != "robot":
        raise InputError(str(file), xml.tag, "the outermost element of a URDF is <robot>")
    locked = _lock(xml)
    return replace(_checked(file, xml), locked=locked)


def mount(arm: Urdf, flange: str, tool: Urdf) -> Urdf:
    """The tool's tree fixed to the arm's flange link, without an offset.

    Raises:
        InputError: the arm has no such link, or arm and tool share a name.
    """
    if flange != arm.root and flange not in arm.parent:
        raise InputError(str(arm.file), f"link[{flange}]", "the flange link is not in the arm")
    xml = ET.Element("robot", {"name": arm.xml.get("name", "arm")})
    xml.extend(list(arm.xml))
    taken = {(element.tag, element.get("name")) for element in arm.xml}
    for element in tool.xml:
        if element.tag in ("link", "joint") and (element.tag, element.get("name")) in taken:
            field = f"{element.tag}[{element.get('name')}]"
            raise InputError(str(tool.file), field, f"{arm.file.name} has that name too")
        xml.append(element)
    joint = ET.SubElement(xml, "joint", {"name": "tool_mount", "type": "fixed"})
    ET.SubElement(joint, "parent", {"link": flange})
    ET.SubElement(joint, "child", {"link": tool.root})
    return replace(_checked(arm.file, xml), locked=arm.locked + tool.locked)


def _lock(xml: ET.Element) -> tuple[str, ...]:
    """Fix the joints that follow another one, and name them."""
    locked = []
    for joint in xml.findall("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            joint.remove(mimic)
            joint.set("type", "fixed")
            locked.append(joint.get("name", ""))
    return tuple(locked)


def _checked(file: Path, xml: ET.Element) -> Urdf:
    links = _named(file, xml, "link")
    joints = _named(file, xml, "joint")
    parent: dict[str, str] = {}
    joint_above: dict[str, str] = {}
    moving: list[str] = []
    driven: set[str] = set()
    for name, joint in joints.items():
        ends = []
        for end in ("parent", "child"):
            element = joint.find(end)
            link = None if element is None else element.get("link")
            if link not in links:
                raise InputError(str(file), f"joint[{name}].{end}", f"no link {link!r}")
            ends.append(str(link))
        above, below = ends
        if below in parent:
            raise InputError(str(file), f"joint[{name}].child", f"{below!r} hangs on two joints")
        parent[below], joint_above[below] = above, name
        _origin(file, f"joint[{name}]", joint)
        kind = joint.get("type")
        if kind == "revolute":
            _limits(file, name, joint)
            _axis(file, name, joint)
            moving.append(name)
            driven.add(below)
        elif kind != "fixed":
            raise InputError(
                str(file), f"joint[{name}].type", f"{kind!r}: only revolute and fixed joints"
            )
    roots = [link for link in links if link not in parent]
    if len(roots) != 1:
        raise InputError(str(file), "robot", f"needs one root link, has {len(roots)}: {roots}")
    shapes, shapeless = {}, []
    for name, element in links.items():
        count = _shapes(file, name, element)
        if count:
            shapes[name] = count
        elif name in driven or any(element.find(tag) is not None for tag in _THING):
            shapeless.append(name)
        if count or name in driven:
            _inertial(file, name, element)
    return Urdf(
        file, xml, roots[0], parent, joint_above, tuple(moving), shapes, tuple(shapeless), ()
    )


def _named(file: Path, xml: ET.Element, tag: str) -> dict[str, ET.Element]:
    found: dict[str, ET.Element] = {}
    for element in xml.findall(tag):
        name = element.get("name")
        if not name or name in found:
            fault = "stands twice" if name else "has no name"
            raise InputError(str(file), f"{tag}[{name or len(found)}]", fault)
        found[name] = element
    return found


def _number(file: Path, field: str, element: ET.Element | None, attribute: str) -> float:
    text = None if element is None else element.get(attribute)
    if text is None:
        raise InputError(str(file), field, f"{attribute!r} is missing")
    return _finite(file, f"{field}.{attribute}", text)


def _finite(file: Path, field: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError as error:
        raise InputError(str(file), field, f"{text!r} is not a number") from error
    if not math.isfinite(value):
        raise InputError(str(file), field, f"{text!r} is not finite")
    return value


def _triple(file: Path, field: str, text: str) -> list[float]:
    values = [_finite(file, field, part) for part in text.split()]
    if len(values) != 3:
        raise InputError(str(file), field, f"needs three numbers, has {len(values)}")
    return values


def _origin(file: Path, field: str, element: ET.Element) -> None:
    origin = element.find("origin")
    if origin is not None:
        for attribute in ("xyz", "rpy"):
            _triple(file, f"{field}.origin.{attribute}", origin.get(attribute, "0 0 0"))


def _limits(file: Path, name: str, joint: ET.Element) -> None:
    field = f"joint[{name}].limit"
    limit = joint.find("limit")
    lower = _number(file, field, limit, "lower")
    upper = _number(file, field, limit, "upper")
    if lower >= upper:
        raise InputError(str(file), field, f"lower {lower} is not below upper {upper}")
    if _number(file, field, limit, "effort") <= 0:
        raise InputError(str(file), f"{field}.effort", "must be positive")


def _axis(file: Path, name: str, joint: ET.Element) -> None:
    axis = joint.find("axis")
    field = f"joint[{name}].axis"
    values = _triple(file, field, "1 0 0" if axis is None else axis.get("xyz", "1 0 0"))
    if abs(math.hypot(*values) - 1) > 1e-6:
        raise InputError(str(file), field, "must have length 1")


def _inertial(file: Path, name: str, link: ET.Element) -> None:
    field = f"link[{name}].inertial"
    inertial = link.find("inertial")
    if inertial is None:
        raise InputError(str(file), field, "is missing: the link would weigh nothing")
    _origin(file, field, inertial)
    if _number(file, f"{field}.mass", inertial.find("mass"), "value") <= 0:
        raise InputError(str(file), f"{field}.mass", "must be positive")
    for entry in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        _number(file, f"{field}.inertia", inertial.find("inertia"), entry)


def _shapes(file: Path, name: str, link: ET.Element) -> int:
    collisions = link.findall("collision")
    for index, collision in enumerate(collisions):
        field = f"link[{name}].collision[{index}]"
        _origin(file, field, collision)
        geometry = collision.find("geometry")
        shapes = [] if geometry is None else list(geometry)
        if len(shapes) != 1 or shapes[0].tag not in _SHAPES:
            found = ", ".join(f"<{shape.tag}>" for shape in shapes) or "nothing"
            raise InputError(
                str(file),
                field,
                f"must be one cylinder or sphere, is {found} "
                "(write a capsule as a cylinder and two spheres)",
            )
        for attribute in _SHAPES[shapes[0].tag]:
            if _number(file, field, shapes[0], attribute) <= 0:
                raise InputError(str(file), f"{field}.{attribute}", "must be positive")
    return len(collisions)
