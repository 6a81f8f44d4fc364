"""Two solvers on the same instances: is the one better, or was it luck?

Each instance is one observation; several runs of a solver on it count by their mean.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import fmean

import numpy as np
from scipy import stats

from cellcolor.arrays import Array
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.lab.runs.summary import contestants_of, markdown_table, par2
from cellcolor.lab.runs.table import Row, by

RESAMPLES = 9_999


def paired(rows: Sequence[Row], one: str, other: str) -> Iterator[str]:
    """Lines of Markdown that compare two contestants, for each search space and limit.

    What each proves that the other does not is held against a fair coin (the exact McNemar test).
    PAR2 seconds are compared by Wilcoxon's signed-rank test. Intervals are bootstrapped.

    Raises:
        InputError: a contestant has no runs, or the two have no instance in common.
    """
    for name in (one, other):
        if name not in contestants_of(rows):
            known = ", ".join(contestants_of(rows))
            raise InputError(None, "--pair", f"there are no runs of {name}, only of {known}")
    compared = False
    for (space, limit), own in by(rows, lambda row: (row.search_space, row.limit)).items():
        of_instance = by(own, lambda row: row.sha256).values()
        runs = [by(found, lambda row: row.contestant) for found in of_instance]
        both = [(found[one], found[other]) for found in runs if one in found and other in found]
        if both:
            compared = True
            yield from ("", f"## {one} and {other}, search space {space}, {limit:g} s", "")
            yield from _compared(one, other, both)
    if not compared:
        raise InputError(None, "--pair", f"{one} and {other} were not run on the same instances")


def _compared(
    one: str, other: str, both: Sequence[tuple[Sequence[Row], Sequence[Row]]]
) -> Iterator[str]:
    solved = np.array([[all(row.solved for row in runs) for runs in pair] for pair in both])
    scores = np.array([[par2(runs) for runs in pair] for pair in both])
    first, second = (int((solved[:, k] & ~solved[:, 1 - k]).sum()) for k in (0, 1))
    yield from markdown_table(
        [f"of {count(len(both), 'instance')}", one, other],
        [
            ["proved", *map(str, solved.sum(axis=0).tolist())],
            ["proved by this one alone", str(first), str(second)],
            ["PAR2, seconds", *(f"{score:.3g}" for score in scores.mean(axis=0))],
        ],
    )
    yield ""
    if first + second:
        chance = stats.binomtest(first, first + second).pvalue
        yield f"- Minima that one alone proved: p = {chance:.2g} (exact McNemar test)."
    less = scores[:, 0] - scores[:, 1]
    text = f"- PAR2 of {one} less that of {other}: {less.mean():.3g} s ({_interval(less)})"
    if less.any():
        text += f", p = {stats.wilcoxon(less).pvalue:.2g} (Wilcoxon's signed-rank test)"
    yield f"{text}."
    seconds = [
        [max(fmean(row.seconds or 0.0 for row in runs), 1e-4) for runs in pair]
        for pair, proved in zip(both, solved, strict=True)
        if proved.all()
    ]
    if seconds:
        ratio = np.log(np.array(seconds)[:, 0] / np.array(seconds)[:, 1])
        times = f"{np.exp(ratio.mean()):.3g} times as long (geometric mean, "
        proved = count(len(seconds), "instance")
        yield f"- Where both proved it ({proved}), {one} took {times}{_interval(ratio, np.exp)})."


def _interval(values: Array, scale: np.ufunc | None = None) -> str:
    """The 95 % interval of a mean, by resampling the instances."""
    if len(values) < 2:
        return "one instance has no interval"
    samples = np.random.default_rng(0).choice(values, (RESAMPLES, len(values)))
    ends = np.percentile(samples.mean(axis=1), (2.5, 97.5))
    low, high = ends if scale is None else scale(ends)
    return f"95 % interval {low:.3g} to {high:.3g}"
