"""``cellcolor.show_versions`` names all that the package can need."""

from __future__ import annotations

import re
import tomllib

import numpy as np
import pytest
from shipped import TOP

import cellcolor
from cellcolor.door.extras import DISTRIBUTIONS


def test_every_dependency_is_named_with_its_version(capsys: pytest.CaptureFixture[str]) -> None:
    project = tomllib.loads((TOP / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    used = [need for name in extras if name not in ("test", "docs") for need in extras[name]]
    names = {re.split(r"[<>=\[]", need)[0] for need in [*project["dependencies"], *used]}
    assert names - {"fewest-lift-offs"} == set(DISTRIBUTIONS)
    cellcolor.show_versions()
    said = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert set(said) == {"cellcolor", "python", "system", "processor", *DISTRIBUTIONS}
    assert said["cellcolor"].startswith(cellcolor.__version__)
    assert said["numpy"] == np.__version__
