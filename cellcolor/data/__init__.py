"""The validated values that every stage hands on: surface, instance, solution, plan.

No solver and no robot in here (``docs/formats.md`` describes the files).
"""
