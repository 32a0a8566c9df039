"""How many threads work."""

from __future__ import annotations

from . import _core
from ._arrays import count


def set_threads(number: int | None) -> None:
    """Sets the number of threads that work in this process; None: as many as there are processors.

    Results are the same bits for any number.

    >>> import asperity as asp
    >>> asp.set_threads(1)
    >>> asp.threads()
    1
    >>> asp.set_threads(None)
    """
    _core.set_threads(None if number is None else count("number of threads", number))


def threads() -> int:
    """Number of threads that work in this process.

    As many as there are processors, unless the environment variable RAYON_NUM_THREADS or :func:`set_threads` says
    otherwise.
    """
    return _core.threads()
