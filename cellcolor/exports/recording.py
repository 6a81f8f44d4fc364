"""The motion as an MCAP recording for viewers: joint states, transforms and markers of ROS 2."""

from __future__ import annotations

import io
import re

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.exports.cdr import Messages
from cellcolor.exports.interface import ArmAxes, NotForThisArm, PlannedMotion
from cellcolor.exports.samples import Samples, stretches
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
_TOPICS = (
    ("/joint_states", "sensor_msgs/msg/JointState", _JOINT_STATE),
    ("/tf", "tf2_msgs/msg/TFMessage", _TRANSFORMS),
    ("/markers", "visualization_msgs/msg/MarkerArray", _MARKERS),
)
_LINE_STRIP, _TRIANGLES = 4, 11


def recording(planned: PlannedMotion) -> bytes:
    """``/joint_states``, ``/tf`` (each joint's axis, the tool's tip) and ``/markers``.

    Transforms are in the frame ``world``. The surface and the strokes are markers, at the start.

    Raises:
        NotForThisArm: the package ``mcap`` is not installed, or the arm is not known.
    """
    try:
        from mcap.writer import Writer
    except ImportError as error:
        raise NotForThisArm("a recording needs the package mcap") from error
    if planned.axes is None or planned.axes.slides:
        raise NotForThisArm("a recording needs an arm whose joints all turn")
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start(profile="ros2", library="cellcolor")
    channels = {}
    for topic, kind, definition in _TOPICS:
        schema = writer.register_schema(kind, "ros2msg", definition.encode())
        channels[topic] = writer.register_channel(topic, "cdr", schema)
    writer.add_message(channels["/markers"], 0, _markers(planned), 0)
    for own in stretches(planned.trajectory, planned.step_s or _STEP):
        begun = planned.trajectory.times[own.first] - planned.trajectory.times[0]
        moments = np.round((own.times + begun) * 1e9).astype(np.int64)
        states = _states(planned.axes, own, moments)
        rows = zip(moments.tolist(), states, _transforms(planned.axes, own, moments), strict=True)
        for moment, state, transforms in rows:
            writer.add_message(channels["/joint_states"], moment, state, moment)
            writer.add_message(channels["/tf"], moment, transforms, moment)
    writer.add_metadata(_MARK.decode(), {"made_by": "cellcolor"})
    writer.finish()  # type: ignore[no-untyped-call]
    return stream.getvalue()


def _header(messages: Messages, moments: Index, frame: str = "world") -> None:
    messages.numbers("i4", np.column_stack(np.divmod(moments, 1_000_000_000)))
    messages.text(frame)


def _states(axes: ArmAxes, own: Samples, moments: Index) -> list[bytes]:
    messages = Messages(len(moments))
    _header(messages, moments)
    messages.numbers("u4", len(axes.names))
    for name in axes.names:
        messages.text(name)
    messages.sequence("f8", own.joints)
    messages.sequence("f8", own.velocities)
    messages.sequence("f8", [])  # efforts
    return messages.each()


def _transforms(axes: ArmAxes, own: Samples, moments: Index) -> list[bytes]:
    x = np.zeros_like(own.normals)
    x[np.arange(len(x)), np.argmin(np.abs(own.normals), axis=1)] = 1
    x -= np.sum(x * own.normals, axis=1, keepdims=True) * own.normals
    tips = quaternions(x / np.linalg.norm(x, axis=1, keepdims=True), own.normals)
    frames = [*_frames(axes, own.joints), (own.points, tips)]
    messages = Messages(len(moments))
    messages.numbers("u4", len(frames))
    for name, (points, turns) in zip([*axes.names, "tool_tip"], frames, strict=True):
        _header(messages, moments)
        messages.text(name)
        messages.numbers("f8", points)
        messages.numbers("f8", turns)
    return messages.each()


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


def _markers(planned: PlannedMotion) -> bytes:
    """The surface in the colors of its segments, and a line for each tool path."""
    surface, paths = planned.surface, planned.paths.paths
    fills = np.array([_rgba(fill) for fill in (*planned.fills, "#DDDDDD")])
    corners = surface.faces.ravel()
    colors = fills[planned.segment_of[corners]]  # -1 is the last one
    messages = Messages(1)
    messages.numbers("u4", 1 + len(paths))
    _marker(messages, "surface", 0, _TRIANGLES, 1.0, surface.vertices[corners], colors)
    for number, path in enumerate(paths):
        line = path.points + 0.0005 * path.normals
        _marker(messages, "tool paths", number, _LINE_STRIP, 0.001, line, np.empty((0, 4)))
    return messages.each()[0]


def _marker(
    messages: Messages, space: str, number: int, kind: int, scale: float, points: Array, of: Array
) -> None:
    """A marker at ``points`` (k, 3), each of its own color ``of`` (k, 4), or all dark."""
    now = np.zeros(1, dtype=np.int64)
    _header(messages, now)
    messages.text(space)
    messages.numbers("i4", [number, kind, 0])
    messages.numbers("f8", [0, 0, 0, 0, 0, 0, 1, scale, scale, scale])  # pose and scale
    messages.numbers("f4", [0.1, 0.1, 0.1, 1.0])
    messages.numbers("i4", [0, 0])  # lifetime
    messages.numbers("u1", 0)  # locked to its frame
    for kind_of, rows in (("f8", points), ("f4", of)):
        messages.numbers("u4", len(rows))
        messages.numbers(kind_of, rows.ravel())
    messages.text("")
    _header(messages, now, "")
    messages.text("")  # no texture
    messages.sequence("u1", [])
    messages.sequence("f4", [])
    messages.text("")
    messages.text("")  # no file of a mesh
    messages.sequence("u1", [])
    messages.text("")
    messages.numbers("u1", 0)


def _rgba(fill: str) -> list[float]:
    return [*(byte / 255 for byte in bytes.fromhex(fill.removeprefix("#"))), 1.0]
