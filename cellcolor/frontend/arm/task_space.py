"""Which numbers of the tool's pose a task asks for, and which joints answer (docs/frontend.md)."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["FREE_IN_PLANE", "FREE_TURN", "GIVEN_IN_PLANE", "GIVEN_TURN", "TaskSpace"]


@dataclass(frozen=True)
class TaskSpace:
    """Rows and columns of the task's Jacobian.

    Attributes:
        joints: how many joints answer, counted from the base; those after them move nothing that is
            asked for.
        turn: whether the turn of the tool about its axis is asked for, one row in rad.
        plane: whether the tip moves in a plane across the tool, two rows in m, and the tool's
            direction is what it is. Otherwise the tip's position is asked for, three rows in m, and
            the tool's direction, two rows in rad.
    """

    joints: int
    turn: bool
    plane: bool = False

    @property
    def dimensions(self) -> int:
        """How many rows there are."""
        return (2 if self.plane else 5) + self.turn

    @property
    def most_joints(self) -> int:
        """How many an arm may have: one more may turn the tool about its axis, and is locked."""
        return self.joints if self.turn or self.plane else self.joints + 1

    @property
    def lengths(self) -> int:
        """How many of them are lengths."""
        return 2 if self.plane else 3


FREE_TURN = TaskSpace(joints=5, turn=False)
"""The tool's turn is free: a sixth joint turns it about its own axis and is locked."""

GIVEN_TURN = TaskSpace(joints=6, turn=True)
"""The tool's whole pose is asked for."""

FREE_IN_PLANE = TaskSpace(joints=2, turn=False, plane=True)
"""Where the tip is in a plane, and nothing else."""

GIVEN_IN_PLANE = TaskSpace(joints=3, turn=True, plane=True)
"""The same, and the tool's turn."""
