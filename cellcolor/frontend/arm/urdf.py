"""URDF text, checked before any robotics library sees it.

Pinocchio answers most URDF faults with the same sentence, reads a missing limit as [0, 0] and a
missing inertial as no mass, and drops collision shapes it does not know with a remark on standard
error. So the XML is held to what the front end relies on here. The first fault is raised as an
:class:`~cellcolor.errors.InputError` that names file and field.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from cellcolor.data.wording import beyond_turns, looks_like_degrees, looks_like_millimeters
from cellcolor.errors import InputError, naming
from cellcolor.files.documents import read_text


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


def _number(field: str, element: ET.Element | None, attribute: str) -> float:
    """A finite number that has to be there."""
    text = None if element is None else element.get(attribute)
    if text is None:
        raise InputError(None, field, f"{attribute!r} is missing")
    return _finite(f"{field}.{attribute}", text)


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


def _check_origin(field: str, element: ET.Element) -> None:
    """Hold an element's ``<origin>``, if there is one, to three numbers each."""
    origin = element.find("origin")
    if origin is not None:
        for attribute in ("xyz", "rpy"):
            values = _triple(f"{field}.origin.{attribute}", origin.get(attribute, "0 0 0"))
            if attribute == "rpy" and beyond_turns(most := max(values, key=abs), 1):
                raise InputError(None, f"{field}.origin.rpy", looks_like_degrees(most))


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


def _shape(field: str, collision: ET.Element) -> LinkShape:
    _check_origin(field, collision)
    geometry = collision.find("geometry")
    shapes = [] if geometry is None else list(geometry)
    if len(shapes) != 1 or shapes[0].tag not in _KINDS:
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
        return LinkShape(kind, tuple(scale), named)
    if kind == "box":
        size = _triple(f"{field}.box.size", shape.get("size", ""))
        if min(size) <= 0:
            raise InputError(None, f"{field}.box.size", "must be positive")
        return LinkShape(kind, tuple(size))
    sizes = []
    for attribute in _SIZES[kind]:
        sizes.append(_number(field, shape, attribute))
        if sizes[-1] <= 0:
            raise InputError(None, f"{field}.{attribute}", "must be positive")
    return LinkShape(kind, tuple(sizes))


_LONGEST = 60.0  # m; of a rail
_MOST_DEGREES = 3600  # of a joint's limit; beyond, as 999999, it means that there is none
CONTINUOUS, PRISMATIC = "continuous", "prismatic"
_MOVING = ("revolute", CONTINUOUS, PRISMATIC)


@dataclass(frozen=True)
class Follower:
    """A joint with ``<mimic>``: at ``multiplier`` times the leader's position plus ``offset``."""

    leader: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Urdf:
    """A checked URDF tree.

    Attributes:
        folder: what relative file names in it are relative to.
        root: the link that nothing carries.
        links, joints: the elements by their names.
        parent: the link that carries each other link.
        joint_above: the name of the joint between a link and its parent.
        kinds: the type of each joint that can move, followers included, in the order of the file.
        shapes: the collision shapes of each link that has any.
        followers: the joints that follow another one.
    """

    file: Path
    folder: Path
    root: str
    links: dict[str, ET.Element]
    joints: dict[str, ET.Element]
    parent: dict[str, str]
    joint_above: dict[str, str]
    kinds: dict[str, str]
    shapes: dict[str, tuple[LinkShape, ...]]
    followers: dict[str, Follower]

    @property
    def leading(self) -> dict[str, str]:
        """The types of the joints that can move and follow no other one."""
        return {name: kind for name, kind in self.kinds.items() if name not in self.followers}

    def chain(self, link: str) -> tuple[str, ...]:
        """The links from the root to ``link``, both included."""
        links = [link]
        while links[-1] in self.parent:
            links.append(self.parent[links[-1]])
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
        links, joints = _named(xml, "link"), _named(xml, "joint")
        parent: dict[str, str] = {}
        joint_above: dict[str, str] = {}
        kinds: dict[str, str] = {}
        followers: dict[str, Follower] = {}
        for name, joint in joints.items():
            above, below = (_end(name, joint, end, links) for end in ("parent", "child"))
            if below in parent:
                raise InputError(None, f"joint[{name}].child", f"{below!r} hangs on two joints")
            parent[below], joint_above[below] = above, name
            _check_origin(f"joint[{name}]", joint)
            kind = _kind(name, joint)
            if kind != "fixed":
                kinds[name] = kind
                if (mimic := joint.find("mimic")) is not None:
                    factor, offset = (
                        _finite(f"joint[{name}].mimic.{key}", mimic.get(key, usual))
                        for key, usual in (("multiplier", "1"), ("offset", "0"))
                    )
                    followers[name] = Follower(mimic.get("joint", ""), factor, offset)
        roots = [link for link in links if link not in parent]
        if len(roots) != 1:
            raise InputError(None, "robot", f"needs one root link, has {len(roots)}: {roots}")
        shapes = {
            name: tuple(
                _shape(f"link[{name}].collision[{number}]", collision)
                for number, collision in enumerate(link.findall("collision"))
            )
            for name, link in links.items()
            if link.find("collision") is not None
        }
    return Urdf(
        file, folder, roots[0], links, joints, parent, joint_above, kinds, shapes, followers
    )


def _refuse_xacro(text: str, file: Path) -> None:
    """Refuse what has to be expanded first; the declaration of xacro's name alone is harmless."""
    without = re.sub(r"""xmlns:xacro\s*=\s*("[^"]*"|'[^']*')""", "", text)
    without = re.sub(r"<!--.*?-->", "", without, flags=re.DOTALL)
    if re.search(r"</?xacro:|=\s*[\"'][^\"']*\$[{(]", without):
        out = file.name.removesuffix(".xacro").removesuffix(".urdf") + ".urdf"
        command = f"xacro {file.name} -o {out}"
        message = f"is a xacro file; expand it first: {command} (without ROS: pip install xacrodoc)"
        raise InputError(None, "robot", message)


def _end(name: str, joint: ET.Element, end: str, links: Collection[str]) -> str:
    """The link at one end of a joint."""
    element = joint.find(end)
    link = None if element is None else element.get("link")
    if link not in links:
        raise InputError(None, f"joint[{name}].{end}", f"no link {link!r}")
    return str(link)


def _kind(name: str, joint: ET.Element) -> str:
    """The type of a joint whose axis and limits are good; continuous if these mean none."""
    kind = joint.get("type", "")
    if kind == "fixed":
        return kind
    if kind not in _MOVING:
        message = f"{kind!r}: only revolute, continuous, prismatic and fixed joints"
        raise InputError(None, f"joint[{name}].type", message)
    field = f"joint[{name}].axis"
    if abs(math.hypot(*_triple(field, axis_of(joint))) - 1) > 1e-6:
        raise InputError(None, field, "must have length 1")
    if joint.find("mimic") is not None:  # whose limits count where its leader moves
        return kind
    return CONTINUOUS if math.isinf(limits_of(joint)[0]) else kind


def axis_of(joint: ET.Element) -> str:
    """The axis of a joint as its file has it, three numbers."""
    axis = joint.find("axis")
    return "1 0 0" if axis is None else axis.get("xyz", "1 0 0")


def limits_of(joint: ET.Element) -> tuple[float, float]:
    """The limits of a joint that moves, in rad or m, infinite if it has none.

    They are its soft ones where it has some, beyond which a controller stops it. Soft limits that
    leave no range are none: both are zero where nobody wrote any. Only a follower may have none.

    Raises:
        InputError: one is missing, they are no range, or in another unit.
    """
    kind, given = joint.get("type"), joint.find("limit")
    if kind == CONTINUOUS or (given is None and joint.find("mimic") is not None):
        return -math.inf, math.inf
    field = f"joint[{joint.get('name')}]"
    lower, upper = (_number(f"{field}.limit", given, end) for end in ("lower", "upper"))
    soft = joint.find("safety_controller")
    softer = [None if soft is None else soft.get(f"soft_{end}_limit") for end in ("lower", "upper")]
    if None not in softer:
        low, high = (_finite(f"{field}.safety_controller", str(text)) for text in softer)
        if low < high:
            lower, upper = max(lower, low), min(upper, high)
    field += ".limit"
    if lower >= upper:
        raise InputError(None, field, f"lower {lower} is not below upper {upper}")
    most = max(upper, lower, key=abs)
    if kind == PRISMATIC:
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


def effort_fault(joint: ET.Element) -> InputError | None:
    """What is wrong with a joint's effort; vendors write 0 where they do not say it."""
    field = f"joint[{joint.get('name')}].limit"
    try:
        effort = _number(field, joint.find("limit"), "effort")
    except InputError as error:
        return error
    if effort <= 0:
        return InputError(None, f"{field}.effort", f"is {effort:g}, must be positive")
    return None


def inertial_fault(link: ET.Element) -> InputError | None:
    """Why a link's weight is not known."""
    field, inertial = f"link[{link.get('name')}].inertial", link.find("inertial")
    if inertial is None:
        return InputError(None, field, "is missing: the link would weigh nothing")
    try:
        _check_origin(field, inertial)
        if _number(f"{field}.mass", inertial.find("mass"), "value") <= 0:
            return InputError(None, f"{field}.mass", "must be positive")
        for entry in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
            _number(f"{field}.inertia", inertial.find("inertia"), entry)
    except InputError as error:
        return error
    return None
