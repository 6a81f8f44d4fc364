"""The surface to be covered: simple shapes and mesh files."""
