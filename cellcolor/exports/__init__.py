"""What other programs read: joints as CSV, tool paths as YAML, painted meshes."""
