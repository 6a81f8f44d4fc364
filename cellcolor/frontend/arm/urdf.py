"""URDF text, checked and read: links with their shapes, joints, and how they hang together.

Other readers answer most URDF faults with the same sentence, read a missing limit as [0, 0] and a
missing inertial as no mass, and drop unknown collision shapes with a remark on standard error. So
the XML is read here; the first fault is an :class:`~cellcolor.errors.InputError`.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array, unit
from cellcolor.data.wording import beyond_turns, looks_like_degrees, looks_like_millimeters
from cellcolor.errors import InputError, naming
from cellcolor.files.documents import read_text


@dataclass(frozen=True)
class LinkShape:
    """One ``<collision>`` of a link.

    Attributes:
        kind: box, capsule, cylinder, mesh or sphere.
        sizes: of a box along x, y and z; radius and, between the round ends of a capsule, length
            of the others; how many meters a unit of a mesh is along x, y and z.
        place: in the frame of the link.
        mesh: the name of the mesh as the URDF has it, empty for the others.
    """

    kind: str
    sizes: tuple[float, ...]
    place: pin.SE3
    mesh: str = ""


@dataclass(frozen=True, eq=False)
class Link:
    """A link, and the file that has it.

    Attributes:
        folder: what relative file names in the file are relative to.
        mass, center: in kg, and (3,) in m in the frame of the link; 0 where they are not known.
        weightless: why they are not known.
        real: whether it is more than a frame: it has a weight or a picture.
    """

    name: str
    file: Path
    folder: Path
    shapes: tuple[LinkShape, ...]
    mass: float
    center: Array
    weightless: InputError | None
    real: bool


FIXED, PRISMATIC = "fixed", "prismatic"
_MOVING = ("revolute", "continuous", PRISMATIC)


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint, and the file that has it.

    Attributes:
        kind: revolute, continuous, prismatic or fixed.
        place: its frame at zero in that of the link ``parent``.
        axis: (3,) unit vector in its own frame.
        lower, upper: limits in rad or m, infinite if it has none.
        velocity, effort: limits in rad/s or m/s, and N m or N; NaN where the file has none.
        powerless: why the effort is not known.
        follows: the joint that it follows (``<mimic>``), at the multiple of its position plus the
            offset that come next.
    """

    name: str
    file: Path
    parent: str
    child: str
    place: pin.SE3
    kind: str = FIXED
    axis: Array = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.nan
    effort: float = math.nan
    powerless: InputError | None = None
    follows: tuple[str, float, float] | None = None

    def at(self, position: float) -> pin.SE3:
        """The frame behind it in that of the parent, at a position in rad or m."""
        if self.kind == FIXED:
            return self.place
        if self.kind == PRISMATIC:
            return self.place * pin.SE3(np.eye(3), position * self.axis)
        return self.place * pin.SE3(pin.exp3(position * self.axis), np.zeros(3))

    def refused(self, message: str, key: str = "") -> InputError:
        """An error that names the joint, or a key of it."""
        return InputError(str(self.file), f"joint[{self.name}]{key}", message)


@dataclass(frozen=True)
class Urdf:
    """A checked URDF tree.

    Attributes:
        root: the link that nothing carries.
        links, joints: by their names, in the order of the file.
        above: the joint that carries each link but the root.
    """

    file: Path
    root: str
    links: dict[str, Link]
    joints: dict[str, Joint]
    above: dict[str, Joint]

    @property
    def leading(self) -> dict[str, Joint]:
        """The joints that can move and follow no other one."""
        return {
            name: joint
            for name, joint in self.joints.items()
            if joint.kind != FIXED and joint.follows is None
        }

    def chain(self, link: str) -> tuple[str, ...]:
        """The links from the root to ``link``, both included."""
        links = [link]
        while links[-1] in self.above:
            links.append(self.above[links[-1]].parent)
        return tuple(reversed(links))


def load_urdf(file: Path) -> Urdf:
    """Read and check a URDF file.

    Raises:
        InputError: not readable, or what :func:`parse_urdf` refuses.
    """
    return parse_urdf(read_text(file), file, file.parent)


def parse_urdf(text: str, file: Path, folder: Path = Path()) -> Urdf:
    """Check a URDF text.

    Args:
        file: what errors name; it is not read.
        folder: what relative file names in it are relative to.

    Raises:
        InputError: not XML, a xacro file, not one tree, a joint that floats or has no usable
            limits, a collision shape of an unknown kind, numbers that are not finite.
    """
    with naming(file):
        _refuse_xacro(text, file)
        try:
            xml = ET.fromstring(text)
        except ET.ParseError as error:
            raise InputError(None, None, f"not XML: {error}") from error
        if xml.tag != "robot":
            raise InputError(None, xml.tag, "the outermost element of a URDF is <robot>")
        named = _named(xml, "link")
        joints = {
            name: _joint(name, joint, file, named) for name, joint in _named(xml, "joint").items()
        }
        above: dict[str, Joint] = {}
        for joint in joints.values():
            if joint.child in above:
                raise joint.refused(f"{joint.child!r} hangs on two joints", ".child")
            above[joint.child] = joint
        roots = [link for link in named if link not in above]
        if len(roots) != 1:
            raise InputError(None, "robot", f"needs one root link, has {len(roots)}: {roots}")
        reached = roots.copy()
        for link in reached:  # which grows by the links that hang on this one
            reached += [joint.child for joint in joints.values() if joint.parent == link]
        if len(reached) < len(named):
            stray = next(link for link in named if link not in reached)
            raise InputError(None, f"link[{stray}]", "hangs on itself, by joints in a circle")
        links = {name: _link(name, link, file, folder) for name, link in named.items()}
    return Urdf(file, roots[0], links, joints, above)


def _refuse_xacro(text: str, file: Path) -> None:
    """Refuse what has to be expanded first; the declaration of xacro's name alone is harmless."""
    without = re.sub(r"""xmlns:xacro\s*=\s*("[^"]*"|'[^']*')""", "", text)
    without = re.sub(r"<!--.*?-->", "", without, flags=re.DOTALL)
    if re.search(r"</?xacro:|=\s*[\"'][^\"']*\$[{(]", without):
        out = file.name.removesuffix(".xacro").removesuffix(".urdf") + ".urdf"
        command = f"xacro {file.name} -o {out}"
        message = f"is a xacro file; expand it first: {command} (without ROS: pip install xacrodoc)"
        raise InputError(None, "robot", message)


def _named(xml: ET.Element, tag: str) -> dict[str, ET.Element]:
    """The elements with a tag by their names, each of which stands once."""
    found: dict[str, ET.Element] = {}
    for element in xml.findall(tag):
        name = element.get("name")
        if not name or name in found:
            fault = "stands twice" if name else "has no name"
            raise InputError(None, f"{tag}[{name or len(found)}]", fault)
        found[name] = element
    return found


def _given(xml: ET.Element, tag: str) -> dict[str, str]:
    """The attributes of the element inside with a tag; none if there is none."""
    element = xml.find(tag)
    return {} if element is None else element.attrib


def _number(field: str, given: dict[str, str], key: str) -> float:
    """A finite number that has to be there."""
    if key not in given:
        raise InputError(None, field, f"{key!r} is missing")
    return _finite(f"{field}.{key}", given[key])


def _positive(field: str, given: dict[str, str], key: str) -> float:
    """A finite number above zero that has to be there."""
    value = _number(field, given, key)
    if value <= 0:
        raise InputError(None, f"{field}.{key}", f"is {value:g}, must be positive")
    return value


def _finite(field: str, text: str) -> float:
    """A finite number."""
    try:
        value = float(text)
    except ValueError as error:
        raise InputError(None, field, f"{text!r} is not a number") from error
    if not math.isfinite(value):
        raise InputError(None, field, f"{text!r} is not finite")
    return value


def _triple(field: str, text: str) -> list[float]:
    """Three finite numbers."""
    values = [_finite(field, part) for part in text.split()]
    if len(values) != 3:
        raise InputError(None, field, f"needs three numbers, has {len(values)}")
    return values


def _origin(field: str, element: ET.Element) -> pin.SE3:
    """The pose of an element's ``<origin>``, the identity if there is none."""
    given = _given(element, "origin")
    xyz, rpy = (_triple(f"{field}.origin.{key}", given.get(key, "0 0 0")) for key in ("xyz", "rpy"))
    if beyond_turns(most := max(rpy, key=abs), 1):
        raise InputError(None, f"{field}.origin.rpy", looks_like_degrees(most))
    return pose(xyz, rpy)


def pose(xyz: Collection[float], rpy: Collection[float]) -> pin.SE3:
    """A position in m, and angles in rad, extrinsic x, y, z."""
    return pin.SE3(pin.rpy.rpyToMatrix(np.array(rpy)), np.array(xyz))


def _link(name: str, xml: ET.Element, file: Path, folder: Path) -> Link:
    shapes = tuple(
        _shape(f"link[{name}].collision[{number}]", collision)
        for number, collision in enumerate(xml.findall("collision"))
    )
    mass, center, weightless = 0.0, np.zeros(3), None
    field, inertial = f"link[{name}].inertial", xml.find("inertial")
    try:
        if inertial is None:
            raise InputError(None, field, "is missing: the link would weigh nothing")
        center = _origin(field, inertial).translation
        mass = _positive(f"{field}.mass", _given(inertial, "mass"), "value")
    except InputError as error:  # it matters where forces are asked for
        weightless = error
    real = inertial is not None or xml.find("visual") is not None
    return Link(name, file, folder, shapes, mass, center, weightless, real)


_SIZES = {"cylinder": ("radius", "length"), "sphere": ("radius",), "capsule": ("radius", "length")}


def _shape(field: str, collision: ET.Element) -> LinkShape:
    place, geometry = _origin(field, collision), collision.find("geometry")
    shapes = [] if geometry is None else list(geometry)
    if len(shapes) != 1 or shapes[0].tag not in (*_SIZES, "box", "mesh"):
        found = ", ".join(f"<{shape.tag}>" for shape in shapes) or "nothing"
        message = f"must be one box, capsule, cylinder, mesh or sphere, is {found}"
        raise InputError(None, field, message)
    shape, kind = shapes[0], shapes[0].tag
    if kind == "mesh":
        named = shape.get("filename")
        if not named:
            raise InputError(None, f"{field}.mesh", "'filename' is missing")
        scale = _triple(f"{field}.mesh.scale", shape.get("scale", "1 1 1"))
        if 0 in scale:
            raise InputError(None, f"{field}.mesh.scale", "must not be zero")
        return LinkShape(kind, tuple(scale), place, named)
    if kind == "box":
        size = _triple(f"{field}.box.size", shape.get("size", ""))
        if min(size) <= 0:
            raise InputError(None, f"{field}.box.size", "must be positive")
        return LinkShape(kind, tuple(size), place)
    return LinkShape(
        kind, tuple(_positive(field, shape.attrib, key) for key in _SIZES[kind]), place
    )


def _joint(name: str, xml: ET.Element, file: Path, links: Collection[str]) -> Joint:
    field, kind = f"joint[{name}]", xml.get("type", "")
    parent, child = (_given(xml, end).get("link", "") for end in ("parent", "child"))
    for end, link in (("parent", parent), ("child", child)):
        if link not in links:
            raise InputError(None, f"{field}.{end}", f"no link {link!r}")
    place = _origin(field, xml)
    if kind == FIXED:
        return Joint(name, file, parent, child, place)
    if kind not in _MOVING:
        message = f"{kind!r}: only revolute, continuous, prismatic and fixed joints"
        raise InputError(None, f"{field}.type", message)
    axis = np.array(_triple(f"{field}.axis", _given(xml, "axis").get("xyz", "1 0 0")))
    if abs(np.linalg.norm(axis) - 1) > 1e-6:
        raise InputError(None, f"{field}.axis", "must have length 1")
    limit, mimic = _given(xml, "limit"), xml.find("mimic")
    velocity = _finite(f"{field}.limit.velocity", limit.get("velocity", "0"))
    effort, powerless, follows = math.nan, None, None
    try:
        effort = _positive(f"{field}.limit", limit, "effort")  # vendors write 0 if they do not say
    except InputError as error:  # it matters where forces are asked for
        powerless = error
    if mimic is not None:
        factor, offset = (
            _finite(f"{field}.mimic.{key}", mimic.get(key, usual))
            for key, usual in (("multiplier", "1"), ("offset", "0"))
        )
        follows = mimic.get("joint", ""), factor, offset
    lower, upper = -math.inf, math.inf
    if kind != "continuous" and follows is None:  # the leader's limits count
        lower, upper = _limits(field, xml, kind == PRISMATIC)
    return Joint(
        name,
        file,
        parent,
        child,
        place,
        kind=kind,
        axis=unit(axis),
        lower=lower,
        upper=upper,
        velocity=velocity if velocity > 0 else math.nan,  # vendors write 0 as well
        effort=effort,
        powerless=powerless,
        follows=follows,
    )


_ENDS = ("lower", "upper")
_LONGEST = 60.0  # m; of a rail
_MOST_DEGREES = 3600  # of a joint's limit; beyond, as 999999, it means that there is none


def _limits(field: str, joint: ET.Element, slides: bool) -> tuple[float, float]:
    """The limits of a joint in rad or m, infinite if they mean that it has none.

    They are its soft ones where it has some, beyond which a controller stops it. Soft limits that
    leave no range are none: both are zero where nobody wrote any.
    """
    lower, upper = (_number(f"{field}.limit", _given(joint, "limit"), end) for end in _ENDS)
    soft = _given(joint, "safety_controller")
    if all(f"soft_{end}_limit" in soft for end in _ENDS):
        low, high = (
            _number(f"{field}.safety_controller", soft, f"soft_{end}_limit") for end in _ENDS
        )
        if low < high:
            lower, upper = max(lower, low), min(upper, high)
    field += ".limit"
    if lower >= upper:
        raise InputError(None, field, f"lower {lower} is not below upper {upper}")
    most = max(upper, lower, key=abs)
    if slides:
        if _LONGEST < abs(most) <= 1000 * _LONGEST:
            raise InputError(None, field, looks_like_millimeters(most))
    elif beyond_turns(most, 2) and abs(most) <= _MOST_DEGREES:
        message = f"{looks_like_degrees(most)} (a joint that turns endlessly is 'continuous')"
        raise InputError(None, field, message)
    elif abs(most) > _MOST_DEGREES:
        if min(-lower, upper) <= _MOST_DEGREES:
            message = f"{most:g} is as good as none, and the other end has one: give both or none"
            raise InputError(None, field, message)
        return -math.inf, math.inf
    return lower, upper
