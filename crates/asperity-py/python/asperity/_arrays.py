"""Numbers from outside, made what the core takes: C-ordered float64 in SI units, or an error."""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, TypeVar, get_args

import numpy as np
import numpy.typing as npt

from ._core import CaseError
from ._units import bare, frequency, has_unit, is_labelled, variable_of

AnyPath = str | os.PathLike[str]
#: A real number of Python or numpy.
Scalar = float | np.floating[Any] | np.integer[Any]
#: Lengths of a domain along x and y [m], or of a line.
Size = Scalar | Sequence[float] | Sequence[Scalar] | npt.NDArray[Any] | None
ArrayLike = npt.ArrayLike
AnyArray = npt.NDArray[Any]
Floats = npt.NDArray[np.float64]
Counts = npt.NDArray[np.int64]
Labels = npt.NDArray[np.uint32]
Array = TypeVar("Array", bound=npt.NDArray[Any])


def number(what: str, value: Any, unit: str | None = None) -> float:
    """A real number in SI units; an array of one counts, text and complex numbers do not. A quantity of pint, say, is converted to
    `unit`, by default that of the parameter `what`."""
    value = bare(what, value, unit)
    if isinstance(value, (str, bytes, bool)) or value is None:
        raise CaseError(f"{what} is {value!r}, but must be a number in SI units")
    try:
        array = np.asarray(value)
        if array.size != 1 or np.iscomplexobj(array):
            raise TypeError
        return float(array.reshape(())[()])
    except (TypeError, ValueError):
        raise CaseError(f"{what} is {shown(value)}, but must be a number in SI units") from None


def numbers_of(given: dict[str, Any], units: dict[str, str] | None = None) -> dict[str, Any]:
    """The parameters that are given: numbers in SI units, words as they are. `units` has the units that do not follow from the name."""
    return {
        name: value if isinstance(value, (str, bool)) else number(name, value, (units or {}).get(name))
        for name, value in given.items()
        if value is not None
    }


def shown(value: Any) -> str:
    """A value in a message: a number of numpy as a plain one."""
    return repr(value.item() if isinstance(value, np.generic) else value)


def choice(what: str, value: Any, words: Any) -> Any:
    """One of these words, a list or a Literal, or an error that names the nearest."""
    words = get_args(words) or words
    if isinstance(value, str) and value in words:
        return value
    raise CaseError(f"{what} is {value!r}, but must be {either(map(repr, words))}{meant(value, words)}")


def meant(word: Any, words: Iterable[str], alike: float = 0.6) -> str:
    """Asks for the word that a misspelt one is nearest to, where they are that much alike."""
    near = difflib.get_close_matches(word, list(words), 1, alike) if isinstance(word, str) else []
    return f"; did you mean {near[0]!r}?" if near else ""


class NotThere(FileNotFoundError, CaseError):
    """A file that is not there: an OSError, and an argument that is wrong."""


def path_of(what: str, given: Any) -> str | None:
    """A path as text; None where none is given."""
    if given is not None and not isinstance(given, (str, os.PathLike)):
        raise CaseError(f"{what} is {given!r}, but must be a path")
    return None if given is None else str(os.fspath(given))


def either(words: Iterable[str]) -> str:
    """The words as alternatives: "a, b or c"."""
    *first, last = words
    return f"{', '.join(first)} or {last}" if first else last


def distinct(what: str, given: Any, words: Sequence[str]) -> list[str]:
    """A list of some of these words, each at most once."""
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise CaseError(f"{what} is {given!r}, but must be a list, as in {what}=[{(given if isinstance(given, str) else words[0])!r}]")
    names = [str(choice(f"an entry of {what}", str(name), words)) for name in given]
    if twice := [name for name in names if names.count(name) > 1]:
        raise CaseError(f"{what} holds {twice[0]!r} twice")
    return names


def in_hertz(what: str, value: Any) -> float:
    """A frequency in Hz; a quantity may be in rad/s or rpm."""
    return number(what, frequency(what, value, angular=False))


def angle(what: str, value: Any) -> float:
    """An angle in rad; a quantity of pint, say, may be in degrees. A plain number beyond a whole turn is one in degrees, and refused."""
    if has_unit(value):
        return number(what, value, "rad")
    found = number(what, value)
    if abs(found) > 2.0 * np.pi * (1.0 + 1e-12):
        raise CaseError(f"{what} is {found:g} rad, more than a whole turn: angles are in rad; {found:g} degrees are {np.radians(found):.6g} rad (numpy.radians)")
    return found


def direction_of(value: Any) -> str | float:
    """A direction in the plane: "x", "y" or an angle from x towards y [rad]."""
    if isinstance(value, str) and value not in ("x", "y"):
        raise CaseError(f"direction is {value!r}, but must be 'x', 'y' or an angle from x towards y [rad]")
    return value if isinstance(value, str) else angle("direction", value)


def count(what: str, value: Any, least: int = 1, most: int = 2**53) -> int:
    """A whole number; one that is an integer already keeps all its digits."""
    value = bare(what, value)
    given = value if isinstance(value, (int, np.integer)) and not isinstance(value, bool) else number(what, value)
    if isinstance(given, float) and not given.is_integer():
        raise CaseError(f"{what} is {shown(value)}, but must be a whole number")
    whole = int(given)
    if not least <= whole <= most:
        limit = f"at least {least}" if whole < least else f"at most {most}"
        raise CaseError(f"{what} is {shown(value)}, but must be {limit}")
    return whole


def lengths(what: str, value: Any, dimensions: tuple[int, ...] = (1, 2)) -> tuple[float, ...]:
    """Numbers along the directions of a grid: two, along x and y, or one of a line, which may stand without a list."""
    value = bare(what, value)
    alone = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    listed = [value] if alone else list(value) if np.ndim(value) == 1 else []
    if len(listed) not in dimensions:
        raise CaseError(f"{what} is {value!r}, but must be two numbers, along x and y{', or one for a line of cells' if 1 in dimensions else ''}")
    names = [what] if len(listed) == 1 else [f"{what} along x", f"{what} along y"]
    return tuple(number(name, one) for name, one in zip(names, listed))


def pair(what: str, value: Any) -> tuple[float, float]:
    """Two numbers, along x and y."""
    x, y = lengths(what, value, (2,))
    return x, y


def cell_counts(what: str, value: Any) -> tuple[int, ...]:
    """Whole numbers along the directions of a grid, as :func:`lengths`."""
    value = bare(what, value)
    found = lengths(what, value)
    # The numbers as they were given keep all their digits.
    given = [value] if np.ndim(value) == 0 else list(value)
    return tuple(count(what, n) for n in given[: len(found)])


def along(what: str, value: Any, dimensions: int, along_y: float = 0.0) -> list[float]:
    """Two numbers of a plane; of a line the one along x, and `along_y`."""
    found = lengths(what, value)
    if len(found) != dimensions and not (dimensions == 1 and len(found) == 2 and found[1] == along_y):
        raise CaseError(f"{what} is {value!r}, but must be {'one number on a line' if dimensions == 1 else 'two numbers, along x and y'}")
    return [found[0], along_y] if dimensions == 1 else list(found)


def counts(what: str, value: Any, least: int = 1) -> tuple[int, int]:
    """Two whole numbers, along x and y."""
    x, y = pair(what, value)
    return count(f"{what} along x", x, least), count(f"{what} along y", y, least)


def plain(array: Any) -> Floats:
    """The array as the core takes it: float64, in C order, aligned (what came through a socket may not be); no copy where
    it is so."""
    return np.require(array, np.float64, ["C_CONTIGUOUS", "ALIGNED"])


def array(what: str, value: Any, unit: str | None = None) -> Floats:
    """Real numbers of any shape in SI units."""
    value = bare(what, list(value) if isinstance(value, Iterator) else value, unit)
    found = np.asarray(value)
    if found.dtype.kind not in "fiu":
        told = f"has dtype {found.dtype}" if found.ndim else f"is {value!r}"
        raise CaseError(f"{what} {told}, but must hold real numbers in SI units")
    return found.astype(np.float64, copy=False)


def frozen(values: Array) -> Array:
    """The array, read-only."""
    view = values.view()
    view.flags.writeable = False
    return view


def in_order(what: str, value: Any, size: Sequence[float] | None = None) -> Any:
    """An array of xarray with its dimensions in the order x, y and rising coordinates; anything else as it is. Where the `size` [m]
    of the domain is given, the coordinates must span it."""
    value = variable_of(what, value)
    if not is_labelled(value):
        return value
    names = [str(name) for name in value.dims]
    if len(names) > 1 and sorted(names) != ["x", "y"]:
        raise CaseError(f"{what} has the dimensions {tuple(names)}, but must have x and y, or one: select one of the others, as in isel(time=-1)")
    if len(names) == 2:
        value, names = value.transpose("x", "y"), ["x", "y"]
    for axis, name in enumerate(names):
        pitch = pitch_of(what, value, name) or 0.0
        value = value.isel({name: slice(None, None, -1)}) if pitch < 0.0 else value
        length = abs(pitch) * value.sizes[name]
        if pitch and size is not None and len(size) == len(names) and abs(length - size[axis]) > 0.1 * abs(pitch):
            raise CaseError(f"the coordinate {name} of {what} spans {length:.6g} m, but the surface is {size[axis]:.6g} m long")
    return value


def check_places(what: str, value: Any, surface: Any) -> None:
    """Refuses an array of xarray that lies beside the array of the surface, where the coordinates of both tell: a
    :class:`Surface` does not keep its place."""
    value, surface = variable_of(what, value), variable_of("surface", surface)
    if not (is_labelled(value) and is_labelled(surface)):
        return
    for name in map(str, value.dims):
        if name not in surface.dims or value.sizes[name] != surface.sizes[name]:
            continue
        pitch, other = (abs(pitch_of(what, one, name) or np.nan) for one in (value, surface))
        if not abs(pitch - other) < 1e-6 * pitch:
            continue
        starts = [float(array(name, one.coords[name], "m").min()) for one in (value, surface)]
        if abs(starts[0] - starts[1]) > 0.1 * pitch:
            raise CaseError(f"the coordinate {name} of {what} begins at {starts[0]:.6g} m, but that of the surface at {starts[1]:.6g} m")


def pitch_of(what: str, value: Any, name: str) -> float | None:
    """The distance of neighbours [m] along a dimension of an array of xarray, below zero where its coordinate falls; None without
    coordinate."""
    coords = getattr(value, "coords", {})
    if name not in coords or value.sizes[name] < 2 or coords[name].dtype.kind not in "fiu":
        return None
    places = array(name, coords[name], "m")
    pitch = float(places[-1] - places[0]) / (len(places) - 1)
    # Coordinates of single precision carry 1e-7 of their largest value.
    slack = 1e-6 * np.abs(places).max() + 1e-3 * abs(pitch)
    if pitch == 0.0 or not np.allclose(np.diff(places), pitch, rtol=0.0, atol=slack):
        raise CaseError(f"the coordinate {name} of {what} is not evenly spaced: resample it to equal cells")
    return pitch


def field(what: str, value: Any, line: bool = False, *, unit: str | None = None, size: Sequence[float] | None = None) -> Floats:
    """A two-dimensional array of real numbers as C-ordered float64 in SI units; no copy where it is one already. With `line` one
    of one dimension counts too. `unit` is by default that of the parameter; coordinates must span the `size` [m] where it is given."""
    value = in_order(what, value, size)
    if np.ma.isMaskedArray(value) and value.dtype.kind in "fiu":
        value = np.ma.filled(value.astype(np.float64), np.nan)
    found = array(what, value, unit)
    if found.ndim not in ((1, 2) if line else (2,)) or found.size == 0:
        raise CaseError(f"{what} has shape {found.shape}, but must be two-dimensional, (nx, ny){', or (n,) for a line of cells' if line else ''}")
    return plain(found)


def as_plane(array: Floats) -> Floats:
    """The array as the core takes it: that of a line, (n,), as (n, 1)."""
    return array.reshape(-1, 1) if array.ndim == 1 else array


def size_of(what: str, array: Floats, size: Any) -> list[float]:
    """The lengths of the domain [m] of an array: two of (nx, ny), one of (n,)."""
    found = lengths("size", size)
    if len(found) != array.ndim:
        words = "two lengths, size=(Lx, Ly)" if array.ndim == 2 else "one length, size=(L,)"
        raise CaseError(f"size is {size!r}, but {what} has shape {array.shape}, which needs {words}")
    for length in found:
        check_length("size", length)
    return list(found)


def check_length(what: str, length: float) -> None:
    """Refuses lengths [m] that the core does not take: products of four of them overflow or vanish."""
    if not 1e-60 <= length <= 1e60:
        raise CaseError(f"{what} is {length:g} m, but must be finite and greater than 0 m (1e-60 m to 1e60 m)")


def cells_of(array: Floats) -> str:
    """In words: 128 x 64 cells, a line of 128 cells."""
    return f"a line of {array.shape[0]} cells" if array.ndim == 1 else f"{array.shape[0]} x {array.shape[1]} cells"


def line(what: str, value: Any, unit: str | None = None) -> Floats:
    """A one-dimensional array of real numbers as float64 in SI units."""
    found = array(what, value, unit)
    if found.ndim != 1:
        raise CaseError(f"{what} has shape {found.shape}, but must be a list of real numbers")
    return plain(found)


def columns(**given: Any) -> list[Floats]:
    """One-dimensional arrays of one length."""
    found = [line(what, values) for what, values in given.items()]
    if len({len(column) for column in found}) > 1:
        told = ", ".join(f"{what} {len(column)}" for what, column in zip(given, found))
        raise CaseError(f"the columns must have the same length; there are: {told}")
    return found


def each(function: Callable[[Floats], Floats], what: str, value: Any) -> Floats:
    """The numbers of a function of a list at each number of an array of any shape."""
    at = array(what, value)
    return function(line(what, at.reshape(-1))).reshape(at.shape)


def points(what: str, value: Any, units: tuple[str, str] = ("", "")) -> list[tuple[float, float]]:
    """A list of pairs, whose numbers have these units."""
    value = list(value) if isinstance(value, Iterator) else value
    if isinstance(value, (list, tuple)) and all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in value):
        value = [tuple(bare(what, one, unit) for one, unit in zip(pair, units)) for pair in value]
    found = np.asarray(bare(what, value))
    if found.dtype.kind not in "fiu" or found.ndim != 2 or found.shape[1] != 2:
        shape = f"has the shape {found.shape}" if found.ndim else f"is {value!r}"
        raise CaseError(f"{what}: the list {shape}, but must be one of pairs of numbers")
    return [(float(a), float(b)) for a, b in found]


def centres(cells: int, length: float) -> Floats:
    """Centres of equal cells along a length; read-only."""
    return frozen(np.asarray((np.arange(cells) + 0.5) * (length / cells), dtype=np.float64))
