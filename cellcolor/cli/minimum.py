"""The minimum: ``build``, ``solve``, ``check`` and ``show``."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    COUNT,
    INPUT,
    LEFT_ALONE,
    PATH,
    SHARE,
    TOLERANCE,
    cellcolor,
    json_option,
    keywords,
    option,
    output_option,
)
from cellcolor.cli.terminal import at_work, complain, say, say_lines
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError
from cellcolor.files.writing import (
    SIDE_FILE,
    Output,
    check_output,
    is_stream,
    kind_of_format,
    write,
)
from cellcolor.pictures.registry import PICTURES
from cellcolor.solvers.registry import DEFAULT, OWN_NAMES, PAPERS, REFERENCE

_SCHEMES = 1000  # that are listed unless --limit says otherwise


@cellcolor.command()
@click.argument("source", metavar="SCENE.toml|SURFACE.json", type=INPUT)
@output_option("INSTANCE.json", "The instance; other files are named after it.", required=True)
def build(source: Path, output: Path) -> Exit:
    """Make the topological graph of a robot scene or of a labelled surface.

    For a scene the labelled surface is written as well, beside the instance.
    """
    from cellcolor.cli.inputs import open_file
    from cellcolor.cli.tables import nothing_to_cover
    from cellcolor.data.instance import Instance
    from cellcolor.data.surface import LabelledSurface
    from cellcolor.door.subject import is_scene

    check_output(output, kind_of_format(Instance.FORMAT), [source])
    if is_scene(output):
        message = "must not end in .toml: the other commands would take it for a scene"
        raise InputError(str(output), None, message)
    alone = is_stream(output)  # nothing lies beside a pipe, and nothing can be named from there
    stem = output.name.removesuffix(".json")
    surface_path = output.with_name(f"{stem}.surface.json")
    side_path = output.with_name(f"{stem}.reasons.npz")
    if is_scene(source) and not alone:
        check_output(surface_path, kind_of_format(LabelledSurface.FORMAT), [source])
        check_output(side_path, SIDE_FILE, [source])
    subject = open_file(source)
    if subject.given_instance is not None:
        raise InputError(str(source), "format", "is an instance already")
    beside: list[Output] = []
    instance = subject.graph()
    reference = os.path.relpath(source.resolve(), output.parent.resolve())
    if (built := subject.built) is not None:
        side = {"side_file": side_path.name}
        surface = replace(built.surface, meta=built.surface.meta | side)
        instance, reference = replace(instance, meta=surface.meta), surface_path.name
        beside = [Output(side_path, SIDE_FILE, [built.candidates.to_bytes()])]
        beside += [Output.of(surface_path, surface)]
    named = None
    if instance.surface is not None and not alone:
        named = replace(instance.surface, path=PurePath(reference).as_posix())
    instance, beside = replace(instance, surface=named), [] if alone else beside
    # The instance last: it carries the fingerprint of its surface.
    write([*beside, Output.of(output, instance)], [source])
    if built is not None:
        say_lines(built.report)
    for file in beside:
        say(f"wrote {file.path}")
    say(f"wrote {output}: {instance.size}")
    if instance.nothing_to_cover:
        complain(f"{source}: {nothing_to_cover(instance)}")
        return Exit.STOPPED
    return Exit.DONE


@cellcolor.command(of=("door.solving:solve", "door.asked:SearchOfAPart", "door.asked:Search"))
@click.argument("files", metavar="FILE…", nargs=-1, required=True, type=INPUT)
@output_option("OUT", "A file for one input, a folder for several.")
@option(
    "--solver",
    str,
    f"{', '.join(OWN_NAMES)}, or what another package registers. {PAPERS} is the paper's "
    f"depth-first search, for small instances, and {REFERENCE} the same search with a bound.",
    default=DEFAULT,
    show_default=True,
)
@keywords(search_space=click.Choice(["paper", "surface"]), strands=COUNT, cover=SHARE)
@LEFT_ALONE
@TOLERANCE
@option("--all", bool, "List all optimal schemes.", to="every")
@option("--limit", COUNT, "With --all, stop after this many schemes.  [default: 1000]")
@option("--time-limit", float, "Seconds for each file.", to="seconds")
@keywords(workers=COUNT, seed=int)
@json_option("Print JSON Lines, one solution per file.")
def solve(files: tuple[Path, ...], every: bool, limit: int | None, **given: Any) -> Exit:
    """Find the fewest segments of instances, labelled surfaces and scenes.

    FILE may be the name of a shipped one, such as wok: a file of that name goes first. That holds
    for the other commands as well; the command library lists the names.
    """
    first = Deadline.of(given["seconds"])
    if limit is not None and not every:
        raise click.UsageError("--limit needs --all")

    from cellcolor.cli.solving import solve_files

    return solve_files(files, schemes=(limit or _SCHEMES) if every else None, first=first, **given)


@cellcolor.command()
@click.argument("subject", metavar="FILE", type=click.Path())
@click.argument("claim", metavar="SOLUTION.json|PLAN.json|TRAJECTORY", type=click.Path())
@option(
    "--time-limit",
    float,
    "Seconds, including reading, for a trajectory, or for the proven range that a plan is compared "
    "with.",
    to="seconds",
    default=60.0,
    show_default=True,
)
@LEFT_ALONE
@TOLERANCE
@option(
    "--cache",
    PATH,
    "For a plan: keep the proven range there, so that the next plan on the same surface needs no "
    "proof.",
    metavar="FOLDER",
)
@option(
    "--require-optimal", bool, "For a plan: exit code 1 if it can be beaten, 3 if that is open."
)
@json_option("One JSON object.")
def check(seconds: float, **given: Any) -> Exit:
    """Check a solution, a plan on a labelled surface, or a trajectory for a scene.

    FILE is what was solved, an instance, a labelled surface or a scene; for a plan it leads to a
    surface, for a trajectory (.json or .csv) it is the scene. One of the two may be -, for standard
    input.
    """
    deadline = Deadline.of(seconds)
    if given["subject"] == given["claim"] == "-":
        raise click.UsageError("only one of the two can be standard input (-)")

    from cellcolor.cli.checking import Request, check_files

    return check_files(Request(seconds=seconds, deadline=deadline, **given))


@cellcolor.command(of=("door.drawing:show",))
@click.argument("file", metavar="FILE", type=INPUT)
@click.argument("claim", metavar="[SOLUTION.json|PLAN.json]", required=False, type=INPUT)
@output_option("OUT.(html|png|svg)", "The picture; the ending gives its format.", required=True)
@keywords(view=click.Choice(list(PICTURES)), color=str, vertex=int, branch=str)
def show(file: Path, claim: Path | None, output: Path, **of: Any) -> Exit:
    """Draw an instance, a labelled surface or a scene, by cell unless an option says otherwise.

    With a solution after what was solved, or a plan on its surface: by segment.
    """
    from cellcolor.cli.inputs import open_file
    from cellcolor.data.plan import Plan
    from cellcolor.door.drawing import kind_of_picture
    from cellcolor.door.drawing import show as drawing_of
    from cellcolor.door.reading import format_of_claim

    check_output(output, kind_of_picture(output), [file, *filter(None, [claim])])
    if claim is not None:
        of["plan" if format_of_claim(claim) == Plan.FORMAT else "solution"] = claim
    subject = open_file(file)
    with at_work(file, "drawing"):
        drawing = drawing_of(subject, **of)
    drawing.save(output)
    say(f"wrote {output}: {drawing}")
    return Exit.DONE
