"""Runs of solvers on instances, and what follows from them.

``once`` solves one instance, ``sweep`` makes the runs of a whole plan, ``table`` is the file that
they are kept in, a ``row`` each. ``agreement`` looks for contradictions, ``statistics`` counts and
``summary`` writes that down. ``timings`` measures what is no solver.
"""
