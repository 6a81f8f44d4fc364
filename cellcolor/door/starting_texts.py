"""The files that ``cellcolor.new`` writes, with places to be filled (``string.Template``)."""

from __future__ import annotations

import os
from pathlib import Path

MARK = "# begun by cellcolor new"

TOOL = """<!-- begun by cellcolor new: a polisher on the axis of the last joint, 100 mm long -->
<robot name="polisher">
  <link name="body">
    <inertial><origin xyz="0 0 0.045"/><mass value="0.5"/>
      <inertia ixx="4e-4" ixy="0" ixz="0" iyy="4e-4" iyz="0" izz="1e-4"/></inertial>
    <!-- ends 10 mm above the tip, so that only the tip touches the part -->
    <collision><origin xyz="0 0 0.045"/>
      <geometry><cylinder radius="0.02" length="0.09"/></geometry></collision>
  </link>
  <joint name="tip_joint" type="fixed">
    <parent link="body"/><child link="tip"/><origin xyz="0 0 0.1"/>
  </joint>
  <link name="tip"/>
</robot>
"""

SETUP = (
    MARK
    + """: the robot, its tool, and what counts as valid (docs/frontend.md).
# File names are relative to this file. The world frame is the root link of $arm.

[robot]
arm_urdf = $arm_urdf
kinematics = $family                # the family of the arm, which has its inverse kinematics
flange_link = $flange               # where the tool's root link is fixed
mount_position_m = $mount_at   # of the tool's root link on it
mount_rpy_rad = $mount_turned      # turns the tool's z axis onto the last joint's
tool_urdf = $tool
tip_link = $tip                     # where the tool touches; its z axis goes into the part
locked_joint_6_rad = 0.0            # the tool may turn about its axis: the last joint stands still
fixed_joints = {$fixed}             # joints that stand still, rad or m
may_touch_ground = $standing
may_touch = $touching               # pairs of links that overlap in every posture
# mesh_collision_of = { some_link = "exact" }   # a link's mesh itself instead of its convex hull

[task]
normal_force_n = 20.0               # pressed along the tool's axis
contact_radius_m = 0.005            # obstacles and the ground stay farther off the tip than this
# stand_off_m = 0.1                 # of a tool that sprays or scans: from its tip to the surface
gravity_m_per_s2 = [0.0, 0.0, -9.81]

[constraints]
force = $force                      # whether torques are tested; URDFs need masses and efforts

# How near a singularity is too near, as shares of the cube of the arm's reach.
[thresholds]
min_manipulability = 0.009
min_task_determinant = 0.0009

# When two configurations on neighboring vertices are joined by a continuous motion.
[continuity]
base_step_rad = 0.1
step_per_length_rad_per_m = 30.0
near_singular_determinant = 0.0045
probe_spacing_m = 0.0005
validity_spacing_m = $spacing

# Very small cells, as shares of the surface: simplified, or given up and said so.
[slivers]
simplify_below_share = 0.01
uncover_below_share = 0.005

# Lists of joints: $joints.
[motion]
tool_radius_m = 0.015               # of the tool's footprint
spacing_m = 0.01                    # between neighboring passes
# overlap_m = 0.01                  # of neighboring segments, so that no seam is left
speed_m_per_s = 0.05                # of the tool on the part
approach_speed_m_per_s = 0.02       # of the tool within 10 mm of a touch
# transfer_speed_m_per_s = 0.25     # of the tool between strokes
# least_feed = 0.8                  # less than this share of the speed is a fault
# Velocities lower than the URDF's, or in place of those that it lacks: take the data sheet's.
${velocities}joint_velocities_rad_per_s = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
joint_accelerations_rad_per_s2 = [5.0, 5.0, 5.0, 5.0, 5.0, 5.0]   # take the data sheet's
# joint_jerks_rad_per_s3 = [1e3, 1e3, 1e3, 1e3, 1e3, 1e3]   # for the judge, if there is a limit
retract_m = 0.05                    # along the normal, before moving on
clearance_m = 0.005                 # to everything, between strokes
# Where the arm begins and ends; free in this scene, over the part if there is room.
home_rad = $home

# Of divisions with as few lift-offs the one nearest to home_rad (docs/motion.md, "Posture").
# [prefer]
# posture = "well-conditioned"      # the one farthest from limits and singularities
# branch = "shoulder-left"          # these words of a branch's name first

# For programs (docs/formats/other-programs.md); an arm of Universal Robots needs no table.
# [controller]
# language = "rapid"                # urscript, rapid, krl or fanuc
# signs = [1, 1, 1, 1, 1, 1]        # of its axes against the URDF's; there are offsets_deg too
"""
)

SCENE = (
    MARK
    + """: the part, and what stands where (docs/frontend.md). Lengths are in meters.
name = $name
setup = "setup.toml"

[object]
kind = "mesh"
file = $part
meters_per_unit = $meters_per_unit              # 0.001 for a file in millimeters
max_edge_m = $max_edge                   # longer edges are halved; finer meshes take longer
repair = $repair
flip = $flip                        # of an open part the other side is the outside
$cover
# Put where the arm reaches the part best, of nine places before the robot.
[placement]
position_m = $position              # of the file's origin, from the robot's root link
rpy_rad = $rpy           # extrinsic x, y, z

[ground]
height_m = 0.0

# [[obstacle]]
# kind = "box"
# size_m = [0.1, 0.1, 0.5]
# position_m = [0.3, 0.4, 0.25]
# rpy_rad = [0.0, 0.0, 0.0]
"""
)


def relative(file: Path, folder: Path) -> str:
    """How a text in a folder names a file."""
    return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
