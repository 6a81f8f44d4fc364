"""Four ways to write the whole problem for somebody to read, a file each (docs/encodings.md).

For CP-SAT, ``pointers`` hangs trees of sub-cells up by pointers, ``ranks`` by numbers, ``contour``
walks round them. ``choco`` has the ranks for another solver. Each file has all that is its own, and
shares with the others what is no formulation: what is given (``problem``), and for CP-SAT how it is
solved, with two bounds that help (``solving``). They search the space ``paper``, in cells with one
live loop.
"""
