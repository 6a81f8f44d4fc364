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
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
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
_THING = ("inertial", "visual")  # what a link that is more than a frame has


@dataclass(frozen=True)
class Follower:
    """A joint with ``<mimic>``: its position is ``multiplier`` times the leader's plus ``offset``.

    In the XML it is a fixed joint, which stands at zero; ``kind`` is the type that it had.
    """

    leader: str
    kind: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Urdf:
    """A checked URDF tree.

    Attributes:
        folder: what relative file names in it are relative to.
        root: the link that nothing carries.
        parent: the link that carries each other link.
        joint_above: the name of the joint between a link and its parent.
        kinds: the type of each joint that can move, in the order of the file.
        shapes: the collision shapes of each link that has any.
        shapeless: the links without one that are things all the same: they have a mass or a
            picture, or a joint moves them.
        weightless: why the force constraint cannot be tested: what is wrong with the mass of
            links that a joint moves, and with the effort of joints.
        locked: joints that follow another one (``<mimic>``) and are not fixed with it; they are
            written as fixed at zero.
        followers: all joints that follow another one, fixed or not.
    """

    file: Path
    folder: Path
    xml: ET.Element
    root: str
    parent: dict[str, str]
    joint_above: dict[str, str]
    kinds: dict[str, str]
    shapes: dict[str, tuple[LinkShape, ...]]
    shapeless: tuple[str, ...]
    weightless: tuple[InputError, ...]
    locked: tuple[str, ...]
    followers: Mapping[str, Follower]

    def settled_followers(self) -> tuple[dict[str, Follower], dict[str, float]]:
        """Those of the ``locked`` joints that move, and the positions of the others.

        What follows a follower is written as if it followed the first leader directly. One
        whose leader is fixed stands where it is with the leader at zero.

        Raises:
            InputError: a joint follows one that is not there, or itself.
        """
        moving, standing = {}, {}
        known = set(self.joint_above.values())
        for name in self.locked:
            leader, factor, offset, seen = name, 1.0, 0.0, {name}
            while leader in self.locked:
                own = self.followers[leader]
                leader, offset = own.leader, offset + factor * own.offset
                factor *= own.multiplier
                if leader not in known or leader in seen:
                    fault = "follows itself" if leader in seen else f"no joint {leader!r}"
                    raise InputError(str(self.file), f"joint[{name}].mimic", fault)
                seen.add(leader)
            if leader in self.kinds and factor:
                moving[name] = Follower(leader, self.followers[name].kind, factor, offset)
            else:
                standing[name] = offset
        return moving, standing

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
        InputError: not XML, a xacro file, or what :func:`check_urdf` refuses.
    """
    with naming(file):
        _refuse_xacro(text, file)
        try:
            xml = ET.fromstring(text)
        except ET.ParseError as error:
            raise InputError(None, None, f"not XML: {error}") from error
        if xml.tag != "robot":
            raise InputError(None, xml.tag, "the outermost element of a URDF is <robot>")
        followers = _followers(xml)
        _soften(xml)
    return check_urdf(file, folder, xml, tuple(followers), followers)


def _refuse_xacro(text: str, file: Path) -> None:
    """Refuse what has to be expanded first; the declaration of xacro's name alone is harmless."""
    without = re.sub(r"""xmlns:xacro\s*=\s*("[^"]*"|'[^']*')""", "", text)
    without = re.sub(r"<!--.*?-->", "", without, flags=re.DOTALL)
    if re.search(r"</?xacro:|=\s*[\"'][^\"']*\$[{(]", without):
        out = file.name.removesuffix(".xacro").removesuffix(".urdf") + ".urdf"
        command = f"xacro {file.name} -o {out}"
        message = f"is a xacro file; expand it first: {command} (without ROS: pip install xacrodoc)"
        raise InputError(None, "robot", message)


def _followers(xml: ET.Element) -> dict[str, Follower]:
    """Fix the joints that follow another one, and name them."""
    found = {}
    for joint in xml.findall("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            name = joint.get("name", "")
            where = f"joint[{name}].mimic"
            factor, offset = (
                _finite(f"{where}.{attribute}", mimic.get(attribute, usual))
                for attribute, usual in (("multiplier", "1"), ("offset", "0"))
            )
            kind = joint.get("type", "")
            found[name] = Follower(mimic.get("joint", ""), kind, factor, offset)
            joint.remove(mimic)
            joint.set("type", "fixed")
    return found


def _soften(xml: ET.Element) -> None:
    """Narrow the limits of joints to their soft ones, beyond which a controller stops them.

    Soft limits that are missing, or leave no range, are none: both are zero where nobody wrote any.
    """
    for joint in xml.findall("joint"):
        soft, limit = joint.find("safety_controller"), joint.find("limit")
        if soft is None or limit is None or joint.get("type") == CONTINUOUS:
            continue
        field = f"joint[{joint.get('name', '')}].safety_controller"
        names = [f"soft_{end}_limit" for end in ("lower", "upper")]
        given = [soft.get(name) for name in names]
        if None in given:
            continue
        low, high = (_finite(f"{field}.{name}", soft.get(name, "")) for name in names)
        if low < high:
            for end, better, value in (("lower", max, low), ("upper", min, high)):
                own = _number(f"joint[{joint.get('name', '')}].limit", limit, end)
                limit.set(end, repr(better(own, value)))


def check_urdf(
    file: Path,
    folder: Path,
    xml: ET.Element,
    locked: tuple[str, ...],
    followers: Mapping[str, Follower],
) -> Urdf:
    """Check a tree; arguments as of :class:`Urdf`.

    Raises:
        InputError: not one tree, a joint that floats or has no usable limits, a collision shape of
            an unknown kind, numbers that are not finite.
    """
    with naming(file):
        links, joints = _named(xml, "link"), _named(xml, "joint")
        parent, joint_above, kinds = _tree(links, joints)
        roots = [link for link in links if link not in parent]
        if len(roots) != 1:
            raise InputError(None, "robot", f"needs one root link, has {len(roots)}: {roots}")
        driven = {link for link, name in joint_above.items() if name in kinds}
        shapes, shapeless = _shapes(links, driven)
    tree = Urdf(
        file, folder, xml, roots[0], parent, joint_above, kinds, shapes, shapeless, (), locked,
        followers,
    )  # fmt: skip
    return replace(tree, weightless=tuple(_weightless(tree, links, joints, driven)))


def _tree(
    links: Mapping[str, ET.Element], joints: Mapping[str, ET.Element]
) -> tuple[dict[str, str], dict[str, str], dict[str, str]]:
    """The parent of each link, the joint between the two, and the kinds of joints that move."""
    parent: dict[str, str] = {}
    joint_above: dict[str, str] = {}
    kinds: dict[str, str] = {}
    for name, joint in joints.items():
        ends = []
        for end in ("parent", "child"):
            element = joint.find(end)
            link = None if element is None else element.get("link")
            if link not in links:
                raise InputError(None, f"joint[{name}].{end}", f"no link {link!r}")
            ends.append(str(link))
        above, below = ends
        if below in parent:
            raise InputError(None, f"joint[{name}].child", f"{below!r} hangs on two joints")
        parent[below], joint_above[below] = above, name
        _check_origin(f"joint[{name}]", joint)
        kind = joint.get("type", "")
        if kind in _MOVING:
            if kind != CONTINUOUS:
                kind = _limits(name, joint, kind)
            _axis(name, joint)
            kinds[name] = kind
        elif kind != "fixed":
            message = f"{kind!r}: only revolute, continuous, prismatic and fixed joints"
            raise InputError(None, f"joint[{name}].type", message)
    return parent, joint_above, kinds


def _shapes(
    links: Mapping[str, ET.Element], driven: Collection[str]
) -> tuple[dict[str, tuple[LinkShape, ...]], tuple[str, ...]]:
    """The collision shapes of links, and the links without any that are things all the same."""
    shapes, shapeless = {}, []
    for name, element in links.items():
        own = tuple(
            _shape(f"link[{name}].collision[{number}]", collision)
            for number, collision in enumerate(element.findall("collision"))
        )
        if own:
            shapes[name] = own
        elif name in driven or any(element.find(tag) is not None for tag in _THING):
            shapeless.append(name)
    return shapes, tuple(shapeless)


def check_follower(name: str, joint: ET.Element, kind: str) -> None:
    """Hold a joint that moves with another one to what is asked of others; limits may be left out.

    Raises:
        InputError: it is of another kind, or has no usable axis or limits.
    """
    if kind not in _MOVING:
        message = f"{kind!r}: only revolute, continuous and prismatic joints can follow another one"
        raise InputError(None, f"joint[{name}].type", message)
    if kind != CONTINUOUS and joint.find("limit") is not None:
        _limits(name, joint, kind)
    _axis(name, joint)


def _weightless(
    tree: Urdf, links: dict[str, ET.Element], joints: dict[str, ET.Element], driven: set[str]
) -> Iterator[InputError]:
    """What keeps the force constraint from being tested; what nothing moves may weigh anything."""
    for name in tree.kinds:
        fault = _effort(name, joints[name])
        if fault is not None:
            yield fault
    for name, element in links.items():
        carried = any(link in driven for link in tree.chain(name))
        if carried and (name in tree.shapes or name in driven):
            try:
                _inertial(name, element)
            except InputError as error:
                yield error


def _limits(name: str, joint: ET.Element, kind: str) -> str:
    """Check a joint's limits; its kind, which becomes continuous where they mean none."""
    field = f"joint[{name}].limit"
    limit = joint.find("limit")
    lower = _number(field, limit, "lower")
    upper = _number(field, limit, "upper")
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
        joint.set("type", CONTINUOUS)
        return CONTINUOUS
    return kind


def _effort(name: str, joint: ET.Element) -> InputError | None:
    """What is wrong with a joint's effort; vendors write 0 where they do not say it."""
    field = f"joint[{name}].limit"
    try:
        effort = _number(field, joint.find("limit"), "effort")
    except InputError as error:
        return error
    if effort <= 0:
        return InputError(None, f"{field}.effort", f"is {effort:g}, must be positive")
    return None


def axis_of(joint: ET.Element) -> str:
    """The axis of a joint as its file has it, three numbers."""
    axis = joint.find("axis")
    return "1 0 0" if axis is None else axis.get("xyz", "1 0 0")


def _axis(name: str, joint: ET.Element) -> None:
    field = f"joint[{name}].axis"
    if abs(math.hypot(*_triple(field, axis_of(joint))) - 1) > 1e-6:
        raise InputError(None, field, "must have length 1")


def _inertial(name: str, link: ET.Element) -> None:
    field = f"link[{name}].inertial"
    inertial = link.find("inertial")
    if inertial is None:
        raise InputError(None, field, "is missing: the link would weigh nothing")
    _check_origin(field, inertial)
    if _number(f"{field}.mass", inertial.find("mass"), "value") <= 0:
        raise InputError(None, f"{field}.mass", "must be positive")
    for entry in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        _number(f"{field}.inertia", inertial.find("inertia"), entry)
