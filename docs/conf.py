"""How Sphinx makes the site: ``sphinx-build -W -n docs OUT`` (``.ci/run`` does)."""

from __future__ import annotations

import sys
from pathlib import Path
from pkgutil import walk_packages
from typing import Any

from sphinx.application import Sphinx
from sphinx.ext.napoleon import Config, GoogleDocstring

sys.path.append(str(Path(__file__).parent))

import library_table
import reports
from front_door import front_door

import cellcolor
from cellcolor import __version__

project = "cellcolor"
author = "the cellcolor authors"
project_copyright = "the cellcolor authors, MIT licence"
release = version = __version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
]
exclude_patterns = ["_build"]

# Markdown: every heading can be linked to as on GitHub, and a link to nothing is a warning.
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath", "amsmath"]  # formulas, as GitHub renders them too

# The code of the tutorials is run in each build; an error in it ends the build. With
# ``-D nb_execution_mode=off`` nothing is run or planned, which takes less than half of the time.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 180  # of a cell; one plans a motion
nb_merge_streams = True

# The reference is made of the docstrings of every module that there is (_write_reference).
autodoc_default_options = {"members": True, "ignore-module-all": True}
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_use_type_comments = False  # there are none, and looking for them takes a while
python_use_unqualified_type_names = True
toc_object_entries = False  # hundreds of functions in the table of contents of every page
maximum_signature_line_length = 88

nitpicky = True
# Names of other packages: no inventory of theirs is fetched while the site is built.
_OTHERS = "annotated_types click coal fcl matplotlib mpl_toolkits networkx numpy ortools pinocchio"
_OTHERS += " pydantic pydantic_core rich scipy trimesh np nx pin hypothesis pytest _pytest"
nitpick_ignore_regex = [
    (r"py:attr", r"cellcolor\..*|\w+\.\w+"),  # they stand in the lists of their classes
    (r"py:.*", rf"({'|'.join([*_OTHERS.split(), *sys.stdlib_module_names])})(\..*)?"),
    # Type variables, names for type checkers only, what annotated_types says of numbers, and
    # halves of a signature that Sphinx cannot read because of a dataclass's default factory.
    (
        r"py:class",
        r"(.*\.)?(T|Kind|_\w+|FieldInfo|TypeForm|ConfigDict|NoneType|Handler|DataclassInstance)",
    ),
    (r"py:class", r"Outside|CoverChoice"),  # literals
    (
        r"py:class",
        r"Ge|Gt|Le|Lt|MinLen|[\d.e-]+|dict\[(str|int)|(Mapping|tuple)\[str|lambda|tuple\[~pathlib\.Path|list\[list\[tuple\[int",
    ),
    # Signatures of the front door that Sphinx takes as they are written: they name classes that
    # only type checkers import there.
    (
        r"py:class",
        r"Path(Like)?(\[str\])?|NDArray|Array|Index|Mask|Telling|Scene|BuildResult|SearchSpace|Count"
        r"|cellcolor\.Drawing|cp_model\.\w+",
    ),
]

html_theme = "furo"
html_title = f"cellcolor {version}"
html_show_sphinx = False
html_copy_source = False
html_extra_path = ["_reports"]  # beside the front page (_write_reports)
reports.FOLDER.mkdir(exist_ok=True)


class _Docstring(GoogleDocstring):
    """Google's style, with attributes as a list: ``width, height: in m`` is one entry for two."""

    def _parse_attributes_section(self, section: str) -> list[str]:  # noqa: ARG002
        return self._format_fields("Attributes", self._consume_fields())


def _read_docstring(
    app: Sphinx, what: str, name: str, value: Any, options: Any, lines: list[str]
) -> None:
    """Turn a docstring into reStructuredText, but leave the one of a plain value as it is.

    Napoleon would take what stands before the colon in such a docstring for the value's type.
    """
    if what not in ("attribute", "data", "property"):
        lines[:] = _Docstring(lines, Config(), app, what, name, value, options).lines()


def _write_reference(_app: Sphinx) -> None:
    """Write the list of the front door, and a page for each room with all of its modules."""
    folder = Path(__file__).parent / "_api"
    folder.mkdir(exist_ok=True)
    (folder / "front_door.txt").write_text(front_door())
    pages: dict[str, list[str]] = {}
    for module in walk_packages(cellcolor.__path__, "cellcolor."):
        room = module.name.split(".")[1]
        if room != "__main__":  # importing it runs the command
            pages.setdefault(room, []).append(module.name)
    for old in {path.stem for path in folder.glob("*.rst")} - pages.keys():
        (folder / f"{old}.rst").unlink()
    for room, modules in pages.items():
        title = f"cellcolor.{room}"
        lines = [title, "=" * len(title), ""]
        for name in modules:
            if name != title:
                lines += ["", name.removeprefix(f"{title}."), "-" * len(name), ""]
            lines.append(f".. automodule:: {name}")
        text = "\n".join(lines) + "\n"
        page = folder / f"{room}.rst"
        if not page.exists() or page.read_text() != text:  # Sphinx rereads newer files
            page.write_text(text)


def _write_library(_app: Sphinx) -> None:
    """Write the table that ``library.md`` includes, with the pictures in it."""
    library_table.write_table(library_table.LIBRARY, library_table.FOLDER)


def _write_reports(app: Sphinx) -> None:
    """Plan the pages that the front page embeds and its gallery leads to."""
    if app.builder.name == "html" and app.config.nb_execution_mode != "off":
        reports.write_reports(reports.FOLDER)


def setup(app: Sphinx) -> None:
    """Tell Sphinx of the docstrings' style, and of what is written before the pages are read."""
    app.connect("builder-inited", _write_reference)
    app.connect("builder-inited", _write_library)
    app.connect("builder-inited", _write_reports)
    app.connect("autodoc-process-docstring", _read_docstring)
