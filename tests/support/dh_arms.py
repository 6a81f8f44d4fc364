"""Arms written from Denavit-Hartenberg constants that their makers or papers have published.

Constants are a, alpha, d and the offset of theta, in m and degrees, joint after joint: each turns
about z, then comes the way d along z, a along the new x, and the twist alpha about it.
"""

from __future__ import annotations

import numpy as np
from assembled import load_robot
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.setup import RobotFiles

Constants = tuple[tuple[float, float, float, float], ...]

ARMS: dict[str, Constants] = {
    # KUKA KR 6 R900 sixx, data sheet: wrist in line, shoulder 25 mm in front.
    "kr6": (
        (0.025, -90, 0.400, 0),
        (0.455, 0, 0, 0),
        (0.035, -90, 0, -90),
        (0, 90, 0.420, 0),
        (0, -90, 0, 0),
        (0, 0, 0.080, 0),
    ),
    # ABB IRB 120, product manual: no offset of the shoulder.
    "irb120": (
        (0, -90, 0.290, 0),
        (0.270, 0, 0, -90),
        (0.070, -90, 0, 0),
        (0, 90, 0.302, 0),
        (0, -90, 0, 0),
        (0, 0, 0.072, 180),
    ),
    # Unimation PUMA 560 (Corke and Armstrong 1994): upper arm and forearm beside the base's axis.
    "puma560": (
        (0, 90, 0.672, 0),
        (0.4318, 0, 0, 0),
        (0.0203, -90, 0.15005, 0),
        (0, 90, 0.4318, 0),
        (0, -90, 0, 0),
        (0, 0, 0.056, 0),
    ),
    # Universal Robots UR5e, the maker's page on Denavit-Hartenberg parameters.
    "ur5e": (
        (0, 90, 0.1625, 0),
        (-0.425, 0, 0, 0),
        (-0.3922, 0, 0, 0),
        (0, 90, 0.1333, 0),
        (0, -90, 0.0997, 0),
        (0, 0, 0.0996, 0),
    ),
    # Three parallel axes, but 5 and 6 pass each other at 50 mm: made up, its signs have no names.
    "passing": (
        (0, -90, 0.3, 0),
        (0.4, 0, 0, 0),
        (0.4, 0, 0, 0),
        (0, 90, 0.1, 0),
        (0.05, -90, 0.1, 0),
        (0, 0, 0.1, 0),
    ),
    # Spherical wrist on the cuspidal 3R arm of Wenger (1992), its lengths halved or less: 2 is not
    # parallel to 3, and no two neighbors of the first three axes meet.
    "cuspidal": (
        (0.4, -90, 0.4, 0),
        (0.8, 90, 0.4, 0),
        (0, -90, 0, 0),
        (0, 90, 0.6, 0),
        (0, -90, 0, 0),
        (0, 0, 0.08, 0),
    ),
    # FANUC CRX-10iA (Abbes and Poisson 2024): the wrist's axes 4 and 6 pass each other at 150 mm.
    "crx10ia": (
        (0, -90, 0.245, 0),
        (0.540, 0, 0, -90),
        (0, -90, 0, 0),
        (0, 90, 0.540, 0),
        (0, -90, 0.150, 0),
        (0, 0, 0.160, 0),
    ),
    # UFACTORY xArm6, the maker's manual: axes 5 and 6 pass each other at 76 mm.
    "xarm6": (
        (0, -90, 0.267, 0),
        (0.28948866, 0, 0, -79.34995),
        (0.0775, -90, 0, 79.34995),
        (0, 90, 0.3425, 0),
        (0.076, -90, 0, 0),
        (0, 0, 0.097, 0),
    ),
    # Yaskawa HC10 (motoman_hc10_support of ROS-Industrial): axes 4 and 6 pass at 162 mm.
    "hc10": (
        (0, -90, 0.275, 0),
        (0.700, 0, 0, -90),
        (0, -90, 0, 0),
        (0, 90, 0.500, 0),
        (0, -90, 0.162, 0),
        (0, 0, 0.130, 0),
    ),
}

# Kinova Gen3 with six joints (kortex_description): origins of its joints and of its flange as the
# maker writes them, so that axes are parallel and meet within some micrometers only.
_GEN3 = (
    ((0, 0, 0.15643), (3.1416, 0, 0)),
    ((0, 0.005375, -0.12838), (1.5708, 0, 0)),
    ((0, -0.41, 0), (3.1416, 0, 0)),
    ((0, 0.20843, -0.006375), (1.5708, 0, 0)),
    ((0, -0.00017505, -0.10593), (-1.5708, 0, 0)),
    ((0, 0.10593, -0.00017505), (1.5708, 0, 0)),
    ((0, 0, -0.061525), (np.pi, 0, 0)),
)
OFFSET_WRISTS = ("crx10ia", "xarm6", "hc10", "gen3")

FILES = RobotFiles(arm_urdf="<", flange_link="flange", tool_urdf="<", tip_link="tool_tip")
LOCKED = FILES.varied(locked_joint_6_rad=0.4)
"""How a setup names these arms with their tool."""

_LINK = (
    '<link name="l{0}"><inertial><mass value="1"/><inertia ixx=".01" ixy="0" ixz="0" iyy=".01"'
    ' iyz="0" izz=".01"/></inertial></link>'
)
_TOOL = (
    '<robot name="tool"><link name="body"/><joint name="tip_joint" type="fixed">'
    '<parent link="body"/><child link="tool_tip"/><origin xyz="{}" rpy="{}"/></joint>'
    '<link name="tool_tip"/></robot>'
)


def steps_of(constants: Constants) -> list[Array]:
    """What comes after the turn of each joint, (4, 4) each."""
    steps = []
    for a, alpha, d, offset in constants:
        twist, turn = np.radians(alpha), np.radians(offset)
        x = np.array([np.cos(turn), np.sin(turn), 0])
        y = np.array([-np.sin(turn), np.cos(turn), 0])
        up = np.array([0, 0, 1.0])
        step = np.eye(4)
        step[:3, :3] = np.column_stack(
            [x, np.cos(twist) * y + np.sin(twist) * up, -np.sin(twist) * y + np.cos(twist) * up]
        )
        step[:3, 3] = a * x + d * up
        steps.append(step)
    return steps


def urdf_of(placements: list[Array], limit: float = 2 * np.pi) -> str:
    """URDF of an arm whose joints turn about z, each in a frame (4, 4) behind the one before.

    The last placement is that of the flange, a link named ``flange``.
    """
    count = len(placements) - 1
    text = ['<robot name="arm">', *(_LINK.format(k) for k in range(count + 1))]
    for k, placement in enumerate(placements, 1):
        kind, child = ("fixed", "flange") if k > count else ("revolute", f"l{k}")
        xyz = " ".join(map(repr, placement[:3, 3].tolist()))
        rpy = " ".join(map(repr, _rpy(placement[:3, :3]).tolist()))
        text.append(
            f'<joint name="j{k}" type="{kind}"><parent link="l{k - 1}"/><child link="{child}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>'
            f'<limit lower="{-limit!r}" upper="{limit!r}" velocity="3" effort="500"/></joint>'
        )
    return "".join([*text, '<link name="flange"/></robot>'])


def tool_of(xyz: str = "0 0 0.1", rpy: str = "0 0 0") -> str:
    """URDF of a tool without collision shapes, its tip there in the flange's frame, m and rad."""
    return _TOOL.format(xyz, rpy)


def urdf(name: str) -> str:
    """URDF of one of ``ARMS``, or of ``gen3``."""
    if name != "gen3":
        return urdf_of([np.eye(4), *steps_of(ARMS[name])])
    placements = np.tile(np.eye(4), (len(_GEN3), 1, 1))
    for placement, (xyz, rpy) in zip(placements, _GEN3, strict=True):
        placement[:3, :3] = Rotation.from_euler("xyz", rpy).as_matrix()
        placement[:3, 3] = xyz
    return urdf_of(list(placements))


def robot(text: str, joints: int = 6) -> Robot:
    """An arm with the tool on its flange."""
    arm, tool = parse_urdf(text, "arm.urdf"), parse_urdf(tool_of(), "tool.urdf")
    return load_robot(arm, "flange", tool, "tool_tip", joints)


def _rpy(turn: Array) -> Array:
    """Extrinsic angles about x, y, z."""
    pitch = np.arctan2(-turn[2, 0], np.hypot(turn[0, 0], turn[1, 0]))
    if np.cos(pitch) < 1e-9:
        return np.array([np.arctan2(-turn[1, 2], turn[1, 1]), pitch, 0.0])
    roll, yaw = np.arctan2(turn[2, 1], turn[2, 2]), np.arctan2(turn[1, 0], turn[0, 0])
    return np.array([roll, pitch, yaw])
