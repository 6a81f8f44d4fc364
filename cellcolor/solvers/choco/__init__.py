"""Choco, a constraint solver with lazy clause generation, on a model of the whole problem.

It searches the space ``paper``, in cells with one live loop. ``model`` has what is given and how it
is written, and ``solver`` runs it.
"""
