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

EXPORTS = {
    "joints.csv": Export(joint_table.KIND, joint_table.joints_csv),
    "strokes.zip": Export(strokes.KIND, strokes.strokes_zip),
    "tool_paths.yaml": Export(tool_poses.KIND, tool_poses.tool_paths_yaml),
    "joint_trajectory.yaml": Export(joint_trajectory.KIND, joint_trajectory.joint_trajectory_yaml),
    "cellcolor.script": Export(programs.URSCRIPT, programs.urscript),
    "cellcolor.mod": Export(programs.RAPID, programs.rapid),
    "cellcolor.src": Export(programs.KRL, programs.krl),
    "motion.mcap": Export(recording.KIND, recording.recording),
    "painted.ply": Export(painted_mesh.PLY, painted_mesh.ply),
    "painted.glb": Export(painted_mesh.GLB, painted_mesh.glb),
}
"""The files beside those of cellcolor's own formats in the folder of a plan."""


def exported(planned: PlannedMotion) -> dict[str, bytes]:
    """All files that there are for a motion and its arm, by name."""
    found = {}
    for name, export in EXPORTS.items():
        with suppress(NotForThisArm):
            found[name] = export.content(planned)
    return found
