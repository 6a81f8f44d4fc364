"""The laboratory: solvers compared with each other on random instances."""
