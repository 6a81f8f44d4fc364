"""From a painting to tool paths: each segment covered without lifting, by named patterns."""
