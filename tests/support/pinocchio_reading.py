"""An arm and its tool as Pinocchio reads their files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import pinocchio as pin

from cellcolor.frontend.arm.robot import Robot


def readable(file: Path) -> str:
    """The URDF with zeros where efforts and velocities are missing, without which it is refused."""
    xml = ET.fromstring(file.read_text("utf-8"))
    for limit in xml.iter("limit"):
        limit.attrib = {"effort": "0", "velocity": "0"} | limit.attrib
    return ET.tostring(xml, encoding="unicode")


def geometry_of(robot: Robot) -> pin.GeometryModel:
    """Shapes on the joints of the robot's model, under the frames of their links."""
    geometry = pin.GeometryModel()
    for text in map(readable, robot.files):
        own = pin.buildModelFromXML(text)
        read = pin.buildGeomFromUrdfString(own, text, pin.GeometryType.COLLISION)
        for shape in read.geometryObjects:
            link = own.frames[shape.parentFrame]
            frame = robot.model.getFrameId(link.name, pin.FrameType.BODY)
            there = robot.model.frames[frame]
            shape.placement = there.placement * link.placement.inverse() * shape.placement
            shape.parentJoint, shape.parentFrame = there.parentJoint, frame
            geometry.addGeometryObject(shape)
    return geometry
