"""Divisions of cells with many edges, made of the links that a bound counts (docs/routes.md)."""
