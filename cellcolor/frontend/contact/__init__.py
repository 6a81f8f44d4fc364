"""What the arm and its tool may hit: itself, the object, obstacles, the ground."""
