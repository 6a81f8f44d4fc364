"""The codes of the standard tests by name, as ``Reason.JOINT_LIMITS``."""

from __future__ import annotations

from enum import IntEnum

from cellcolor.frontend.reach.validity_tests import STANDARD_TESTS


class _Named(IntEnum):
    @property
    def text(self) -> str:
        """The name as reports have it."""
        return self.name.lower().replace("_", " ")


_NAMES = ("valid", "no solution", *(test.name for test in STANDARD_TESTS))
Reason = _Named("Reason", {name.upper().replace(" ", "_"): k for k, name in enumerate(_NAMES)})
