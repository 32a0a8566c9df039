"""Numbers from outside, made what the core takes: C-ordered float64, or an error."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._core import CaseError

Floats = npt.NDArray[np.float64]


def number(what: str, value: Any) -> float:
    """A real number; an array of one counts, text and complex numbers do not."""
    if isinstance(value, (str, bytes, bool)) or value is None:
        raise CaseError(f"{what} is {value!r}, but must be a number in SI units")
    try:
        array = np.asarray(value)
        if array.size != 1 or np.iscomplexobj(array):
            raise TypeError
        return float(array.reshape(())[()])
    except (TypeError, ValueError):
        raise CaseError(f"{what} is {value!r}, but must be a number in SI units") from None


def count(what: str, value: Any, least: int = 1, most: int = 2**53) -> int:
    """A whole number; one that is an integer already keeps all its digits."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        whole = int(value)
    else:
        real = number(what, value)
        if real != int(real) if np.isfinite(real) else True:
            raise CaseError(f"{what} is {value!r}, but must be a whole number")
        whole = int(real)
    if whole < least:
        raise CaseError(f"{what} is {value!r}, but must be at least {least}")
    if whole > most:
        raise CaseError(f"{what} is {value!r}, but must be at most {most}")
    return whole


def pair(what: str, value: Any) -> tuple[float, float]:
    """Two numbers, along x and y."""
    if isinstance(value, (str, bytes)):
        raise CaseError(f"{what} is {value!r}, but must be two numbers, along x and y")
    try:
        x, y = value
    except (TypeError, ValueError):
        raise CaseError(f"{what} is {value!r}, but must be two numbers, along x and y") from None
    return number(f"{what} along x", x), number(f"{what} along y", y)


def counts(what: str, value: Any) -> tuple[int, int]:
    """Two whole numbers, along x and y."""
    x, y = pair(what, value)
    return count(f"{what} along x", x), count(f"{what} along y", y)


def plain(array: Any) -> Floats:
    """The array as the core takes it: float64, in C order, aligned (what came through a socket may not be); no copy where
    it is so."""
    out: Floats = np.require(array, np.float64, ["C_CONTIGUOUS", "ALIGNED"])
    return out


def field(what: str, value: Any) -> Floats:
    """A two-dimensional array of real numbers as C-ordered float64; no copy where it is one already."""
    mask = np.ma.getmask(value)
    array = np.asarray(np.ma.getdata(value))
    if array.dtype.kind not in "fiu":
        raise CaseError(f"{what} has dtype {array.dtype}, but must hold real numbers")
    if array.ndim != 2 or array.size == 0:
        raise CaseError(f"{what} has shape {array.shape}, but must be two-dimensional, (nx, ny)")
    out = plain(array)
    if mask is not np.ma.nomask and np.any(mask):
        out = np.where(mask, np.nan, out)
    return out


def line(what: str, value: Any) -> Floats:
    """A one-dimensional array of real numbers as float64."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        raise CaseError(f"{what} has shape {array.shape} and dtype {array.dtype}, but must be a list of real numbers")
    return plain(array)


def points(what: str, value: Any) -> list[tuple[float, float]]:
    """A list of pairs."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] != 2:
        raise CaseError(f"{what} is {value!r}, but must be a list of pairs of numbers")
    return [(float(a), float(b)) for a, b in array]
