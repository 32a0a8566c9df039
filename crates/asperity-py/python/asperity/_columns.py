"""The numbers of the rows: as arrays of a result, and as numbers of a step. `_rows.pyi` declares each for editors and type checkers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from . import _core
from ._arrays import AnyArray
from ._units import written

if TYPE_CHECKING:
    import xarray


Dims = str | tuple[str, ...]
#: An array of a dataset of xarray: dimensions, values, attributes.
Variable = tuple[Dims, AnyArray, dict[str, str]]


def variable(dims: Dims, values: Any, unit: str, words: str) -> Variable:
    """A copy of the values with their unit and meaning."""
    return dims, np.array(values), {"units": unit, "long_name": words}


def dataset(arrays: dict[str, Any], coordinates: dict[str, Any] = {}, attributes: dict[str, Any] = {}) -> xarray.Dataset:
    """A dataset of these arrays."""
    import xarray

    return xarray.Dataset(arrays, coords=coordinates, attrs=attributes)


def frame(columns: dict[str, Any]) -> Any:
    """A pandas.DataFrame of these columns."""
    import pandas  # type: ignore[import-not-found,import-untyped,unused-ignore]

    return pandas.DataFrame(columns)


class Entry(NamedTuple):
    """What a column or a field of a result is."""

    #: Its unit, "1" where it has none, and that on a line contact, where forces, areas and energies are per length along y.
    unit: str
    line_unit: str
    words: str
    kind: Literal["real", "count", "vector", "histogram"]

    def variable(self, dims: Dims, values: Any, line: bool = False) -> Variable:
        """Its array in a dataset."""
        return variable(dims, values, self.line_unit if line else self.unit, self.words)

    def attributes(self, line: bool = False) -> dict[str, str]:
        """The attributes of its array in a dataset."""
        return {"units": self.line_unit if line else self.unit, "long_name": self.words}


_REGISTRY: dict[str, dict[str, Entry]] = {
    part: {name: Entry(written(unit), written(line_unit), words, kind) for name, unit, line_unit, words, kind in entries}
    for part, entries in _core.registry().items()
}
#: Numbers of each row, and optional quantities of a row.
ROW, QUANTITIES = _REGISTRY["rows"], _REGISTRY["quantities"]
COLUMNS = {**ROW, **QUANTITIES}
#: Those of them with a number for each bin.
HISTOGRAMS = [name for name, entry in QUANTITIES.items() if entry.kind == "histogram"]
#: Those with two numbers, along x and y.
VECTORS = [name for name, entry in QUANTITIES.items() if entry.kind == "vector"]
FIELDS = _REGISTRY["fields"]
#: Stress below the surface, over `field_times` and `depth`.
STRESS = _REGISTRY["stress"]
#: Numbers of the leak of a liquid, and of a gas.
LEAKS, GAS_LEAKS = _REGISTRY["leaks"], _REGISTRY["leaks of a gas"]


def told(row: dict[str, Any], line: bool) -> list[tuple[str, str]]:
    """Numbers of a row in words, with their units."""
    entries = {name: (ROW[name], ROW[name].attributes(line)["units"]) for name in row}
    return [(entry.words, f"{row[name]:.6g}{'' if unit == '1' else f' {unit}'}") for name, (entry, unit) in entries.items()]


class Held:
    """A number or column as attribute of its holder, which finds it by its method `find`. `_rows.pyi` has its type."""

    def __init__(self, find: str) -> None:
        self._find = find

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        unit, _, words, _ = {**COLUMNS, **STRESS}[name]
        self.__doc__ = f"{words[:1].upper()}{words[1:]}{f' [{unit}]' if unit != '1' else ''}."

    def __get__(self, holder: Any, owner: type) -> Any:
        return self if holder is None else getattr(holder, self._find)(self._name)
