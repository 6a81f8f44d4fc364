"""The whole problem as a 0-1 linear model, its file formats, and solvers of such files.

Only the color regions are shared with other solvers. ``docs/models.md`` says what the model has and why.
"""
