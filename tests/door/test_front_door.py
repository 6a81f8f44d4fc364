"""What ``import cellcolor`` offers: the names, lazily, and the same for type checkers."""

from __future__ import annotations

import ast
import json
import pkgutil
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from shipped import TOP

import cellcolor
from cellcolor.door.installed import DISTRIBUTIONS

PACKAGE = Path(cellcolor.__file__).parent


def modules_after(script: str) -> set[str]:
    """What has been imported when a script ends, in a process of its own."""
    report = "\nimport json, sys\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", script + report], capture_output=True, text=True, check=True
    )
    return set(json.loads(done.stdout.splitlines()[-1]))


def test_the_public_names() -> None:
    """Those of the stub; whoever takes one away takes it from others."""
    assert set(cellcolor.__all__) <= set(dir(cellcolor))
    for name in cellcolor.__all__:
        assert getattr(cellcolor, name) is not None


def test_other_names_are_refused() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Nonsense'"):
        _ = cellcolor.Nonsense  # type: ignore[attr-defined]


def test_the_stub_is_read_as_type_checkers_read_it() -> None:
    stub = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    told = {}
    for statement in stub.body:
        assert isinstance(statement, ast.ImportFrom)
        for alias in statement.names:
            assert alias.name == alias.asname
            told[alias.name] = statement.module
    assert told == cellcolor._ROOM_OF
    assert sorted(told) == cellcolor.__all__


def test_importing_it_imports_nothing_else() -> None:
    before = modules_after("")
    new = modules_after("import cellcolor") - before
    assert new == {"cellcolor"}


def test_looking_at_its_names_imports_nothing_else() -> None:
    before = modules_after("")
    script = "import cellcolor\ndir(cellcolor)\nhasattr(cellcolor, 'nothing')\ncellcolor.library()"
    loaded = modules_after(script) - before
    assert not {name.partition(".")[0] for name in loaded} & {"numpy", "pydantic", "ortools"}


def test_no_module_overwrites_a_public_name() -> None:
    """Importing ``cellcolor.X`` makes X an attribute of the package."""
    modules = {module.name for module in pkgutil.iter_modules([str(PACKAGE)])}
    assert not modules & set(cellcolor.__all__)


def test_every_dependency_is_named_with_its_version(capsys: pytest.CaptureFixture[str]) -> None:
    project = tomllib.loads((TOP / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    others = extras.keys() - {"test", "second", "docs"}
    used = [need for name in others for need in extras[name]]
    names = {re.split(r"[<>=\[]", need)[0] for need in [*project["dependencies"], *used]}
    assert names - {"fewest-lift-offs"} == set(DISTRIBUTIONS)
    cellcolor.show_versions()
    said = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert set(said) == {"cellcolor", "python", "system", "processor", *DISTRIBUTIONS}
    assert said["cellcolor"].startswith(cellcolor.__version__)
    assert said["numpy"] == np.__version__
