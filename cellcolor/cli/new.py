"""``cellcolor new``: a scene and a setup to begin with."""

from __future__ import annotations

from pathlib import Path

from cellcolor.cli.exits import Exit
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import complain, say
from cellcolor.deadline import Deadline, OutOfTime


def begin_scene(
    part: Path,
    arm: Path,
    folder: Path,
    tool: Path | None,
    tip_link: str,
    unit: str | None,
    deadline: Deadline,
) -> Exit:
    """Write a scene and its setup, and say what to do next.

    Args:
        part: a mesh file.
        arm: a URDF.
        folder: for the files; made where it does not exist.
        tool: a URDF; None for one that is written as well.
        tip_link: of the tool.
        unit: of the mesh; None for the likely one.
        deadline: when to give up.
    """
    from cellcolor.door.starting import new

    try:
        with stages_of(part, "beginning") as tell:
            made = new(
                part,
                arm,
                folder,
                tool=tool,
                tip_link=tip_link,
                unit=unit,
                time_limit=deadline,
                progress=tell,
            )
    except OutOfTime:
        complain(f"{part}: the time limit came first; nothing is written")
        return Exit.STOPPED
    INTERRUPTS.check()
    say(f"wrote {made.scene} and its setup: {made.reachable_share:.0%} of the part can be reached")
    for note in made.notes:
        say(f"  {note}")
    say(f"next: cellcolor plan {made.scene} -o {made.scene.parent / 'plan'}")
    return Exit.DONE
