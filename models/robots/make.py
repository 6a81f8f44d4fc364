"""The arms and setups in this folder, from tables of what their makers have published.

    python models/robots/make.py

writes every URDF and setup but those of the UR5, the KR 6 R700 Z200, the tool and the camera: these
are handmade.
``tables.py`` has the facts and where they are from; what is the same for all arms is here.
"""

from __future__ import annotations

import math
from pathlib import Path

from tables import ARMS, Arm, Capsule, Link, Vector

FOLDER = Path(__file__).parent

SETUP = """\
# {about}, polishing. Written by make.py; it is ur5_polishing.toml for another arm, with thresholds
# as shares of the cube of the arm's reach. File names are relative to this file; the world frame is
# the arm's root link.

[robot]
arm_urdf = "{name}.urdf"
flange_link = "{flange}"
tool_urdf = "polishing_tool.urdf"
tip_link = "tool_tip"                 # its z axis goes against the surface normal
kinematics = "{kinematics}"
locked_joint_6_rad = 0.0              # the task leaves the last joint free
may_touch_ground = ["base_link", "{first}"]

[task]
normal_force_n = 20.0                 # pressed along the tool axis
contact_radius_m = 0.005              # obstacles and the ground stay farther off the tip than this
gravity_m_per_s2 = [0.0, 0.0, -9.81]
{constraints}
[thresholds]
min_manipulability = 0.009            # translational, five joints (Yoshikawa 1990)
min_task_determinant = 0.0009         # |det| of the 5x5 Jacobian of tip and tool direction

[continuity]
base_step_rad = 0.1
step_per_length_rad_per_m = 30.0
near_singular_determinant = 0.0045
probe_spacing_m = 0.0005
validity_spacing_m = 0.001

[slivers]
simplify_below_share = 0.01
uncover_below_share = 0.005

[motion]
tool_radius_m = 0.015
spacing_m = 0.01                      # between neighboring passes
speed_m_per_s = 0.05                  # of the tool on the surface; slower where joints limit it
joint_accelerations_rad_per_s2 = [8.0, 8.0, 8.0, 12.0, 12.0, 12.0]  # estimated
retract_m = 0.05                      # along the normal
clearance_m = 0.005                   # to everything, between segments
home_rad = {home}
"""
SCARA = """\
# {about}, dispensing: the tip follows the part, the tool is upright and always turned the same way.
# Written by make.py. File names are relative to this file; the world frame is the arm's root link.

[robot]
arm_urdf = "{name}.urdf"
flange_link = "{flange}"
tool_urdf = "polishing_tool.urdf"
tip_link = "tool_tip"                 # its z axis points down, whatever the surface's normal
kinematics = "{kinematics}"
may_touch_ground = ["base_link"]

[task]
normal_force_n = 0.0
contact_radius_m = 0.005              # obstacles and the ground stay farther off the tip than this
gravity_m_per_s2 = [0.0, 0.0, -9.81]

[task.turn]
along = [1.0, 0.0, 0.0]               # the tool's x axis, in the world
{constraints}
# Shares of the square of the arm's reach: the prismatic joint's column has no length.
[thresholds]
min_manipulability = 0.02             # translational, four joints (Yoshikawa 1990)
min_task_determinant = 0.02           # |det| of the 4x4 Jacobian of tip and turn

[continuity]
base_step_rad = 0.1
step_per_length_rad_per_m = 30.0
near_singular_determinant = 0.05
probe_spacing_m = 0.0005
validity_spacing_m = 0.001
"""
CONTROLLER = """
# At zero the controller's axes are where the URDF's are, and turn in the same sense.
[controller]
language = "{language}"
"""
LANGUAGES = {"kr6": "krl", "irb120": "rapid"}
NO_FORCE = """
[constraints]
force = false                         # the URDF has no masses
"""


def setup(name: str, arm: Arm) -> str:
    """The text of an arm's setup."""
    template = SCARA if arm.kinematics == "scara" else SETUP
    if name in LANGUAGES:
        template += CONTROLLER
    return template.format(
        about=arm.about,
        name=name,
        flange=arm.flange[0],
        kinematics=arm.kinematics,
        first=arm.links[1].name,
        constraints="" if arm.force else NO_FORCE,
        home=list(arm.home),
        language=LANGUAGES.get(name),
    )


def urdf(name: str, arm: Arm) -> str:
    """The text of an arm's URDF."""
    sources = "".join(f"  {line}\n" for line in arm.sources)
    comment = f"<!--\n  {arm.about}. Written by make.py.\n{sources}-->\n"
    lines = [f'<?xml version="1.0"?>\n{comment}<robot name="{name}">\n']
    for before, link in zip((None, *arm.links), arm.links, strict=False):
        if before is not None:
            lines.append(_joint(link, before.name))
        lines.append(_link(link))
    flange, turn = arm.flange
    lines.append(
        '  <joint name="flange_joint" type="fixed">\n'
        f'    <parent link="{arm.links[-1].name}"/>\n'
        f'    <child link="{flange}"/>\n'
        f"    {_origin((0, 0, 0), turn)}\n"
        f'  </joint>\n  <link name="{flange}"/>\n</robot>\n'
    )
    return "".join(lines)


def _joint(link: Link, parent: str) -> str:
    unit = 1.0 if link.prismatic else math.radians(1)
    kind = "prismatic" if link.prismatic else "revolute"
    lower, upper = (unit * end for end in link.limits)
    limit = f'lower="{_number(lower)}" upper="{_number(upper)}"'
    if link.speed is not None:
        limit += f' velocity="{_number(unit * link.speed)}"'
    if link.effort is not None:
        limit += f' effort="{_number(link.effort)}"'
    return (
        f'  <joint name="{link.joint}" type="{kind}">\n'
        f'    <parent link="{parent}"/>\n    <child link="{link.name}"/>\n'
        f"    {_origin(link.origin, link.turn)}\n"
        f'    <axis xyz="{_row(link.axis)}"/>\n    <limit {limit}/>\n  </joint>\n'
    )


def _link(link: Link) -> str:
    lines = [f'  <link name="{link.name}">\n']
    if link.mass is not None and link.center is not None:
        inertia = _number(0.4 * link.mass * 0.1**2)  # of a ball of 0.1 m
        lines.append(
            f"    <inertial>\n      {_origin(link.center, (0, 0, 0))}\n"
            f'      <mass value="{_number(link.mass)}"/>\n'
            f'      <inertia ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0"'
            f' izz="{inertia}"/>\n    </inertial>\n'
        )
    for shape in link.shapes:
        lines += _collisions(shape)
    return "".join([*lines, "  </link>\n"])


def _collisions(shape: Capsule) -> list[str]:
    """A cylinder and, for round ends, a sphere on each: many readers know no capsules."""
    middle = tuple((a + b) / 2 for a, b in zip(shape.start, shape.end, strict=True))
    along = tuple(b - a for a, b in zip(shape.start, shape.end, strict=True))
    length = math.hypot(*along)
    # From z to the segment: first about y, then about z.
    turn = (
        0.0,
        math.degrees(math.acos(along[2] / length)),
        math.degrees(math.atan2(along[1], along[0])),
    )
    radius = _number(shape.radius)
    shapes = [(middle, turn, f'<cylinder radius="{radius}" length="{_number(length)}"/>')]
    if not shape.flat:
        sphere = f'<sphere radius="{radius}"/>'
        shapes += [(end, (0, 0, 0), sphere) for end in (shape.start, shape.end)]
    return [
        f"    <collision>\n      {_origin(at, turned)}\n"
        f"      <geometry>{geometry}</geometry>\n    </collision>\n"
        for at, turned, geometry in shapes
    ]


def _origin(xyz: Vector, degrees: Vector) -> str:
    turned = f' rpy="{_row(tuple(map(math.radians, degrees)))}"' if any(degrees) else ""
    return f'<origin xyz="{_row(xyz)}"{turned}/>'


def _row(numbers: tuple[float, ...]) -> str:
    return " ".join(map(_number, numbers))


def _number(value: float) -> str:
    """To sixteen digits, so that right angles are right; lengths without the noise of sums."""
    return repr(round(float(value), 15) + 0.0).removesuffix(".0")


def written() -> dict[str, str]:
    """The text of each file by its name."""
    files = {}
    for name, arm in ARMS.items():
        files[f"{name}.urdf"] = urdf(name, arm)
        task = "dispensing" if arm.kinematics == "scara" else "polishing"
        files[f"{name}_{task}.toml"] = setup(name, arm)
    return files


if __name__ == "__main__":
    for file, text in written().items():
        (FOLDER / file).write_text(text, encoding="utf-8")
