"""Of all tests: an example that Hypothesis draws may take as long as it does.

Its own limit of 200 ms is one of wall-clock time, which a busy machine fails without a fault. The
default tests draw fewer examples than those of ``pytest --hypothesis-profile=thorough``.
"""

from hypothesis import settings

from examples import DEFAULT, THOROUGH

settings.register_profile("any-machine", deadline=None, max_examples=DEFAULT)
settings.register_profile("thorough", deadline=None, max_examples=THOROUGH)
settings.load_profile("any-machine")
