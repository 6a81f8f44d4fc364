"""The kinds of lower bounds: what each says, and what its certificate holds.

The solvers find bounds and the checker verifies them; neither is in here, so that they share the
data and nothing else.
"""
