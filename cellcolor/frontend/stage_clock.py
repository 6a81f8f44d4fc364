"""The stages of a build as they pass: told, timed, and ended when the time is up."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from cellcolor.deadline import Deadline

Progress = Callable[[str], None]
"""Told the name of each stage as it begins."""


class StageClock:
    """What one build has spent its time on.

    Attributes:
        deadline: when to give up.
        seconds: wall time of each timed stage, in the order in which they first ended; of a stage
            that came several times, the sum.
    """

    def __init__(self, deadline: Deadline, progress: Progress | None) -> None:
        self.deadline, self._progress = deadline, progress
        self.seconds: dict[str, float] = {}

    def begin(self, stage: str) -> None:
        """A stage begins.

        Raises:
            OutOfTime: the deadline has come.
        """
        self.deadline.check()
        if self._progress is not None:
            self._progress(stage)

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """A stage from its beginning to its end; raises like :meth:`begin`."""
        self.begin(stage)
        started = time.perf_counter()
        yield
        self.add({stage: time.perf_counter() - started})

    def add(self, seconds: Mapping[str, float]) -> None:
        """Times that were taken elsewhere, of parts of a stage."""
        for stage, spent in seconds.items():
            self.seconds[stage] = self.seconds.get(stage, 0.0) + spent
