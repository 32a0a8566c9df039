"""The numbers of the rows: as arrays of a result, and as numbers of a step. Each is declared, so that editors and type checkers know it."""

from __future__ import annotations

from typing import Any, NoReturn, overload

from . import _core
from ._arrays import Floats
from ._units import written

#: Numbers of each row: unit and meaning.
ROW: dict[str, tuple[str, str]] = {
    "time": ("s", "time"),
    "load": ("N", "normal load"),
    "approach": ("m", "rigid-body approach"),
    "contact_area": ("m^2", "contact area"),
    "contact_area_corrected": ("m^2", "contact area corrected by its perimeter"),
    "contact_fraction": ("1", "contact area over nominal area"),
    "capped_area": ("m^2", "area at the hardness"),
    "mean_pressure": ("Pa", "load over nominal area"),
    "max_pressure": ("Pa", "largest pressure"),
    "mean_gap": ("m", "mean gap"),
    "iterations": ("1", "iterations of the solver"),
    "convolutions": ("1", "convolutions"),
    "residual": ("1", "KKT residual"),
    "certificate": ("1", "certified relative error in the energy norm"),
    "time_error": ("1", "estimated error of the stress, relative"),
    "stage": ("1", "stage of the load"),
}
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


class Column:
    """A column of the rows as attribute of their holder, which finds it by `_column(name)`; it cannot be replaced."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        unit, words = {**ROW, **QUANTITIES}.get(name, ("", name.replace("_", " ")))
        self.__doc__ = f"{words[:1].upper()}{words[1:]}{f' [{unit}]' if unit not in ('', '1') else ''}."

    @overload
    def __get__(self, holder: None, owner: type) -> Column: ...
    @overload
    def __get__(self, holder: object, owner: type) -> Floats: ...
    def __get__(self, holder: Any, owner: type) -> Column | Floats:
        if holder is None:
            return self
        values: Floats = holder._column(self._name)
        return values

    def __set__(self, holder: object, value: Any) -> NoReturn:
        raise AttributeError(f"{self._name} cannot be set: a result is what was computed; work on a copy of its numbers")


class Number:
    """A number of one row, as :class:`Column`."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        unit, words = {**ROW, **QUANTITIES}.get(name, ("", name.replace("_", " ")))
        self.__doc__ = f"{words[:1].upper()}{words[1:]}{f' [{unit}]' if unit not in ('', '1') else ''}."

    @overload
    def __get__(self, holder: None, owner: type) -> Number: ...
    @overload
    def __get__(self, holder: object, owner: type) -> float: ...
    def __get__(self, holder: Any, owner: type) -> Number | float:
        if holder is None:
            return self
        value: float = holder._number(self._name)
        return value

    def __set__(self, holder: object, value: Any) -> NoReturn:
        raise AttributeError(f"{self._name} cannot be set: a step is what was computed")
