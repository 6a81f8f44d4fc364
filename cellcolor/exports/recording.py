"""The motion as an MCAP recording for viewers: joint states, transforms and markers of ROS 2."""

from __future__ import annotations

import io
import re
from typing import Any

import numpy as np

from cellcolor.arrays import Array
from cellcolor.exports.interface import ArmAxes, NotForThisArm, PlannedMotion
from cellcolor.exports.samples import stretches
from cellcolor.exports.tool_poses import quaternions
from cellcolor.files.writing import FileKind

_MARK = b"cellcolor/recording"
KIND = FileKind(
    "a recording written by cellcolor",
    re.compile(rb"\x89MCAP0\r\n.*" + _MARK, re.DOTALL),
)
_STEP = 0.1  # s, unless another one is asked for

_HEADER = """
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec"""
_GEOMETRY = """
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z"""
_JOINT_STATE = (
    "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
    "float64[] effort" + _HEADER
)
_TRANSFORMS = (
    """geometry_msgs/TransformStamped[] transforms
================================================================================
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation"""
    + _GEOMETRY
    + _HEADER
)
_MARKERS = (
    """visualization_msgs/Marker[] markers
================================================================================
MSG: visualization_msgs/Marker
std_msgs/Header header
string ns
int32 id
int32 type
int32 action
geometry_msgs/Pose pose
geometry_msgs/Vector3 scale
std_msgs/ColorRGBA color
builtin_interfaces/Duration lifetime
bool frame_locked
geometry_msgs/Point[] points
std_msgs/ColorRGBA[] colors
string texture_resource
sensor_msgs/CompressedImage texture
visualization_msgs/UVCoordinate[] uv_coordinates
string text
visualization_msgs/MeshFile mesh_file
string mesh_resource
bool mesh_use_embedded_materials
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: std_msgs/ColorRGBA
float32 r
float32 g
float32 b
float32 a
================================================================================
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
================================================================================
MSG: sensor_msgs/CompressedImage
std_msgs/Header header
string format
uint8[] data
================================================================================
MSG: visualization_msgs/UVCoordinate
float32 u
float32 v
================================================================================
MSG: visualization_msgs/MeshFile
string filename
uint8[] data"""
    + _GEOMETRY
    + _HEADER
)
_LINE_STRIP, _TRIANGLES = 4, 11


def recording(planned: PlannedMotion) -> bytes:
    """``/joint_states``, ``/tf`` (each joint's axis, the tool's tip) and ``/markers``.

    Transforms are in the frame ``world``. The surface and the strokes are markers, at the start.

    Raises:
        NotForThisArm: the package ``mcap-ros2-support`` is not installed, or the arm is not known.
    """
    try:
        from mcap_ros2.writer import Writer
    except ImportError as error:
        raise NotForThisArm("a recording needs the package mcap-ros2-support") from error
    if planned.axes is None or planned.axes.slides:
        raise NotForThisArm("a recording needs an arm whose joints all turn")
    stream = io.BytesIO()
    writer = Writer(stream)
    states = writer.register_msgdef("sensor_msgs/msg/JointState", _JOINT_STATE)
    frames = writer.register_msgdef("tf2_msgs/msg/TFMessage", _TRANSFORMS)
    markers = writer.register_msgdef("visualization_msgs/msg/MarkerArray", _MARKERS)
    writer.write_message("/markers", markers, {"markers": _markers(planned)}, 0, 0)
    names = list(planned.axes.names)
    for own in stretches(planned.trajectory, planned.step_s or _STEP):
        begun = planned.trajectory.times[own.first] - planned.trajectory.times[0]
        moments = np.round((own.times + begun) * 1e9).astype(np.int64).tolist()
        x = np.zeros_like(own.normals)
        x[np.arange(len(x)), np.argmin(np.abs(own.normals), axis=1)] = 1
        x -= np.sum(x * own.normals, axis=1, keepdims=True) * own.normals
        tips = quaternions(x / np.linalg.norm(x, axis=1, keepdims=True), own.normals)
        poses = [*_frames(planned.axes, own.joints), (own.points, tips)]
        for row, moment in enumerate(moments):
            header = {"stamp": _stamp(moment), "frame_id": "world"}
            state = {
                "header": header,
                "name": names,
                "position": own.joints[row].tolist(),
                "velocity": own.velocities[row].tolist(),
                "effort": [],
            }
            writer.write_message("/joint_states", states, state, moment, moment)
            transforms = [
                {
                    "header": header,
                    "child_frame_id": name,
                    "transform": {"translation": _xyz(points[row]), "rotation": _xyzw(turns[row])},
                }
                for name, (points, turns) in zip([*names, "tool_tip"], poses, strict=True)
            ]
            writer.write_message("/tf", frames, {"transforms": transforms}, moment, moment)
    writer.add_metadata(_MARK.decode(), {"made_by": "cellcolor"})
    writer.finish()  # type: ignore[no-untyped-call]
    return stream.getvalue()


def _frames(axes: ArmAxes, joints: Array) -> list[tuple[Array, Array]]:
    """Where each axis is (k, 3) and how its link is turned (k, 4), for joints (k, n)."""
    from scipy.spatial.transform import Rotation

    turn, shift = Rotation.identity(len(joints)), np.zeros((len(joints), 3))
    found = []
    for point, direction, angles in zip(axes.points, axes.directions, joints.T, strict=True):
        own = turn * Rotation.from_rotvec(angles[:, None] * direction)
        shift = turn.apply(point) + shift - own.apply(point)
        turn = own
        found.append((turn.apply(point) + shift, turn.as_quat()))
    return found


def _markers(planned: PlannedMotion) -> list[dict[str, Any]]:
    """The surface in the colors of its segments, and a line for each tool path."""
    surface = planned.surface
    fills = np.array([_rgba(fill) for fill in (*planned.fills, "#DDDDDD")])
    corners = surface.faces.ravel()
    colors = fills[planned.segment_of[corners]]  # -1 is the last one
    found = [_marker("surface", 0, _TRIANGLES, 1.0, surface.vertices[corners], colors)]
    found += [
        _marker("tool paths", number, _LINE_STRIP, 0.001, path.points + 0.0005 * path.normals, None)
        for number, path in enumerate(planned.paths.paths)
    ]
    return found


def _marker(
    space: str, number: int, kind: int, scale: float, points: Array, colors: Array | None
) -> dict[str, Any]:
    shades = [] if colors is None else [_shade(color) for color in colors.tolist()]
    return {
        "header": {"stamp": _stamp(0), "frame_id": "world"},
        "ns": space,
        "id": number,
        "type": kind,
        "action": 0,
        "pose": {"position": _xyz(np.zeros(3)), "orientation": _xyzw(np.eye(4)[3])},
        "scale": dict.fromkeys("xyz", scale),
        "color": _shade([0.1, 0.1, 0.1, 1.0]),
        "lifetime": _stamp(0),
        "frame_locked": False,
        "points": [_xyz(point) for point in points],
        "colors": shades,
        "texture_resource": "",
        "texture": {"header": {"stamp": _stamp(0), "frame_id": ""}, "format": "", "data": b""},
        "uv_coordinates": [],
        "text": "",
        "mesh_file": {"filename": "", "data": b""},
        "mesh_resource": "",
        "mesh_use_embedded_materials": False,
    }


def _rgba(fill: str) -> list[float]:
    return [*(byte / 255 for byte in bytes.fromhex(fill.removeprefix("#"))), 1.0]


def _shade(color: list[float]) -> dict[str, float]:
    return dict(zip("rgba", color, strict=True))


def _stamp(moment: int) -> dict[str, int]:
    return {"sec": moment // 1_000_000_000, "nanosec": moment % 1_000_000_000}


def _xyz(point: Array) -> dict[str, float]:
    return dict(zip("xyz", point.tolist(), strict=True))


def _xyzw(turn: Array) -> dict[str, float]:
    return dict(zip("xyzw", turn.tolist(), strict=True))
