"""A trajectory and its faults so far: neighboring samples with the same fault are one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import numpy as np

from cellcolor.arrays import Array, Index, Mask, stretches
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import Fault, FaultKind
from cellcolor.trajectory_checker.dense import Dense

_MOST = 100  # of a kind; the rest is counted


class FaultList:
    """The faults of one trajectory.

    Attributes:
        trajectory: which one.
        tips: (k, 3) where its joints put the tool's tip, m.
        timed: whether its times mean anything.
        counts: how many of each kind were found.
        faults: the first of each kind.
    """

    def __init__(self, trajectory: Trajectory, tips: Array, timed: bool = True) -> None:
        self.trajectory, self.tips, self.timed = trajectory, tips, timed
        self.counts: Counter[FaultKind] = Counter()
        self.faults: list[Fault] = []

    def add(
        self,
        kind: FaultKind,
        text: str,
        sample: int | None = None,
        last_sample: int | None = None,
        *,
        joint: int | None = None,
        reason: str | None = None,
        place: Array | None = None,
    ) -> None:
        """Note one fault.

        Args:
            joint: its number.
            place: (3,) in m; None for that of the tip at the sample.
        """
        self.counts[kind] += 1
        if self.counts[kind] > _MOST:
            return
        time: float | None = None
        if sample is not None:
            time = float(self.trajectory.times[sample]) if self.timed else None
            place = self.tips[sample] if place is None else place
        name = None if joint is None else self.trajectory.joint_names[joint]
        x_y_z = None if place is None else (float(place[0]), float(place[1]), float(place[2]))
        last_sample = sample if last_sample is None else last_sample
        self.faults.append(Fault(kind, text, sample, last_sample, time, name, reason, x_y_z))

    def add_stretches(
        self,
        kind: FaultKind,
        at_fault: Mask,
        excess: Array,
        text: Callable[[int], str],
        joint: int | None = None,
    ) -> None:
        """Note each stretch of neighboring samples at fault once, with the text of its worst one.

        Args:
            at_fault: (k,).
            excess: (k,) how bad each is.
            text: what to say of a sample.
        """
        for first, after in stretches(at_fault):
            worst = first + int(np.argmax(excess[first:after]))
            self.add(kind, text(worst), first, after - 1, joint=joint)

    def add_rows(
        self,
        kind: FaultKind,
        dense: Dense,
        rows: Index,
        excess: Array,
        most: float,
        text: Callable[[int], str],
        reason: str | None = None,
    ) -> None:
        """The same for configurations between samples as well, where they exceed what is allowed.

        Args:
            rows: (c,) the configurations that are judged.
            excess: (c,) how bad each is.
            text: what to say of one, by its number among the rows.
        """
        number = np.full(len(dense), -1)
        number[rows] = np.arange(len(rows))
        at_fault = np.zeros(len(dense), dtype=bool)
        at_fault[rows] = excess > most
        for first, after in stretches(at_fault):
            own = number[first:after]
            worst = int(own[np.argmax(excess[own])])
            said = text(worst) + dense.where(rows[worst])
            begin, end = int(dense.sample[first]), int(dense.sample[after - 1])
            self.add(kind, said, begin, end, reason=reason, place=dense.tips[first])

    def add_joint_stretches(
        self,
        kind: FaultKind,
        at_fault: Mask,
        excess: Array,
        text: Callable[[int, int], str],
    ) -> None:
        """The same for each joint; ``text`` says of a row and a joint what follows its name.

        Args:
            at_fault, excess: (k, joints).
        """
        for joint in np.flatnonzero(at_fault.any(axis=0)).tolist():

            def said(row: int, joint: int = joint) -> str:
                return f"{self.trajectory.joint_names[joint]} {text(row, joint)}"

            self.add_stretches(kind, at_fault[:, joint], excess[:, joint], said, joint)
