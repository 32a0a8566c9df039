"""The numbers of the rows: as arrays of a result, and as numbers of a step. `_rows.pyi` declares each for editors and type checkers."""

from __future__ import annotations

from typing import Any, NoReturn, overload

from . import _core
from ._arrays import Floats
from ._units import written

#: Numbers of each row: unit and meaning.
ROW: dict[str, tuple[str, str]] = {name: (written(unit), words) for name, unit, words in _core.rows()}
#: Optional quantities of a row: unit and meaning.
QUANTITIES: dict[str, tuple[str, str]] = {name: (written(unit), words) for name, unit, words, _ in _core.quantities()}
#: Those of them with a number for each bin: names of dimension and ends, unit and meaning of what is counted.
HISTOGRAMS: dict[str, tuple[str, str, str, str]] = {
    "spot_histogram": ("spot_bin", "spot_edge", "m^2", "a class of spots"),
    "pressure_histogram": ("pressure_bin", "pressure_edge", "Pa", "a bin of the pressure"),
    "gap_histogram": ("gap_bin", "gap_edge", "m", "a bin of the gap"),
}
#: Units on a line contact, where forces, areas and energies are per length along y.
ON_LINE = {"N": "N/m", "m^2": "m", "J": "J/m", "N/m": "N/m^2", "N m": "N", "W": "W/m"}


def units_of(name: str, unit: str, line: bool) -> str:
    """The unit of a number of a row, of a line contact where `line`."""
    if not line:
        return unit
    # The border of a contact on a line are its ends.
    return "1" if name == "contact_perimeter" else ON_LINE.get(unit, unit)


class _Held:
    """A number or column as attribute of its holder, which finds it by a method; it cannot be replaced."""

    _find: str
    _sealed: str

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        unit, words = {**ROW, **QUANTITIES}.get(name, ("", name.replace("_", " ")))
        self.__doc__ = f"{words[:1].upper()}{words[1:]}{f' [{unit}]' if unit not in ('', '1') else ''}."

    def _of(self, holder: Any) -> Any:
        return self if holder is None else getattr(holder, self._find)(self._name)

    def __set__(self, holder: object, value: Any) -> NoReturn:
        raise AttributeError(f"{self._name} cannot be set: {self._sealed}")


class Column(_Held):
    """A column of the rows, which its holder finds by `_column(name)`."""

    _find, _sealed = "_column", "a result is what was computed; work on a copy of its numbers"

    @overload
    def __get__(self, holder: None, owner: type) -> Column: ...
    @overload
    def __get__(self, holder: object, owner: type) -> Floats: ...
    def __get__(self, holder: Any, owner: type) -> Any:
        return self._of(holder)


class Number(_Held):
    """A number of one row, which its holder finds by `_number(name)`."""

    _find, _sealed = "_number", "a step is what was computed"

    @overload
    def __get__(self, holder: None, owner: type) -> Number: ...
    @overload
    def __get__(self, holder: object, owner: type) -> float: ...
    def __get__(self, holder: Any, owner: type) -> Any:
        return self._of(holder)
