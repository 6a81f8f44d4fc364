"""Trajectories at the front door: read from any of their files, and judged."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TypeAlias

from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_csv import TrajectoryTable, read_trajectory_csv
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.deadline import Deadline
from cellcolor.door.extras import extras_for
from cellcolor.door.subject import Subject

__all__ = ["ReadTrajectory", "is_table", "judge_trajectory", "read_trajectory"]

ReadTrajectory: TypeAlias = Trajectory | TrajectoryTable
"""A trajectory, or a table that a scene's arm has to complete."""


def read_trajectory(file: str | PathLike[str]) -> ReadTrajectory:
    """What is in a trajectory's file.

    Raises:
        InputError: it cannot be used; names file and member, or file, line and column.
    """
    return read_trajectory_csv(file) if is_table(file) else Trajectory.read(file)


def judge_trajectory(
    subject: Subject,
    given: ReadTrajectory,
    deadline: Deadline,
    progress: Callable[[str], None] | None = None,
) -> TrajectoryVerdict:
    """The verdict on a trajectory for a scene, the proven minimum beside it if it is found in time.

    Raises:
        InputError: the subject is no scene, or the trajectory is of another arm.
        OutOfTime: the deadline came before there was a verdict.
    """
    from cellcolor.oracle import prove

    built = subject.build()
    with extras_for("the front end"):
        from cellcolor.trajectory_checker.check import check_trajectory
        from cellcolor.trajectory_checker.other_planners import completed

    report = progress or (lambda _: None)
    tells = isinstance(given, Trajectory)
    timed = isinstance(given, Trajectory) or given.times is not None
    if isinstance(given, TrajectoryTable):
        given = completed(given, built.robot, deadline)
    report("proven minimum")
    # Half of the time is for the judge, who has something to say whatever is proved.
    bounds = prove(built.surface, deadline.share(0.5)).bounds
    return check_trajectory(
        built,
        given,
        timed=timed,
        tells=tells,
        minimum_lift_offs=max(0, bounds.lower - 1) if bounds.exact else None,
        deadline=deadline,
        progress=progress,
    )


def is_table(file: str | PathLike[str]) -> bool:
    """Whether a file is a table of a trajectory, which its suffix says."""
    return Path(file).suffix == ".csv"
