"""For the test suites of other planners: a pytest plugin, and Hypothesis strategies."""
