"""Programs for controllers: URScript, RAPID and KRL (docs/formats/other-programs.md).

A program is written only for an arm whose joint angles mean the same as the maker's. This is judged
by where the axes are in space at zero, not by the arm's name. Each program refuses to start unless
the arm stands where the motion begins, and ends where a move was not planned.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.exports.interface import ArmAxes, NotForThisArm, PlannedMotion
from cellcolor.exports.samples import Samples, stretches, via_points
from cellcolor.files.writing import FileKind

UR_STEP = 0.008  # s; the rate at which a UR controller is fed unless another is asked for
WITHIN = 5e-4  # rad from the samples between via points
_NEAR = 1e-3  # m and rad: how far an axis may be from the maker's
_START = 0.02  # rad from the first sample

Axes = tuple[tuple[tuple[float, float, float], tuple[float, float, float]], ...]

# Points (m) and directions of the axes in the base frame when the controller shows zero degrees on
# all of them. They are the makers', as ros-industrial has them in kuka_kr6_support
# (kr6r900sixx_macro.xacro) and abb_irb120_support (irb120_3_58_macro.xacro).
KR6_R900: Axes = (
    ((0.0, 0.0, 0.4), (0, 0, -1)),
    ((0.025, 0.0, 0.4), (0, 1, 0)),
    ((0.48, 0.0, 0.4), (0, 1, 0)),
    ((0.48, 0.0, 0.435), (-1, 0, 0)),
    ((0.9, 0.0, 0.435), (0, 1, 0)),
    ((0.98, 0.0, 0.435), (-1, 0, 0)),
)
IRB_120: Axes = (
    ((0.0, 0.0, 0.29), (0, 0, 1)),
    ((0.0, 0.0, 0.29), (0, 1, 0)),
    ((0.0, 0.0, 0.56), (0, 1, 0)),
    ((0.0, 0.0, 0.63), (1, 0, 0)),
    ((0.302, 0.0, 0.63), (0, 1, 0)),
    ((0.374, 0.0, 0.63), (1, 0, 0)),
)
KR6_SPEEDS = (360.0, 300.0, 360.0, 381.0, 388.0, 615.0)  # degrees/s at 100 %
_UR_JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
)
_UR_DIRECTIONS = np.array([(0, 0, 1), (0, 1, 0), (0, 1, 0), (0, 1, 0), (0, 0, -1), (0, 1, 0)])


URSCRIPT = FileKind(
    "a program in URScript written by cellcolor", re.compile(rb"# cellcolor: URScript")
)
RAPID = FileKind(
    "a program in RAPID written by cellcolor", re.compile(rb"MODULE cellcolor\n +! cellcolor: ")
)
KRL = FileKind(
    "a program in KRL written by cellcolor", re.compile(rb"&ACCESS RVP\n&COMMENT cellcolor: ")
)


def urscript(planned: PlannedMotion) -> bytes:
    """``servoj`` at a fixed time step, rad, for arms of Universal Robots.

    Raises:
        NotForThisArm: it is no such arm, or its joint angles are not the controller's.
    """
    _check_ur(planned.axes)
    step = planned.step_s or UR_STEP
    found = stretches(planned.trajectory, step)
    beside = max((own.beside for own in found), default=0.0)
    lines = [
        "# cellcolor: URScript, joints in rad, servoj at a fixed time step",
        f"# {step:g} s a step; at most {beside:.2g} rad beside the motion that was judged",
        "def cellcolor():",
    ]
    body: list[str] = []
    for number, own in enumerate(found, start=1):
        start = _listed(own.joints[0])
        body += [
            f"def stretch_{number}():",
            f"  start = {start}",
            "  here = get_actual_joint_positions()",
            "  i = 0",
            "  while i < 6:",
            f"    if norm(here[i] - start[i]) > {_START}:",
            '      popup("the arm does not stand where the motion begins", error=True)',
            "      halt",
            "    end",
            "    i = i + 1",
            "  end",
        ]
        on = False
        for contact, joints in zip(own.contact.tolist(), own.joints, strict=True):
            if contact != on:
                body += _touching(contact, planned.force_n)
                on = contact
            body.append(f"  servoj({_listed(joints)}, t={step:g}, lookahead_time=0.1, gain=300)")
        if on:
            body += _touching(False, planned.force_n)
        body += ["  stopj(2.0)", "end"]
    if found:
        body.append("stretch_1()")
    if len(found) > 1:
        body.append("# The move to the next stretch was not planned: bring the arm there by hand.")
        body += [f"# stretch_{number}()" for number in range(2, len(found) + 1)]
    return _text([*lines, *(f"  {line}" for line in body), "end"])


def _touching(begins: bool, force_n: float) -> list[str]:
    if not begins:
        return ["  # end_force_mode()"]
    return [
        "  # Contact. To press along the tool, N, instead of keeping the place:",
        f"  # force_mode(get_actual_tcp_pose(), [0,0,1,0,0,0], [0,0,{force_n:g},0,0,0], 2, "
        "[0.1,0.1,0.05,0.3,0.3,0.3])",
    ]


def rapid(planned: PlannedMotion) -> bytes:
    """``MoveAbsJ`` over via points, degrees, each with its time, for the ABB IRB 120.

    Raises:
        NotForThisArm: the arm's axes are not those of an IRB 120.
    """
    _check(planned.axes, IRB_120, "ABB IRB 120")
    found = stretches(planned.trajectory, planned.step_s)
    lines = [
        "MODULE cellcolor",
        "  ! cellcolor: RAPID for the ABB IRB 120, joints in degrees, times in s",
        *_via_remark(planned, "  !"),
        "  ! The tool and its load: replace tool0 by yours.",
    ]
    external = "[9E9,9E9,9E9,9E9,9E9,9E9]"
    for number, own in enumerate(found, start=1):
        kept = _points_of(planned, own)
        degrees, times = np.degrees(own.joints[kept]), own.times[kept]
        lines += [
            f"  PROC stretch_{number}()",
            "    VAR jointtarget here;",
            "    here := CJointT();",
        ]
        lines += [
            f"    IF Abs(here.robax.rax_{axis} - ({angle:.6f})) > {np.degrees(_START):.3f} THEN\n"
            '      TPWrite "The arm does not stand where the motion begins.";\n'
            "      Stop;\n    ENDIF"
            for axis, angle in enumerate(degrees[0].tolist(), start=1)
        ]
        for place in range(1, len(kept)):
            if own.contact[kept[place]] != own.contact[kept[place - 1]]:
                lines.append(f"    ! contact {'begins' if own.contact[kept[place]] else 'ends'}")
            zone = "fine" if place == len(kept) - 1 else "z0"
            target = f"[[{','.join(f'{angle:.6f}' for angle in degrees[place])}],{external}]"
            seconds = times[place] - times[place - 1]
            lines.append(f"    MoveAbsJ {target}\\NoEOffs, v100\\T:={seconds:.6f}, {zone}, tool0;")
        lines.append("  ENDPROC")
    lines += ["  PROC main()", *(["    stretch_1;"] if found else [])]
    lines += [
        f"    ! stretch_{number};  not planned up to there: bring the arm there by hand"
        for number in range(2, len(found) + 1)
    ]
    return _text([*lines, "  ENDPROC", "ENDMODULE"])


def krl(planned: PlannedMotion) -> bytes:
    """``PTP`` over via points, degrees, for the KUKA KR 6 R900.

    PTP takes no times: the speed of each move is a whole percentage of the axes' speeds.

    Raises:
        NotForThisArm: the arm's axes are not those of a KR 6 R900.
    """
    _check(planned.axes, KR6_R900, "KUKA KR 6 R900")
    found = stretches(planned.trajectory, planned.step_s)
    lines = [
        "&ACCESS RVP",
        "&COMMENT cellcolor: KRL for the KUKA KR 6 R900, degrees",
        "DEF cellcolor( )",
        *_via_remark(planned, "  ;"),
        "  ; Speeds are whole percentages of the axes' speeds: times are kept roughly.",
        "  ; $TOOL, $BASE and the load are not set here: PTP to axis angles needs only the load.",
        "  BAS(#INITMOV, 0)",
        *(["  stretch_1( )"] if found else []),
        *(
            f"  ; stretch_{number}( )  not planned up to there: bring the arm there by hand"
            for number in range(2, len(found) + 1)
        ),
        "END",
    ]
    for number, own in enumerate(found, start=1):
        kept = _points_of(planned, own)
        degrees, times = np.degrees(own.joints[kept]), own.times[kept]
        lines += [f"DEF stretch_{number}( )"]
        lines += [
            f"  IF ABS($AXIS_ACT.A{axis} - ({angle:.5f})) > {np.degrees(_START):.3f} THEN\n"
            "    HALT ; the arm does not stand where the motion begins\n  ENDIF"
            for axis, angle in enumerate(degrees[0].tolist(), start=1)
        ]
        percent = 0
        for place in range(1, len(kept)):
            if own.contact[kept[place]] != own.contact[kept[place - 1]]:
                lines.append(f"  ; contact {'begins' if own.contact[kept[place]] else 'ends'}")
            seconds = times[place] - times[place - 1]
            share = np.abs(degrees[place] - degrees[place - 1]) / seconds / KR6_SPEEDS
            # Rounded down: the arm must not be faster than planned. At least 1, or it stands still.
            wanted = int(np.clip(np.floor(100 * share.max()), 1, 100))
            if wanted != percent:
                lines.append(f"  speed_of_axes({wanted})")
                percent = wanted
            angles = ", ".join(
                f"A{axis} {angle:.5f}" for axis, angle in enumerate(degrees[place], start=1)
            )
            lines.append(f"  PTP {{{angles}}}{'' if place == len(kept) - 1 else ' C_PTP'}")
        lines.append("END")
    lines += [
        "DEF speed_of_axes(percent :IN)",
        "  INT percent, i",
        "  FOR i = 1 TO 6",
        "    $VEL_AXIS[i] = percent",
        "  ENDFOR",
        "END",
    ]
    return _text(lines)


def _via_remark(planned: PlannedMotion, comment: str) -> list[str]:
    if planned.step_s is not None:
        return [f"{comment} a point every {planned.step_s:g} s"]
    return [f"{comment} via points; in between at most {WITHIN:g} rad beside the judged samples"]


def _points_of(planned: PlannedMotion, own: Samples) -> Index:
    return via_points(own, WITHIN) if planned.step_s is None else np.arange(len(own.times))


def _check(axes: ArmAxes | None, wanted: Axes, name: str) -> None:
    """Refuse an arm unless its axes are the maker's: then zero and sense of rotation agree too."""
    axes = _six_turning(axes)
    for number in range(6):
        point, direction = map(np.array, wanted[number])
        away = axes.points[number] - point
        off = np.linalg.norm(away - (away @ direction) * direction)
        if off > _NEAR:
            text = f"at zero its axis {number + 1} is {1000 * off:.0f} mm from that of the {name}"
            raise NotForThisArm(text)
        _check_direction(axes, number, direction, f"that of the {name}")


def _check_ur(axes: ArmAxes | None) -> None:
    axes = _six_turning(axes)
    if tuple(name.removeprefix("ur_") for name in axes.names) != _UR_JOINTS:
        raise NotForThisArm("its joints are not named as those of Universal Robots are")
    for number, direction in enumerate(_UR_DIRECTIONS):
        _check_direction(axes, number, direction, "that of arms of Universal Robots", 0.02)
    steps = np.diff(axes.points[1:4], axis=0)
    if (steps[:, 0] <= 0.05).any() or (np.abs(steps[:, 2]) > 0.02).any():
        raise NotForThisArm("at zero it is not stretched out along x, as a UR controller has it")


def _six_turning(axes: ArmAxes | None) -> ArmAxes:
    if axes is None:
        raise NotForThisArm("its axes are not known")
    if len(axes.names) != 6 or axes.slides:
        raise NotForThisArm("it does not have six joints that turn")
    return axes


def _check_direction(
    axes: ArmAxes, number: int, direction: Array, whose: str, near: float = _NEAR
) -> None:
    if np.linalg.norm(axes.directions[number] - direction) > near:
        text = f"at zero its axis {number + 1} does not turn about the direction of {whose}"
        raise NotForThisArm(text)


def _listed(joints: Array) -> str:
    return f"[{', '.join(f'{angle:.7f}' for angle in joints.tolist())}]"


def _text(lines: Sequence[str]) -> bytes:
    return ("\n".join(lines) + "\n").encode("ascii")
