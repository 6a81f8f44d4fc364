"""URScript, RAPID, KRL and FANUC's LS: how each language says a move."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array
from cellcolor.files.writing import FileKind

START = 0.02  # rad from the first sample
_START_DEG = round(float(np.degrees(START)), 3)
_NOT_THERE = "the arm does not stand where the motion begins"
_LEAST_BLEND, _MOST_BLEND = 5e-5, 1e-3  # m, of movep


@dataclass(frozen=True, eq=False)
class Job:
    """What a program is about.

    Attributes:
        name: of the program.
        remarks: sentences for its head.
        tool, work_object: their names or numbers.
        tip, part: (4, 4) poses of the tip in the flange's frame, and of the part in the base's.
        stretches: how many there are; only the first is called.
        step_s: the fixed time step, s; 0 without one.
        force_n: pressed along the tool's axis, N.
    """

    name: str
    remarks: list[str]
    tool: str
    tip: Array
    work_object: str
    part: Array
    stretches: int
    step_s: float
    force_n: float


@dataclass(frozen=True, eq=False)
class Move:
    """A place that the arm goes to.

    Attributes:
        degrees: (6,) that the controller shows there.
        at, turn: the tip in the work object: (3,) in m, and the quaternion x, y, z, w.
        seconds: from the place before.
        contact: whether the tool is on the surface there.
        begins: whether it comes to the surface with this move.
        presses: whether the force is given a new direction there.
        stops: whether the arm rests there: a stretch ends, a stroke begins or ends.
        feed: of the tip, m/s, if the move is linear; 0 for a joint move.
        room: how far the nearer of the places before and after is, m.
        share: of the speed of the joint that it needs most, 0 to 1.
    """

    degrees: Array
    at: Array
    turn: Array
    seconds: float
    contact: bool
    begins: bool
    presses: bool
    stops: bool
    feed: float
    room: float
    share: float


class _Common:
    """What languages share. Each has besides, as lines of a program:

    ``head`` and ``tail``, all before the first stretch and after the last one; ``begin``, the
    beginning of a stretch, which stops unless the arm stands there; ``joint``, a move of all joints
    in proportion; ``linear``, one of the tip along a straight line.

    Attributes:
        suffix: of files.
        mark: what such a file begins with.
        comment: what a remark begins with.
        call: of the routine of a stretch.
        end, release: the ends of a stretch, and of pressing along the tool's axis.
        stepped: whether samples need a fixed time step.
    """

    suffix: str
    mark: str
    comment: str
    call: str = ""
    end: tuple[str, ...] = ()
    release: tuple[str, ...] = ()
    stepped = False

    @property
    def kind(self) -> FileKind:
        """Of its files."""
        name = f"a program {self.suffix} written by cellcolor"
        return FileKind(name, re.compile(self.mark.encode()))

    def remark(self, text: str) -> str:
        """A comment."""
        return f"  {self.comment} {text}"

    def calls(self, job: Job) -> Iterator[str]:
        """The call of the first stretch; those of others are remarks."""
        for number in range(1, job.stretches + 1):
            call = self.call.format(number)
            more = f"{call}  not planned up to there: bring the arm there by hand"
            yield f"  {call}" if number == 1 else self.remark(more)

    def press(self, job: Job) -> Iterable[str]:  # noqa: ARG002
        """Press from here on along the tool's axis as it is now."""
        return ()


class UrScript(_Common):
    """``servoj`` along straight ways in joints, ``movep`` along lines; m and rad."""

    suffix, comment, call, stepped = ".script", "#", "stretch_{}()", True
    end = ("  stopj(2.0)", "  end")
    release = ("  if pressing:", "    end_force_mode()", "  end")
    mark = "# cellcolor: URScript"

    def head(self, job: Job) -> Iterable[str]:
        share = ", ".join(f"at[{i}] + s * (to[{i}] - at[{i}])" for i in range(6))
        yield "# cellcolor: URScript, joints in rad, lengths in m, servoj at a fixed time step"
        yield from (f"# {text}" for text in job.remarks)
        yield f"def {job.name}():"
        yield f"  global {job.tool} = {_pose(job.tip)}"
        yield f"  global {job.work_object} = {_pose(job.part)}"
        yield f"  set_tcp({job.tool})"
        if job.force_n:
            yield "  # True: presses with a force along the tool instead of keeping the place."
            yield "  global pressing = False"
        yield "  global at = get_actual_joint_positions()"
        yield "  # Straight for all joints, in n time steps."
        yield from ("  def go(to, n):", "    i = 1.0", "    while i <= n:", "      s = i / n")
        yield f"      servoj([{share}], t={job.step_s:g}, lookahead_time=0.1, gain=300)"
        yield from ("      i = i + 1.0", "    end", "    global at = to", "  end")

    def begin(self, number: int, start: Move) -> Iterable[str]:
        yield from (f"  def stretch_{number}():", f"  start = {_radians(start)}")
        yield from ("  here = get_actual_joint_positions()", "  i = 0", "  while i < 6:")
        yield f"    if norm(here[i] - start[i]) > {START}:"
        yield f'      popup("{_NOT_THERE}", error=True)'
        yield from ("      halt", "    end", "    i = i + 1", "  end", "  global at = start")

    def joint(self, job: Job, move: Move) -> str:
        return f"  go({_radians(move)}, {max(1, round(move.seconds / job.step_s)):d}.0)"

    def linear(self, job: Job, move: Move) -> str:
        blend = min(_MOST_BLEND, 0.4 * move.room)
        blend = 0.0 if move.stops or blend < _LEAST_BLEND else blend
        pose = _listed([*move.at, *Rotation.from_quat(move.turn).as_rotvec()], 7)
        where = f"pose_trans({job.work_object}, p[{pose}])"
        line = f"  movep({where}, a=1.2, v={move.feed:.5f}, r={blend:.6f})"
        # The next joint move begins where the line ends.
        return f"{line}\n  global at = {_radians(move)}" if move.stops else line

    def press(self, job: Job) -> Iterable[str]:
        yield "  if pressing:"
        yield (
            f"    force_mode(get_actual_tcp_pose(), [0,0,1,0,0,0], [0,0,{job.force_n:g},0,0,0], "
            "2, [0.1,0.1,0.05,0.3,0.3,0.3])"
        )
        yield "  end"

    def tail(self, job: Job) -> Iterable[str]:
        return (*self.calls(job), "end")


class Rapid(_Common):
    """``MoveAbsJ`` with its duration, ``MoveL`` at the feed; degrees and mm."""

    suffix, comment, call, end = ".mod", "!", "stretch_{};", ("  ENDPROC",)
    mark = r"MODULE cellcolor\w*\n +! cellcolor: "
    _external = "[9E9,9E9,9E9,9E9,9E9,9E9]"

    def head(self, job: Job) -> Iterable[str]:
        yield f"MODULE {job.name}"
        yield "  ! cellcolor: RAPID, joints in degrees, lengths in mm, times in s"
        yield from (f"  ! {text}" for text in job.remarks)
        yield "  ! The load of the tool has to be yours."
        load = "[1,[0,0,1],[1,0,0,0],0,0,0]"
        yield f"  PERS tooldata {job.tool} := [TRUE,{self._frame(job.tip)},{load}];"
        frames = f'"",{self._frame(job.part)},[[0,0,0],[1,0,0,0]]'
        yield f"  PERS wobjdata {job.work_object} := [FALSE,TRUE,{frames}];"

    @staticmethod
    def _frame(pose: Array) -> str:
        x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat()
        return f"[[{_listed(1e3 * pose[:3, 3], 4)}],[{_listed([w, x, y, z], 8)}]]"

    def begin(self, number: int, start: Move) -> Iterable[str]:
        yield from (f"  PROC stretch_{number}()", "    VAR jointtarget here;")
        yield "    here := CJointT();"
        for axis, angle in enumerate(start.degrees.tolist(), start=1):
            yield f"    IF Abs(here.robax.rax_{axis} - ({angle:.6f})) > {_START_DEG} THEN"
            yield from (f'      TPWrite "{_NOT_THERE}";', "      EXIT;", "    ENDIF")

    def joint(self, job: Job, move: Move) -> str:
        zone = "fine" if move.stops else "z0"
        target = f"[[{_listed(move.degrees, 6)}],{self._external}]"
        return f"    MoveAbsJ {target}\\NoEOffs, v100\\T:={move.seconds:.6f}, {zone}, {job.tool};"

    def linear(self, job: Job, move: Move) -> str:
        x, y, z, w = move.turn
        quarters = ",".join(str(int(move.degrees[axis] // 90)) for axis in (0, 3, 5))
        pose = f"[{_listed(1e3 * move.at, 4)}],[{_listed([w, x, y, z], 8)}]"
        speed = f"[{1e3 * move.feed:.3f},500,5000,1000]"
        zone = "fine" if move.stops else "z0"
        return (
            f"    MoveL [{pose},[{quarters},0],{self._external}], {speed}, {zone}, {job.tool}"
            f"\\WObj:={job.work_object};"
        )

    def tail(self, job: Job) -> Iterable[str]:
        return ("  PROC main()", "  ConfL\\Off;", *self.calls(job), "  ENDPROC", "ENDMODULE")


@dataclass(eq=False)
class Krl(_Common):
    """``PTP`` at a share of the axes' speeds, ``LIN`` at the feed; degrees and mm."""

    suffix, comment, call, end = ".src", ";", "stretch_{}( )", ("END",)
    mark = r"&ACCESS RVP\n&COMMENT cellcolor: "
    _speeds: dict[str, str] = field(default_factory=dict)

    def _at(self, speed: str, move: str) -> str:
        """A move, and its speed unless that is as it was."""
        what = speed[:4]
        said, self._speeds[what] = self._speeds.get(what) == speed, speed
        return f"  {move}" if said else f"  {speed}\n  {move}"

    def head(self, job: Job) -> Iterable[str]:
        yield "&ACCESS RVP"
        yield "&COMMENT cellcolor: KRL, degrees and mm"
        yield f"DEF {job.name}( )"
        yield from (f"  ; {text}" for text in job.remarks)
        yield "  ; Speeds of PTP are whole percentages of the axes': times are kept roughly."
        yield f"  ; As planned, TOOL_DATA[{job.tool}] = {_euler(job.tip)}"
        yield f"  ; and BASE_DATA[{job.work_object}] = {_euler(job.part)}"
        yield "  BAS(#INITMOV, 0)"
        yield from (f"  BAS(#TOOL, {job.tool})", f"  BAS(#BASE, {job.work_object})")
        yield from ("  $APO.CDIS = 0.5", *self.calls(job), "END")

    def begin(self, number: int, start: Move) -> Iterable[str]:
        self._speeds.clear()  # each stretch may be called by itself
        yield f"DEF stretch_{number}( )"
        for axis, angle in enumerate(start.degrees.tolist(), start=1):
            # A program goes on behind a HALT, so it has to come here again.
            yield f"  WHILE ABS($AXIS_ACT.A{axis} - ({angle:.5f})) > {_START_DEG}"
            yield from (f"    HALT ; {_NOT_THERE}", "  ENDWHILE")

    def joint(self, job: Job, move: Move) -> str:
        del job
        # Rounded down: the arm must not be faster than planned. At least 1, or it stands still.
        percent = int(np.clip(np.floor(100 * move.share + 1e-6), 1, 100))
        named = enumerate(move.degrees.tolist(), start=1)
        angles = ", ".join(f"A{axis} {angle:.5f}" for axis, angle in named)
        rounded = "" if move.stops else " C_PTP"
        return self._at(f"speed_of_axes({percent})", f"PTP {{{angles}}}{rounded}")

    def linear(self, job: Job, move: Move) -> str:
        del job
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = Rotation.from_quat(move.turn).as_matrix(), move.at
        rounded = "" if move.stops else " C_DIS"
        return self._at(f"$VEL.CP = {move.feed:.5f}", f"LIN {_euler(pose)}{rounded}")

    def tail(self, job: Job) -> Iterable[str]:  # noqa: ARG002
        yield "DEF speed_of_axes(percent :IN)"
        yield from ("  INT percent, i", "  FOR i = 1 TO 6", "    $VEL_AXIS[i] = percent")
        yield from ("  ENDFOR", "END")


@dataclass(eq=False)
class Fanuc(_Common):
    """``J`` with its duration and ``L`` at the feed, to joint positions in degrees; mm.

    A program of its own has all stretches, and pauses between them.
    """

    suffix, comment = ".ls", "!"
    mark = r"/PROG  CELLCOLOR\w*\n"
    _places: list[Array] = field(default_factory=list)

    def head(self, job: Job) -> Iterable[str]:
        self._places.clear()
        yield f"/PROG  {job.name.upper()}"
        yield from ("/ATTR", 'COMMENT = "cellcolor: degrees, mm";', "DEFAULT_GROUP = 1,*,*,*,*;")
        yield "/MN"
        yield from (self.remark(text) for text in job.remarks)
        yield self.remark(f"As planned, tool {job.tool} is {_w_p_r(job.tip)},")
        yield self.remark(f"and user frame {job.work_object} is {_w_p_r(job.part)}.")
        yield f"   :  UTOOL_NUM={job.tool} ;"
        yield f"   :  UFRAME_NUM={job.work_object} ;"

    def remark(self, text: str) -> str:
        """Comments, of 32 characters at most each."""
        words = re.findall(r"\S.{0,29}(?=\s|$)|\S{1,30}", text)
        return "\n".join(f"   :  !{part} ;" for part in words)

    def begin(self, number: int, start: Move) -> Iterable[str]:
        if number > 1:
            yield self.remark("The move to the next point was not planned: bring the arm there.")
            yield "   :  PAUSE ;"
        yield "   :  PR[1]=JPOS ;"
        for axis, angle in enumerate(start.degrees.tolist(), start=1):
            low, high = (f"{angle + off:.3f}" for off in (-_START_DEG, _START_DEG))
            yield f"   :  IF (PR[1,{axis}]<({low}) OR PR[1,{axis}]>({high})),JMP LBL[99] ;"

    def _to(self, move: Move) -> str:
        self._places.append(move.degrees)
        return f"P[{len(self._places)}]"

    def joint(self, job: Job, move: Move) -> str:
        del job
        milliseconds = max(1, round(1e3 * move.seconds))
        return f"   :J {self._to(move)} {milliseconds}msec {'FINE' if move.stops else 'CNT0'} ;"

    def linear(self, job: Job, move: Move) -> str:
        del job
        speed = f"{max(1, round(1e3 * move.feed))}mm/sec"
        return f"   :L {self._to(move)} {speed} {'FINE' if move.stops else 'CNT100'} ;"

    def tail(self, job: Job) -> Iterable[str]:
        yield "   :  JMP LBL[100] ;"
        yield "   :  LBL[99] ;"
        yield self.remark(_NOT_THERE)
        yield from ("   :  ABORT ;", "   :  LBL[100] ;", "/POS")
        for number, degrees in enumerate(self._places, start=1):
            named = enumerate(degrees.tolist(), start=1)
            yield from (f"P[{number}]{{", "   GP1:", f"\tUF : {job.work_object}, UT : {job.tool},")
            yield ",\n".join(f"\tJ{axis} = {angle:.5f} deg" for axis, angle in named)
            yield "};"
        yield "/END"


Language = UrScript | Rapid | Krl | Fanuc
LANGUAGES: dict[str, Language] = {
    "urscript": UrScript(),
    "rapid": Rapid(),
    "krl": Krl(),
    "fanuc": Fanuc(),
}
"""Every language by its name in setups."""


def _listed(numbers: Iterable[float], digits: int) -> str:
    return ",".join(f"{number:.{digits}f}" for number in numbers)


def _radians(move: Move) -> str:
    return f"[{_listed(np.radians(move.degrees), 7)}]"


def _pose(pose: Array) -> str:
    turn = Rotation.from_matrix(pose[:3, :3]).as_rotvec()
    return f"p[{_listed([*pose[:3, 3], *turn], 7)}]"


def _angles(pose: Array) -> Iterator[float]:
    """x, y, z in mm and the angles about z, y and x in degrees."""
    yield from (1e3 * pose[:3, 3]).tolist()
    yield from Rotation.from_matrix(pose[:3, :3]).as_euler("ZYX", degrees=True).tolist()


def _euler(pose: Array) -> str:
    named = zip("XYZABC", _angles(pose), strict=True)
    return f"{{{', '.join(f'{name} {value:.5f}' for name, value in named)}}}"


def _w_p_r(pose: Array) -> str:
    x, y, z, r, p, w = _angles(pose)
    return f"X {x:.3f} Y {y:.3f} Z {z:.3f} W {w:.3f} P {p:.3f} R {r:.3f}"
