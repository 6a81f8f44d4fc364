"""Runs of solvers on instances, and what follows from them.

``sweep`` makes the runs of a whole plan, ``table`` is the file that they are kept in, a ``row``
each, and ``summary`` sums them up.
"""
