"""The last cycle of a run whose load, or approach, goes up and down."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _core
from ._core import CaseError

if TYPE_CHECKING:
    from ._arrays import Floats
    from ._result import Result


def last_cycle(result: Result) -> slice | None:
    """Rows of the last full period of a load that is a sine; else from the last but one to the last peak of the load or, where this is
    held, of the approach. None if there is no cycle."""
    if result.is_sweep:
        return None
    for sine in reversed(result._setup.get("sines") or []):
        if (span := _last_period(result, sine["stage"], sine["frequency"])) is not None:
            # Ends of periods and times of rows differ by rounding errors.
            rounding = 1e-9 * (span[1] - span[0])
            return slice(*(int(n) for n in np.searchsorted(result.time, [span[0] - rounding, span[1] + rounding])))
    return _between_peaks(result.load) or _between_peaks(result.approach)


def _last_period(result: Result, stage: int, frequency: float) -> tuple[float, float] | None:
    """Start and end of the last full period of a stage."""
    first, last = (int(n) for n in np.searchsorted(result.stage, [stage, stage + 0.5]))
    # A stage starts where the one before ended.
    start = float(result.time[first - 1]) if first else 0.0
    # A jump at the start is a row of the stage; without one the stage begins with the last row before.
    if 0 < first < last and result.time[first] > start:
        first -= 1
    time, load, approach = (column[first:last].tolist() for column in (result.time, result.load, result.approach))
    try:
        found = _core.cycles_of(time, load, approach, frequency, start)
    except CaseError:  # a run that has just begun
        return None
    return found[-1][:2] if found else None


def _between_peaks(course: Floats) -> slice | None:
    """Rows from the last but one to the last peak of a course that has three of them or more. A peak is higher than the lowest value on
    both sides, back to the next higher one, by a tenth of the range."""
    low, high = float(np.min(course, initial=np.inf)), float(np.max(course, initial=-np.inf))
    # A held load differs from row to row by rounding errors.
    if not high - low > 1e-6 * max(abs(low), abs(high)):
        return None
    least = 0.1 * (high - low)
    peaks: list[int] = []
    top = bottom = 0
    rising = True
    values = course.tolist()
    for n, value in enumerate(values):
        if rising:
            if value > values[top]:
                top = n
            elif values[top] - value > least:
                peaks.append(top)
                rising, bottom = False, n
        elif value < values[bottom]:
            bottom = n
        elif value - values[bottom] > least:
            rising, top = True, n
    return slice(peaks[-2], peaks[-1] + 1) if len(peaks) >= 3 else None
