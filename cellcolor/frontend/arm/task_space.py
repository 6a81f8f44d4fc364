"""Which numbers of the tool's pose a task asks for, and which joints answer (docs/frontend.md)."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class TaskSpace:
    """Rows and columns of the task's Jacobian.

    Attributes:
        joints: how many joints answer, counted from the base; those after them move nothing that is
            asked for.
        turn: whether the turn of the tool about its axis is asked for, one row in rad.
        lengths: how many rows are lengths: 3 for the tip's position, 2 where the tip moves in a
            plane across the tool.
        direction: whether the tool's direction is asked for, two rows in rad. Otherwise it is what
            it is.
    """

    joints: int
    turn: bool
    lengths: int = 3
    direction: bool = True

    @property
    def dimensions(self) -> int:
        """How many rows there are."""
        return self.lengths + 2 * self.direction + self.turn

    @property
    def most_joints(self) -> int:
        """How many an arm may have: one more may turn the tool about its axis, and is locked."""
        return self.joints + 1 if self.direction and not self.turn else self.joints

    @property
    def plane(self) -> bool:
        """Whether the tip moves in a plane across the tool."""
        return self.lengths == 2


FREE_TURN = TaskSpace(joints=5, turn=False)
"""The tool's turn is free: a sixth joint turns it about its own axis and is locked."""

GIVEN_TURN = TaskSpace(joints=6, turn=True)
"""The tool's whole pose is asked for."""

POSITION = TaskSpace(joints=3, turn=False, direction=False)
"""Where the tip is, and nothing else."""

POSITION_AND_TURN = TaskSpace(joints=4, turn=True, direction=False)
"""Where the tip is, and how the tool is turned about its own axis, whose direction is fixed."""

FREE_IN_PLANE = TaskSpace(joints=2, turn=False, lengths=2, direction=False)
"""Where the tip is in a plane, and nothing else."""

GIVEN_IN_PLANE = TaskSpace(joints=3, turn=True, lengths=2, direction=False)
"""The same, and the tool's turn."""
