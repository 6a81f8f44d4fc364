"""A checked URDF as Pinocchio is to read it: what it would refuse or swallow put into its words.

Continuous joints become revolute ones, which have one position each; joints get the efforts and
velocities that the reader asks for, links lose inertials that cannot be used, and pictures are
left out. A mesh or a capsule becomes a small sphere, which has the same place.
"""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET

from cellcolor.frontend.arm.urdf import CONTINUOUS, Urdf

__all__ = ["pinocchio_text"]

_NO_LIMIT = 1e6  # rad; for those who ask the model itself


def pinocchio_text(urdf: Urdf) -> str:
    """The XML as one string."""
    xml = ET.Element("robot", dict(urdf.xml.attrib))
    faulty = {error.field for error in urdf.weightless}
    for element in urdf.xml:
        if element.tag == "joint":
            xml.append(_joint(element))
        elif element.tag == "link":
            xml.append(_link(element, faulty))
    return ET.tostring(xml, encoding="unicode")


def _joint(given: ET.Element) -> ET.Element:
    joint = copy.deepcopy(given)
    continuous = joint.get("type") == CONTINUOUS
    if continuous:
        joint.set("type", "revolute")
    limit = joint.find("limit")
    if joint.get("type") == "fixed":
        if limit is not None:  # of a joint that stands still now; it may be incomplete
            joint.remove(limit)
    else:
        if limit is None:
            limit = ET.SubElement(joint, "limit")
        for attribute in ("effort", "velocity"):
            limit.set(attribute, limit.get(attribute, "0"))
        if continuous:
            limit.set("lower", str(-_NO_LIMIT))
            limit.set("upper", str(_NO_LIMIT))
    return joint


def _link(given: ET.Element, faulty: set[str | None]) -> ET.Element:
    link = copy.deepcopy(given)
    for visual in link.findall("visual"):
        link.remove(visual)
    inertial = link.find("inertial")
    field = f"link[{link.get('name')}].inertial"
    if inertial is not None and any((f or "").startswith(field) for f in faulty):
        link.remove(inertial)
    for collision in link.findall("collision"):
        geometry = collision.find("geometry")
        assert geometry is not None  # checked
        if geometry[0].tag in ("mesh", "capsule"):
            geometry[:] = [ET.Element("sphere", {"radius": "0.001"})]
    return link
