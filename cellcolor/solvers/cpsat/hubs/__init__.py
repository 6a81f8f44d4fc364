"""Divisions of cells with many edges, made from the links that a bound counts (docs/routes.md)."""
