"""Hold the commands to their limits on random inputs: ``python benchmarks/limits.py [FILE …]``.

Every input is given to one command as a process of its own, with a time limit. Promised are the
limit + 10 % + 1 s from the start of the process, of which ``plan`` has two more for loading its
libraries, and 4 GiB. Prints a table by kind of input, then the runs that were worst; ``--kinds``,
``--seed`` and ``--count 1`` repeat one of them. A kind's inputs are functions of their seeds, and
so is the command, which takes turns: ``check`` is the oracle, which proves, paints and keeps the
proof. ``rings`` are what it paints slowest, ``plan`` plans the stored scenes. Files that are given
are run instead, with every command that takes them. Of several limits each seed has its own::

    python benchmarks/limits.py --count 154 --limit 0.5 1 2 --jobs 2

Late is what was beyond the promise even without the time, after the limit, in which its main thread
stood in line for a processor. Wrong is an answer that the checker refuses, that contradicts itself,
or an exit code that the command does not have then; of a plan a file that is not whole, or a motion
without its verdict. What was lost in a traceback is counted apart.

What is still running when it should have ended is asked for its Python stack, and killed at three
times the limit + 30 s, or at 6 GiB.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any, Literal

import numpy as np
from limits_answers import not_whole, wrong_in_answer, wrong_in_plan

from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import LARGE
from cellcolor.lab.families.meshes import grid_faces

Subject = Instance | LabelledSurface

PROMISED_MEMORY_MB = 4096
KILLED_AT_MB = 6144
SHOWN = 12

# A process that prints its stack on a signal, and is the command otherwise. While it ends, when
# nobody prints any more, the signal has to be ignored.
COMMAND = """
import faulthandler, signal, sys
signal.signal(signal.SIGUSR1, signal.SIG_IGN)
faulthandler.register(signal.SIGUSR1, all_threads=False)
from cellcolor.cli import main
sys.exit(main())
"""

VARIANTS = {
    "paper": ("solve", "--search-space", "paper"),
    "surface": ("solve", "--search-space", "surface"),
    "all": ("solve", "--all"),
    "check": ("check",),
}
PLAN, RINGS = "plan", "rings"
SCENES = sorted((Path(__file__).parents[1] / "instances" / "scenes").glob("*.toml"))
KINDS = [*LARGE, RINGS, PLAN]
LOADING = 2.0  # s, which pinocchio, trimesh and others take when a plan begins


@dataclass
class Run:
    """What one process did.

    Attributes:
        kind: of the input.
        seed: of the input, or its file.
        variant: of the command.
        seconds: from the start of the process to its end.
        cpu: seconds of all processors that it used; few where the machine was busy otherwise.
        over: seconds beyond what is promised, negative if it was kept.
        waited: seconds after the limit in which it could have run, but no processor was free.
        megabytes: the most memory that the process had at a time.
        end: how it ended.
        exit_code: of the process, negative for a signal.
        status: of the solution, None if there is none.
        segments: of the solution.
        bound: the lower bound for what was asked.
        stage: the innermost frames of the package when it should have ended.
        error: what it said of a file, or the last line of a traceback.
        wrong: what of its answer or files must not be so.
    """

    kind: str
    seed: int | str
    variant: str
    seconds: float
    cpu: float
    over: float
    waited: float
    megabytes: float
    end: Literal["itself", "killed: time", "killed: memory"]
    exit_code: int
    status: str | None = None
    segments: int | None = None
    bound: int | None = None
    stage: str = ""
    error: str = ""
    wrong: str = ""

    @property
    def broken(self) -> bool:
        """Whether a promise was not kept."""
        return (
            self.over > 0
            or self.megabytes > PROMISED_MEMORY_MB
            or self.lost
            or bool(self.wrong)
            or self.end != "itself"
        )

    @property
    def late(self) -> bool:
        """Whether it would have been too late if a processor had always been free."""
        return self.over - self.waited > 0

    @property
    def lost(self) -> bool:
        """Whether it ended in a traceback, or without an answer."""
        if self.variant == PLAN or self.error.startswith("Traceback"):
            return bool(self.error)
        return not (self.refused or (self.exit_code in (0, 3) and self.status is not None))

    @property
    def refused(self) -> bool:
        """Whether the input is nothing for the command."""
        return self.exit_code == 2 and self.variant == "all"


def measure(
    kind: str,
    seed: int | str,
    variant: str,
    files: list[Path],
    limit: float,
    subject: Subject | None = None,
) -> Run:
    """Run one command and look at it from outside; what a subject is solved to is checked."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "out"
        command, *options = VARIANTS.get(variant, (variant,))
        arguments = [command, *map(str, files), *options, "--time-limit", str(limit)]
        arguments += ["--output", str(folder)] if variant == PLAN else ["--json"]
        arguments += ["--cache", str(folder)] if variant == "check" else []
        promised = 1.1 * limit + 1.0 + (LOADING if variant == PLAN else 0.0)
        run, said = _measured(kind, seed, variant, arguments, limit, promised)
        if variant == PLAN:
            run.wrong = wrong_in_plan(run.exit_code, folder)
        elif subject is not None and not (run.lost or run.refused):
            run.wrong = wrong_in_answer(said, subject) or not_whole(folder)
    return run


def _measured(
    kind: str, seed: int | str, variant: str, arguments: list[str], limit: float, promised: float
) -> tuple[Run, str]:
    """The run, and what it printed."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        started = time.monotonic()
        process = subprocess.Popen(
            [sys.executable, "-c", COMMAND, *arguments], stdout=out, stderr=err
        )
        end: Literal["itself", "killed: time", "killed: memory"] = "itself"
        asked, before, waited = False, 0.0, 0.0
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            seconds = time.monotonic() - started
            if pid:
                break
            if seconds < limit:
                before = _waited(process.pid)
            waited = max(waited, _waited(process.pid) - before)
            if seconds > promised and not asked:
                process.send_signal(signal.SIGUSR1)
                asked = True
            if end == "itself":
                if seconds > 3 * limit + 30:
                    end = "killed: time"
                elif _megabytes(process.pid) > KILLED_AT_MB:
                    end = "killed: memory"
                if end != "itself":
                    process.kill()
            time.sleep(0.01)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        said, complaints = out.read().decode(), err.read().decode(errors="replace")
    run = Run(
        kind,
        seed,
        variant,
        round(seconds, 2),
        round(usage.ru_utime + usage.ru_stime, 2),
        round(seconds - promised, 2),
        round(waited, 2),
        round(usage.ru_maxrss / 1024, 1),
        end,
        process.returncode,
        stage=_stage(complaints),
    )
    _read_answer(run, said, complaints)
    return run, said


def _megabytes(pid: int) -> float:
    """Memory of a process now; 0 if it has just ended."""
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def _waited(pid: int) -> float:
    """Seconds that the main thread has stood in line for a processor; 0 if it has just ended."""
    try:
        return int(Path(f"/proc/{pid}/schedstat").read_text().split()[1]) / 1e9
    except (OSError, IndexError):
        return 0.0


def _stage(complaints: str) -> str:
    """The innermost three frames of the package in a stack that faulthandler printed."""
    frames = []
    for line in complaints.splitlines():
        if line.startswith('  File "') and "/cellcolor/" in line:
            place, _, name = line.rpartition(" in ")
            module = place.rpartition("/cellcolor/")[2].partition('"')[0]
            number = place.rpartition(" ")[2]
            frames.append(f"{module}:{number} {name}")
    return " < ".join(frames[:3])


def _read_answer(run: Run, said: str, complaints: str) -> None:
    """Take the numbers of a solution or of a verdict over into the run."""
    try:
        answer: dict[str, Any] = json.loads(said.splitlines()[0])
    except (IndexError, ValueError):
        answer = {}
    if "status" in answer:
        # Out of time before there was a graph, the answer has a status and an error only.
        run.status, run.segments = answer["status"], answer.get("segments")
        run.bound = answer.get("surface_lower_bound" if "surface" in run.variant else "lower_bound")
    elif "valid" in answer:
        run.status = "optimal" if answer["lower_bound"] == answer["upper_bound"] else "feasible"
        run.segments, run.bound = answer["upper_bound"], answer["lower_bound"]
    elif "error" in answer:
        run.error = answer["error"]
    if "Traceback (most recent call last)" in complaints:
        run.error = f"Traceback: {complaints.strip().splitlines()[-1][:200]}"


def drawn(kind: str, seed: int, folder: Path, limits: list[float]) -> Run:
    """The run of one random input, with the command whose turn it is."""
    limit = random.Random(f"limit {kind} {seed}").choice(limits)
    if kind == PLAN:
        return measure(kind, seed, PLAN, [SCENES[seed % len(SCENES)]], limit)
    subject = rings(seed) if kind == RINGS else LARGE[kind](seed)
    variants = list(VARIANTS) if kind != RINGS else ["check"]
    if not isinstance(subject, LabelledSurface):
        variants.remove("check")
    # The rounds are shifted, so that no command gets only what an even seed makes.
    variant = variants[(seed + seed // len(variants)) % len(variants)]
    suffix = ".surface.json" if isinstance(subject, LabelledSurface) else ".json"
    file = folder / f"{kind.replace(' ', '_')}_{seed}{suffix}"
    file.write_text(subject.to_json())
    files = [file]
    if variant == "check" and isinstance(subject, LabelledSurface):
        files.append(_plan(subject, file))
    run = measure(kind, seed, variant, files, limit, subject)
    for path in files:
        path.unlink()
    return run


def rings(seed: int) -> LabelledSurface:
    """A square whose inner points have all colors, and those of its rim one each, by chance.

    So a single cell has a ring of dozens to hundreds of neighbors, with a corridor to most of them.
    """
    rng = random.Random(f"rings {seed}")
    size, colors = rng.randint(20, 100), rng.randint(3, 8)
    row, column = np.mgrid[0:size, 0:size].reshape(2, -1)
    rim = (row % (size - 1) == 0) | (column % (size - 1) == 0)
    run, own = 0, 0
    vertex_colors = []
    for outer in rim.tolist():
        if run == 0:
            run, own = rng.randint(1, 4), rng.randrange(colors)
        run -= outer
        vertex_colors.append((own,) if outer else tuple(range(colors)))
    return LabelledSurface(
        name=f"rings_{seed}",
        colors=tuple(f"c{number}" for number in range(colors)),
        vertices=0.01 * np.column_stack([column, row, np.zeros(len(row))]),
        faces=grid_faces(size, size),
        vertex_colors=tuple(vertex_colors),
    )


def _plan(surface: LabelledSurface, file: Path) -> Path:
    """A plan beside a surface's file that takes for each vertex the first of its colors."""
    plan = file.with_suffix(".plan.json")
    colors = tuple(own[0] if own else None for own in surface.vertex_colors)
    plan.write_text(Plan(colors).to_json())
    return plan


def _finished(tasks: list[Future[Run]]) -> Iterator[Run]:
    """The runs of all tasks; a fault of the measurement itself is told and costs one run only."""
    for task in tasks:
        try:
            yield task.result()
        except Exception:
            traceback.print_exc()


def given(file: Path, folder: Path, limit: float) -> Iterator[Run]:
    """The runs of a file, with every command that takes it."""
    for variant in [PLAN] if file.suffix == ".toml" else VARIANTS:
        files = [file]
        if variant == "check":
            if not file.name.endswith(".surface.json"):
                continue
            files.append(_plan(LabelledSurface.read(file), folder / file.name))
        yield measure("files", str(file), variant, files, limit)


def table(runs: list[Run]) -> Iterator[str]:
    """Lines of Markdown: what each kind did, and what was worst.

    Seconds beyond the promise are those of the worst run; then of the worst one if a processor had
    always been free after the limit, which tells a slow program from a busy machine (or from its
    own workers). Refused are cells with several live loops, which ``--all`` does not take.
    """
    yield (
        "| kind | runs | wrong | lost | late | kept | s beyond | without waiting | most MB "
        "| refused | optimal | unknown | median gap |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    kinds = list(dict.fromkeys(run.kind for run in runs))
    for kind in [*kinds, *(["all"] if len(kinds) > 1 else [])]:
        own = [run for run in runs if kind in (run.kind, "all")]
        gaps = [r.segments - r.bound for r in own if r.segments is not None and r.bound is not None]
        cells = (
            kind,
            len(own),
            sum(bool(run.wrong) for run in own),
            sum(run.lost for run in own),
            sum(run.late for run in own),
            sum(not run.broken for run in own),
            f"{max(run.over for run in own):+.1f}",
            f"{max(run.over - run.waited for run in own):+.1f}",
            f"{max(run.megabytes for run in own):.0f}",
            sum(run.refused for run in own),
            sum(run.status == "optimal" for run in own),
            sum(run.status == "unknown" for run in own),
            f"{median(gaps):g}" if gaps else "",
        )
        yield "| " + " | ".join(map(str, cells)) + " |"
    offenders = sorted((run for run in runs if run.broken), key=lambda run: run.waited - run.over)
    if offenders:
        yield ""
        yield f"The worst of {len(offenders)} runs that broke a promise:"
        yield ""
        yield "| kind | seed | command | s | CPU s | beyond | waited | MB | end | exit | stage |"
        yield "|---|---|---|---|---|---|---|---|---|---|---|"
    for run in offenders[:SHOWN]:
        what = f"| {run.kind} | {run.seed} | {run.variant} | {run.seconds} | {run.cpu} "
        what += f"| {run.over:+.1f} | {run.waited:.1f} | {run.megabytes:.0f} | {run.end} "
        yield f"{what}| {run.exit_code} | {run.wrong or run.error or run.stage} |"


def main() -> int:
    """Run, print, and say by the exit code whether anything was wrong, lost, late or too large."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--count", type=int, default=200, help="inputs of each kind")
    parser.add_argument("--seed", type=int, default=0, help="of the first one")
    parser.add_argument("--limit", type=float, nargs="+", default=[5.0], help="seconds")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time")
    parser.add_argument("-o", "--output", type=Path, help="each run as a line of JSON")
    arguments = parser.parse_args()
    limits, runs = arguments.limit, list[Run]()
    with (
        tempfile.TemporaryDirectory() as name,
        ThreadPoolExecutor(arguments.jobs) as pool,
        open(arguments.output or os.devnull, "w", encoding="utf-8") as lines,  # noqa: PTH123
    ):
        folder = Path(name)
        if arguments.files:
            results = (run for file in arguments.files for run in given(file, folder, limits[0]))
        else:
            tasks = [
                pool.submit(drawn, kind, arguments.seed + number, folder, limits)
                for kind in arguments.kinds
                for number in range(arguments.count)
            ]
            results = _finished(tasks)
        for run in results:
            runs.append(run)
            lines.write(json.dumps(asdict(run)) + "\n")
            lines.flush()
            if sys.stderr.isatty():
                print(f"\r{len(runs)} {run.kind} {run.seed}   ", end="", file=sys.stderr)
    print("\n".join(table(runs)))
    return int(
        any(run.wrong or run.lost or run.late or run.megabytes > PROMISED_MEMORY_MB for run in runs)
    )


if __name__ == "__main__":
    sys.exit(main())
