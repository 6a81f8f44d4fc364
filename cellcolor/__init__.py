"""cellcolor: the fewest lift-offs of a robot arm over a surface, with a proof.

The problem is that of Yang, Valls Miro, Lai, Wang and Xiong, "Cellular Decomposition for
Non-repetitive Coverage Task with Minimum Discontinuities" (2020). Terms are the paper's::

    import cellcolor

    result = cellcolor.solve("wok", time_limit=60)  # a scene, a surface, an instance
    print(result)
    result.plot("wok.html")

What is public is in ``__all__`` and imported when it is first used (PEP 562): whoever imports the
package waits for no library. ``__init__.pyi`` says the same to type checkers and editors.
"""

from cellcolor.version import __version__

_ROOMS = {
    "cellcolor.data.bounds": ("Bound",),
    "cellcolor.data.cells_and_edges": ("OUTSIDE", "Cell", "Edge"),
    "cellcolor.data.coverage": ("Coverage",),
    "cellcolor.data.instance": ("Instance",),
    "cellcolor.data.joint_plan": ("ContactPath", "JointPlan"),
    "cellcolor.data.objective": ("Objective",),
    "cellcolor.data.plan": ("Plan",),
    "cellcolor.data.solution": ("CellDivision", "Solution", "SubCell"),
    "cellcolor.data.surface": ("Crack", "LabelledSurface"),
    "cellcolor.data.tool_paths": ("ToolPath", "ToolPaths"),
    "cellcolor.data.trajectory": ("Trajectory",),
    "cellcolor.data.trajectory_verdict": ("Fault", "TrajectoryVerdict"),
    "cellcolor.deadline": ("Deadline", "OutOfTime"),
    "cellcolor.door.asking": ("explain", "tradeoff"),
    "cellcolor.door.comparing": ("ComparedArm", "Comparison", "compare"),
    "cellcolor.door.drawing": ("Drawing", "show"),
    "cellcolor.door.extras": ("show_versions",),
    "cellcolor.door.judging": ("check", "judge", "proven_range"),
    "cellcolor.door.oracle": ("Oracle",),
    "cellcolor.door.painting": ("cover", "paint"),
    "cellcolor.door.parts": ("inspect", "repair"),
    "cellcolor.door.placing": ("place",),
    "cellcolor.door.planned": ("PlanOutOfTime", "PlannedScene"),
    "cellcolor.door.planning": ("plan",),
    "cellcolor.door.reading": ("read",),
    "cellcolor.door.result": ("Result",),
    "cellcolor.door.setting_up": ("ChosenSetUps", "setups"),
    "cellcolor.door.shipped": ("library",),
    "cellcolor.door.solving": ("build", "decompose", "solve"),
    "cellcolor.door.starting": ("Started", "new"),
    "cellcolor.errors": ("CellcolorError", "ContradictionError", "InputError", "TooLarge"),
    "cellcolor.oracle": ("PathVerdict", "ProvenRange", "Verdict"),
    "cellcolor.painting.paint": ("Painted",),
    "cellcolor.questions.explanation": ("BranchHere", "Explanation", "RelaxedMinimum"),
    "cellcolor.questions.front": ("Front", "FrontPoint"),
    "cellcolor.questions.placements": ("Leeway", "PlacedMinimum", "PlacementMap", "Placements"),
    "cellcolor.questions.places": ("WorldBox",),
    "cellcolor.questions.refinement": ("RefinedStep", "Refinement"),
    "cellcolor.questions.set_ups": ("SetUp", "SetUpPlan"),
    "cellcolor.tool_paths.cover": ("Covered",),
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names}

__all__ = [
    "OUTSIDE",
    "Bound",
    "BranchHere",
    "Cell",
    "CellDivision",
    "CellcolorError",
    "ChosenSetUps",
    "ComparedArm",
    "Comparison",
    "ContactPath",
    "ContradictionError",
    "Coverage",
    "Covered",
    "Crack",
    "Deadline",
    "Drawing",
    "Edge",
    "Explanation",
    "Fault",
    "Front",
    "FrontPoint",
    "InputError",
    "Instance",
    "JointPlan",
    "LabelledSurface",
    "Leeway",
    "Objective",
    "Oracle",
    "OutOfTime",
    "Painted",
    "PathVerdict",
    "PlacedMinimum",
    "PlacementMap",
    "Placements",
    "Plan",
    "PlanOutOfTime",
    "PlannedScene",
    "ProvenRange",
    "RefinedStep",
    "Refinement",
    "RelaxedMinimum",
    "Result",
    "SetUp",
    "SetUpPlan",
    "Solution",
    "Started",
    "SubCell",
    "TooLarge",
    "ToolPath",
    "ToolPaths",
    "Trajectory",
    "TrajectoryVerdict",
    "Verdict",
    "WorldBox",
    "__version__",
    "build",
    "check",
    "compare",
    "cover",
    "decompose",
    "explain",
    "inspect",
    "judge",
    "library",
    "new",
    "paint",
    "place",
    "plan",
    "proven_range",
    "read",
    "repair",
    "setups",
    "show",
    "show_versions",
    "solve",
    "tradeoff",
]


def __getattr__(name: str) -> object:
    if name not in _ROOM_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(_ROOM_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
