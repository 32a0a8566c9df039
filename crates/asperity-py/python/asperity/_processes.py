"""Processes on this machine that solve points, one each at a time.

They are started by name and import nothing of the caller's script, so that a study runs from a notebook and from a
script without a guard. A process that dies takes its own point with it and no other.
"""

from __future__ import annotations

import contextlib
import io
import os
import pickle
import queue
import subprocess
import sys
import threading
import types
from collections.abc import Generator, Sequence
from typing import Any

from ._core import CaseError
from ._points import Point, Solved

#: How long a process may take to stop [s]: it stops within one iteration of its solver.
_PATIENCE = 10.0
_CODE = "import sys; sys.path.insert(0, sys.argv[1]); from asperity._worker import main; main()"


def cores() -> int:
    """Processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


def shared(points: int, workers: int | None, threads: int | None) -> tuple[int, int]:
    """Processes and threads of each, so that together they are as many as there are processors."""
    there = cores()
    if workers is None:
        workers = min(points, there if threads is None else max(1, there // threads))
    return workers, max(1, there // workers) if threads is None else threads


class _Process:
    """One process and the point that it solves."""

    def __init__(self, threads: int, answers: queue.SimpleQueue[tuple[_Process, Any]]) -> None:
        self.point: int | None = None
        package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        # Ctrl-C is for the study, which tells its processes.
        alone: dict[str, Any] = {"start_new_session": True, "creationflags": getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)}
        self.process = subprocess.Popen([sys.executable, "-c", _CODE, package], **pipes, **alone)
        self._write({"path": list(sys.path), "threads": threads})
        threading.Thread(target=self._listen, args=(answers,), daemon=True).start()

    def _listen(self, answers: queue.SimpleQueue[tuple[_Process, Any]]) -> None:
        assert self.process.stdout is not None
        try:
            while True:
                answers.put((self, pickle.load(self.process.stdout)))
        except Exception:
            answers.put((self, None))

    def _write(self, what: Any) -> None:
        assert self.process.stdin is not None
        # One that has ended cannot be told; who listens says so.
        with contextlib.suppress(OSError):
            self.process.stdin.write(pickle.dumps(what))
            self.process.stdin.flush()

    def send(self, point: int, task: bytes) -> None:
        self.point = point
        self._write(task)

    def close(self) -> None:
        """Tells it to stop."""
        self.point = None
        with contextlib.suppress(OSError):
            assert self.process.stdin is not None
            self.process.stdin.close()

    def end(self) -> None:
        """Waits until it has."""
        try:
            self.process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        if self.process.stdout is not None:
            self.process.stdout.close()

    def fate(self) -> str:
        """Why it ended, in words."""
        code = self.process.wait()
        if code < 0:
            return f"its process was ended by signal {-code} (by the system, perhaps for lack of memory)"
        return f"its process ended with exit code {code}"


class _Pickler(pickle.Pickler):
    """Refuses what another process could not find: the functions and classes of the script or notebook."""

    def reducer_override(self, held: Any) -> Any:
        if isinstance(held, (types.FunctionType, type)) and held.__module__ == "__main__":
            raise CaseError(f"{held.__qualname__!r} of this script or notebook cannot be sent to another process: install cloudpickle, or put it into a module")
        return NotImplemented


def pickled(point: Point) -> bytes:
    """A point for another process; functions of a notebook or script need cloudpickle, wherever the point holds them."""
    try:
        import cloudpickle  # type: ignore[import-not-found,import-untyped,unused-ignore]
    except ImportError:
        cloudpickle = None
    try:
        if cloudpickle is not None:
            return bytes(cloudpickle.dumps(point))
        into = io.BytesIO()
        _Pickler(into, protocol=pickle.HIGHEST_PROTOCOL).dump(point)
        return into.getvalue()
    except CaseError:
        raise
    except Exception as error:
        raise CaseError(f"a point of the study cannot be sent to another process: {error}") from None


def solved(points: Sequence[Point], workers: int, threads: int) -> Generator[tuple[int, Solved], None, None]:
    """The points as they are done, with their numbers."""
    tasks = [pickled(point) for point in points]
    answers: queue.SimpleQueue[tuple[_Process, Any]] = queue.SimpleQueue()
    waiting = list(range(len(points)))[::-1]
    running: set[_Process] = set()

    def occupy(process: _Process) -> None:
        running.add(process)
        if waiting:
            number = waiting.pop()
            process.send(number, tasks[number])
        else:
            process.close()

    try:
        for _ in range(min(workers, len(points))):
            occupy(_Process(threads, answers))
        while running:
            try:
                # With an end, so that Ctrl-C is heard on every system.
                process, answer = answers.get(timeout=0.5)
            except queue.Empty:
                continue
            point = process.point
            if answer is not None:
                occupy(process)
            else:
                running.discard(process)
                answer = ("failed", process.fate(), None)
                if point is not None and waiting:
                    occupy(_Process(threads, answers))
                process.end()
            if point is not None:
                yield point, answer
    finally:
        for process in running:
            process.close()
        for process in running:
            process.end()
