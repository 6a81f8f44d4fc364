"""Divisions without a model of the whole: segments are planned, then routed."""
