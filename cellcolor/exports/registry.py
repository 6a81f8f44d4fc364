"""Every export by the name of its file."""

from __future__ import annotations

from contextlib import suppress

from cellcolor.exports import joint_files, programs
from cellcolor.exports.interface import Export, NotForThisArm, PlannedMotion
from cellcolor.exports.languages import LANGUAGES

EXPORTS = {
    "joints.csv": Export(joint_files.TABLE, joint_files.joints_csv),
    "joint_trajectory.yaml": Export(joint_files.MESSAGES, joint_files.joint_trajectory_yaml),
    **programs.PROGRAMS,
}
"""The files beside those of cellcolor's own formats in the folder of a plan."""


def exported(planned: PlannedMotion) -> dict[str, bytes]:
    """All files that there are for a motion and its arm, by name."""
    found = {}
    for name, export in EXPORTS.items():
        with suppress(NotForThisArm):
            found[name] = export.content(planned)
    return found


def programs_of(planned: PlannedMotion) -> tuple[str, ...]:
    """The names of the programs for the arm's controller, none if there is none."""
    if why_no_program(planned) is not None:
        return ()
    suffix = LANGUAGES[programs.controller_of(planned).language].suffix
    return tuple(name for name in programs.PROGRAMS if name.endswith(suffix))


def why_no_program(planned: PlannedMotion) -> str | None:
    """Why there is no program for a controller of this arm; None if there is one."""
    try:
        programs.controller_of(planned)
    except NotForThisArm as error:
        return str(error)
    return None
