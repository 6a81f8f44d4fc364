"""The group that all commands belong to, and the options that several share.

What an option means is said once, where the front door says it: :class:`Command` takes it from
there, so that a command names no more than the keyword and its type.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from cellcolor.cli.terminal import apart_from
from cellcolor.deadline import Deadline
from cellcolor.version import __version__

Decorator = Callable[[Callable[..., int]], Callable[..., int]]

_PACKAGE = Path(__file__).parents[1]
_ENTRY = re.compile(r"^    (\w+(?:, \w+)*): (.*(?:\n        .*)*)", re.MULTILINE)
"""Keywords in a docstring, and what it says of them."""
_MARKUP = re.compile(r":\w+:`~?(?:\w+\.)*(\w+)`|``(.*?)``")


def said_of(place: str) -> dict[str, str]:
    """What is said of each keyword, read without importing its module, which takes long.

    Args:
        place: ``module:name`` of a function or a class in this package.
    """
    module, _, name = place.partition(":")
    source = _PACKAGE.joinpath(*module.split(".")).with_suffix(".py").read_text(encoding="utf-8")
    (own,) = (node for node in ast.parse(source).body if getattr(node, "name", None) == name)
    assert isinstance(own, ast.FunctionDef | ast.ClassDef)
    usual = {
        ast.unparse(node.target): node.value for node in own.body if isinstance(node, ast.AnnAssign)
    }
    if isinstance(own, ast.FunctionDef):
        arguments = (argument.arg for argument in own.args.kwonlyargs)
        usual = dict(zip(arguments, own.args.kw_defaults, strict=True))
    found: dict[str, str] = {}
    for names, text in _ENTRY.findall(ast.get_docstring(own) or ""):
        about = " ".join(text.split()).replace("None for", "without it")
        about = _MARKUP.sub(r"\1\2", about[:1].upper() + about[1:])
        for name in names.split(", "):
            default = getattr(usual.get(name), "value", None)
            found[name] = f"{about}  [default: {default}]" if default else about
    return found


class Command(click.Command):
    """A command of the front door; an option that is not given is no argument of its function.

    What it prints goes to standard error if it writes its output to standard output.

    Args:
        of: functions and classes, as ``module:name``, whose docstrings say what options mean that
            have no text of their own.
    """

    def __init__(self, *given: Any, of: tuple[str, ...] = (), **more: Any) -> None:
        super().__init__(*given, **more)
        options = (own for own in self.params if isinstance(own, click.Option))
        self._keywords = [own for own in options if own.help is None]
        self._of = of

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The same, each with its text."""
        said = {name: text for place in self._of for name, text in said_of(place).items()}
        for own in self._keywords:
            own.help = said[own.name or ""]
        super().format_options(ctx, formatter)

    def invoke(self, ctx: click.Context) -> Any:
        """The same, without the keywords that were left out."""
        for own in self._keywords:
            if ctx.params[own.name or ""] is None:
                del ctx.params[own.name or ""]
        with apart_from(ctx.params.get("output")):
            return super().invoke(ctx)


class Commands(click.Group):
    """Lists every command with its first paragraph in full; click would cut it to one line."""

    command_class = Command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        rows = []
        for name in self.list_commands(ctx):
            paragraph = (self.commands[name].help or "").partition("\n\n")[0]
            rows.append((name, " ".join(paragraph.split())))
        with formatter.section("Commands"):
            formatter.write_dl(rows)


@click.group(name="cellcolor", cls=Commands, invoke_without_command=True)
@click.version_option(__version__, message="%(prog)s %(version)s")
@click.pass_context
def cellcolor(context: click.Context) -> None:
    """The fewest lift-offs of a robot arm over a surface, with a proof."""
    if context.invoked_subcommand is None:
        raise click.UsageError("no command given; see cellcolor --help", context)


class Real(click.FloatRange):
    """A number in a range; click takes NaN for one in any range."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number."""
        number = super().convert(value, param, ctx)
        if math.isnan(number):
            self.fail(f"{value} is not in the range.", param, ctx)
        return number


class Numbers(click.ParamType):  # type: ignore[type-arg]
    """Numbers with commas between; whoever takes them says what they may be.

    Args:
        said: what is said where they are something else.
        count: how many; None for any number of them.
        word: what may be said instead of numbers.
    """

    def __init__(self, said: str, count: int | None = None, word: str | None = None) -> None:
        self.said, self.count, self.word = said, count, word
        self.name = "n,n,…" if count is None else ",".join("n" * count)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """A tuple of numbers, or the word."""
        if isinstance(value, tuple) or value == self.word:
            return value
        try:
            numbers = tuple(map(float, value.split(",")))
        except ValueError:
            numbers = ()
        if len(numbers) != (self.count or len(numbers) or 1):
            self.fail(f"{self.said}, is {value!r}.", param, ctx)
        return numbers


def _input(name: str) -> Path:
    """A file to be read, or a shipped one by its name."""
    from cellcolor.door.installed import find_file

    return find_file(name)


def _place(text: str) -> Any:
    """A place on a surface; the module that reads it is imported where one is given."""
    from cellcolor.questions.places import read_place

    return read_place(text, "--left-alone")


PATH = click.Path(path_type=Path)
INPUT = _input
COUNT = click.IntRange(1)
SHARE = Real(0, 1)
LENGTH = Real(0, min_open=True)
"""m."""


def option(
    name: str, kind: Any, meaning: str | None = None, *, to: str = "", **more: Any
) -> Decorator:
    """An option.

    Args:
        kind: its type; ``bool`` for a flag.
        meaning: None for what the front door says of the keyword.
        to: the command's parameter; "" for that of the name.
        more: as of ``click.option``.
    """
    names = [name, *filter(None, [to])]
    about: dict[str, Any] = {"is_flag": True} if kind is bool else {"type": kind}
    if meaning is None:
        about["default"] = None
    return click.option(*names, help=meaning, **about | more)


def keywords(**kinds: Any) -> Decorator:
    """An option for each of some keywords of the front door, by its type."""

    def add(command: Callable[..., int]) -> Callable[..., int]:
        for name, kind in reversed(kinds.items()):
            command = option(f"--{name.replace('_', '-')}", kind)(command)
        return command

    return add


def output_option(metavar: str, meaning: str, *, to: str = "output", **more: Any) -> Decorator:
    """The option ``-o`` for what the command writes."""
    return click.option("-o", "--output", to, metavar=metavar, type=PATH, help=meaning, **more)


def json_option(printed: str) -> Decorator:
    """The option ``--json``; ``printed`` is its help."""
    return click.option("--json", "as_json", is_flag=True, help=printed)


LEFT_ALONE = option(
    "--left-alone",
    _place,
    "What must not be covered: a box x,y,z,x,y,z (lowest and highest corner, m), a JSON file with "
    "a mask, or a labelled surface, for what it gives up.",
    metavar="PLACE",
)
TOLERANCE = option(
    "--tolerance",
    str,
    "How far a scene's part may stand off, be turned, or both, such as 2mm,0.5deg: colors hold at "
    "a sample of such displacements.",
    metavar="D,A",
)
TIME_LIMIT = option(
    "--time-limit",
    float,
    "Seconds, including reading.  [default: no limit]",
    callback=lambda _context, _option, seconds: Deadline.of(seconds),
)
"""A deadline, which begins as the command does."""
