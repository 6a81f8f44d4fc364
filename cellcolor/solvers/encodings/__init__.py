"""Four ways to write the whole problem for somebody to read (docs/encodings.md).

For CP-SAT, ``pointers`` hangs trees of sub-cells up by pointers, ``ranks`` by numbers, ``contour``
walks round them. ``choco`` has the ranks for another solver. All share what is given
(``problem``). Those for CP-SAT share how they are solved, with two bounds that help, and the first
two what trees of sub-cells have in common (``solving``). They search the space ``paper``, in cells
with one live loop.
"""
