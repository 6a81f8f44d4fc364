"""How high a price may be, for what adds prices and for the command line; and shares.

Prices are added in floating point, which has 53 bits. Up to this limit a sum of prices is right to
far less than a thousandth of a lift-off. Far above it a segment more would not change the sum.
"""

from __future__ import annotations

from cellcolor.errors import InputError

MOST_PRICE = 1_000_000
"""Of a change-over, in lift-offs."""

_BINARY = 1e-6
"""How far 1000 times a price with three decimals may be from a whole number, in floating point."""


def check_share(name: str, share: float | None) -> None:
    """Refuse a share that is not from 0 to 1; None is none.

    Raises:
        InputError: it is not.
    """
    if share is not None and not 0 <= share <= 1:
        raise InputError(None, name, f"must be from 0 to 1, is {share:g}")


def check_change_over(price: float) -> None:
    """Refuse what a change-over cannot cost: less than the lift-off that it takes, for example.

    Raises:
        InputError: it is out of its range, or finer than a thousandth of a lift-off.
    """
    if not 1 <= price <= MOST_PRICE:
        message = f"must be a number from 1 to {MOST_PRICE}, is {price:g}"
        raise InputError(None, "change_over", message)
    if abs(1000 * price - round(1000 * price)) > _BINARY:
        message = f"must have no more than three decimals, is {price}"
        raise InputError(None, "change_over", message)
