"""Maps of force curves: modulus, and work of adhesion or exponent of a power law, at each pixel of a grid."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import Floats, centres
from ._columns import dataset
from ._core import CaseError
from ._force_curves import ForceCurve
from ._indentation import PowerLawFit, fit_indentation
from ._sealed import ReadOnlyArrays
from .plot import force_map

if TYPE_CHECKING:
    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]

#: What a map has of each fit, with the unit: the value, and the ends of its interval.
_QUANTITIES = {"young": "Pa", "work": "J/m2", "exponent": "1"}
_ENDS = ("", "_low", "_high")


@dataclass(frozen=True, eq=False)
class ForceMap(ReadOnlyArrays):
    """Maps over the pixels of a grid of force curves, [x, y]; NaN where there is no curve, or none that could be fitted. Made by
    :func:`fit_force_map`."""

    #: Young's modulus [Pa], of a power law that after 1 s, with the ends of its 95 % intervals; NaN where the record does not determine it.
    young: Floats
    young_low: Floats
    young_high: Floats
    #: Work of adhesion [J/m2] with the ends of its 95 % intervals; 0 of the model "hertz", NaN of a power law.
    work: Floats
    work_low: Floats
    work_high: Floats
    #: Exponent of a power law with the ends of its 95 % intervals; NaN of other models.
    exponent: Floats
    exponent_low: Floats
    exponent_high: Floats
    #: Depth of first touch [m].
    touch: Floats
    #: Root mean square of the distance from the curve, each channel over its range.
    relative_rms: Floats
    #: Sides of the grid [m], its outer pixels included; None where the curves do not state them.
    size: tuple[float, float] | None
    #: Pixels whose curve could not be fitted, with the reason.
    failures: dict[tuple[int, int], str]
    #: Pixels whose fit has notes, with the notes.
    notes: dict[tuple[int, int], list[str]]

    def __repr__(self) -> str:
        across, up = self.young.shape
        known = self.young[np.isfinite(self.young)]
        middle = f", median of E {np.median(known):.4g} Pa" if known.size else ""
        failed = f", {len(self.failures)} without a fit" if self.failures else ""
        return f"<ForceMap of {across} x {up} pixels{middle}{failed}>"

    def to_xarray(self) -> Any:
        """The maps as a dataset over x and y [m], pixels where the curves do not state the size of the grid."""
        units = {f"{name}{end}": unit for name, unit in _QUANTITIES.items() for end in _ENDS} | {"touch": "m", "relative_rms": "1"}
        maps: dict[str, Any] = {name: (("x", "y"), getattr(self, name).copy(), {"units": unit}) for name, unit in units.items()}
        for name, count, side in zip("xy", self.young.shape, self.size or (None, None)):
            maps[name] = (name, np.arange(count), {}) if side is None else (name, centres(count, side).copy(), {"units": "m"})
        return dataset(maps)

    def plot(self, quantity: str = "young", *, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of "young", "work" or "exponent", or of an end of their intervals ("young_low", "work_high", ...); what has no value is light, and the title
        says how many pixels that are. Further arguments go to matplotlib's ``imshow``."""
        return force_map(self, quantity, ax, style)


def fit_force_map(curves: Iterable[ForceCurve], /, *, poisson: float, model: str, **how: Any) -> ForceMap:
    """Fits each of the force curves of a grid, such as those of one file of :func:`read_force_curves`.

    A curve that cannot be fitted leaves its pixel without a value and is named in `failures`.

    Parameters
    ----------
    curves : with the place of each in its `metadata`: "grid index x", "grid index y", and, of the grid, "grid shape x", "grid shape y" and
        "grid size x", "grid size y" [m] where they are known
    poisson : Poisson's ratio
    model : "hertz", "dmt", "jkr" or "maugis", or "power-law", which takes curves with times: approach and hold
    **how : further arguments of :func:`fit_indentation`: `radius`, or `indenter` and `angle`, and others

    Raises
    ------
    CaseError : no curves, a curve without a place, two at one place, or no curve that can be fitted

    Examples
    --------
    >>> import asperity as asp, numpy as np
    >>> depth = np.linspace(0.5e-6, -0.2e-6, 200)
    >>> def curve(x, young):                                    # Hertz: 4/3 E* sqrt(R) d^(3/2)
    ...     force = 4 / 3 * young / 0.75 * np.sqrt(10e-6) * np.maximum(depth, 0.0) ** 1.5
    ...     return asp.ForceCurve(force, depth, metadata={"grid index x": x, "grid index y": 0})
    >>> found = asp.fit_force_map([curve(0, 1e6), curve(1, 2e6)], radius=10e-6, poisson=0.5, model="hertz", indenter="paraboloid")
    >>> found.young.shape, (found.young / 1e6).round(2).tolist()
    ((2, 1), [[1.0], [2.0]])
    """
    if model == "viscoelastic":
        raise CaseError('model is "viscoelastic", but a force map takes hertz, dmt, jkr, maugis or power-law: each curve may have another number of terms')
    placed: dict[tuple[int, int], ForceCurve] = {}
    for n, curve in enumerate(curves):
        if not isinstance(curve, ForceCurve):
            raise CaseError(f"curve {n} is of the type {type(curve).__name__}, but must be an asperity.ForceCurve")
        place = _place(n, curve)
        if place in placed:
            raise CaseError(f"curve {n} is at the pixel {place} of another one: a map has one curve at each")
        placed[place] = curve
    if not placed:
        raise CaseError("there are no curves")
    fits, failures = {}, {}
    for place, curve in placed.items():
        try:
            fits[place] = fit_indentation(curve, poisson=poisson, model=model, **how)  # type: ignore[call-overload]
        except CaseError as error:
            failures[place] = str(error)
    if not fits:
        place, why = next(iter(failures.items()))
        raise CaseError(f"none of the {len(placed)} curves can be fitted; at the pixel {place}: {why}")
    # As many pixels along a side as are stated, or as many as the curves need.
    stated = [[int(curve.metadata.get(f"grid shape {axis}") or 0) for curve in placed.values()] for axis in "xy"]
    shape = tuple(max([*stated[k], 1 + max(place[k] for place in placed)]) for k in (0, 1))
    maps = {name: np.full(shape, np.nan) for name in ForceMap.__annotations__ if name not in ("size", "failures", "notes")}
    for place, fit in fits.items():
        told = {"young": fit.modulus, "exponent": fit.exponent} if isinstance(fit, PowerLawFit) else {"young": fit.young, "work": fit.work}
        numbers = {name + end: value for name, interval in told.items() for end, value in zip(_ENDS, interval)}
        for name, value in {**numbers, "touch": fit.touch[0], "relative_rms": fit.relative_rms}.items():
            maps[name][place] = value
    sides: list[set[Any]] = [{curve.metadata.get(f"grid size {axis}") for curve in placed.values()} for axis in "xy"]
    known = all(len(side) == 1 and None not in side for side in sides)
    size = (float(sides[0].pop()), float(sides[1].pop())) if known else None
    return ForceMap(**maps, size=size, failures=failures, notes={place: fit.notes for place, fit in fits.items() if fit.notes})


def _place(n: int, curve: ForceCurve) -> tuple[int, int]:
    """The pixel of a curve."""
    names = ("grid index x", "grid index y")
    for name in names:
        if (value := curve.metadata.get(name)) is None:
            raise CaseError(f'curve {n} has no "{name}" in its metadata, which a map needs')
        if value != int(value) or value < 0:
            raise CaseError(f'"{name}" of curve {n} is {value}, but must be a whole number, 0 or greater')
    x, y = (int(curve.metadata[name]) for name in names)
    return x, y
