"""The validated values that stages exchange: surface, instance, solution, plan.

This package contains no solver and no robot (``docs/formats.md`` describes the files).
"""
