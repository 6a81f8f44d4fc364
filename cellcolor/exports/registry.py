"""Every export by the name of its file."""

from __future__ import annotations

from contextlib import suppress

from cellcolor.exports import (
    joint_table,
    joint_trajectory,
    painted_mesh,
    programs,
    recording,
    strokes,
    tool_poses,
)
from cellcolor.exports.interface import Export, NotForThisArm, PlannedMotion
from cellcolor.exports.languages import LANGUAGES

PROGRAM = "program for a controller"
EXPORTS = {
    "joints.csv": Export(joint_table.KIND, joint_table.joints_csv),
    "strokes.zip": Export(strokes.KIND, strokes.strokes_zip),
    "tool_paths.yaml": Export(tool_poses.KIND, tool_poses.tool_paths_yaml),
    "joint_trajectory.yaml": Export(joint_trajectory.KIND, joint_trajectory.joint_trajectory_yaml),
    **programs.programs(),
    "motion.mcap": Export(recording.KIND, recording.recording, recording.check),
    "painted.ply": Export(painted_mesh.PLY, painted_mesh.ply),
    "painted.glb": Export(painted_mesh.GLB, painted_mesh.glb),
}
"""The files beside those of cellcolor's own formats in the folder of a plan."""


def exported(planned: PlannedMotion) -> dict[str, bytes]:
    """All files that there are for a motion and its arm, by name."""
    found = {}
    for name, export in EXPORTS.items():
        with suppress(NotForThisArm):
            export.check(planned)
            found[name] = export.content(planned)
    return found


def programs_of(planned: PlannedMotion) -> tuple[str, ...]:
    """The names of the programs for the arm's controller, none if there is none."""
    try:
        language = programs.controller_of(planned).language
    except NotForThisArm:
        return ()
    suffix = LANGUAGES[language].suffix
    return tuple(name for name in programs.programs() if name.endswith(suffix))


def why_not(planned: PlannedMotion) -> dict[str, str]:
    """What there is not for this arm, each with the reason: programs, a recording."""
    found = {}
    for name, check in (
        (PROGRAM, programs.controller_of),
        ("motion.mcap", recording.check),
    ):
        try:
            check(planned)
        except NotForThisArm as error:
            found[name] = str(error)
    return found
