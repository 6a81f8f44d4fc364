"""How high a price may be, for what adds prices and for the command line.

Prices are added in floating point, which has 53 bits. Up to these limits a sum of prices is right
to far less than a thousandth of a lift-off or of a square centimeter. Far above them a segment more
would not change the sum.
"""

from __future__ import annotations

from cellcolor.errors import InputError

MOST_PRICE = 1_000_000
"""Of a change-over, or of all that is left uncovered, in lift-offs."""

MOST_CM2 = 1_000_000_000
"""Of a lift-off, in square centimeters."""

_BINARY = 1e-6
"""How far 1000 times a price with three decimals may be from a whole number, in floating point."""


def check_price(name: str, price: float, least: int = 0, most: int = MOST_PRICE) -> None:
    """Refuse a price that is no number or out of its range.

    Raises:
        InputError: it is; names the price and the range.
    """
    if not least <= price <= most:
        raise InputError(None, name, f"must be a number from {least} to {most}, is {price:g}")


def check_change_over(price: float) -> None:
    """Refuse what a change-over cannot cost: less than the lift-off that it takes, for example.

    Raises:
        InputError: it is out of its range, or finer than a thousandth of a lift-off.
    """
    check_price("change_over", price, 1)
    if abs(1000 * price - round(1000 * price)) > _BINARY:
        message = f"must have no more than three decimals, is {price}"
        raise InputError(None, "change_over", message)
