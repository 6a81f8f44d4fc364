"""Runs of solvers on instances: ``sweep`` makes them, ``table`` keeps them, ``summary`` sums up."""
