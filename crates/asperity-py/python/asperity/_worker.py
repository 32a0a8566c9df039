"""A process that solves points of a study: ``python -m asperity._worker``, started by :mod:`asperity._study`.

Pickled tasks come in on stdin, pickled answers go out on stdout. Once stdin ends, because the study was stopped or its
process died, the point under way is interrupted as by Ctrl-C, and the process ends: nothing goes on unseen.
"""

from __future__ import annotations

import os
import pickle
import queue
import sys
import threading
import _thread
from typing import Any, BinaryIO


def _read(source: BinaryIO, tasks: queue.SimpleQueue[Any]) -> None:
    """Tasks to the main thread; at the end of the input an interruption and None."""
    try:
        while True:
            tasks.put(pickle.load(source))
    except (EOFError, pickle.UnpicklingError, OSError):
        tasks.put(None)
        _thread.interrupt_main()


def main() -> None:
    # What a user's function prints must not get between the answers.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    source = sys.stdin.buffer
    first = pickle.load(source)
    sys.path[:] = first["path"]
    from asperity import _core
    from asperity._points import solve_point

    _core.set_threads(first["threads"])
    tasks: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(source, tasks), daemon=True).start()
    try:
        while (task := tasks.get()) is not None:
            answer = pickle.dumps(solve_point(pickle.loads(task)), protocol=pickle.HIGHEST_PROTOCOL)
            answers.write(answer)
            answers.flush()
    except (KeyboardInterrupt, BrokenPipeError):
        pass
    # Not waiting for the thread that reads.
    os._exit(0)


if __name__ == "__main__":
    main()
