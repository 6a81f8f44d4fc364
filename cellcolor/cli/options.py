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


class _Positive(click.FloatRange):
    """A positive, finite number of some unit."""

    def __init__(self, units: str) -> None:
        super().__init__(min=0, min_open=True)
        self.units = units

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """The number; NaN is refused."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{value} is not a number of {self.units}.", param, ctx)
        return number


class Price(click.FloatRange):
    """A price in a range; click takes NaN for one in any range."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """The number; NaN is refused."""
        number = float(super().convert(value, param, ctx))
        if math.isnan(number):
            self.fail(f"{value} is not in the range {self.min}<=x<={self.max}.", param, ctx)
        return number


class _Numbers(click.ParamType):  # type: ignore[type-arg]
    """Numbers with commas between.

    Args:
        said: what is said where they are something else.
        count: how many; None for any number of them.
        finite: whether each has to be finite.
        word: what may be said instead of numbers.
    """

    name = "numbers"

    def __init__(
        self, said: str, count: int | None = None, *, finite: bool = False, word: str | None = None
    ) -> None:
        self.said, self.count, self.finite, self.word = said, count, finite, word

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if isinstance(value, tuple) or value == self.word:
            return value
        try:
            numbers = tuple(map(float, value.split(",")))
        except ValueError:
            numbers = ()
        wrong = not numbers if self.count is None else len(numbers) != self.count
        if wrong or (self.finite and not all(map(math.isfinite, numbers))):
            self.fail(f"{self.said}, is {value!r}.", param, ctx)
        return numbers


class _Number(_Numbers):
    """A single finite number."""

    def __init__(self) -> None:
        super().__init__("must be a number", 1, finite=True)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        return super().convert(str(value), param, ctx)[0]


class _Input(click.Path):
    """A file to be read, or the name of a shipped one."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        from cellcolor.door.shipped import find_file

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
SECONDS = _Positive("seconds")
METRES = _Positive("metres")
POINT = _Numbers("a point is three numbers x,y,z", 3, finite=True)
POSE = _Numbers("a place is six numbers x,y,z,roll,pitch,yaw", 6)
SEED = click.option(
    "--seed",
    metavar="N",
    type=click.IntRange(0, 2**31 - 1),
    default=0,
    show_default=True,
    help="Of everything random.",
)
TIME_LIMIT = click.option(
    "--time-limit",
    metavar="S",
    type=SECONDS,
    callback=_deadline,
    help="Seconds, including reading.  [default: no limit]",
)
"""Hands a :class:`~cellcolor.deadline.Deadline` to the command."""
WORKERS = click.option(
    "--workers", metavar="N", type=click.IntRange(1, 1000), help="CP-SAT's search workers."
)


def output_option(
    metavar: str, meaning: str, *, name: str = "output", required: bool = False
) -> Callable[[Command], Command]:
    """The option ``-o`` for what the command writes; ``name`` is that of its parameter."""
    return click.option(
        "-o", "--output", name, metavar=metavar, type=PATH, required=required, help=meaning
    )


def cover_option(meaning: str, **default: Any) -> Callable[[Command], Command]:
    """The option ``--cover`` for a share that has to be covered."""
    return click.option(
        "--cover", metavar="S", type=click.FloatRange(0, 1), help=meaning, **default
    )


_PLACE = (
    "a box x,y,z,x,y,z (lowest and highest corner, m), a JSON file with a mask, or a labelled "
    "surface, for what it gives up."
)
COVER = cover_option(
    "Cover only this share of the area, 0 to 1, with the fewest lift-offs that do."
)
REQUIRED = click.option(
    "--required", metavar="PLACE", callback=_place, help=f"What has to be covered: {_PLACE}"
)
LEFT_ALONE = click.option(
    "--left-alone", metavar="PLACE", callback=_place, help=f"What must not be covered: {_PLACE}"
)
TOLERANCE = click.option(
    "--tolerance",
    metavar="D,A",
    help="How far a scene's part may stand off, be turned, or both, such as 2mm,0.5deg: colors "
    "hold at a sample of such displacements.",
)
UNIT = click.option(
    "--unit",
    type=click.Choice(["m", "mm", "cm", "in"]),
    help="Unit of the coordinates.  [default: guessed from the size]",
)
JOBS: dict[str, Any] = {
    "metavar": "N",
    "type": click.IntRange(min=1),
    "show_default": True,
    "help": "Number of processes at a time.",
}
CLUSTER = click.option(
    "--cluster",
    metavar="ADDRESS",
    help="The scheduler of a Dask cluster that does the work, such as tcp://10.0.0.1:8786, "
    "instead of processes here.",
)


def json_option(printed: str) -> Callable[[Command], Command]:
    """The option ``--json``; ``printed`` is its help."""
    return click.option("--json", "as_json", is_flag=True, help=printed)


def ranges(command: Command) -> Command:
    """An option for each variable of a placement."""
    variables = {"x": "m", "y": "m", "z": "m", "roll": "rad", "pitch": "rad", "yaw": "rad"}
    for name, unit in reversed(variables.items()):
        said = f"Where the part may be put, {name} in {unit}. Values not given stay."
        kind = _Numbers("a range is two numbers LOW,HIGH", 2)
        command = click.option(f"--{name}", metavar="LOW,HIGH", type=kind, help=said)(command)
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
        home = key == "home_rad"
        several = home or key.startswith("joint")
        numbers = _Numbers("must be numbers N,N,…", finite=True, word="free" if home else None)
        command = click.option(
            f"--{key.replace('_', '-')}",
            key,
            metavar="N,N,…" if several else "N",
            type=numbers if several else _Number(),
            help=meaning,
        )(command)
    return command
