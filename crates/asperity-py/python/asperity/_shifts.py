"""How the times of a material depend on temperature: shift factors a_T.

In a thermorheologically simple material all times scale by one factor: E(t, T) = E(t/a_T, T_r). A body of changing
temperature runs on its reduced time, d xi = dt/a_T(T(t)).

Sources: M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701; L. W. Morland, E. H. Lee, Trans.
Soc. Rheology 4 (1960) 233.
"""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, array, line, number, points
from ._core import CaseError
from ._findings import ResultWarning
from ._units import carries


@dataclass(frozen=True)
class Shift:
    """A shift factor a_T over temperature [K]; made by :func:`wlf`, :func:`arrhenius`, :func:`shift_table` or a fit."""

    model: str
    numbers: tuple[float, ...]
    #: Points of a table: (temperature [K], ln a_T).
    points: tuple[tuple[float, float], ...] = ()

    def factor(self, temperature: npt.ArrayLike) -> Floats:
        """a_T at temperatures [K]: processes take a_T times as long as at the reference temperature.

        >>> import asperity as asp
        >>> round(float(asp.wlf(c1=8.86, c2=101.6, reference=293.15).factor(303.15)), 3)
        0.161
        """
        at = array("temperatures", temperature)
        out: Floats = _core.shift_factor(self._words, line("temperatures", at.reshape(-1)))
        return out.reshape(at.shape)

    @property
    def _words(self) -> tuple[str, list[float], list[tuple[float, float]]]:
        return self.model, list(self.numbers), list(self.points)

    def __repr__(self) -> str:
        if self.model == "wlf":
            c1, c2, reference = self.numbers
            return f"wlf(c1={c1!r}, c2={c2!r}, reference={reference!r})"
        if self.model == "arrhenius":
            energy, reference = self.numbers
            return f"arrhenius(activation_energy={energy!r}, reference={reference!r})"
        return f"shift_table({[(t, ln / math.log(10.0)) for t, ln in self.points]!r})"


def wlf(*, c1: float, c2: float, reference: float) -> Shift:
    """log10 a_T = -c1 (T - T_r)/(c2 + T - T_r), c2 and the reference temperature T_r in K."""
    return _checked(Shift("wlf", (number("c1", c1), number("c2", c2), _kelvin("reference", reference, 3))))


def arrhenius(*, activation_energy: float, reference: float) -> Shift:
    """ln a_T = (E_a/R)(1/T - 1/T_r), the activation energy in J/mol, the reference temperature in K."""
    numbers = (number("activation_energy", activation_energy), _kelvin("reference", reference, 3))
    return _checked(Shift("arrhenius", numbers))


def shift_table(pairs: Sequence[tuple[float, float]] | str | os.PathLike[str]) -> Shift:
    """log10 a_T, linear between (temperature [K], log10 a_T) points in order of temperature; or the path of a table of temperatures
    and shift factors with a header, in a text file or a spreadsheet, as ``asperity material fit --shift-table`` reads it.

    >>> import asperity as asp
    >>> round(float(asp.shift_table([(283.15, 1.0), (293.15, 0.0)]).factor(288.15)), 9)
    3.16227766
    """
    if isinstance(pairs, (str, os.PathLike)):
        shift = made(_core.read_shift_table(os.fspath(pairs)))
        assert shift is not None
        return shift
    ln10 = math.log(10.0)
    return _checked(Shift("table", (), tuple((t, decades * ln10) for t, decades in points("points of the shift", pairs, ("K", "")))))


#: Below this temperature no curves of a polymer are shifted [K]: it is one in degrees Celsius.
_COLD = 100.0


def _kelvin(what: str, value: Any, stacklevel: int) -> float:
    """A temperature [K], with a warning where it looks like one in degrees Celsius."""
    kelvin = number(what, value)
    if 0.0 < kelvin < _COLD and not carries(value):
        words = f"{what} is {kelvin:g} K, which is {kelvin - 273.15:g} °C: temperatures are in K, and {kelvin:g} °C is {kelvin + 273.15:g} K"
        warnings.warn(f"{words} [unlikely-unit]", ResultWarning, stacklevel=stacklevel)
    return kelvin


def _checked(shift: Shift) -> Shift:
    # The core checks the constants even where no temperature is asked for.
    _core.shift_factor(shift._words, np.empty(0))
    return shift


def made(words: tuple[str, list[float], list[tuple[float, float]]] | None) -> Shift | None:
    """The shift of the core's words."""
    if words is None:
        return None
    model, numbers, pairs = words
    return Shift(model, tuple(numbers), tuple(pairs))


def temperatures(value: float | Sequence[tuple[float, float]] | None) -> list[tuple[float, float]]:
    """A temperature of the run [K], or its (time [s], temperature [K]) points."""
    if value is None:
        return []
    if carries(value) or (not isinstance(value, (list, tuple)) and np.ndim(value) == 0):
        return [(0.0, _kelvin("temperature", value, 5))]
    pairs = points("temperature", value, ("s", "K"))
    if not pairs:
        raise CaseError("temperature holds no points: give a number [K] or (time [s], temperature [K]) pairs")
    return pairs
