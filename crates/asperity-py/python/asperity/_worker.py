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
import traceback
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
            try:
                point = pickle.loads(task)
            except Exception as error:  # modules may fail with any error
                answer: Any = "failed", f"the point could not be read in its process: {type(error).__name__}: {error}", None
            else:
                answer = solve_point(point)
            answers.write(pickle.dumps(answer, protocol=pickle.HIGHEST_PROTOCOL))
            answers.flush()
    except (KeyboardInterrupt, BrokenPipeError):
        pass
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    # Not waiting for the thread that reads, which Python would end with an abort.
    os._exit(0)


if __name__ == "__main__":
    main()
