"""Triangle meshes: what follows from them, cut, and points found on them. No robot, no colors."""
