"""Figures of results, surfaces and fits by matplotlib (an optional dependency: pip install asperity[plot])."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import number

if TYPE_CHECKING:
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


class Plots:
    """Each method draws one figure and returns its axes; `ax` draws into axes that are there."""

    def __init__(self, result: Result) -> None:
        self._result = result

    def evolution(self, *, log_time: bool = False) -> Any:
        """Contact area, approach, load and pressure over time: four axes."""
        import matplotlib.pyplot as plt

        result = self._result
        _, axes = plt.subplots(2, 2, figsize=(8, 5.4), layout="constrained")
        area = ("contact area", "m", 2, [("counted", "contact_area"), ("corrected", "contact_area_corrected")])
        length = ("contact length", "m", 1, [("", "contact_area")])
        panels = [
            length if result.is_line else area,
            ("approach", "m", 1, [("", "approach")]),
            ("load", result.units("load"), 1, [("", "load")]),
            ("pressure", "Pa", 1, [("mean", "mean_pressure"), ("largest", "max_pressure")]),
        ]
        for ax, (title, unit, power, names) in zip(axes.flat, panels):
            largest = max(float(np.max(np.abs(getattr(result, key)), initial=0.0)) for _, key in names)
            factor, text = _shown(largest, unit, power)
            for label, key in names:
                ax.plot(result.time, getattr(result, key) * factor, label=label or None)
            ax.set_xlabel("time [s]")
            ax.set_ylabel(f"{title} [{text}]")
            ax.margins(x=0)
            if log_time:
                ax.set_xscale("log")
            if len(names) > 1:
                ax.legend(frameon=False)
        return axes

    def load_displacement(self, *, ax: Any = None) -> Any:
        """Load over approach."""
        ax = _axes(ax)
        result = self._result
        along, across = (_shown(float(np.max(np.abs(v), initial=0.0)), u) for v, u in ((result.approach, "m"), (result.load, result.units("load"))))
        ax.plot(result.approach * along[0], result.load * across[0])
        ax.set_xlabel(f"approach [{along[1]}]")
        ax.set_ylabel(f"load [{across[1]}]")
        return ax

    def pressure(self, *, time: float | None = None, ax: Any = None) -> Any:
        """Map of the pressure at the stored time nearest to `time` [s]; default the last. Of a line contact a curve over x."""
        return self._map("pressure", "Pa", "inferno", time, ax)

    def gap(self, *, time: float | None = None, ax: Any = None) -> Any:
        """Map of the gap at the stored time nearest to `time` [s]; default the last."""
        return self._map("gap", "m", "viridis", time, ax)

    def displacement(self, *, time: float | None = None, ax: Any = None) -> Any:
        """Map of the displacement at the stored time nearest to `time` [s]; default the last."""
        return self._map("displacement", "m", "viridis", time, ax)

    def contact(self, *, time: float | None = None, ax: Any = None) -> Any:
        """Map of the contact state: open, in contact, at the hardness."""
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        result = self._result
        if "contact" in result.fields:
            states = result.field("contact", time=time)
        else:
            states = (result.field("pressure", time=time) > 0).astype(float)
        ax = _axes(ax)
        if result.is_line:
            along = _shown(result.size[0], "m")
            ax.step(result.x * along[0], states, where="mid")
            ax.set_xlabel(f"x [{along[1]}]")
            ax.set_yticks([0, 1, 2], ["open", "contact", "at hardness"])
            ax.margins(x=0)
            return ax
        colours = ["#f0f0ee", "#0072b2", "#d55e00"]
        self._image(ax, states, cmap=ListedColormap(colours), vmin=0, vmax=2)
        names = ["open", "contact", "at hardness"][: int(np.max(states, initial=0)) + 1]
        handles = [Patch(facecolor=c, edgecolor="k", linewidth=0.4, label=n) for c, n in zip(colours, names)]
        ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 1.12), ncols=3, frameon=False)
        return ax

    def profile(self, *, time: float | None = None, y: float | None = None, ax: Any = None) -> Any:
        """Pressure along x at `y` [m]; default through the middle."""
        result = self._result
        if result.is_line:
            return self._curve("pressure", "Pa", time, ax)
        p = result.field("pressure", time=time)
        at = 0.5 * result.size[1] if y is None else number("y", y)
        j = int(np.argmin(np.abs(result.y - at)))
        ax = _axes(ax)
        along, across = _shown(result.size[0], "m"), _shown(float(np.max(p, initial=0.0)), "Pa")
        ax.plot(result.x * along[0], p[:, j] * across[0])
        ax.set_xlabel(f"x [{along[1]}]")
        ax.set_ylabel(f"pressure [{across[1]}]")
        ax.margins(x=0)
        return ax

    def _curve(self, name: str, unit: str, time: float | None, ax: Any) -> Any:
        """A field of a line contact over x."""
        result = self._result
        values = result.field(name, time=time)
        values = np.where(np.isfinite(values), values, np.nan)
        along, across = _shown(result.size[0], "m"), _shown(float(np.nanmax(np.abs(values), initial=0.0)), unit)
        ax = _axes(ax)
        ax.plot(result.x * along[0], values * across[0])
        ax.set_xlabel(f"x [{along[1]}]")
        ax.set_ylabel(f"{name} [{across[1]}]")
        ax.margins(x=0)
        return ax

    def _map(self, name: str, unit: str, colours: str, time: float | None, ax: Any) -> Any:
        if self._result.is_line:
            return self._curve(name, unit, time, ax)
        values = self._result.field(name, time=time)
        values = np.where(np.isfinite(values), values, np.nan)
        factor, text = _shown(float(np.nanmax(np.abs(values), initial=0.0)), unit)
        ax = _axes(ax)
        image = self._image(ax, values * factor, cmap=colours)
        ax.figure.colorbar(image, ax=ax, label=f"{name} [{text}]")
        return ax

    def _image(self, ax: Any, values: Any, **style: Any) -> Any:
        lx, ly = self._result.size
        factor, text = _shown(max(lx, ly), "m")
        image = ax.imshow(values.T, origin="lower", extent=(0, lx * factor, 0, ly * factor), interpolation="nearest", **style)
        ax.set_xlabel(f"x [{text}]")
        ax.set_ylabel(f"y [{text}]")
        return image


class SurfacePlots:
    """Each method draws one figure and returns its axes; `ax` draws into axes that are there."""

    def __init__(self, surface: Surface) -> None:
        self._surface = surface

    def heights(self, *, ax: Any = None) -> Any:
        """Map of the heights about their mean, undefined points left white; of a profile a curve."""
        surface = self._surface
        z = np.where(np.isfinite(surface.heights), surface.heights, np.nan)
        z = z - np.nanmean(z)
        along = _shown(max(surface.size), "m")
        across = _shown(float(np.nanmax(np.abs(z), initial=0.0)), "m")
        ax = _axes(ax)
        if surface.is_line:
            x = (np.arange(surface.cells[0]) + 0.5) * (surface.size[0] / surface.cells[0])
            ax.plot(x * along[0], z * across[0])
            ax.set_xlabel(f"x [{along[1]}]")
            ax.set_ylabel(f"height [{across[1]}]")
            ax.margins(x=0)
            return ax
        lx, ly = (length * along[0] for length in surface.size)
        image = ax.imshow(z.T * across[0], origin="lower", extent=(0, lx, 0, ly), interpolation="nearest", cmap="viridis")
        ax.set_xlabel(f"x [{along[1]}]")
        ax.set_ylabel(f"y [{along[1]}]")
        ax.figure.colorbar(image, ax=ax, label=f"height [{across[1]}]")
        return ax

    def power_spectrum(self, *, per_decade: int = 16, ax: Any = None) -> Any:
        """Radially averaged power spectrum over wavenumber, both logarithmic."""
        q, c = self._surface.power_spectrum(per_decade)
        ax = _axes(ax)
        # Below is the rounding of the transform, where a synthetic surface has no waves.
        seen = c > 1e-20 * np.max(c, initial=0.0)
        ax.loglog(q[seen], c[seen], ".-")
        ax.set_xlabel("wavenumber q [1/m]")
        ax.set_ylabel("power spectrum C [m⁴]")
        return ax

    def bearing_curve(self, *, ax: Any = None) -> Any:
        """Height over the share of the surface above it."""
        z, share = self._surface.bearing_curve()
        across = _shown(float(np.max(np.abs(z), initial=0.0)), "m")
        ax = _axes(ax)
        ax.plot(100 * share, z * across[0])
        ax.set_xlabel("share of the surface above [%]")
        ax.set_ylabel(f"height [{across[1]}]")
        ax.set_xlim(0, 100)
        return ax


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
