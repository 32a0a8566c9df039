"""A function of time as a table of points, straight in between."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._arrays import Floats, line, number
from ._core import CaseError

Points = tuple[tuple[float, float], ...]

#: Times of a run closer than this share of its end are one.
_SAME = 1e-12
#: A step that was halved down to this share of the end holds a jump.
_SHORTEST = 1e-7
_MOST = 100_000


def as_points(
    what: str, function: Callable[[float], Any], marks: Floats, breaks: Sequence[float], tolerance: float, unit: str
) -> tuple[Points, float]:
    """The points (time [s], value) of a table of the function, and the largest distance of the table from it that was found.

    They are at 0, at the `marks`, the last of which is the end, and at the `breaks`, where the function has a value on each side. Between
    them a step is halved until the function at its quarters is closer to the straight line than `tolerance` times its largest value.
    """
    end = float(marks[-1])
    near = _SAME * end
    kinks = line("breaks", breaks) if np.size(breaks) else np.empty(0)
    for kink in kinks[~((kinks > 0.0) & (kinks < end))]:
        raise CaseError(f"breaks holds {kink:g} s, but must hold times between 0 s and the end, {end:g} s")
    if not tolerance > 0.0:
        raise CaseError(f"tolerance is {tolerance:g}, but must be greater than 0")

    def value(t: float) -> float:
        found = number(f"{what} at {t:g} s", function(t), unit)
        if not np.isfinite(found):
            raise CaseError(f"{what} is {found} at {t:g} s, but must be finite")
        return found

    steps = [0.0]
    for time in np.unique(np.concatenate([marks, kinks])).tolist():
        if time - steps[-1] > near:
            steps.append(time)
    jumps = {0.0, end, *kinks.tolist()}
    # Values on both sides of each time, and the steps that are still to be looked at, the first on top.
    there = [value(t) for t in steps]
    largest = max(map(abs, there))

    def limit(n: int, side: float) -> float:
        """The value beside a time; that at the time itself where they differ by rounding."""
        beside = value(steps[n] + side * near)
        return there[n] if abs(beside - there[n]) <= 1e-9 * max(largest, abs(beside)) else beside

    before = [limit(n, -1.0) if t in jumps and t > 0.0 else there[n] for n, t in enumerate(steps)]
    after = [limit(n, 1.0) if t in jumps and t < end else before[n] for n, t in enumerate(steps)]
    todo = list(zip(steps, after, steps[1:], before[1:]))[::-1]
    starts = dict(zip(steps, after))
    points, worst = [(0.0, after[0])], 0.0
    largest = max(map(abs, [*before, *after]))
    while todo:
        start, first, stop, last = todo.pop()
        inner = [value(start + share * (stop - start)) for share in (0.25, 0.5, 0.75)]
        largest = max([largest, *map(abs, inner)])
        error = max(abs(one - (first + share * (last - first))) for one, share in zip(inner, (0.25, 0.5, 0.75)))
        if error > tolerance * largest:
            if stop - start < _SHORTEST * end or len(points) > _MOST:
                raise CaseError(
                    f"{what} goes from {first:g} to {last:g} between {start:.9g} s and {stop:.9g} s, too fast for a table: "
                    "where it jumps, give the time in breaks=[...]"
                )
            middle = 0.5 * (start + stop)
            todo += [(middle, inner[1], stop, last), (start, first, middle, inner[1])]
            continue
        worst = max(worst, error)
        points.append((stop, last))
        if starts.get(stop, last) != last:
            points.append((stop, starts[stop]))
    return tuple(points), worst
