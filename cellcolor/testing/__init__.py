"""For the test suites of other planners: a pytest plugin, and Hypothesis strategies."""

PICTURES = "cellcolor_pictures"
"""Attribute of a failed assertion: what draws its pictures, given the name of the test."""
