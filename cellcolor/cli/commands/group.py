"""The group that all commands belong to."""

from __future__ import annotations

import click

from cellcolor.version import __version__


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
