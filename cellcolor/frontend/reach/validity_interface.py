"""What makes a configuration valid or not: the kinds of ``[[validity_test]]`` in a scene."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

from cellcolor.arrays import Mask
from cellcolor.frontend.reach.postures import Postures
from cellcolor.frontend.registry import Registry
from cellcolor.frontend.tables import Table


class ValidityTest(Table):
    """A test that candidates pass or fail.

    A kind that files can name has a key ``kind`` with its name, and is registered by an entry
    point of the group ``cellcolor.validity_tests``.

    Attributes:
        name: of the reason that a candidate has which fails here first, as ``joint limits``.
    """

    name: ClassVar[str]

    @abstractmethod
    def failed(self, postures: Postures) -> Mask:
        """Which of the postures fail, (k,)."""


VALIDITY_TESTS: Registry[ValidityTest] = Registry(
    "cellcolor.validity_tests",
    ValidityTest,  # type: ignore[type-abstract]
    {},
)
