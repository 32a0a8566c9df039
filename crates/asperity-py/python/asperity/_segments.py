"""Segments of a force curve: approach, hold and retraction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ._arrays import Floats

Kind = Literal["approach", "hold", "retract"]

#: A segment that moves at less than this share of the fastest one is a hold.
_SLOW = 0.2
#: Share of the way from whose end on a curve may pause, and of the rows that such a pause has at least.
_TOP, _PAUSE = 0.02, 0.1


@dataclass(frozen=True)
class Segment:
    """A part of a force curve, rows `start` to `stop` - 1."""

    #: "approach", "hold" or "retract".
    kind: Kind
    start: int
    stop: int
    #: Mean velocity of the cantilever's base, or of the depth where that is not known, towards the sample [m/s]; None without times.
    rate: float | None = None
    #: "force" or "height": what was kept during a hold; None of the others.
    clamp: Literal["force", "height"] | None = None


def found(way: Floats, force: Floats, time: Floats | None, given: Sequence[tuple[int, int]], mode: str | None = None) -> tuple[Segment, ...]:
    """The segments of a curve whose base moves along `way`, larger towards the sample; `given` are the rows of those that the file tells,
    `mode` its word for the test, which decides what is kept in a hold under load."""
    whole = float(np.ptp(way)) or 1.0
    parts = [part for start, stop in given if stop > start for part in _turned(way, start, stop, whole)]
    rates = [_rate(way, time, *part) for part in parts]
    fastest = max((abs(rate) for rate in rates), default=0.0)
    segments = []
    for (start, stop), rate in zip(parts, rates):
        kind: Kind = "approach" if rate > 0 else "retract"
        clamp = None
        if abs(rate) <= _SLOW * fastest and float(np.ptp(way[start:stop])) < 0.5 * whole:
            kind, clamp = "hold", _clamp(way[start:stop] / whole, force[start:stop] / (float(np.ptp(force)) or 1.0), mode)
        segments.append(Segment(kind, start, stop, None if time is None else rate, clamp))
    return tuple(segments)


def _rate(way: Floats, time: Floats | None, start: int, stop: int) -> float:
    """Along a straight line; per row where there are no times."""
    if stop - start < 2:
        return 0.0
    t = np.arange(stop - start, dtype=float) if time is None else time[start:stop] - time[start:stop].mean()
    t = t - t.mean()
    squares = float(t @ t)
    return float(t @ (way[start:stop] - way[start:stop].mean())) / squares if squares > 0 else 0.0


def _turned(way: Floats, start: int, stop: int, whole: float) -> list[tuple[int, int]]:
    """A part that goes forth and back, in two or, with a pause between, in three."""
    own = way[start:stop]
    top = int(np.argmax(own))
    if min(own[top] - own[0], own[top] - own[-1]) < 0.25 * whole:
        return [(start, stop)]
    near = np.flatnonzero(own >= own[top] - _TOP * whole)
    first, last = int(near[0]), int(near[-1]) + 1
    if last - first > _PAUSE * len(own):
        return [(start, start + first), (start + first, start + last), (start + last, stop)]
    return [(start, start + top + 1), (start + top + 1, stop)]


def _clamp(way: Floats, force: Floats, mode: str | None) -> Literal["force", "height"]:
    """What changes less from the first to the last quarter of a hold."""
    if mode == "creep-compliance":
        return "force"
    if mode == "stress-relaxation":
        return "height"
    quarter = max(len(way) // 4, 1)
    moved = [abs(float(x[-quarter:].mean() - x[:quarter].mean())) for x in (way, force)]
    return "force" if moved[1] < moved[0] else "height"
