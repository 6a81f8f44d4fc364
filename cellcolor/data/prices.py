"""How high a price may be, for what adds prices and for the command line.

Prices are added in floating point, which has 53 bits. Up to these limits a sum of prices is right
to far less than a thousandth of a lift-off or of a square centimeter. Far above them a segment more
would not change the sum.
"""

from __future__ import annotations

MOST_PRICE = 1_000_000
"""Of a segment, a change-over, or all that is left uncovered, in lift-offs."""

MOST_CM2 = 1_000_000_000
"""Of a lift-off, in square centimeters."""
