"""What makers have published of their arms, as tables; ``make.py`` writes the files from them.

Lengths are in m, angles in degrees, masses in kg, torques in N m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Capsule:
    """All within a radius of a segment, in the link's frame; with flat ends a cylinder."""

    start: Vector
    end: Vector
    radius: float
    flat: bool = False


@dataclass(frozen=True)
class Link:
    """A link, and the joint that moves it; the first link of an arm has none.

    Attributes:
        origin, turn: of the joint in the frame of the link before; the turn is extrinsic x, y, z.
        limits: lower and upper, degrees, or m if it is prismatic.
        speed: degrees/s; None where it was not found.
        effort: N m; None where it was not found.
        mass, center: kg, m; None where it was not found.
        prismatic: whether the joint slides along its axis.
    """

    name: str
    shapes: tuple[Capsule, ...]
    joint: str = ""
    origin: Vector = (0, 0, 0)
    turn: Vector = (0, 0, 0)
    axis: Vector = (0, 0, 1)
    limits: tuple[float, float] = (-360, 360)
    speed: float | None = 0
    effort: float | None = None
    mass: float | None = None
    center: Vector | None = None
    prismatic: bool = False


@dataclass(frozen=True)
class Arm:
    """What is written of one arm.

    Attributes:
        about: the first line of both files.
        sources: what is from where, and what is estimated; lines of the URDF's comment.
        links: from the base to the last joint.
        flange: name of the link that carries the tool, and its turn on the last link; its z axis
            points out of the flange.
        kinematics: the family.
        home: angles of the joints, rad; none for an arm whose motions are not planned.
        force: whether the force constraint can be tested: masses and efforts are known.
    """

    about: str
    sources: tuple[str, ...]
    links: tuple[Link, ...]
    flange: tuple[str, Vector]
    kinematics: str
    home: tuple[float, ...]
    force: bool


# --- Universal Robots -----------------------------------------------------------------------------

UR_PAGE = "universal-robots.com, DH Parameters for calculations of kinematics and dynamics"
UR_SOURCES = (
    f"kinematics, masses, centers of mass: {UR_PAGE};",
    "  the mass of the base is estimated, it does not move",
    "efforts, speeds: Universal_Robots_ROS2_Description, of the same maker; limits: +-360 degrees",
    "  as in its data sheets (that description stops the elbow at 180, where it meets the arm);",
    "  of the UR16e masses and centers of mass as well",
    "inertia tensors: of balls of 0.1 m, they do not matter in statics",
    "capsules: estimated, sized after outlines and offsets of links in that description",
    "Frames: base_link is the DH base turned by pi about z. Every joint turns about its own z",
    "  axis, and at zero the frames are the DH frames before their twist alpha.",
)
UR_JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
UR_HOME = (1.5708, -1.5708, 1.5708, -1.5708, -1.5708, 0.0)  # turned aside from what is in front


@dataclass(frozen=True)
class Ur:
    """Denavit-Hartenberg constants and dynamics as the maker's page has them, and outlines.

    Attributes:
        d1, a2, a3, d4, d5, d6: m.
        masses: kg, links 1 to 6.
        centers: of mass, in the Denavit-Hartenberg frames, m.
        efforts, speeds: of the joints.
        beside: how far upper arm and forearm lie beside the shoulder, along axis 2.
        radii: of base, shoulder, upper arm, forearm, wrists 1 and 2, and wrist 3.
        housing: length of the housings of wrists 1 and 2 without their round ends, and of wrist 3.
    """

    constants: tuple[float, float, float, float, float, float]
    masses: tuple[float, ...]
    centers: tuple[Vector, ...]
    efforts: tuple[float, ...]
    speeds: tuple[float, ...]
    beside: tuple[float, float]
    radii: tuple[float, ...]
    housing: tuple[float, float]


BIG_WRISTS = {
    "efforts": (330, 330, 150, 54, 54, 54),
    "speeds": (120, 120, 180, 180, 180, 180),
    "radii": (0.095, 0.08, 0.078, 0.06, 0.05, 0.045),
    "housing": (0.06, 0.048),
}
UR = {
    "ur3e": Ur(
        (0.15185, -0.24355, -0.2132, 0.13105, 0.08535, 0.0921),
        (1.98, 3.4445, 1.437, 0.871, 0.805, 0.261),
        ((0, -0.02, 0), (0.13, 0, 0.1157), (0.05, 0, 0.0238),
         (0, 0, 0.01), (0, 0, 0.01), (0, 0, -0.02)),
        (54, 54, 28, 9, 9, 9),
        (180, 180, 180, 360, 360, 360),
        (0.12, 0.027),
        (0.064, 0.052, 0.052, 0.042, 0.036, 0.032),
        (0.04, 0.042),
    ),
    "ur5e": Ur(
        (0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996),
        (3.761, 8.058, 2.846, 1.37, 1.3, 0.365),
        ((0, -0.02561, 0.00193), (0.2125, 0, 0.11336), (0.15, 0, 0.0265),
         (0, -0.0018, 0.01634), (0, 0.0018, 0.01634), (0, 0, -0.001159)),
        (150, 150, 150, 28, 28, 28),
        (180, 180, 180, 180, 180, 180),
        (0.138, 0.007),
        (0.075, 0.062, 0.06, 0.052, 0.043, 0.0375),
        (0.05, 0.046),
    ),
    "ur10e": Ur(
        (0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655),
        (7.369, 13.051, 3.989, 2.1, 1.98, 0.615),
        ((0.021, 0, 0.027), (0.38, 0, 0.158), (0.24, 0, 0.068),
         (0, 0.007, 0.018), (0, 0.007, 0.018), (0, 0, -0.026)),
        beside=(0.1762, 0.0393),
        **BIG_WRISTS,
    ),
    "ur16e": Ur(
        (0.1807, -0.4784, -0.36, 0.17415, 0.11985, 0.11655),
        (7.369, 10.45, 4.321, 2.18, 2.033, 0.907),
        ((0, -0.016, 0.03), (0.302, 0, 0.16), (0.194, 0, 0.065),
         (0, -0.009, 0.011), (0, 0.018, 0.012), (0, 0, -0.044)),
        beside=(0.176, 0.04),
        **BIG_WRISTS,
    ),
}  # fmt: skip


def ur_arm(name: str, ur: Ur) -> Arm:
    """An arm of the e-Series in the frames that ur5.urdf has."""
    d1, a2, a3, d4, d5, d6 = ur.constants
    upper, fore = ur.beside
    base, shoulder, arm, forearm, wrist, last = ur.radii
    barrel, cap = ur.housing
    shapes = (
        (Capsule((0, 0, 0), (0, 0, 0.05), base),),
        (Capsule((0, 0, 0), (0, arm - upper, 0), shoulder),),
        (
            Capsule((0, 0, upper), (a2, 0, upper), arm),
            Capsule((a2, 0, fore + forearm), (a2, 0, upper), forearm),
        ),
        (Capsule((0, 0, fore), (a3, 0, fore), forearm),),
        (Capsule((0, 0, -barrel), (0, 0, 0), wrist),),
        (Capsule((0, 0, -barrel), (0, 0, 0), wrist),),
        (Capsule((0, 0, -cap), (0, 0, 0), last, flat=True),),
    )
    origins = ((0, 0, d1), (0, 0, 0), (a2, 0, 0), (a3, 0, d4), (0, -d5, 0), (0, d6, 0))
    turns = ((0, 0, 180), (90, 0, 0), (0, 0, 0), (0, 0, 0), (90, 0, 0), (-90, 0, 0))
    links = [Link("base_link", shapes[0], mass=4.0, center=(0, 0, 0.03))]
    bodies = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
    for k, (joint, body) in enumerate(zip(UR_JOINTS, bodies, strict=True)):
        x, y, z = ur.centers[k]
        center = ((x, -z, y), (a2 + x, y, z), (a3 + x, y, z), (x, -z, y), (x, z, -y), (x, y, z))[k]
        links.append(
            Link(
                f"{body}_link",
                shapes[k + 1],
                f"{joint}_joint",
                origins[k],
                turns[k],
                speed=ur.speeds[k],
                effort=ur.efforts[k],
                mass=ur.masses[k],
                center=center,
            )
        )
    about = f"Universal Robots {name[:-1].upper()}e"
    return Arm(about, UR_SOURCES, tuple(links), ("tool0", (0, 0, 0)), "ur", UR_HOME, True)


def calibrated(arm: Arm) -> Arm:
    """Every joint but the first off by some tenths of a millimeter and of a milliradian."""
    off = (
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        ((0.0003, -0.0002, 0.0004), (0.4, -0.3, 0.6)),
        ((-0.0005, 0.0003, 0.0002), (-0.5, 0.8, -0.2)),
        ((0.0004, 0.0001, -0.0003), (0.6, -0.4, 0.3)),
        ((-0.0002, 0.0004, 0.0003), (-0.3, 0.5, -0.6)),
        ((0.0001, -0.0003, 0.0002), (0.2, 0.6, 0.4)),
    )  # m and mrad
    links = [arm.links[0]]
    for link, (shift, turn) in zip(arm.links[1:], off, strict=True):
        origin = tuple(a + b for a, b in zip(link.origin, shift, strict=True))
        turned = tuple(a + math.degrees(b / 1000) for a, b in zip(link.turn, turn, strict=True))
        links.append(replace(link, origin=origin, turn=turned))
    sources = (
        "the joints' origins are off by made-up numbers of the size that a calibration finds;",
        "  they are those of no real arm. The rest is as in ur5e.urdf:",
        *arm.sources,
    )
    return replace(arm, about=f"{arm.about}, calibrated", sources=sources, links=tuple(links))


# --- Spherical wrists -----------------------------------------------------------------------------

SILENT = (
    "masses and centers of mass: not found, so they are left out, and the force constraint is",
    "  off in the setup",
)


def arm_of(about: str, sources: tuple[str, ...], flange: Vector, home: Vector, *links: Link) -> Arm:
    """A spherical-wrist arm; ``home`` has the joints 2, 3 and 5 in rad, the others are at zero."""
    at_home = (0.0, home[0], home[1], 0.0, home[2], 0.0)
    return Arm(about, (*sources, *SILENT), links, ("tool0", flange), "eaik", at_home, False)


QUARTER = 1.5708
OUTLINES = "capsules: estimated, sized after the outlines of the public meshes in ros-industrial's"
KR6 = arm_of(
    "KUKA KR 6 R900 sixx",
    (
        "kinematics, limits, speeds: the maker's, as ros-industrial's kuka_experimental has them",
        OUTLINES,
        "  kuka_experimental",
        "efforts: not found, so they are left out",
        "Frames: all parallel to the base's at zero, where the arm is stretched out along x.",
    ),
    (0, 90, 0),
    (-QUARTER, QUARTER, QUARTER),
    Link("base_link", (Capsule((0, 0, 0), (0, 0, 0.25), 0.107, flat=True),
         Capsule((-0.14, 0, 0.07), (-0.05, 0, 0.09), 0.07))),
    Link("link_1", (Capsule((0.01, 0, -0.06), (0.01, 0, -0.02), 0.12),
         Capsule((0.025, -0.05, 0), (0.025, 0.05, 0), 0.09)),
         "joint_a1", (0, 0, 0.4), axis=(0, 0, -1), limits=(-170, 170), speed=360),
    Link("link_2", (Capsule((0, 0, 0), (0.455, 0, 0), 0.075),
         Capsule((0.455, -0.055, 0), (0.455, 0.055, 0), 0.07)),
         "joint_a2", (0.025, 0, 0), axis=(0, 1, 0), limits=(-190, 45), speed=300),
    Link("link_3", (Capsule((-0.01, 0, 0.01), (0.05, 0, 0.02), 0.075),),
         "joint_a3", (0.455, 0, 0), axis=(0, 1, 0), limits=(-120, 156), speed=360),
    Link("link_4", (Capsule((0.15, 0, 0), (0.41, 0, 0), 0.055),),
         "joint_a4", (0, 0, 0.035), axis=(-1, 0, 0), limits=(-185, 185), speed=381),
    Link("link_5", (Capsule((0, 0, 0), (0.03, 0, 0), 0.04),),
         "joint_a5", (0.42, 0, 0), axis=(0, 1, 0), limits=(-120, 120), speed=388),
    Link("link_6", (Capsule((-0.014, 0, 0), (0, 0, 0), 0.02, flat=True),),
         "joint_a6", (0.08, 0, 0), axis=(-1, 0, 0), limits=(-350, 350), speed=615),
)  # fmt: skip
IRB120 = arm_of(
    "ABB IRB 120-3/0.6",
    (
        "kinematics, limits, speeds: the maker's, as ros-industrial's abb_experimental has them",
        OUTLINES,
        "  abb_experimental",
        "efforts: not found, so they are left out",
        "Frames: all parallel to the base's at zero, where the forearm is stretched out along x.",
    ),
    (0, 90, 0),
    (0.0, 0.0, QUARTER),
    Link("base_link", (Capsule((0, 0, 0), (0, 0, 0.15), 0.093, flat=True),
         Capsule((-0.15, 0, 0.07), (-0.05, 0, 0.07), 0.065))),
    Link("link_1", (Capsule((0, 0, -0.045), (0, 0, -0.02), 0.095),),
         "joint_1", (0, 0, 0.29), limits=(-165, 165), speed=250),
    Link("link_2", (Capsule((0, -0.055, 0), (0, -0.045, 0.27), 0.06),
         Capsule((0, 0.055, 0), (0, 0.045, 0.27), 0.06)),
         "joint_2", (0, 0, 0), axis=(0, 1, 0), limits=(-110, 110), speed=250),
    Link("link_3", (Capsule((0, 0, 0), (0, 0, 0.07), 0.06),
         Capsule((-0.03, 0, 0.07), (0.1, 0, 0.07), 0.065)),
         "joint_3", (0, 0, 0.27), axis=(0, 1, 0), limits=(-110, 70), speed=250),
    Link("link_4", (Capsule((0.18, 0, 0), (0.28, 0, 0), 0.05),),
         "joint_4", (0, 0, 0.07), axis=(1, 0, 0), limits=(-160, 160), speed=320),
    Link("link_5", (Capsule((-0.02, 0, 0), (0.03, 0, 0), 0.04),),
         "joint_5", (0.302, 0, 0), axis=(0, 1, 0), limits=(-120, 120), speed=320),
    Link("link_6", (Capsule((-0.013, 0, 0), (0, 0, 0), 0.02, flat=True),),
         "joint_6", (0.072, 0, 0), axis=(1, 0, 0), limits=(-400, 400), speed=420),
)  # fmt: skip
TX2_60 = arm_of(
    "Staubli TX2-60",
    (
        "kinematics, limits, nominal speeds, efforts: the maker's manual, as ros-industrial's",
        "  staubli_experimental quotes it",
        OUTLINES,
        "  staubli_experimental; that of link 5 has none",
        "Frames: all parallel to the base's at zero, where the arm is stretched out upwards.",
    ),
    (0, 0, 0),
    (0.0, QUARTER, QUARTER),
    Link("base_link", (Capsule((0, 0, 0), (0, 0, 0.18), 0.111, flat=True),
         Capsule((-0.12, 0, 0.09), (0, 0, 0.09), 0.07))),
    Link("link_1", (Capsule((0, 0, -0.09), (0, 0, 0), 0.095),
         Capsule((0, 0, 0), (0, 0.05, 0), 0.088)),
         "joint_1", (0, 0, 0.375), limits=(-180, 180), speed=435, effort=126),
    Link("link_2", (Capsule((-0.04, 0.172, -0.04), (-0.03, 0.172, 0.31), 0.047),
         Capsule((0.04, 0.172, -0.04), (0.03, 0.172, 0.31), 0.047)),
         "joint_2", (0, 0, 0), axis=(0, 1, 0), limits=(-127.5, 127.5), speed=385, effort=47),
    Link("link_3", (Capsule((0, 0, -0.06), (0, 0, 0.03), 0.078),
         Capsule((0, 0, 0), (0, 0.055, 0), 0.072)),
         "joint_3", (0, 0.02, 0.29), axis=(0, 1, 0), limits=(-152.5, 152.5), speed=500, effort=32),
    Link("link_4", (Capsule((0, 0, 0.15), (0, 0, 0.29), 0.048),),
         "joint_4", (0, 0, 0), limits=(-270, 270), speed=995, effort=7),
    Link("link_5", (Capsule((0, 0, 0), (0, 0, 0.02), 0.04),),
         "joint_5", (0, 0, 0.31), axis=(0, 1, 0), limits=(-121, 132.5), speed=1065, effort=8),
    Link("link_6", (Capsule((0, 0, -0.012), (0, 0, 0), 0.02, flat=True),),
         "joint_6", (0, 0, 0.07), limits=(-270, 270), speed=1445, effort=2),
)  # fmt: skip

ARMS = {name: ur_arm(name, constants) for name, constants in UR.items()}
# --- SCARA ----------------------------------------------------------------------------------------

COBRA_600 = Arm(
    about="Adept Cobra 600, a SCARA",
    sources=(
        "lengths, height, stroke and ranges of joints 1 and 2: the public model of Corke's",
        "  Robotics Toolbox (mdl_cobra600), not compared with a data sheet; joint 4 has none",
        "speeds, masses, centers of mass, efforts: not found, left out, so there is no force",
        "  constraint",
        "capsules: estimated",
        "Frames: those of that model; from joint 3 on z points down.",
    ),
    links=(
        Link("base_link", (Capsule((0, 0, 0.0), (0, 0, 0.3), 0.09, flat=True),)),
        Link("link_1", (Capsule((0, 0, 0), (0.325, 0, 0), 0.05),), "joint_1", (0, 0, 0.387),
             limits=(-50, 50), speed=None),
        Link("link_2", (Capsule((0, 0, 0.11), (0.275, 0, 0.11), 0.05),), "joint_2", (0.325, 0, 0),
             limits=(-88, 88), speed=None),
        Link("shaft", (Capsule((0, 0, -0.35), (0, 0, -0.03), 0.012),), "joint_3", (0.275, 0, 0),
             (180, 0, 0), limits=(0, 0.21), speed=None, prismatic=True),
        Link("link_4", (Capsule((0, 0, -0.01), (0, 0, 0), 0.02, flat=True),), "joint_4",
             limits=(-360, 360), speed=None),
    ),
    flange=("flange", (0, 0, 0)),
    kinematics="scara",
    home=(),
    force=False,
)  # fmt: skip

ARMS |= {
    "cobra600": COBRA_600,
    "ur5e_calibrated": calibrated(ARMS["ur5e"]),
    "kr6": KR6,
    "irb120": IRB120,
    "tx2_60": TX2_60,
}
