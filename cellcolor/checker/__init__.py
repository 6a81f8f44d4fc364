"""The checker: independent of every solver, the only judge of what leaves the program."""
