"""The whole problem as a 0-1 linear model, its file formats, and solvers of such files.

Nothing but the color regions is shared with other solvers. ``docs/models.md`` says what the model
has and why.
"""
