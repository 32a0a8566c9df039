"""Figures of results, surfaces and fits by matplotlib (an optional dependency: pip install asperity[plot]).

Units of axes are those that suit the numbers; a second curve in the same axes has the unit of the first."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._arrays import number
from ._core import CaseError
from ._drawing import _axes, _bar, _beside, _check_style, _image, _in_si, _legend, _placed, _scale, _settle, _shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]

    from ._contact import ElasticCurve
    from ._fit import Fit
    from ._result import Result
    from ._surface import Surface
    from ._words import Axis, Field

def _told(plots: Any, missing: frozenset[str] = frozenset()) -> str:
    """Which figures there are."""
    names = [name for name, value in vars(type(plots)).items() if name[0] != "_" and callable(value) and name not in missing]
    return f"<plots: {', '.join(f'{name}()' for name in names)}>"


#: Labels of the contact states, by number.
_STATES = {0: ("open", "#f0f0ee"), 1: ("contact", "#0072b2"), 2: ("at hardness", "#d55e00")}


class Plots:
    """Each method draws one figure and returns its axes; `ax` draws into axes that are there.

    Further arguments go to matplotlib: of maps to ``imshow`` (cmap, norm, vmin, vmax in SI units, alpha, ...), of curves to ``plot``
    (label, color, linestyle, marker, ...).
    """

    def __init__(self, result: Result) -> None:
        self._result = result

    def __repr__(self) -> str:
        fields = self._result.fields
        missing = {name for name in ("pressure", "gap", "displacement", "flattening") if name not in fields}
        touching = {"pressure", "contact"} & {*fields}
        return _told(self, frozenset(missing | ({"contact", "spots"} if not touching else set()) | ({"profile"} if not fields else set())))

    def evolution(self, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> npt.NDArray[Any]:
        """Contact area, approach, load and pressure over time (of a sweep: friction in place of the load, over the velocity): four axes,
        in a new figure or the `axes` that another evolution returned. Time is logarithmic where half of the rows lie in the first tenth of the run, and where
        `log_time` says so; the row at the time 0 is not shown then."""
        result = self._result
        if "ax" in style:
            raise TypeError("evolution draws into four axes: give axes=, as plt.subplots(2, 2) returns them")
        _check_style(style)
        if axes is None:
            import matplotlib.pyplot as plt

            _, axes = plt.subplots(2, 2, figsize=(8, 5.4), layout="constrained")
        if np.size(axes) != 4:
            raise CaseError(f"axes holds {np.size(axes)} axes, but must hold four, as plt.subplots(2, 2) returns them")
        area = ("contact area", "m", 2, [("counted", "contact_area"), ("corrected", "contact_area_corrected")])
        length = ("contact length", "m", 1, [("", "contact_area")])
        load = ("load", result.units("load"), 1, [("", "load")])
        # Of a sweep, whose load is constant, the friction.
        friction = ("friction coefficient", "1", 1, [("", "friction_coefficient")])
        if "friction_coefficient_total" in result._table:
            friction[-1][:] = [("of the bulk", "friction_coefficient"), ("in total", "friction_coefficient_total")]
        panels = [
            length if result.is_line else area,
            ("approach", "m", 1, [("", "approach")]),
            friction if result.is_sweep and "friction_coefficient" in result._table else load,
            ("pressure", "Pa", 1, [("mean over the domain", "mean_pressure"), ("largest", "max_pressure")]),
        ]
        over = result._table["time"]
        drawn_before = [ax for ax in np.ravel(np.asarray(axes, dtype=object)) if ax.lines]
        if log_time is None and drawn_before:
            log_time = drawn_before[0].get_xscale() == "log"
        elif log_time is None:
            log_time = result.is_sweep or _crowds_the_start(over)
        # A logarithmic axis has no place for the row at the time 0.
        rows = over > 0 if log_time else np.full(over.shape, True)
        for ax, (title, unit, power, names) in zip(np.ravel(np.asarray(axes, dtype=object)), panels):
            largest = max(float(np.max(np.abs(getattr(result, key)), initial=0.0)) for _, key in names)
            factor, text = _scale(ax, title, largest, unit, power)
            for n, (words, key) in enumerate(names):
                told = ", ".join(str(part) for part in (label, words) if part not in (None, ""))
                given = _marked(style if n == 0 else _second(style, label), len(over[rows]))
                ax.plot(over[rows], getattr(result, key)[rows] * factor, label=told or None, **given)
            _settle(ax)
            ax.set_xlabel("velocity [m/s]" if result.is_sweep else "time [s]")
            ax.set_ylabel(title if unit == "1" else f"{title} [{text}]")
            if log_time:
                # What another evolution has at the time 0 has no place here either.
                ax.set_xscale("log", nonpositive="mask")
            if len(names) > 1 or label:
                _legend(ax)
        drawn: npt.NDArray[Any] = np.asarray(axes, dtype=object)
        return drawn

    def load_displacement(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Load over approach."""
        return _load_displacement(self._result.approach, self._result.load, self._result.units("load"), ax, style)

    def pressure(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the pressure at the stored time nearest to `time` [s] (of a sweep: velocity [m/s]), or with that index; default the
        last. Of a line contact a curve over x."""
        return self._map("pressure", "contact pressure", "Pa", "inferno", (time, velocity, index), ax, style)

    def gap(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the gap, as :meth:`pressure`."""
        return self._map("gap", "gap", "m", "viridis", (time, velocity, index), ax, style)

    def displacement(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any
    ) -> Axes:
        """Map of the displacement, as :meth:`pressure`."""
        return self._map("displacement", "displacement", "m", "viridis", (time, velocity, index), ax, style)

    def flattening(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any
    ) -> Axes:
        """Map of the permanent flattening, as :meth:`pressure`."""
        return self._map("flattening", "flattening", "m", "viridis", (time, velocity, index), ax, style)

    def contact(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the contact state: open, in contact, at the hardness."""
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        result, at = self._result, (time, velocity, index)
        if "contact" in result.fields:
            states = self._field("contact", at)
        else:
            states = (self._field("pressure", at) > 0).astype(float)
        ax = _axes(ax, style, "curve" if result.is_line else "map")
        self._tell(ax, at)
        if result.is_line:
            along = _shown(result.size[0], "m")
            ax.step(result.x * along[0], states, **{"where": "mid", **style})
            ax.set_xlabel(f"x [{along[1]}]")
            shown = range(max(2, int(np.max(states, initial=0)) + 1))
            ax.set_yticks(list(shown), [_STATES[state][0] for state in shown])
            return ax
        colours = [colour for _, colour in _STATES.values()]
        _image(ax, states, result.size, {"cmap": ListedColormap(colours), "vmin": 0, "vmax": 2, **style})
        if not style:
            held = list(_STATES.values())[: int(np.max(states, initial=0)) + 1]
            handles = [Patch(facecolor=colour, edgecolor="k", linewidth=0.4, label=name) for name, colour in held]
            ax.legend(handles=handles, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
        return ax

    def spots(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the contact spots by their number, the largest first, what is open left white."""
        at = (time, velocity, index)
        labels = self._result.spots(time=time, velocity=velocity, index=index)
        if self._result.is_line:
            raise CaseError("a map of the spots needs a contact over a plane; result.spots() has the numbers")
        ax = _axes(ax, style, "map")
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
        field: Field = "pressure",
        ax: Axes | None = None,
        **style: Any,
    ) -> Axes:
        """A field along x at `y` [m]; default the pressure through the middle."""
        result, at = self._result, (time, velocity, index)
        unit = "Pa" if field == "pressure" else "1" if field == "contact" else "m"
        if result.is_line:
            return self._curve(field, unit, at, ax, style)
        values = self._field(field, at)
        place = 0.5 * result.size[1] if y is None else number("y", y)
        if not 0 <= place <= result.size[1]:
            raise CaseError(f"y is {place:g} m, but must lie in the domain, 0 m to {result.size[1]:g} m")
        row = int(np.argmin(np.abs(result.y - place)))
        factor, text = _shown(max(result.size), "m")
        return self._line(field, unit, values[:, row], at, ax, style, f"y = {result.y[row] * factor:.4g} {text}")

    def _curve(self, name: str, unit: str, at: Any, ax: Axes | None, style: dict[str, Any]) -> Axes:
        """A field of a line contact over x."""
        values = self._field(name, at)
        return self._line(name, unit, np.where(np.isfinite(values), values, np.nan), at, ax, style)

    def _line(self, name: str, unit: str, values: Any, at: Any, ax: Axes | None, style: dict[str, Any], place: str = "") -> Axes:
        result = self._result
        ax = _axes(ax, style)
        along = _shown(result.size[0], "m")
        factor, text = _scale(ax, name, float(np.nanmax(np.abs(values), initial=0.0)), unit)
        ax.plot(result.x * along[0], values * factor, **style)
        ax.set_xlabel(f"x [{along[1]}]")
        ax.set_ylabel(f"{name} [{text}]" if unit != "1" else name)
        if "label" in style:
            _legend(ax)
        else:
            self._tell(ax, at, place)
        return ax

    def _map(self, name: str, words: str, unit: str, colours: str, at: Any, ax: Axes | None, style: dict[str, Any]) -> Axes:
        if self._result.is_line:
            return self._curve(name, unit, at, ax, style)
        values = self._field(name, at)
        ax = _axes(ax, style, "map")
        self._tell(ax, at)
        style = _in_si(style, unit)
        shown = np.where(np.isfinite(values), values, np.nan)
        if name == "pressure" and np.any(values > 0):
            if not {"norm", "vmin"} & style.keys():
                # What is out of contact is no small pressure: it lies below the scale.
                style = {**style, "vmin": np.finfo(float).tiny, "cmap": _with_under(style.get("cmap", colours), _STATES[0][1])}
        elif name == "pressure":
            ax.set_title(", ".join(part for part in ("no contact", ax.get_title()) if part))
        image = _image(ax, shown, self._result.size, {"cmap": colours, **style})
        _bar(ax, image, words, unit, values)
        return ax

    def _field(self, name: Any, at: Any) -> Any:
        time, velocity, index = at
        return self._result.field(name, time=time, velocity=velocity, index=index)

    def _tell(self, ax: Any, at: Any, place: str = "") -> None:
        """The place, and the time where there is more than one."""
        result, when = self._result, ""
        if len(result.field_times) > 1:
            time, velocity, index = at
            n = result._index(time if velocity is None else velocity, index)
            when = f"v = {result.field_times[n]:.4g} m/s" if result.is_sweep else f"t = {result.field_times[n]:.4g} s"
        if told := ", ".join(part for part in (place, when) if part):
            ax.set_title(told)


def _with_under(colours: Any, under: str) -> Any:
    """A colour map, or that of this name, with a colour of its own for what lies below its scale."""
    from matplotlib import colormaps

    return (colormaps[colours] if isinstance(colours, str) else colours).with_extremes(under=under)


def _marked(style: dict[str, Any], points: int) -> dict[str, Any]:
    """The style of a curve; one of a single point is seen by its marker only."""
    return style if points != 1 else {"marker": "o", **style}


def _second(style: dict[str, Any], label: str | None) -> dict[str, Any]:
    """The style of the second curve of axes, which must differ from the first: by its line where colours are given or count the runs."""
    if not label and "color" not in style and "c" not in style:
        return style
    line = style.get("linestyle", style.get("ls", "-"))
    rest = {key: value for key, value in style.items() if key not in ("linestyle", "ls")}
    if line in ("", " ", "none", "None"):
        return {**style, "markerfacecolor": "none"}
    return {**rest, "linestyle": ":" if line in ("--", "dashed") else "--"}


def _crowds_the_start(times: Any) -> bool:
    """Whether half of the times lie in the first tenth of the run: a linear axis would draw them on top of one another."""
    after = times[times > 0]
    return len(after) > 4 and bool(after[len(after) // 2] < 0.1 * after[-1])


class CurvePlots:
    """Figures of elastic contacts under a list of loads; further arguments go to ``plot`` of matplotlib."""

    def __init__(self, curve: ElasticCurve) -> None:
        self._curve = curve

    def __repr__(self) -> str:
        return _told(self)

    def area(self, *, corrected: bool = True, ax: Axes | None = None, **style: Any) -> Axes:
        """Contact fraction over mean pressure; with `corrected` that of the area less its perimeter's share."""
        curve, ax = self._curve, _axes(ax, style)
        factor, text = _scale(ax, "pressure", float(np.max(curve.mean_pressure)), "Pa")
        fraction = curve.contact_fraction
        if corrected:
            fraction = curve.contact_area_corrected / math.prod(curve[0].size)
        ax.plot(curve.mean_pressure * factor, 100 * fraction, **{"marker": ".", **style})
        ax.set_xlabel(f"mean pressure [{text}]")
        ax.set_ylabel(f"{'corrected ' if corrected else ''}contact area [% of nominal]")
        if "label" in style:
            _legend(ax)
        return ax

    def load_displacement(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Load over approach."""
        curve = self._curve
        return _load_displacement(curve.approach, curve.load, "N/m" if curve[0].is_line else "N", ax, {"marker": ".", **style})


class SurfacePlots:
    """Each method draws one figure and returns its axes; `ax` draws into axes that are there, and further arguments go to matplotlib
    as of :class:`Plots`."""

    def __init__(self, surface: Surface) -> None:
        self._surface = surface

    def __repr__(self) -> str:
        return _told(self)

    def heights(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the heights about their mean, undefined points left white; of a profile a curve."""
        surface = self._surface
        z = np.where(np.isfinite(surface.heights), surface.heights, np.nan)
        z = z - np.nanmean(z)
        ax = _axes(ax, style, "curve" if surface.is_line else "map")
        if surface.is_line:
            along = _shown(max(surface.size), "m")
            factor, text = _scale(ax, "height", float(np.nanmax(np.abs(z), initial=0.0)), "m")
            ax.plot(surface.x * along[0], z * factor, **style)
            ax.set_xlabel(f"x [{along[1]}]")
            ax.set_ylabel(f"height [{text}]")
            return ax
        image = _image(ax, z, surface.size, {"cmap": "viridis", **_in_si(style, "m")})
        _bar(ax, image, "height", "m", z)
        return ax

    def power_spectrum(self, *, per_decade: int = 16, ax: Axes | None = None, **style: Any) -> Axes:
        """Radially averaged power spectrum over wavenumber, both logarithmic; of a profile its own."""
        q, c = self._surface.power_spectrum(per_decade)
        return _spectrum(q, c, "C1 [m³]" if self._surface.is_line else "C [m⁴]", ax, style)

    def power_spectrum_1d(self, *, direction: Axis = "x", ax: Axes | None = None, **style: Any) -> Axes:
        """Mean power spectrum of the profiles along "x" or "y"."""
        return _spectrum(*self._surface.power_spectrum_1d(direction), "C1 [m³]", ax, style)

    def power_spectrum_2d(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the logarithm of the power spectrum over the wavenumbers along x and y."""
        qx, qy, c = self._surface.power_spectrum_2d()
        ax = _axes(ax, style, "map")
        # Below is the rounding of the transform, where a synthetic surface has no waves.
        shown = np.log10(np.where(c > 1e-20 * c.max(initial=0.0), c, np.nan))
        half = [0.5 * (q[1] - q[0]) if len(q) > 1 else 0.5 for q in (qx, qy)]
        # Wave numbers of 1/µm, 1/mm or 1/m.
        longest = max(qx[-1] + half[0], qy[-1] + half[1])
        factor, text = (1e-6, "µm") if longest >= 1e6 else (1e-3, "mm") if longest >= 1e3 else (1.0, "m")
        extent = tuple(end * factor for end in (qx[0] - half[0], qx[-1] + half[0], qy[0] - half[1], qy[-1] + half[1]))
        image = ax.imshow(shown.T, **_placed(extent, {"cmap": "viridis", **style}))
        ax.set_xlabel(f"qx [1/{text}]")
        ax.set_ylabel(f"qy [1/{text}]")
        _beside(ax, image, "log10 of the power spectrum C [m⁴]")
        return ax

    def autocorrelation(self, *, periodic: bool | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the autocorrelation function over the lags."""
        found = self._surface.autocorrelation(periodic=periodic)
        ax = _axes(ax, style, "map")
        factor, text = _shown(float(max(np.abs(found.x).max(), np.abs(found.y).max())), "m")
        half = [0.5 * side / n for side, n in zip(self._surface.size, self._surface.cells)]
        extent = [end * factor for end in (found.x[0] - half[0], found.x[-1] + half[0], found.y[0] - half[1], found.y[-1] + half[1])]
        image = ax.imshow(found.values.T, **_placed(extent, {"cmap": "RdBu_r", "vmin": -1.0, "vmax": 1.0, **style}))
        ax.set_xlabel(f"lag along x [{text}]")
        ax.set_ylabel(f"lag along y [{text}]")
        _beside(ax, image, "autocorrelation")
        return ax

    def height_distribution(self, *, bins: int = 100, ax: Axes | None = None, **style: Any) -> Axes:
        """Density of the points over height."""
        z, density = self._surface.height_distribution(bins)
        ax = _axes(ax, style)
        factor, text = _shown(float(np.max(np.abs(z), initial=0.0)), "m")
        ax.plot(z * factor, density / factor, **style)
        ax.set_xlabel(f"height [{text}]")
        ax.set_ylabel(f"density [1/{text}]")
        return ax

    def bearing_curve(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Height over the share of the surface above it."""
        z, share = self._surface.bearing_curve()
        ax = _axes(ax, style)
        factor, text = _scale(ax, "height", float(np.max(np.abs(z), initial=0.0)), "m")
        ax.plot(100 * share, z * factor, **style)
        ax.set_xlabel("share of the surface above [%]")
        ax.set_ylabel(f"height [{text}]")
        ax.set_xlim(0, 100)
        return ax


def _load_displacement(approach: Any, load: Any, unit: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    ax = _axes(ax, style)
    across = _scale(ax, "load", float(np.max(np.abs(load), initial=0.0)), unit)
    along = _scale(ax, "approach", float(np.max(np.abs(approach), initial=0.0)), "m", axis="x")
    ax.plot(approach * along[0], load * across[0], **_marked(style, len(load)))
    ax.set_xlabel(f"approach [{along[1]}]")
    ax.set_ylabel(f"load [{across[1]}]")
    if "label" in style:
        _legend(ax)
    return ax


def _two_or_five(value: float) -> str:
    """2 and 5 times a power of ten in the words of matplotlib; nothing for other numbers."""
    power = math.floor(math.log10(value) + 1e-9) if value > 0 else 0
    first = round(value / 10.0**power)
    return f"${first}\\times10^{{{power}}}$" if first in (2, 5) else ""


def _spectrum(q: Any, c: Any, words: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    from matplotlib.ticker import FuncFormatter

    ax = _axes(ax, style)
    # Below is the rounding of the transform, where a synthetic surface has no waves.
    seen = c > 1e-20 * np.max(c, initial=0.0)
    ax.loglog(q[seen], c[seen], **{"marker": ".", **style})
    ends = ax.get_xlim()
    few = ends[1] < 300.0 * ends[0]
    # Within a decade or two there are few powers of ten; all numbers between them would overlap.
    ax.xaxis.set_minor_formatter(FuncFormatter(lambda value, _: _two_or_five(value) if few else ""))
    ax.set_xlabel("wavenumber q [1/m]")
    ax.set_ylabel(f"power spectrum {words}")
    if "label" in style:
        _legend(ax)
    return ax


def fitted(fit: Fit, ax: Axes | None) -> Any:
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
    _legend(ax)
    return ax
