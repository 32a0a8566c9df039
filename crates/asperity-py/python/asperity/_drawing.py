"""What all figures share: units of axes, maps with their colour bars, legends, and the arguments of matplotlib."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import meant, number
from ._prefixes import prefixed, shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]

#: The longer side of a drawn map is at most this many times the shorter one: narrower maps are stretched.
_STRIP = 8.0
#: A map this many times wider than high has its colour bar below.
_WIDE = 3.0
#: Share of the values that may lie beyond either end of the colours.
_OUTLIERS = 1e-3


def _drawn(size: tuple[float, ...]) -> list[float]:
    """The sides of a map as they are drawn, in the unit of its size."""
    return [max(side, max(size) / _STRIP) for side in size]


def stretched(size: tuple[float, ...], style: dict[str, Any]) -> str:
    """Which side of a map is stretched, in words; nothing where none is, or where the arguments of matplotlib give its aspect."""
    if "aspect" in style:
        return ""
    for name, side, drawn in zip("xy", size, _drawn(size)):
        if (times := drawn / side) > 1.0 + 1e-9:
            return f"{name} stretched {times:.2g} times" if times < 10 else f"{name} stretched {times:.0f} times"
    return ""


def draw_map(ax: Any, values: Any, size: tuple[float, ...], style: dict[str, Any]) -> Any:
    """A map over the domain; its values are in SI units, so that those of norm, vmin and vmax are too."""
    narrow = bool(stretched(size, style))
    # Both axes have the same unit, except on a narrow domain.
    (across, x_unit), (up, y_unit) = (shown(side if narrow else max(size), "m") for side in size)
    image = placed(ax, values, (0, size[0] * across, 0, size[1] * up), size, style)
    ax.set(xlabel=f"x [{x_unit}]", ylabel=f"y [{y_unit}]")
    return image


def placed(ax: Any, values: Any, extent: Any, size: tuple[float, ...], style: dict[str, Any]) -> Any:
    """A map whose axes run along x and y, upwards unless `origin` says so; `size` has its sides, both in one unit."""
    left, right, bottom, top = extent
    given = {"origin": "lower", "interpolation": "nearest", **style}
    if narrow := stretched(size, style):
        wide, high = _drawn(size)
        given["aspect"] = high / wide * (right - left) / (top - bottom)
    if given["origin"] == "upper":
        bottom, top = top, bottom
    image = ax.imshow(values.T, **{"extent": (left, right, bottom, top), **given})
    if narrow:
        # Few numbers have room along the narrow side.
        ax.locator_params(axis=narrow[0], nbins=2)
    return image


def centred(ax: Any, values: Any, x: Any, y: Any, factor: float, size: tuple[float, ...], style: dict[str, Any]) -> Any:
    """A map over the middles `x` and `y` of its cells, times a factor."""
    ends = [end for q in (x, y) for half in [0.5 * (q[1] - q[0]) if len(q) > 1 else 0.5] for end in (q[0] - half, q[-1] + half)]
    return placed(ax, values, [end * factor for end in ends], size, style)


def robust(values: Any, style: dict[str, Any]) -> dict[str, Any]:
    """The style of a map with ends of the colours at the quantiles of a thousandth and of all but a thousandth, where a few pits or
    spikes take more than a third of the range of the values; the style as it is where it has ends."""
    finite = values[np.isfinite(values)]
    if finite.size <= 1000 or {"norm", "vmin", "vmax"} & style.keys():
        return style
    low, high = np.quantile(finite, [_OUTLIERS, 1.0 - _OUTLIERS], method="nearest")
    return {**style, "vmin": low, "vmax": high} if high > low and np.ptp(finite) > 1.5 * (high - low) else style


def coloured(colours: Any, **extremes: str) -> Any:
    """A colour map, or that of this name, with colours of their own for what lies below its scale ("under"), or is undefined ("bad")."""
    from matplotlib import colormaps

    return (colormaps[colours] if isinstance(colours, str) else colours).with_extremes(**extremes)


def bar(ax: Any, image: Any, words: str, unit: str) -> None:
    """A colour bar in a unit that suits the ends of the colours."""
    from matplotlib.ticker import FuncFormatter

    low, high = image.get_clim()
    values = np.ma.filled(image.get_array(), np.nan)
    finite = values[np.isfinite(values)]
    factor, text = shown(float(max(abs(low), abs(high))), unit)
    written = FuncFormatter(lambda value, _: f"{value * factor + 0.0:.6g}".replace("-", "\N{MINUS SIGN}"))
    if finite.size and np.ptp(finite) == 0.0 and low == high:
        # One value everywhere: the colours have no width of their own.
        only = float(finite.flat[0])
        image.set_clim(only, only + 1.0)
        beside(ax, image, f"{words} [{text}]", format=written, ticks=[only])
        return
    # What is left open lies below the scale too; pits and spikes lie more than half of a colour beyond it.
    room = (high - low) / 512.0
    below, above = bool(np.any((finite < low - room) & (finite != 0.0))), bool(np.any(finite > high + room))
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[below, above]
    beside(ax, image, f"{words} [{text}]", format=written, extend=extend)


def beside(ax: Any, image: Any, label: str, **keys: Any) -> None:
    """A colour bar, about as high as the map, which may fill a part of its axes only; below a map that is wide."""
    left, right, bottom, top = image.get_extent()
    place, aspect = ax.get_window_extent(), ax.get_aspect()
    shape = place.height / place.width if aspect == "auto" else aspect * abs((top - bottom) / (right - left))
    if shape < 1.0 / _WIDE:
        ax.figure.colorbar(image, ax=ax, label=label, location="bottom", aspect=40.0, **keys)
        return
    # The bar takes a sixth of the width.
    share = min(1.0, 0.83 * place.width / place.height * shape)
    ax.figure.colorbar(image, ax=ax, label=label, shrink=share, aspect=max(20.0 * share, 4.0), **keys)


def draw_legend(ax: Any, kinds: Sequence[str] = ()) -> None:
    """A legend above the axes, where it covers no curve, in as many columns and letters as large as its width lets it have; `kinds` are
    the names of the curves that each run has."""
    handles = _by_run_and_kind(ax.lines, kinds) or [line for line in ax.lines if not line.get_label().startswith("_")]
    # A layout that is made later gives axes about a sixth more.
    room = ax.get_window_extent().width * (1.15 if ax.figure.get_layout_engine() else 1.0)
    letters = 0.83 * letter_size()
    for columns in (3, 2, 1):
        wide = _legend_of(ax, handles, columns, letters)
        if wide <= room:
            return
    _legend_of(ax, handles, 1, letters * max(room / wide, 0.6))


def name_runs(ax: Any, style: dict[str, Any]) -> None:
    """A legend where the curve that was drawn has a label."""
    if "label" in style:
        draw_legend(ax)


def _legend_of(ax: Any, handles: list[Any], columns: int, letters: float) -> float:
    """Draws a legend above the axes; returns its width in pixels."""
    place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.1}
    legend = ax.legend(handles=handles, frameon=False, ncols=columns, fontsize=letters, columnspacing=1.2, **place)
    return float(legend.get_window_extent().width)


def _by_run_and_kind(lines: Any, kinds: Sequence[str]) -> list[Any]:
    """Of curves with labels such as "soft, largest" one entry for each run, in its colour, and one in grey for each kind of curve; none
    where there is only one run, or where runs differ by more than their colours."""
    from matplotlib.lines import Line2D  # type: ignore[import-not-found,import-untyped,unused-ignore]

    runs: dict[str, Any] = {}
    looks: dict[str, Any] = {}
    for line in lines:
        run, _, kind = line.get_label().rpartition(", ")
        look = {"linestyle": line.get_linestyle(), "marker": line.get_marker(), "fillstyle": line.get_fillstyle()}
        if kind not in kinds:
            run = line.get_label()
        elif looks.setdefault(kind, look) != look:
            return []
        runs.setdefault(run, line.get_color())
    if not looks or len(runs) < 2 or "" in runs or len(set(runs.values())) < len(runs):
        return []
    coloured = [Line2D([], [], color=colour, label=run) for run, colour in runs.items()]
    return [*coloured, *(Line2D([], [], color="0.5", label=kind, **look) for kind, look in looks.items())]


def letter_size() -> float:
    """Size of the usual letters in points."""
    import matplotlib.pyplot as plt

    return float(plt.rcParams["font.size"])


def in_si(style: dict[str, Any], unit: str) -> dict[str, Any]:
    """Limits of a map in SI units, where they carry units."""
    return {key: number(key, value, unit) if key in ("vmin", "vmax") and value is not None else value for key, value in style.items()}


def scale(ax: Any, axis: str, words: str, unit: str, *values: Any, power: int = 1, log: bool = False) -> float:
    """Labels an axis with its unit and returns the factor of that unit: the unit of a curve which is there already, else one that suits
    the `values`. A logarithmic axis has powers of ten as its numbers, and needs none in its unit."""
    label, set_label = (ax.get_ylabel(), ax.set_ylabel) if axis == "y" else (ax.get_xlabel(), ax.set_xlabel)
    if unit == "1":
        set_label(words)
        return 1.0
    suited = prefixed if log else shown
    usual = (suited(10.0**tens, unit, power) for tens in range(-60, 61))
    factor, text = next((one for one in usual if label == f"{words} [{one[1]}]"), suited(magnitude(*values), unit, power))
    set_label(f"{words} [{text}]")
    return factor


def magnitude(*values: Any) -> float:
    """The largest magnitude of the finite numbers."""
    return max((float(np.max(np.abs(v[np.isfinite(v)]), initial=0.0)) for v in map(np.asarray, values)), default=0.0)


def is_constant(values: Any) -> bool:
    """Whether numbers differ by rounding errors only."""
    finite = values[np.isfinite(values)]
    return bool(finite.size and np.ptp(finite) <= 1e-6 * np.abs(finite).max())


def settle(ax: Any, axis: str = "y") -> None:
    """Sets limits around curves whose numbers differ by rounding errors only, which would otherwise fill the axes; 0 to 1 for zeros. A
    curve that is added later scales the axes again."""
    drawn = np.concatenate([np.asarray(line.get_data()[axis == "y"], dtype=float) for line in ax.lines])
    free, limit = (ax.get_autoscaley_on(), ax.set_ylim) if axis == "y" else (ax.get_autoscalex_on(), ax.set_xlim)
    if not free or not is_constant(drawn):
        return
    middle = float(np.nanmean(drawn[np.isfinite(drawn)]))
    low, high = (0.0, 1.0) if middle == 0.0 else sorted((0.9 * middle, 1.1 * middle))
    limit(low, high, auto=True)


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


def check_style(style: dict[str, Any], kind: str = "curve") -> None:
    """Refuses what matplotlib does not take for a "curve" or a "map"."""
    for name in style:
        if name not in _takes(kind):
            raise TypeError(f"a {kind} takes no argument {name!r}{meant(name, sorted(_takes(kind)), 0.5)}")


def axes(ax: Axes | None, style: dict[str, Any] | None = None, kind: str = "curve", size: tuple[float, ...] = (1.0, 1.0)) -> Axes:
    """The axes to draw into, new ones by default, once the `style` is one that matplotlib takes. A new figure of a long map of this
    `size` is lower, or narrower, than others."""
    check_style(style or {}, kind)
    if ax is None:
        import matplotlib.pyplot as plt

        figure, ax = plt.subplots(layout="constrained")
        wide, high = _drawn(size) if len(size) == 2 else (1.0, 1.0)
        across, up = figure.get_size_inches()
        # Room for titles and numbers beside the map, in letters of the usual size.
        room = 0.2 * letter_size()
        if wide > _WIDE * high:
            figure.set_size_inches(across, min(up, across * high / wide + room))
        elif high > _WIDE * wide:
            figure.set_size_inches(min(across, up * wide / high + 1.2 * room), up)
    return ax
