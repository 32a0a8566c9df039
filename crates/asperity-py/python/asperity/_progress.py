"""A line that says how far a run is: in the terminal, or as one text that changes in a notebook."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from typing import Any

BARS = "▁▂▃▄▅▆▇█"
PAUSE = 0.2


class Progress:
    """Shows rows done, contact area and time left; nothing unless `on`, or unless stderr is a terminal or notebook."""

    def __init__(self, total: int | None, on: bool | None) -> None:
        self.total, self.started, self.told = total, time.monotonic(), 0.0
        self.rows: list[tuple[float, float]] = []  # time and contact fraction
        self.show = line_of(on)

    def tell(self, row: dict[str, Any], done: int) -> None:
        """One row more."""
        self.rows.append((row["time"], row["contact_fraction"]))
        now = time.monotonic()
        if self.show is None or (now - self.told < PAUSE and (self.total is None or done < self.total)):
            return
        self.told = now
        of, left = "", ""
        if self.total is not None:
            of, left = f"/{self.total}", f"  {(now - self.started) / max(done, 1) * (self.total - done):.0f} s left"
        self.show(f"{done}{of} rows  t = {row['time']:.4g} s  contact {100 * row['contact_fraction']:.2f} % {sparkline(self.rows)}{left}")

    def end(self) -> None:
        """Clears the line."""
        if self.rows and self.show is not None:
            self.show(None)


def sparkline(rows: list[tuple[float, float]], width: int = 16) -> str:
    """Values over time as bars, each the last value up to its end; over log(time) where half of the rows lie in the first tenth."""
    positive = [time for time, _ in rows if time > 0]
    log = len(positive) > 4 and positive[len(positive) // 2] < 0.1 * positive[-1]
    points = [(math.log(time) if log else time, value) for time, value in rows if time > 0 or not log]
    low, high = min(value for _, value in points), max(value for _, value in points)
    first, last = points[0][0], points[-1][0]
    bars = []
    for k in range(width if last > first else 1):
        end = first + (k + 1) / width * (last - first)
        value = [value for place, value in points if place <= end or last == first][-1] if k + 1 < width else points[-1][1]
        bars.append(BARS[round(7 * (value - low) / (high - low)) if high > low else 3])
    return "".join(bars)


def line_of(on: bool | None) -> Callable[[str | None], None] | None:
    """A function that shows a line in place of the one before; given None it clears it. None as :class:`Progress` shows nothing."""
    notebook = _notebook()
    if not (notebook is not None or sys.stderr.isatty() if on is None else on):
        return None
    handle: Any = None

    def show(text: str | None) -> None:
        nonlocal handle
        if notebook is None:
            sys.stderr.write("\r" + (text or "") + "\x1b[K")
            sys.stderr.flush()
        elif text is not None and handle is None:
            handle = notebook({"text/plain": text}, raw=True, display_id=True)
        elif text is not None:
            handle.update({"text/plain": text}, raw=True)

    return show


def _notebook() -> Any:
    """IPython's display where this runs in a notebook, without importing it elsewhere."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is None or type(shell).__name__ != "ZMQInteractiveShell":
        return None
    return sys.modules["IPython"].display.display
