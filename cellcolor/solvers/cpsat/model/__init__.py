"""The CP-SAT models, and what they are made of: dart graphs with strands and seams."""
