"""The motion as an MCAP recording for viewers: joint states, transforms and markers of ROS 2."""

from __future__ import annotations

import io
import re
from importlib.util import find_spec
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, unit
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
_WORLD = "world"  # the frame that everything is in

Field: TypeAlias = "str | NDArray[Any] | np.number[Any]"
_ZERO, _NO = np.uint32(0), np.uint8(0)


def check(planned: PlannedMotion) -> None:
    """Refuse an arm of which there can be no recording.

    Raises:
        NotForThisArm: the package ``mcap`` is not installed, or the arm is not known.
    """
    if find_spec("mcap") is None:
        raise NotForThisArm("it needs the package mcap")
    if planned.axes is None or planned.axes.slides:
        raise NotForThisArm("it needs an arm whose joints all turn")


def recording(planned: PlannedMotion) -> bytes:
    """``/joint_states``, ``/tf`` (each joint's axis, the tool's tip) and ``/markers``.

    Transforms are in the frame ``world``. The surface and the strokes are markers, at the start.

    Raises:
        NotForThisArm: as of :func:`check`.
    """
    check(planned)
    assert planned.axes is not None
    from mcap.well_known import MessageEncoding, Profile, SchemaEncoding
    from mcap.writer import Writer

    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start(Profile.ROS2)

    def channel(topic: str, kind: str, definition: str) -> int:
        schema = writer.register_schema(kind, SchemaEncoding.ROS2, definition.encode())
        return writer.register_channel(topic, MessageEncoding.CDR, schema)

    states = channel("/joint_states", "sensor_msgs/msg/JointState", _JOINT_STATE)
    frames = channel("/tf", "tf2_msgs/msg/TFMessage", _TRANSFORMS)
    markers = channel("/markers", "visualization_msgs/msg/MarkerArray", _MARKERS)
    writer.add_message(markers, 0, _cdr(*_markers(planned)), 0)
    names = list(planned.axes.names)
    count, tip = np.uint32(len(names)), [*names, "tool_tip"]
    for own in stretches(planned.trajectory, planned.step_s or _STEP):
        begun = planned.trajectory.times[own.first] - planned.trajectory.times[0]
        moments = np.round((own.times + begun) * 1e9).astype(np.int64).tolist()
        x = np.zeros_like(own.normals)  # across the normal, from the axis that is least along it
        x[np.arange(len(x)), np.argmin(np.abs(own.normals), axis=1)] = 1
        x -= np.sum(x * own.normals, axis=1, keepdims=True) * own.normals
        tips = quaternions(unit(x), own.normals)
        poses = [*_frames(planned.axes, own.joints), (own.points, tips)]
        places = [np.concatenate(pose, axis=1) for pose in poses]
        for row, moment in enumerate(moments):
            stamp = np.array(divmod(moment, 1_000_000_000), dtype=np.uint32)
            moved = (count, own.joints[row], count, own.velocities[row], _ZERO)  # without efforts
            state = _cdr(stamp, _WORLD, count, *names, *moved)
            writer.add_message(states, moment, state, moment)
            transforms: list[Field] = [np.uint32(len(tip))]
            for name, place in zip(tip, places, strict=True):
                transforms += [stamp, _WORLD, name, place[row]]
            writer.add_message(frames, moment, _cdr(*transforms), moment)
    writer.add_metadata(_MARK.decode(), {"made_by": "cellcolor"})
    writer.finish()  # type: ignore[no-untyped-call]
    return stream.getvalue()


def _cdr(*fields: Field) -> bytes:
    """A message's fields in their order, as ROS 2 sends them (OMG CDR, little-endian).

    Each number begins at a multiple of its size. A sequence is two fields: its length, its items.
    """
    message, head = bytearray(), b"\x00\x01\x00\x00"
    for field in fields:
        if isinstance(field, str):
            text = field.encode() + b"\x00"
            message += bytes(-len(message) % 4) + len(text).to_bytes(4, "little") + text
        elif field.size:
            message += bytes(-len(message) % field.itemsize) + field.tobytes()
    return head + bytes(message)


def _frames(axes: ArmAxes, joints: Array) -> list[tuple[Array, Array]]:
    """Where each axis is (k, 3) and how its link is turned (k, 4), for joints (k, n)."""
    moved = zip(axes.points, axes.moved(joints), strict=True)
    return [(turn.apply(point) + shift, turn.as_quat()) for point, (turn, shift) in moved]


def _markers(planned: PlannedMotion) -> list[Field]:
    """The surface in the colors of its segments, and a line for each tool path."""
    surface = planned.surface
    corners = surface.faces.ravel()
    colors = (planned.colors[corners] / 255).astype(np.float32)
    paths = planned.paths.paths
    found: list[Field] = [np.uint32(1 + len(paths))]
    found += _marker("surface", 0, _TRIANGLES, 1.0, surface.vertices[corners], colors)
    for number, path in enumerate(paths):
        line = path.points + 0.0005 * path.normals
        found += _marker("tool paths", number, _LINE_STRIP, 0.001, line, colors[:0])
    return found


def _marker(
    space: str, number: int, kind: int, scale: float, points: Array, colors: NDArray[np.float32]
) -> list[Field]:
    """The fields of a marker that stays where its points are."""
    never = np.zeros(2, dtype=np.uint32)
    posed: list[Field] = [np.array([0, 0, 0, 0, 0, 0, 1.0]), np.full(3, scale)]
    shade = np.array([0.1, 0.1, 0.1, 1.0], dtype=np.float32)
    what = np.array([number, kind, 0], dtype=np.int32)  # 0: is to be shown
    drawn: list[Field] = [np.uint32(len(points)), points, np.uint32(len(colors)), colors]
    texture: list[Field] = ["", never, "", "", _ZERO, _ZERO]  # no texture
    others: list[Field] = ["", "", _ZERO, "", _NO]  # no text, no mesh
    return [never, _WORLD, space, what, *posed, shade, never, _NO, *drawn, *texture, *others]
