"""The commands and their options. What they do is imported only when one of them runs."""

from cellcolor.cli.commands.ask import compare, explain, place, setups, tradeoff
from cellcolor.cli.commands.bench import bench
from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.library import import_, library
from cellcolor.cli.commands.minimum import build, check, show, solve
from cellcolor.cli.commands.motion import cover, paint, plan
from cellcolor.cli.commands.parts import inspect, new, repair
from cellcolor.cli.commands.portable import answer, export

__all__ = [
    "answer",
    "bench",
    "build",
    "cellcolor",
    "check",
    "compare",
    "cover",
    "explain",
    "export",
    "import_",
    "inspect",
    "library",
    "new",
    "paint",
    "place",
    "plan",
    "repair",
    "setups",
    "show",
    "solve",
    "tradeoff",
]
