"""Hold the commands to their limits on random inputs: ``python benchmarks/limits.py [FILE …]``.

Every input is given to one command as a process of its own, with a time limit. Promised are the
limit + 10 % + 1 s from the start of the process, and 4 GiB. Prints a table by kind of input, then
the runs that were worst; ``--kinds``, ``--seed`` and ``--count 1`` repeat one of them. A kind's
inputs are functions of their seeds, and so is the command, which takes turns. Files that are given
are run instead, with every command that takes them.

What is still running when it should have ended is asked for its Python stack, and killed at three
times the limit + 30 s, or at 6 GiB.
"""

from __future__ import annotations

import argparse
import json
import os
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

from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import LARGE

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
    "paper cuts": ("solve", "--search-space", "paper", "--fewest-cuts"),
    "surface cuts": ("solve", "--search-space", "surface", "--fewest-cuts"),
    "all": ("solve", "--all"),
    "check": ("check",),
}


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

    @property
    def broken(self) -> bool:
        """Whether a promise was not kept."""
        answered = self.exit_code in (0, 3) and self.status is not None
        return (
            self.over > 0 or self.megabytes > PROMISED_MEMORY_MB or not (answered or self.refused)
        )

    @property
    def refused(self) -> bool:
        """Whether the input is nothing for the command."""
        return self.exit_code == 2 and self.variant == "all"


def measure(kind: str, seed: int | str, variant: str, files: list[Path], limit: float) -> Run:
    """Run one command and look at it from outside."""
    name, *options = VARIANTS[variant]
    arguments = [name, *map(str, files), *options, "--time-limit", str(limit), "--json"]
    promised = 1.1 * limit + 1.0
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
    return run


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
    elif "Traceback (most recent call last)" in complaints:
        run.error = f"Traceback: {complaints.strip().splitlines()[-1][:200]}"


def drawn(kind: str, seed: int, folder: Path, limit: float) -> Run:
    """The run of one random input, with the command whose turn it is."""
    subject = LARGE[kind](seed)
    variants = list(VARIANTS)
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
    run = measure(kind, seed, variant, files, limit)
    for path in files:
        path.unlink()
    return run


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
    for variant in VARIANTS:
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
        "| kind | runs | kept | s beyond | without waiting | most MB "
        "| refused | optimal | unknown | median gap |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for kind in dict.fromkeys(run.kind for run in runs):
        own = [run for run in runs if run.kind == kind]
        gaps = [r.segments - r.bound for r in own if r.segments is not None and r.bound is not None]
        cells = (
            kind,
            len(own),
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
        yield f"{what}| {run.exit_code} | {run.error or run.stage} |"


def main() -> int:
    """Run, print, and say by the exit code whether every promise was kept."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--kinds", nargs="+", choices=list(LARGE), default=list(LARGE))
    parser.add_argument("--count", type=int, default=200, help="inputs of each kind")
    parser.add_argument("--seed", type=int, default=0, help="of the first one")
    parser.add_argument("--limit", type=float, default=5.0, help="seconds")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time")
    parser.add_argument("-o", "--output", type=Path, help="each run as a line of JSON")
    arguments = parser.parse_args()
    limit, runs = arguments.limit, list[Run]()
    with (
        tempfile.TemporaryDirectory() as name,
        ThreadPoolExecutor(arguments.jobs) as pool,
        open(arguments.output or os.devnull, "w", encoding="utf-8") as lines,  # noqa: PTH123
    ):
        folder = Path(name)
        if arguments.files:
            results = (run for file in arguments.files for run in given(file, folder, limit))
        else:
            tasks = [
                pool.submit(drawn, kind, arguments.seed + number, folder, limit)
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
    return int(any(run.broken for run in runs))


if __name__ == "__main__":
    sys.exit(main())
