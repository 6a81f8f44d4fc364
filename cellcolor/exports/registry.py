"""Every export by the name of its file."""

from __future__ import annotations

from cellcolor.exports import joint_table, joint_trajectory, painted_mesh, tool_poses
from cellcolor.exports.interface import Export

EXPORTS = {
    "joints.csv": Export(joint_table.KIND, joint_table.joints_csv),
    "tool_paths.yaml": Export(tool_poses.KIND, tool_poses.tool_paths_yaml),
    "joint_trajectory.yaml": Export(joint_trajectory.KIND, joint_trajectory.joint_trajectory_yaml),
    "painted.ply": Export(painted_mesh.PLY, painted_mesh.ply),
    "painted.glb": Export(painted_mesh.GLB, painted_mesh.glb),
}
"""The files beside those of cellcolor's own formats in the folder of a plan."""
