"""The fewest cutting paths among the divisions with the fewest segments."""
