"""The group that all commands belong to, types of options, and the options that several share."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from cellcolor.deadline import NEVER, Deadline
from cellcolor.version import __version__

Command = Callable[..., int]
Decorator = Callable[[Command], Command]


class Commands(click.Group):
    """Lists every command with its first paragraph in full; click would cut it to one line."""

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


class Count(click.IntRange):
    """A whole number in a range."""

    metavar = "N"


class Real(click.FloatRange):
    """A number in a range; click takes NaN for one in any range.

    Args:
        metavar: what stands for it in a help text.
        units: what it counts; without them the range is named where it is refused.
    """

    def __init__(
        self, metavar: str, low: float, high: float | None = None, units: str | None = None
    ) -> None:
        super().__init__(low, high, min_open=units is not None)
        self.metavar, self.units = metavar, units

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """The number; NaN is refused, and infinity where units are counted."""
        number = float(super().convert(value, param, ctx))
        if self.units is not None and not math.isfinite(number):
            self.fail(f"{value} is not a number of {self.units}.", param, ctx)
        if math.isnan(number):
            self.fail(f"{value} is not in the range {self.min}<=x<={self.max}.", param, ctx)
        return number


_MOST_STOPS = 1000


class Numbers(click.ParamType):  # type: ignore[type-arg]
    """Numbers with commas between; whoever takes them says what they may be.

    Args:
        said: what is said where they are something else.
        count: how many; None for any number of them.
        word: what may be said instead of numbers.
    """

    name = "numbers"

    def __init__(self, said: str, count: int | None = None, word: str | None = None) -> None:
        self.said, self.count, self.word = said, count, word

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


class Stops(click.ParamType):  # type: ignore[type-arg]
    """A joint and where it may stand: its name, and evenly spaced positions up to the last."""

    name = "stops"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Split at the sign of equality and the colons."""
        if isinstance(value, tuple):
            return value
        joint, _, spaced = value.partition("=")
        try:
            low, high, step = map(float, spaced.split(":"))
            count = (high - low) / step
        except (ValueError, ZeroDivisionError):
            count = -1.0
        if not joint or not 0 <= count <= _MOST_STOPS:
            asked = (
                f"stops are JOINT=FROM:TO:STEP, at most {_MOST_STOPS}, as in rail_joint=0:2:0.25"
            )
            self.fail(f"{asked}, is {value!r}.", param, ctx)
        return joint, tuple(low + step * number for number in range(int(count + 1e-9) + 1))


class _Input(click.Path):
    """A file to be read, or the name of a shipped one."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        from cellcolor.door.installed import find_file

        return find_file(str(super().convert(value, param, ctx)))


def _place(_context: click.Context, option: click.Parameter, value: str | None) -> Any:
    """A place on a surface; the module that reads it is imported where one is given."""
    if value is None:
        return None
    from cellcolor.questions.places import read_place

    return read_place(value, option.opts[0])


def _deadline(_context: click.Context, _option: click.Parameter, value: float | None) -> Deadline:
    return NEVER if value is None else Deadline.after(value)


def one_of(known: Callable[[], Any]) -> Callable[[click.Context, click.Parameter, str], str]:
    """A callback that refuses a name that nobody has registered; nothing is imported for that."""

    def check(_context: click.Context, _option: click.Parameter, value: str) -> str:
        if value not in known():
            raise click.BadParameter(f"{value!r} is not one of {', '.join(known())}.")
        return value

    return check


PATH = click.Path(path_type=Path)
INPUT = _Input()
SECONDS = Real("S", 0, units="seconds")
METRES = Real("M", 0, units="metres")
SHARE = Real("S", 0, 1)


def option(
    name: str, kind: Any, meaning: str, *, to: str = "", default: Any = None, **more: Any
) -> Decorator:
    """An option with a value.

    Args:
        kind: its type, which may have a metavar.
        to: the command's parameter; "" for that of the name.
        default: told in the help text; without one the parameter is None.
        more: as of ``click.option``.
    """
    names = [name, *filter(None, [to])]
    about: dict[str, Any] = {
        "metavar": getattr(kind, "metavar", None),
        "show_default": default is not None,
    } | more
    return click.option(*names, type=kind, default=default, help=meaning, **about)


def output_option(metavar: str, meaning: str, *, to: str = "output", **more: Any) -> Decorator:
    """The option ``-o`` for what the command writes."""
    return click.option("-o", "--output", to, metavar=metavar, type=PATH, help=meaning, **more)


def json_option(printed: str) -> Decorator:
    """The option ``--json``; ``printed`` is its help."""
    return click.option("--json", "as_json", is_flag=True, help=printed)


_PLACE = (
    "a box x,y,z,x,y,z (lowest and highest corner, m), a JSON file with a mask, or a labelled "
    "surface, for what it gives up."
)
_SHARED = {
    "cover": option(
        "--cover",
        SHARE,
        "Cover only this share of the area, 0 to 1, with the fewest lift-offs that do.",
    ),
    "left_alone": option(
        "--left-alone",
        None,
        f"What must not be covered: {_PLACE}",
        metavar="PLACE",
        callback=_place,
    ),
    "tolerance": option(
        "--tolerance",
        None,
        "How far a scene's part may stand off, be turned, or both, such as 2mm,0.5deg: colors hold "
        "at a sample of such displacements.",
        metavar="D,A",
    ),
    "unit": option(
        "--unit",
        click.Choice(["m", "mm", "cm", "in"]),
        "Unit of the coordinates.  [default: guessed from the size]",
    ),
    "time_limit": option(
        "--time-limit",
        SECONDS,
        "Seconds, including reading.  [default: no limit]",
        callback=_deadline,
    ),
    "workers": option("--workers", Count(1, 1000), "CP-SAT's search workers."),
    "seed": option("--seed", Count(0, 2**31 - 1), "Of everything random.", default=0),
    "jobs": option("--jobs", Count(1), "Number of processes at a time.", default=1),
    "search_space": option(
        "--search-space",
        click.Choice(["paper", "surface"]),
        "paper: no more than one corridor across an edge. surface: several.",
        default="paper",
    ),
}
"""Options by the keywords of the front door's functions; ``time_limit`` is a ``Deadline``."""


def shared(*names: str) -> Decorator:
    """Some of the options that several commands have."""

    def add(command: Command) -> Command:
        for name in reversed(names):
            command = _SHARED[name](command)
        return command

    return add


def ranges(command: Command) -> Command:
    """An option for each variable of a placement."""
    kind = Numbers("a range is two numbers LOW,HIGH", 2)
    variables = {"x": "m", "y": "m", "z": "m", "roll": "rad", "pitch": "rad", "yaw": "rad"}
    for name, unit in reversed(variables.items()):
        said = f"Where the part may be put, {name} in {unit}. Values not given stay."
        command = option(f"--{name}", kind, said, metavar="LOW,HIGH")(command)
    return command


_MOTION = {
    "tool_radius_m": "Of the tool's footprint, m.",
    "spacing_m": "Between neighboring passes, m.",
    "overlap_m": "Of neighboring segments, m; none without.",
    "speed_m_per_s": "Of the tool on the surface, m/s; slower where joints limit it.",
    "lead_m": "Straight on before and after each stroke, of a tool that stands off, m.",
    "approach_speed_m_per_s": "Of the tool within 10 mm of contact, m/s; as in contact without.",
    "transfer_speed_m_per_s": "Of the tool between strokes at most, m/s.",
    "even_feed": "Slow each stroke down as a whole to a feed that it can keep.",
    "least_feed": "A fault below this share of the speed, 0 to 1; none without.",
    "joint_velocities_rad_per_s": "Lower limits than the URDF's, rad/s (m/s for sliding joints).",
    "joint_accelerations_rad_per_s2": "A URDF has none; rad/s² (m/s² for sliding joints).",
    "joint_jerks_rad_per_s3": "Judged, not planned; rad/s³ (m/s³ for sliding joints).",
    "retract_m": "Along the normal, before a move to another stroke, m.",
    "clearance_m": "Distance from everything between strokes, m.",
    "home_rad": "Where the arm begins and ends, rad (m for sliding joints), or free.",
}
"""Keys of a setup's table ``[motion]``. The setup says what may be left out, and checks numbers."""


def motion_options(command: Command) -> Command:
    """An option for each key of a setup's table ``[motion]``; those left out are None."""
    for key, meaning in reversed(_MOTION.items()):
        if key == "even_feed":
            flag = click.option("--even-feed", is_flag=True, default=None, help=meaning)
            command = flag(command)
            continue
        kind: Any = click.FLOAT
        metavar = "N"
        if key == "home_rad" or key.startswith("joint"):
            word = "free" if key == "home_rad" else None
            kind, metavar = Numbers("must be numbers N,N,…", word=word), "N,N,…"
        name = f"--{key.replace('_', '-')}"
        command = option(name, kind, meaning, to=key, metavar=metavar)(command)
    return command
