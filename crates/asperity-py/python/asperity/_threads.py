"""How many threads work."""

from __future__ import annotations

from types import TracebackType

from . import _core
from ._arrays import count


class Threads:
    """The number of threads that was set; as a context manager it sets the number before back at the end."""

    def __init__(self, before: int) -> None:
        self._before = before

    def __enter__(self) -> int:
        return _core.threads()

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        _core.set_threads(self._before)

    def __repr__(self) -> str:
        return f"<{_core.threads()} threads>"


def set_threads(number: int | None) -> Threads:
    """Sets the number of threads that work in this process; None: as many as there are processors.

    Results are the same bits for any number. In a ``with`` statement it holds until the end of the block.

    >>> import asperity as asp
    >>> before = asp.threads()
    >>> with asp.set_threads(1):
    ...     asp.threads()
    1
    >>> asp.threads() == before
    True
    """
    before = _core.threads()
    _core.set_threads(None if number is None else count("number of threads", number))
    return Threads(before)


def threads() -> int:
    """Number of threads that work in this process.

    As many as there are processors, unless the environment variable RAYON_NUM_THREADS or :func:`set_threads` says
    otherwise.
    """
    return _core.threads()
