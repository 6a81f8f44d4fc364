"""Whether a trajectory does what it claims, independent of whatever made it."""
