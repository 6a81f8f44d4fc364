"""Solvers that MiniZinc knows, on the model ``models/constraints/coloring.mzn``.

Nothing is shared with the other solvers. ``docs/models.md`` says what the model has and why.
"""
