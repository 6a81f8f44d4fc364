"""Which configurations are valid at each vertex, and which lead into each other."""
