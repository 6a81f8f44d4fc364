"""From tool paths to a trajectory: joints over time, lift-offs planned, with a scene."""
