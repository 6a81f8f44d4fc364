"""One moment at which everything that takes time has to end."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from numbers import Real
from typing import TypeAlias, TypeVar

from cellcolor.errors import CellcolorError, InputError

_Item = TypeVar("_Item")


class OutOfTime(CellcolorError):
    """The deadline came before the work was done. Whatever takes a deadline may raise this."""


@dataclass(frozen=True, slots=True)
class Deadline:
    """A moment, made once where a task begins and handed down to all that works for it.

    Attributes:
        moment: on the clock of ``time.monotonic``, in seconds; infinity if there is none.
    """

    moment: float = math.inf

    @classmethod
    def after(cls, seconds: float | None) -> Deadline:
        """The moment some seconds from now; None for no deadline."""
        return NEVER if seconds is None else cls(time.monotonic() + seconds)

    @classmethod
    def of(cls, time_limit: TimeLimit) -> Deadline:
        """The moment that a public function has to end at.

        Args:
            time_limit: seconds from now, None for no deadline; or a deadline that there is already,
                whose moment may have passed.

        Raises:
            InputError: it is no positive number of seconds.
        """
        if time_limit is None:
            return NEVER
        if isinstance(time_limit, Deadline):
            return time_limit
        number = isinstance(time_limit, Real) and not isinstance(time_limit, bool)
        if not number or not 0 < time_limit < math.inf:
            message = f"must be a positive number of seconds or None, is {time_limit!r}"
            raise InputError(None, "time_limit", message)
        return cls.after(float(time_limit))

    @property
    def left(self) -> float:
        """Seconds until then, 0 afterwards, infinity if there is no deadline."""
        return max(0.0, self.moment - time.monotonic())

    @property
    def over(self) -> bool:
        """Whether the moment has passed."""
        return time.monotonic() >= self.moment

    def check(self) -> None:
        """End the work if the moment has passed.

        Raises:
            OutOfTime: it has.
        """
        if self.over:
            raise OutOfTime("the time limit came first")

    def watch(self, items: Iterable[_Item]) -> Iterator[_Item]:
        """The same items, for a loop over many that takes microseconds for each.

        Raises:
            OutOfTime: the moment has passed; asked before every thousandth item.
        """
        for number, item in enumerate(items):
            if number % 1000 == 0:
                self.check()
            yield item

    def earlier(self, seconds: float) -> Deadline:
        """An earlier deadline, to leave seconds for what has to be done after the work."""
        return Deadline(self.moment - seconds)

    def share(self, part: float) -> Deadline:
        """A deadline after a part (0 to 1) of the time that is left; none if there is none."""
        if math.isinf(self.moment):
            return self
        return Deadline(time.monotonic() + part * self.left)


NEVER = Deadline()
"""No deadline."""

TimeLimit: TypeAlias = float | Deadline | None
"""Seconds, a deadline, or None for no limit."""
