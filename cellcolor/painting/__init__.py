"""From a solution to a painting: a labelled surface, refined where it must be, and a plan on it."""
