"""What all figures share: units of axes, maps with their colour bars, legends, and the arguments of matplotlib."""

from __future__ import annotations

import difflib
import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import number

if TYPE_CHECKING:
    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]

#: Prefixes by power of a thousand.
_PREFIXES = {-4: "p", -3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G"}


def _shown(largest: float, unit: str, power: int = 1) -> tuple[float, str]:
    """Factor and text of the unit that makes the largest number lie between 1 and 1000, of areas between 0.01 and 10000."""
    k = 0
    if np.isfinite(largest) and largest > 0:
        # Areas change by a million from unit to unit: from 0.01 mm² on they are in mm².
        shift = 0 if power == 1 else 2
        k = int(np.clip(np.floor((np.log10(largest) + shift + 1e-9) / (3 * power)), -4, 0 if unit == "m" else 3))
    return 10.0 ** (-3 * k * power), f"{_PREFIXES[k]}{unit}{'²' if power == 2 else ''}"


def _image(ax: Any, values: Any, size: tuple[float, ...], style: dict[str, Any]) -> Any:
    """A map over the domain; its values are in SI units, so that those of norm, vmin and vmax are too."""
    lx, ly = size
    factor, text = _shown(max(lx, ly), "m")
    image = ax.imshow(values.T, **_placed((0, lx * factor, 0, ly * factor), style))
    ax.set_xlabel(f"x [{text}]")
    ax.set_ylabel(f"y [{text}]")
    return image


def _placed(extent: Any, style: dict[str, Any]) -> dict[str, Any]:
    """Arguments of a map whose axes run along x and y, upwards unless `origin` says so."""
    left, right, bottom, top = extent
    if style.get("origin") == "upper":
        bottom, top = top, bottom
    return {"origin": "lower", "extent": (left, right, bottom, top), "interpolation": "nearest", **style}


def _bar(ax: Any, image: Any, words: str, unit: str, values: Any) -> None:
    """A colour bar in a unit that suits the values."""
    from matplotlib.ticker import FuncFormatter

    finite = values[np.isfinite(values)]
    factor, text = _shown(float(np.abs(finite).max(initial=0.0)), unit)
    written = FuncFormatter(lambda value, _: f"{value * factor + 0.0:.6g}".replace("-", "\N{MINUS SIGN}"))
    low, high = image.get_clim()
    if finite.size and np.ptp(finite) == 0.0 and low == high:
        # One value everywhere: the colours have no width of their own.
        only = float(finite.flat[0])
        image.set_clim(only, only + 1.0)
        _beside(ax, image, f"{words} [{text}]", format=written, ticks=[only])
        return
    _beside(ax, image, f"{words} [{text}]", format=written)


def _beside(ax: Any, image: Any, label: str, **keys: Any) -> None:
    """A colour bar, about as high as the map: a wide map fills a part of the height of its axes only."""
    left, right, bottom, top = image.get_extent()
    place = ax.get_window_extent()
    # The bar takes a sixth of the width.
    share = min(1.0, 0.83 * place.width / place.height * abs((top - bottom) / (right - left)))
    ax.figure.colorbar(image, ax=ax, label=label, shrink=share, aspect=max(20.0 * share, 4.0), **keys)


def _legend(ax: Any) -> None:
    """A legend above the axes, where it covers no curve."""
    ax.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.1, fontsize="small")


def _in_si(style: dict[str, Any], unit: str) -> dict[str, Any]:
    """Limits of a map in SI units, where they carry units."""
    return {key: number(key, value, unit) if key in ("vmin", "vmax") and value is not None else value for key, value in style.items()}


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


def _settle(ax: Any) -> None:
    """Limits about curves that are constant but for rounding errors, which would fill the axes; a curve that is added later scales
    them anew."""
    drawn = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in ax.lines])
    finite = drawn[np.isfinite(drawn)]
    if ax.get_autoscaley_on() and finite.size and 0.0 < np.ptp(finite) <= 1e-6 * np.abs(finite).max():
        middle = float(finite.mean())
        ax.set_ylim(middle - 0.05 * abs(middle), middle + 0.05 * abs(middle), auto=True)


@functools.cache
def _takes(kind: str) -> frozenset[str]:
    """What the methods `plot` and `imshow` of matplotlib take."""
    import inspect

    from matplotlib.artist import ArtistInspector  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from matplotlib.image import AxesImage  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from matplotlib.lines import Line2D  # type: ignore[import-not-found,import-untyped,unused-ignore]

    artist, method = (AxesImage, Axes.imshow) if kind == "map" else (Line2D, Axes.plot)
    inspector = ArtistInspector(artist)
    aliases = {alias for names in inspector.aliasd.values() for alias in names}
    return frozenset({*inspector.get_setters(), *aliases, *inspect.signature(method).parameters, "where"} - {"self", "args", "kwargs", "X"})


def _check_style(style: dict[str, Any], kind: str = "curve") -> None:
    """Refuses what matplotlib does not take for a "curve" or a "map"."""
    for name in style:
        if name not in _takes(kind):
            near = difflib.get_close_matches(name, sorted(_takes(kind)), 1, 0.5)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise TypeError(f"a {kind} takes no argument {name!r}{hint}")


def _axes(ax: Axes | None, style: dict[str, Any] | None = None, kind: str = "curve") -> Axes:
    """The axes to draw into, new ones by default, once the `style` is one that matplotlib takes."""
    _check_style(style or {}, kind)
    if ax is None:
        import matplotlib.pyplot as plt

        _, ax = plt.subplots(layout="constrained")
    return ax
