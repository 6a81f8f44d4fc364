"""The tolerances of the judge, and their reasons (docs/judging-trajectories.md)."""

from __future__ import annotations

import math

STEP = 0.001  # m; between samples whose tips are farther apart, others are put in and tested
STEP_ANGLE = math.radians(1.0)  # the same for the turn of the tool and of each joint that turns

ANGLE_ROUNDING = 1e-6  # rad, and m of a slide; files with six decimals are off by half of that
# rad; what a motion may be off the line between two samples. With 12 rad/s² it is if they are more
# than 0.24 s apart, with less acceleration if they are farther apart.
BOW = math.radians(5.0)
BOW_OF_SLIDE = 0.02  # m; the same of a prismatic joint, with 3 m/s² for about the same time
POSE_ROUNDING = 2e-6  # m; what a rounding of all angles moves a tip by, at a meter's reach
SHARE_OVER_LIMIT = 0.01  # of a velocity, acceleration or jerk, for planners that keep one just so
CYCLE = 0.008  # s, of a controller; a jerk is judged by samples no closer than this
SLOW = 0.9  # of the asked feed; below, contact time counts as slow
AT_LIMIT = 0.9  # of a velocity or acceleration; a joint as near to it limits the feed
JUMP = 0.5  # rad, m; farther between neighbors nothing says any more how a joint gets there
POSE_DISTANCE = 1e-4  # m; the file's point against the one that the joints give
POSE_ANGLE = math.radians(0.1)  # the same for the normal, where the tool is held against it
OFF_SURFACE = 0.001  # m; a mesh leaves the curved object it stands for by up to 0.6 mm as shipped
LEAVING = 0.003  # m; so far the tip may go on within OFF_SURFACE, off contact, beside a stroke
TILT = math.radians(1.0)  # the tool's axis against the interpolated normal
TURN = math.radians(1.0)  # the tool's x axis against the turn that the setup gives
BRANCH = 0.01  # rad, m; configurations nearer than this to a branch's are its
AT_VERTEX = 0.1  # rad, m; the same where tip and tool are off the vertex as far as a contact may be
