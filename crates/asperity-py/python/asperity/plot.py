"""Figures of results, surfaces and fits by matplotlib (an optional dependency: pip install asperity[plot]).

Units of axes are those that suit the numbers; a second curve in the same axes has the unit of the first."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import number
from ._core import CaseError

if TYPE_CHECKING:
    from ._contact import ElasticCurve
    from ._fit import Fit
    from ._result import Result
    from ._surface import Surface

#: Prefixes by power of a thousand.
_PREFIXES = {-4: "p", -3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G"}


def _shown(largest: float, unit: str, power: int = 1) -> tuple[float, str]:
    """Factor and text of the unit that makes the largest number lie between 1 and 1000."""
    k = 0
    if np.isfinite(largest) and largest > 0:
        k = int(np.clip(np.floor((np.log10(largest) + 1e-9) / (3 * power)), -4, 0 if unit == "m" else 3))
    return 10.0 ** (-3 * k * power), f"{_PREFIXES[k]}{unit}{'²' if power == 2 else ''}"


#: Labels of the contact states, by number.
_STATES = {0: ("open", "#f0f0ee"), 1: ("contact", "#0072b2"), 2: ("at hardness", "#d55e00")}


class Plots:
    """Each method draws one figure and returns its axes; `ax` draws into axes that are there.

    Further arguments go to matplotlib: of maps to ``imshow`` (cmap, norm, vmin, vmax in SI units, alpha, ...), of curves to ``plot``
    (label, color, linestyle, marker, ...).
    """

    def __init__(self, result: Result) -> None:
        self._result = result

    def evolution(self, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> Any:
        """Contact area, approach, load and pressure over time (of a sweep over the velocity, logarithmic): four axes, in a new figure
        or the `axes` that another evolution returned."""
        result = self._result
        if axes is None:
            import matplotlib.pyplot as plt

            _, axes = plt.subplots(2, 2, figsize=(8, 5.4), layout="constrained")
        if np.size(axes) != 4:
            raise CaseError(f"axes holds {np.size(axes)} axes, but must hold four, as plt.subplots(2, 2) returns them")
        area = ("contact area", "m", 2, [("counted", "contact_area"), ("corrected", "contact_area_corrected")])
        length = ("contact length", "m", 1, [("", "contact_area")])
        panels = [
            length if result.is_line else area,
            ("approach", "m", 1, [("", "approach")]),
            ("load", result.units("load"), 1, [("", "load")]),
            ("pressure", "Pa", 1, [("mean", "mean_pressure"), ("largest", "max_pressure")]),
        ]
        over = result._table["time"]
        for ax, (title, unit, power, names) in zip(np.ravel(np.asarray(axes, dtype=object)), panels):
            largest = max(float(np.max(np.abs(getattr(result, key)), initial=0.0)) for _, key in names)
            factor, text = _scale(ax, title, largest, unit, power)
            for n, (words, key) in enumerate(names):
                told = ", ".join(part for part in (label, words) if part)
                dashed = {"linestyle": "--"} if n == 1 and "linestyle" not in style and "ls" not in style and label else {}
                ax.plot(over, getattr(result, key) * factor, label=told or None, **{**dashed, **style})
            ax.set_xlabel("velocity [m/s]" if result.is_sweep else "time [s]")
            ax.set_ylabel(f"{title} [{text}]")
            ax.margins(x=0)
            if log_time or (log_time is None and result.is_sweep):
                ax.set_xscale("log")
            if len(names) > 1 or label:
                ax.legend(frameon=False)
        return axes

    def load_displacement(self, *, ax: Any = None, **style: Any) -> Any:
        """Load over approach."""
        return _load_displacement(self._result.approach, self._result.load, self._result.units("load"), ax, style)

    def pressure(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Any = None, **style: Any) -> Any:
        """Map of the pressure at the stored time nearest to `time` [s] (of a sweep: velocity [m/s]), or with that index; default the
        last. Of a line contact a curve over x."""
        return self._map("pressure", "contact pressure", "Pa", "inferno", (time, velocity, index), ax, style)

    def gap(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Any = None, **style: Any) -> Any:
        """Map of the gap, as :meth:`pressure`."""
        return self._map("gap", "gap", "m", "viridis", (time, velocity, index), ax, style)

    def displacement(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Any = None, **style: Any
    ) -> Any:
        """Map of the displacement, as :meth:`pressure`."""
        return self._map("displacement", "displacement", "m", "viridis", (time, velocity, index), ax, style)

    def flattening(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Any = None, **style: Any
    ) -> Any:
        """Map of the permanent flattening, as :meth:`pressure`."""
        return self._map("flattening", "flattening", "m", "viridis", (time, velocity, index), ax, style)

    def contact(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Any = None, **style: Any) -> Any:
        """Map of the contact state: open, in contact, at the hardness."""
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        result, at = self._result, (time, velocity, index)
        if "contact" in result.fields:
            states = self._field("contact", at)
        else:
            states = (self._field("pressure", at) > 0).astype(float)
        ax = _axes(ax)
        self._tell(ax, at)
        if result.is_line:
            along = _shown(result.size[0], "m")
            ax.step(result.x * along[0], states, **{"where": "mid", **style})
            ax.set_xlabel(f"x [{along[1]}]")
            ax.set_yticks([0, 1, 2], [name for name, _ in _STATES.values()])
            ax.margins(x=0)
            return ax
        colours = [colour for _, colour in _STATES.values()]
        _image(ax, states, result.size, {"cmap": ListedColormap(colours), "vmin": 0, "vmax": 2, **style})
        if not style:
            held = list(_STATES.values())[: int(np.max(states, initial=0)) + 1]
            handles = [Patch(facecolor=colour, edgecolor="k", linewidth=0.4, label=name) for name, colour in held]
            ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, frameon=False)
        return ax

    def spots(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Any = None, **style: Any) -> Any:
        """Map of the contact spots by their number, the largest first, what is open left white."""
        at = (time, velocity, index)
        labels = self._result.spots(time=time, velocity=velocity, index=index)
        if self._result.is_line:
            raise CaseError("a map of the spots needs a contact over a plane; result.spots() has the numbers")
        ax = _axes(ax)
        self._tell(ax, at)
        number_ = int(labels.max(initial=0))
        # Neighbouring numbers get colours that differ, the same in each figure.
        shuffled = np.concatenate([[0], 1 + np.random.default_rng(0).permutation(number_)])
        shown = np.where(labels > 0, shuffled[labels], np.nan)
        _image(ax, shown, self._result.size, {"cmap": "turbo", "vmin": 1, "vmax": max(number_, 2), **style})
        told = "1 contact spot" if number_ == 1 else f"{number_} contact spots"
        ax.set_title(", ".join(part for part in (told, ax.get_title()) if part))
        return ax

    def profile(
        self,
        *,
        time: float | None = None,
        velocity: float | None = None,
        index: int | None = None,
        y: float | None = None,
        field: str = "pressure",
        ax: Any = None,
        **style: Any,
    ) -> Any:
        """A field along x at `y` [m]; default the pressure through the middle."""
        result, at = self._result, (time, velocity, index)
        unit = "Pa" if field == "pressure" else "1" if field == "contact" else "m"
        if result.is_line:
            return self._curve(field, unit, at, ax, style)
        values = self._field(field, at)
        place = 0.5 * result.size[1] if y is None else number("y", y)
        values = values[:, int(np.argmin(np.abs(result.y - place)))]
        return self._line(field, unit, values, at, ax, style)

    def _curve(self, name: str, unit: str, at: Any, ax: Any, style: dict[str, Any]) -> Any:
        """A field of a line contact over x."""
        values = self._field(name, at)
        return self._line(name, unit, np.where(np.isfinite(values), values, np.nan), at, ax, style)

    def _line(self, name: str, unit: str, values: Any, at: Any, ax: Any, style: dict[str, Any]) -> Any:
        result = self._result
        ax = _axes(ax)
        along = _shown(result.size[0], "m")
        factor, text = _scale(ax, name, float(np.nanmax(np.abs(values), initial=0.0)), unit)
        ax.plot(result.x * along[0], values * factor, **style)
        ax.set_xlabel(f"x [{along[1]}]")
        ax.set_ylabel(f"{name} [{text}]" if unit != "1" else name)
        ax.margins(x=0)
        if "label" in style:
            ax.legend(frameon=False)
        else:
            self._tell(ax, at)
        return ax

    def _map(self, name: str, words: str, unit: str, colours: str, at: Any, ax: Any, style: dict[str, Any]) -> Any:
        if self._result.is_line:
            return self._curve(name, unit, at, ax, style)
        values = self._field(name, at)
        ax = _axes(ax)
        self._tell(ax, at)
        image = _image(ax, np.where(np.isfinite(values), values, np.nan), self._result.size, {"cmap": colours, **style})
        _bar(ax, image, words, unit, values)
        return ax

    def _field(self, name: str, at: Any) -> Any:
        time, velocity, index = at
        return self._result.field(name, time=time, velocity=velocity, index=index)

    def _tell(self, ax: Any, at: Any) -> None:
        """The time, where there is more than one."""
        result = self._result
        if len(result.field_times) < 2:
            return
        time, velocity, index = at
        n = result._index(time if velocity is None else velocity, index)
        ax.set_title(f"v = {result.field_times[n]:.4g} m/s" if result.is_sweep else f"t = {result.field_times[n]:.4g} s")


class CurvePlots:
    """Figures of elastic contacts under a list of loads; further arguments go to ``plot`` of matplotlib."""

    def __init__(self, curve: ElasticCurve) -> None:
        self._curve = curve

    def area(self, *, corrected: bool = True, ax: Any = None, **style: Any) -> Any:
        """Contact fraction over mean pressure; with `corrected` that of the area less its perimeter's share."""
        curve, ax = self._curve, _axes(ax)
        factor, text = _scale(ax, "pressure", float(np.max(curve.mean_pressure)), "Pa")
        fraction = curve.contact_fraction
        if corrected:
            fraction = curve.contact_area_corrected / math.prod(curve[0].size)
        ax.plot(curve.mean_pressure * factor, 100 * fraction, **{"marker": ".", **style})
        ax.set_xlabel(f"mean pressure [{text}]")
        ax.set_ylabel("contact area [% of nominal]")
        if "label" in style:
            ax.legend(frameon=False)
        return ax

    def load_displacement(self, *, ax: Any = None, **style: Any) -> Any:
        """Load over approach."""
        curve = self._curve
        return _load_displacement(curve.approach, curve.load, "N/m" if curve[0].is_line else "N", ax, {"marker": ".", **style})


class SurfacePlots:
    """Each method draws one figure and returns its axes; `ax` draws into axes that are there, and further arguments go to matplotlib
    as of :class:`Plots`."""

    def __init__(self, surface: Surface) -> None:
        self._surface = surface

    def heights(self, *, ax: Any = None, **style: Any) -> Any:
        """Map of the heights about their mean, undefined points left white; of a profile a curve."""
        surface = self._surface
        z = np.where(np.isfinite(surface.heights), surface.heights, np.nan)
        z = z - np.nanmean(z)
        ax = _axes(ax)
        if surface.is_line:
            along = _shown(max(surface.size), "m")
            factor, text = _scale(ax, "height", float(np.nanmax(np.abs(z), initial=0.0)), "m")
            ax.plot(surface.x * along[0], z * factor, **style)
            ax.set_xlabel(f"x [{along[1]}]")
            ax.set_ylabel(f"height [{text}]")
            ax.margins(x=0)
            return ax
        image = _image(ax, z, surface.size, {"cmap": "viridis", **style})
        _bar(ax, image, "height", "m", z)
        return ax

    def power_spectrum(self, *, per_decade: int = 16, ax: Any = None, **style: Any) -> Any:
        """Radially averaged power spectrum over wavenumber, both logarithmic; of a profile its own."""
        q, c = self._surface.power_spectrum(per_decade)
        return _spectrum(q, c, "C1 [m³]" if self._surface.is_line else "C [m⁴]", ax, style)

    def power_spectrum_1d(self, *, direction: str = "x", ax: Any = None, **style: Any) -> Any:
        """Mean power spectrum of the profiles along "x" or "y"."""
        return _spectrum(*self._surface.power_spectrum_1d(direction), "C1 [m³]", ax, style)

    def power_spectrum_2d(self, *, ax: Any = None, **style: Any) -> Any:
        """Map of the logarithm of the power spectrum over the wavenumbers along x and y."""
        qx, qy, c = self._surface.power_spectrum_2d()
        ax = _axes(ax)
        # Below is the rounding of the transform, where a synthetic surface has no waves.
        shown = np.log10(np.where(c > 1e-20 * c.max(initial=0.0), c, np.nan))
        half = [0.5 * (q[1] - q[0]) if len(q) > 1 else 0.5 for q in (qx, qy)]
        extent = (qx[0] - half[0], qx[-1] + half[0], qy[0] - half[1], qy[-1] + half[1])
        image = ax.imshow(shown.T, **{"origin": "lower", "extent": extent, "interpolation": "nearest", "cmap": "viridis", **style})
        ax.set_xlabel("qx [1/m]")
        ax.set_ylabel("qy [1/m]")
        ax.figure.colorbar(image, ax=ax, label="log10 of the power spectrum C [m⁴]")
        return ax

    def autocorrelation(self, *, periodic: bool | None = None, ax: Any = None, **style: Any) -> Any:
        """Map of the autocorrelation function over the lags."""
        found = self._surface.autocorrelation(periodic=periodic)
        ax = _axes(ax)
        factor, text = _shown(float(max(np.abs(found.x).max(), np.abs(found.y).max())), "m")
        half = [0.5 * side / n for side, n in zip(self._surface.size, self._surface.cells)]
        extent = [end * factor for end in (found.x[0] - half[0], found.x[-1] + half[0], found.y[0] - half[1], found.y[-1] + half[1])]
        settings = {"origin": "lower", "extent": extent, "interpolation": "nearest", "cmap": "RdBu_r", "vmin": -1.0, "vmax": 1.0}
        image = ax.imshow(found.values.T, **{**settings, **style})
        ax.set_xlabel(f"lag along x [{text}]")
        ax.set_ylabel(f"lag along y [{text}]")
        ax.figure.colorbar(image, ax=ax, label="autocorrelation")
        return ax

    def height_distribution(self, *, bins: int = 100, ax: Any = None, **style: Any) -> Any:
        """Density of the points over height."""
        z, density = self._surface.height_distribution(bins)
        ax = _axes(ax)
        factor, text = _shown(float(np.max(np.abs(z), initial=0.0)), "m")
        ax.plot(z * factor, density / factor, **style)
        ax.set_xlabel(f"height [{text}]")
        ax.set_ylabel(f"density [1/{text}]")
        return ax

    def bearing_curve(self, *, ax: Any = None, **style: Any) -> Any:
        """Height over the share of the surface above it."""
        z, share = self._surface.bearing_curve()
        ax = _axes(ax)
        factor, text = _scale(ax, "height", float(np.max(np.abs(z), initial=0.0)), "m")
        ax.plot(100 * share, z * factor, **style)
        ax.set_xlabel("share of the surface above [%]")
        ax.set_ylabel(f"height [{text}]")
        ax.set_xlim(0, 100)
        return ax


def _load_displacement(approach: Any, load: Any, unit: str, ax: Any, style: dict[str, Any]) -> Any:
    ax = _axes(ax)
    across = _scale(ax, "load", float(np.max(np.abs(load), initial=0.0)), unit)
    along = _scale(ax, "approach", float(np.max(np.abs(approach), initial=0.0)), "m", axis="x")
    ax.plot(approach * along[0], load * across[0], **style)
    ax.set_xlabel(f"approach [{along[1]}]")
    ax.set_ylabel(f"load [{across[1]}]")
    if "label" in style:
        ax.legend(frameon=False)
    return ax


def _spectrum(q: Any, c: Any, words: str, ax: Any, style: dict[str, Any]) -> Any:
    ax = _axes(ax)
    # Below is the rounding of the transform, where a synthetic surface has no waves.
    seen = c > 1e-20 * np.max(c, initial=0.0)
    ax.loglog(q[seen], c[seen], **{"marker": ".", **style})
    ax.set_xlabel("wavenumber q [1/m]")
    ax.set_ylabel(f"power spectrum {words}")
    if "label" in style:
        ax.legend(frameon=False)
    return ax


def _image(ax: Any, values: Any, size: tuple[float, ...], style: dict[str, Any]) -> Any:
    """A map over the domain; its values are in SI units, so that those of norm, vmin and vmax are too."""
    lx, ly = size
    factor, text = _shown(max(lx, ly), "m")
    settings = {"origin": "lower", "extent": (0, lx * factor, 0, ly * factor), "interpolation": "nearest"}
    image = ax.imshow(values.T, **{**settings, **style})
    ax.set_xlabel(f"x [{text}]")
    ax.set_ylabel(f"y [{text}]")
    return image


def _bar(ax: Any, image: Any, words: str, unit: str, values: Any) -> None:
    """A colour bar in a unit that suits the values."""
    from matplotlib.ticker import FuncFormatter

    finite = np.abs(values[np.isfinite(values)])
    factor, text = _shown(float(finite.max(initial=0.0)), unit)
    written = FuncFormatter(lambda value, _: f"{value * factor:.6g}")
    ax.figure.colorbar(image, ax=ax, label=f"{words} [{text}]", format=written)


def _scale(ax: Any, words: str, largest: float, unit: str, power: int = 1, axis: str = "y") -> tuple[float, str]:
    """Factor and text of the unit of an axis: that of a curve which is there already, else one that suits the numbers."""
    if unit == "1":
        return 1.0, "1"
    label = ax.get_ylabel() if axis == "y" else ax.get_xlabel()
    for k, prefix in _PREFIXES.items():
        text = f"{prefix}{unit}{'²' if power == 2 else ''}"
        if label == f"{words} [{text}]":
            return 10.0 ** (-3 * k * power), text
    return _shown(largest, unit, power)


def fitted(fit: Fit, ax: Any) -> Any:
    """Points and curves of a fit."""
    ax = _axes(ax)
    dma = fit.kind == "dma"
    fine = np.geomspace(fit.x[fit.x > 0].min(), fit.x.max(), 400)
    labels = {"relaxation": ["modulus"], "creep": ["compliance"], "dma": ["storage modulus", "loss modulus"]}[fit.kind]
    for k, (label, data, curve) in enumerate(zip(labels, fit.curves, fit.curve(fine))):
        ax.loglog(fit.x, data, "o^"[k], color=f"C{k}", markersize=3, alpha=0.6, label=f"{label}, measured")
        ax.loglog(fine, curve, color=f"C{k}", label=f"{label}, fitted")
    reduced = "reduced " if fit.shift is not None else ""
    ax.set_xlabel(f"{reduced}angular frequency [rad/s]" if dma else f"{reduced}time [s]")
    letter = "E" if fit.modulus == "young" else "G"
    names = {"relaxation": f"{letter}(t) [Pa]", "creep": f"{'D' if letter == 'E' else 'J'}(t) [1/Pa]"}
    ax.set_ylabel(names.get(fit.kind, f"{letter}′, {letter}″ [Pa]"))
    ax.legend(frameon=False)
    return ax


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(layout="constrained")
    return ax
