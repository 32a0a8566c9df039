"""What a march leaves: its rows so far, and the fields of some of them, in memory or on disk."""

from __future__ import annotations

import errno
import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arrays import Floats, as_plane, distinct, line
from ._columns import FIELDS, HISTOGRAMS, ROW
from ._core import CaseError
from ._problem import InTime, Problem
from ._result import Result, attributes_of, open

if TYPE_CHECKING:
    from ._solve import March, Step


class Keep:
    """Which fields are kept, and of which rows."""

    def __init__(self, given: Problem) -> None:
        self.fields = distinct("fields", given.fields, list(FIELDS))
        self.title = given.title
        self.every = given.every
        self.times = None if given.field_times is None else line("field_times", given.field_times)
        #: Times that become steps.
        self.steps: list[float] = []
        if self.times is None:
            return
        if self.every is not None:
            raise CaseError("give every or field_times, exactly one of them")
        for time in self.times[~(np.isfinite(self.times) & (self.times >= 0))]:
            raise CaseError(f"field_times holds {time:g} s, but must hold times of the run, from 0 s on")
        if len(np.unique(self.times)) < len(self.times):
            raise CaseError("field_times holds a time twice; give each one once")
        if isinstance(given, InTime):
            self.steps = self.times[self.times > 0].tolist()


class Record:
    """The rows of a march so far, and their fields; with an `output` the fields are on disk only."""

    def __init__(self, march: March, keep: Keep, output: str | None, force: bool) -> None:
        core = march._core
        self._march, self._keep, self._output = march, keep, output
        self._edges: dict[str, Floats] = {name: np.array(ends) for name, ends in core.columns()}
        self._rows: list[dict[str, Any]] = []
        #: What was prescribed between two rows: the number of the row that followed, control and history.
        self.prescribed: list[dict[str, Any]] = []
        # The fields that are kept, by the number of their row; with an output only those that are not yet on disk.
        self._maps: dict[int, dict[str, Any]] = {}
        # Adaptive steps find their rows as they go.
        rows = core.rows_expected
        self._stride = keep.every if keep.every is not None else max(1, -(-((rows or 1) - 1) // 20))
        self._end = core.times()[-1]
        for time in () if keep.times is None else keep.times[keep.times > self._end * (1 + 1e-12)]:
            raise CaseError(f"field_times holds {time:g} s, but the run ends at {self._end:g} s")
        self._writer: _core.Writer | None = None
        if output is not None:
            if not force and os.path.exists(output):
                raise FileExistsError(errno.EEXIST, "exists already; choose another output or replace it with force=True", output)
            setup, gap = json.dumps(march._setup), np.array(as_plane(march.initial_gap))
            self._writer = _core.Writer(output, force, keep.title, setup, list(march.size), gap, keep.fields, list(self._edges.items()), rows)

    def __len__(self) -> int:
        return len(self._rows)

    # Ctrl-C may come between any two lines of Python: each of them leaves a state from which `see` can be called again for the row.
    def see(self, step: Step) -> None:
        """Takes in a row."""
        keeps = self._keeps(step)
        if keeps:
            self._maps[step.index] = {name: step._map(name) for name in self._keep.fields}
        if step.index == len(self._rows):
            self._rows.append(step.row)
        # A row whose fields are not kept waits for the next one: if none comes, its fields are kept as those of the last row.
        self._write(len(self) if keeps else len(self) - 1)

    def _write(self, end: int) -> None:
        """Writes the rows before row `end` to the output, if there is one."""
        while self._writer is not None and self._writer.rows < end:
            row = self._rows[self._writer.rows]
            numbers = [float(n) for name in self._edges for n in np.ravel(row[name])]
            self._writer.append(row, numbers, self._maps.get(self._writer.rows, {}))
            self._maps.pop(self._writer.rows - 1, None)

    def _catch_up(self) -> None:
        """Takes in the row that was solved when Ctrl-C came, and keeps the fields of the last row. They are lost where a step was
        interrupted, or did not converge."""
        march, last = self._march, len(self) - 1
        if march._core.done == last + 2:
            last += 1
            self.see(march._step(last))
        written = 0 if self._writer is None else self._writer.rows
        if written <= last and last not in self._maps and march._core.settled:
            self._maps[last] = {name: march._core.field(name) for name in self._keep.fields}

    def _keeps(self, step: Step) -> bool:
        if step.index == 0 or self._march._core.finished:
            return True
        if self._keep.times is None:
            return step.index % self._stride == 0
        return bool(np.any(np.abs(self._keep.times - step.time) <= 1e-12 * self._end))

    def close(self, status: str, message: str | None = None) -> Result:
        """The result of a march that goes no further: "complete", "interrupted" or "failed"."""
        if self._writer is None or self._output is None:
            return self.result(status)
        self._catch_up()
        self._write(len(self))
        self._writer.finish(status, json.dumps(self._march._found()), message)
        self._writer = None
        return open(self._output)

    def result(self, status: str) -> Result:
        """The rows so far with the fields that were kept, and those of the last row where they are known."""
        self._catch_up()
        shape, steps = self._march.initial_gap.shape, sorted(self._maps)
        stacks = {name: [self._maps[step][name].reshape(shape) for step in steps] for name in self._keep.fields}
        table = {name: np.array([row[name] for row in self._rows]) for name in [*ROW, *self._edges]}
        prescribed = {"prescribed": self.prescribed} if self.prescribed else {}
        return Result(
            table={name: values if self._rows else np.empty(0) for name, values in table.items() if name not in HISTOGRAMS},
            histograms={name: (ends, table[name]) for name, ends in self._edges.items() if name in HISTOGRAMS},
            fields={name: np.array(stack) if stack else np.empty((0, *shape)) for name, stack in stacks.items()},
            attributes=attributes_of(self._keep.title, status, self._march._setup | prescribed, self._march.findings),
            field_steps=steps, initial_gap=self._march.initial_gap, size=self._march.size
        )
