"""Small grammars of URScript, RAPID, KRL and FANUC's LS: they read what programs say, line by line.

They have no part in writing, and refuse every line that they do not know, and every block that is
not closed. They are not the makers': a controller may know better.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

N = r"-?\d+(?:\.\d+)?(?:[eE]-?\d+)?"
LIST = rf"\[{N}(?:, ?{N})*\]"


@dataclass
class Go:
    """A move, or what is done between two: ``joint``, ``linear``, ``press`` or ``release``."""

    kind: str
    joints: np.ndarray | None = None  # as the controller counts them, degrees
    pose: np.ndarray | None = None  # (4, 4) in the work object, m
    seconds: float | None = None
    feed: float | None = None  # m/s
    share: float | None = None  # of the axes' speeds


@dataclass
class Program:
    """What a reader has found.

    Attributes:
        starts: of each stretch, the joints that are asked for before it, degrees.
        stretches: the moves of each.
        called: the numbers of the stretches that are called.
        tool, part: (4, 4) frames that the program states, m.
    """

    starts: list[np.ndarray] = field(default_factory=list)
    stretches: list[list[Go]] = field(default_factory=list)
    called: list[int] = field(default_factory=list)
    tool: np.ndarray | None = None
    part: np.ndarray | None = None
    asked: list[float] = field(default_factory=list)

    def begin(self, joints: np.ndarray) -> None:
        """A stretch that begins at some joints, degrees."""
        self.starts.append(joints)
        self.stretches.append([])

    def ask(self, number: str, angle: str) -> None:
        """A joint's angle before a stretch; the sixth begins it."""
        self.asked.append(float(angle))
        if int(number) == 6:
            self.begin(np.array(self.asked[-6:]))

    def go(self, kind: str, **what: Any) -> None:
        self.stretches[-1].append(Go(kind, **what))

    def call(self, number: str) -> None:
        self.called.append(int(number))


def numbers(text: str) -> np.ndarray:
    return np.array([float(one) for one in re.findall(N, text)])


def pose_of(at_m: np.ndarray, turn: Rotation) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn.as_matrix(), at_m
    return pose


def _read(lines: list[str], grammar: list[tuple[str, str, Callable[..., None] | None]]) -> None:
    """Take each line by the first rule that knows it: pattern, what it opens or closes, act."""
    known = [(re.compile(pattern), block, act) for pattern, block, act in grammar]
    open_blocks: list[str] = []
    for line in lines:
        for pattern, block, act in known:
            found = pattern.fullmatch(line.strip())
            if found is None:
                continue
            if block.startswith("+"):
                open_blocks.append(block[1:])
            elif block.startswith("-"):
                assert open_blocks and open_blocks.pop() in block[1:].split(), line
            if act is not None:
                act(*found.groups())
            break
        else:
            raise AssertionError(f"no rule for {line!r}")
    assert not open_blocks


def read_urscript(text: str) -> Program:
    found, step, frames = Program(), [0.0], {}

    def frame(name: str, given: str) -> None:
        six = numbers(given)
        frames[name] = pose_of(six[:3], Rotation.from_rotvec(six[3:]))

    def go(given: str, count: str) -> None:
        found.go("joint", joints=np.degrees(numbers(given)), seconds=float(count) * step[0])

    def line(name: str, given: str, feed: str) -> None:
        six = numbers(given)
        pose = pose_of(six[:3], Rotation.from_rotvec(six[3:]))
        assert name in frames
        found.go("linear", pose=pose, feed=float(feed))

    def tcp(name: str) -> None:
        found.tool = frames[name]

    share = ", ".join(rf"at\[{i}\] \+ s \* \(to\[{i}\] - at\[{i}\]\)" for i in range(6))
    force = rf"force_mode\(get_actual_tcp_pose\(\), {LIST}, {LIST}, 2, {LIST}\)"
    _read(
        text.splitlines(),
        [
            (r"#.*", "", None),
            (r"def \w+\((?:\w+(?:, \w+)*)?\):", "+def", None),
            (r"while i <=? \w+:", "+while", None),
            (rf"if (?:pressing|norm\(here\[i\] - start\[i\]\) > {N}):", "+if", None),
            ("end", "-def while if", None),
            (rf"global (\w+) = p({LIST})", "", frame),
            (r"set_tcp\((\w+)\)", "", tcp),
            (rf"start = ({LIST})", "", lambda own: found.begin(np.degrees(numbers(own)))),
            (rf"go\(({LIST}), ({N})\)", "", go),
            (rf"movep\(pose_trans\((\w+), p({LIST})\), a={N}, v=({N}), r={N}\)", "", line),
            (
                rf"servoj\(\[{share}\], t=({N}), lookahead_time={N}, gain={N}\)",
                "",
                lambda own: step.__setitem__(0, float(own)),
            ),
            (force, "", lambda: found.go("press")),
            (r"end_force_mode\(\)", "", lambda: found.go("release")),
            (r"stretch_(\d+)\(\)", "", found.call),
            ("global pressing = False", "", None),
            (r"global at = (?:to|start|get_actual_joint_positions\(\))", "", None),
            (rf"global at = {LIST}", "", None),
            (r"here = get_actual_joint_positions\(\)|[is] = [i0-9. +/n]+", "", None),
            (r'popup\("[^"]*", error=True\)|halt|stopj\(2\.0\)', "", None),
        ],
    )
    found.part = frames["cellcolor_part"]
    return found


def read_rapid(text: str) -> Program:
    found = Program()

    def frame(what: str, given: str) -> None:
        x, y, z, *turn = numbers(given)[:7]
        w, *vector = turn
        pose = pose_of(np.array([x, y, z]) / 1e3, Rotation.from_quat([*vector, w]))
        setattr(found, {"tooldata": "tool", "wobjdata": "part"}[what], pose)

    def joint(given: str, seconds: str) -> None:
        found.go("joint", joints=numbers(given), seconds=float(seconds))

    def line(at: str, turn: str, feed: str) -> None:
        w, *vector = numbers(turn)
        pose = pose_of(numbers(at) / 1e3, Rotation.from_quat([*vector, w]))
        found.go("linear", pose=pose, feed=float(feed) / 1e3)

    external = r"\[9E9(?:,9E9){5}\]"
    _read(
        text.splitlines(),
        [
            (r"!.*", "", None),
            (r"MODULE \w+", "+module", None),
            ("ENDMODULE", "-module", None),
            (r"PROC \w+\(\)", "+proc", None),
            ("ENDPROC", "-proc", None),
            (rf"IF Abs\(here\.robax\.rax_(\d) - \(({N})\)\) > {N} THEN", "+if", found.ask),
            ("ENDIF", "-if", None),
            (rf"PERS (tooldata) \w+ := \[TRUE,(\[{LIST},{LIST}\]),\[.*\]\];", "", frame),
            (rf'PERS (wobjdata) \w+ := \[FALSE,TRUE,"",(\[{LIST},{LIST}\]),.*\];', "", frame),
            (
                rf"MoveAbsJ \[({LIST}),{external}\]\\NoEOffs, v100\\T:=({N}), (?:z0|fine), \w+;",
                "",
                joint,
            ),
            (
                rf"MoveL \[({LIST}),({LIST}),{LIST},{external}\], \[({N}),500,5000,1000\], "
                r"(?:z0|fine), \w+\\WObj:=\w+;",
                "",
                line,
            ),
            (r"stretch_(\d+);", "", found.call),
            (r"VAR jointtarget here;|here := CJointT\(\);|EXIT;|ConfL\\Off;", "", None),
            (r'TPWrite "[^"]*";', "", None),
        ],
    )
    return found


def _turned(z_y_x: np.ndarray) -> Rotation:
    return Rotation.from_euler("ZYX", z_y_x, degrees=True)


def read_krl(text: str) -> Program:
    found, said = Program(), {"share": 0.0, "feed": 0.0}
    six = rf"\{{X ({N}), Y ({N}), Z ({N}), A ({N}), B ({N}), C ({N})\}}"
    angles = rf"\{{{', '.join(rf'A{i} ({N})' for i in range(1, 7))}\}}"

    def place(*given: str) -> np.ndarray:
        own = np.array([float(one) for one in given])
        return pose_of(own[:3] / 1e3, _turned(own[3:]))

    def frame(what: str, *given: str) -> None:
        setattr(found, {"TOOL": "tool", "BASE": "part"}[what], place(*given))

    def joint(*given: str) -> None:
        own = np.array([float(one) for one in given])
        found.go("joint", joints=own, share=said["share"])

    def line(*given: str) -> None:
        found.go("linear", pose=place(*given), feed=said["feed"])

    _read(
        text.splitlines(),
        [
            (rf"; (?:As planned,|and) (TOOL|BASE)_DATA\[\d+\] = {six}", "", frame),
            (r";.*|&ACCESS RVP|&COMMENT .*", "", None),
            # What one stretch says of speeds the next one, called by itself, does not know.
            (r"DEF \w+\( \)|DEF speed_of_axes\(percent :IN\)", "+def", said.clear),
            ("END", "-def", None),
            (rf"WHILE ABS\(\$AXIS_ACT\.A(\d) - \(({N})\)\) > {N}", "+while", found.ask),
            ("ENDWHILE", "-while", None),
            ("FOR i = 1 TO 6", "+for", None),
            ("ENDFOR", "-for", None),
            (r"speed_of_axes\((\d+)\)", "", lambda own: said.update(share=int(own) / 100)),
            (rf"\$VEL\.CP = ({N})", "", lambda own: said.update(feed=float(own))),
            (rf"PTP {angles}(?: C_PTP)?", "", joint),
            (rf"LIN {six}(?: C_DIS)?", "", line),
            (r"stretch_(\d+)\( \)", "", found.call),
            (r"BAS\(#(?:INITMOV|TOOL|BASE), \d+\)|\$APO\.CDIS = 0\.5", "", None),
            (r"HALT ;.*|INT percent, i|\$VEL_AXIS\[i\] = percent", "", None),
        ],
    )
    return found


def read_fanuc(text: str) -> Program:
    head, rest = text.split("/MN\n")
    body, places = rest.split("/POS\n")
    assert re.fullmatch(r"/PROG  \w+\n/ATTR\n(?:[A-Z_]+ = [^;]*;\n)*", head)
    remarks = " ".join(re.findall(r"!(.*) ;", body))
    assert all(len(one) <= 32 for one in re.findall(r"!(.*) ;", body))
    angles = "".join(rf",\n\tJ{i} = ({N}) deg" for i in range(1, 7))
    entry = rf"P\[(\d+)\]\{{\n   GP1:\n\tUF : \d+, UT : \d+{angles}\n\}};\n"
    joints = {
        int(number): np.array([float(one) for one in own])
        for number, *own in re.findall(entry, places)
    }
    assert re.fullmatch(rf"(?:{entry})*/END\n", places)
    found = Program(called=[1])

    def start(number: str, low: str, high: str) -> None:
        found.ask(number, repr((float(low) + float(high)) / 2))

    def joint(number: str, ms: str) -> None:
        found.go("joint", joints=joints[int(number)], seconds=int(ms) / 1e3)

    def line(number: str, feed: str) -> None:
        found.go("linear", joints=joints[int(number)], feed=int(feed) / 1e3)

    axis = rf"PR\[1,(\d)\]<\(({N})\) OR PR\[1,\d\]>\(({N})\)"
    ended = r"(?:FINE|CNT\d+)"
    _read(
        body.splitlines(),
        [
            (r":  !.* ;|:  (?:UTOOL|UFRAME)_NUM=\d+ ;|:  PR\[1\]=JPOS ;", "", None),
            (rf":  IF \({axis}\),JMP LBL\[99\] ;", "", start),
            (rf":J P\[(\d+)\] (\d+)msec {ended} ;", "", joint),
            (rf":L P\[(\d+)\] (\d+)mm/sec {ended} ;", "", line),
            (r":  (?:JMP )?LBL\[\d+\] ;|:  ABORT ;|:  PAUSE ;", "", None),
        ],
    )
    frames = re.findall(rf"X ({N}) Y ({N}) Z ({N}) W ({N}) P ({N}) R ({N})", remarks)
    for name, own in zip(("tool", "part"), frames, strict=True):
        x, y, z, w, p, r = (float(one) for one in own)
        setattr(found, name, pose_of(np.array([x, y, z]) / 1e3, _turned(np.array([r, p, w]))))
    return found


READERS = {
    ".script": read_urscript,
    ".mod": read_rapid,
    ".src": read_krl,
    ".ls": read_fanuc,
}
"""By the ending of the file's name."""
