"""From tool paths to a trajectory for a scene: joints over time, with planned lift-offs."""
