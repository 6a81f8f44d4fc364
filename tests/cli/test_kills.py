"""Commands killed at random moments and at chosen ones: each file whole, all or none, no traces."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import kills
import pytest
from commands import run
from library import INSTANCES, PAPER

pytestmark = pytest.mark.second

AT_RENAME = """
import os, signal, sys
from pathlib import Path
rename, left = Path.replace, [int(sys.argv.pop(1))]
def killed(path, target):
    if not left[0]:
        os.kill(os.getpid(), signal.SIGKILL)
    left[0] -= 1
    return rename(path, target)
Path.replace = killed
from cellcolor.cli import main
sys.exit(main())
"""


def kill(name: str, count: int) -> None:
    faults: list[str] = []
    kills.trial(kills.COMMANDS[name], count, 1, faults.append)
    assert faults == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["solve -o", "solve --all -o"])
def test_a_few(name: str) -> None:
    kill(name, 3)


@pytest.mark.slow
@pytest.mark.parametrize("name", kills.COMMANDS)
def test_a_hundred(name: str) -> None:
    kill(name, 100)


@pytest.mark.slow
def test_between_two_renames(tmp_path: Path) -> None:
    """What can happen only then: files of two builds, which are not shown together."""
    kills.prepare(tmp_path, kills.BUILD)
    old = kills.contents(tmp_path, kills.BUILD)
    for done in range(3):
        process = kills.start(
            tmp_path,
            kills.Command(kills.BUILD.arguments, (), script=("-c", AT_RENAME, str(done))),
        )
        process.communicate()
        assert process.returncode == -signal.SIGKILL
        new = kills.contents(tmp_path, kills.BUILD)
        changed = {name for name in old if old[name] != new[name]}
        # The renames done so far, the side file before the surface before the instance.
        assert changed == set(kills.BUILD.outputs[:done])
        assert len(kills.strays(tmp_path)) == 3 - done
        if done:
            faults: list[str] = []
            kills.together(tmp_path, kills.BUILD, changed, signal.SIGKILL, faults.append)
            assert faults == []
    process = kills.start(tmp_path, kills.BUILD)
    process.communicate()
    assert process.returncode == 0 and kills.strays(tmp_path) == []
    assert run("show", tmp_path / "w.json", "--reason", "-o", tmp_path / "x.svg") == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_a_library_swallows(number: signal.Signals, tmp_path: Path) -> None:
    """Whoever catches everything (trimesh does, when imported) catches Ctrl-C as well."""
    script = (
        "import signal, sys\n"
        "import cellcolor.cli.inputs as inputs\n"
        "import cellcolor.door.subject\n"
        "try:\n    import cellcolor.frontend\nexcept ModuleNotFoundError:\n    sys.exit(3)\n"
        "import cellcolor.frontend as frontend\n"
        "build = frontend.build_surface\n"
        "def swallowed(*arguments):\n"
        "    try:\n"
        f"        signal.raise_signal({int(number)})\n"
        "    except BaseException:\n        pass\n"
        "    return build(*arguments)\n"
        "frontend.build_surface = swallowed\n"
        "from cellcolor.cli import main\nsys.exit(main())\n"
    )
    scene = INSTANCES / "scenes" / "wok.toml"
    command = [sys.executable, "-c", script, "build", str(scene), "-o", str(tmp_path / "w.json")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 3
    assert list(tmp_path.iterdir()) == []


def test_a_signal_at_the_very_end_changes_nothing() -> None:
    """The answer is out; how Python then takes itself down is nobody's business."""
    command = [sys.executable, "-m", "cellcolor", "solve", str(PAPER / "ring.json"), "--json"]
    for number in (signal.SIGINT, signal.SIGTERM):
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert process.stdout is not None
        assert process.stdout.readline()
        process.send_signal(number)
        _, errors = process.communicate()
        assert (process.returncode, errors) in ((0, b""), (3, b"cellcolor: interrupted\n"))
