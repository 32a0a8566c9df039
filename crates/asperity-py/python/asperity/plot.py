"""Figures of results, surfaces and fits by matplotlib (an optional dependency: pip install asperity[plot]).

Each axis has a unit that suits its numbers; a second curve in the same axes keeps the unit of the first."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _drawing as _draw
from ._arrays import Floats, choice, number
from ._core import CaseError
from ._last_cycle import last_cycle as _last_cycle_of
from ._prefixes import quantity, shown
from ._columns import FIELDS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]

    from ._contact import ElasticCurve
    from ._fit import Fit
    from ._force_maps import ForceMap
    from ._result import Result
    from ._rows import Field
    from ._surface import Surface
    from ._words import Axis

def _told(plots: Any, missing: frozenset[str] = frozenset()) -> str:
    """Which figures there are."""
    names = [name for name, value in vars(type(plots)).items() if name[0] != "_" and callable(value) and name not in missing]
    return f"<plots: {', '.join(f'{name}()' for name in names)}>"


#: Where bodies do not touch, in a map of the pressure; and where they do, in one of the gap.
_LIGHT = "#f0f0ee"
#: Labels of the contact states, by number.
_STATES = {0: ("open", _LIGHT), 1: ("contact", "#0072b2"), 2: ("at hardness", "#d55e00")}
#: Gaps below this share of the largest undeformed gap, or of the approach, are rounding errors: the gap is closed.
_ROUNDING = 1e-12


#: What a negative gap is: the overlap where the pressure is cut off.
_FLATTENED = "below 0: flattened at the hardness"
#: Names of curves that an evolution has more than one of.
_KINDS = ("counted", "corrected", "at the hardness", "nominal mean", "largest", "mean over the contact", "of the bulk", "in total",
    "against motion", "across it", "solved", "critical constriction", "effective medium", "hydraulic", "critical")


class _Panel(NamedTuple):
    """What one of the axes of an evolution shows."""

    title: str
    unit: str
    #: 2 for an area, whose unit is that of the length squared.
    power: int
    #: Names in the legend, and numbers of the rows.
    curves: list[tuple[str, npt.NDArray[Any]]]


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
        if "friction_coefficient" not in self._result._table:
            missing.add("friction")
        if not self._result._leaks and "gap" not in fields:
            missing.add("leak")
        return _told(self, frozenset(missing | ({"contact", "spots"} if not touching else set()) | ({"profile"} if not fields else set())))

    def evolution(self, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> npt.NDArray[Any]:
        """Contact area, approach, load and pressure over time (of a sweep: friction in place of the load, over the velocity): four axes,
        in a new figure or the `axes` that another evolution returned. The pressure is the nominal mean (load by the area of the
        domain), the largest one and the mean over the contact. Time is logarithmic where half of the rows lie in the first tenth of
        the run (velocities where they span a decade), and where `log_time` says so; the row at the time 0 is not shown then."""
        return self._over_rows("evolution", self._panels(), axes, log_time, label, style)

    def friction(self, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> npt.NDArray[Any]:
        """Friction coefficient, force, contact area over that of the domain and lost power of a contact in motion, over time or, of
        steady states, over the velocity: four axes, as :meth:`evolution`."""
        result = self._result
        coefficient = [("", result.friction_coefficient)]
        if "friction_coefficient_total" in result._table:
            coefficient = [("of the bulk", result.friction_coefficient), ("in total", result.friction_coefficient_total)]
        force = [("", result.friction_force)]
        if _draw.magnitude(result.side_force) > 1e-3 * _draw.magnitude(result.friction_force):
            force = [("against motion", result.friction_force), ("across it", result.side_force)]
        panels = [
            _Panel("friction coefficient", "1", 1, coefficient),
            _Panel("force", result.units("friction_force"), 1, force),
            _Panel("contact over nominal area", "1", 1, [("", result.contact_fraction)]),
            _Panel("power lost", result.units("dissipated_power"), 1, [("", result.dissipated_power)]),
        ]
        return self._over_rows("friction", panels, axes, log_time, label, style)

    def leak(self, leaks: Any = None, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> npt.NDArray[Any]:
        """Leak rate with its two estimates, and hydraulic and critical gap over time, on logarithmic axes: two axes, or one (the gaps) where
        no fluid is given. `leaks` is what :meth:`Result.leakage` returns; by default the leaks that the run stored. Times at which the seal
        is tight are left out."""
        found = self._result.leakage() if leaks is None else leaks
        names = {"solved": "leak_rate", "critical constriction": "leak_estimate_junction", "effective medium": "leak_estimate_medium"}
        names["if the fluid did not act"] = "leak_rate_one_way"
        panels = []
        if "leak_rate" in found:
            rates = [(words, found[name].values) for words, name in names.items() if name in found]
            panels.append(_Panel("leak rate", found["leak_rate"].attrs["units"], 1, rates))
        gaps = [("hydraulic", found["hydraulic_gap"].values), ("critical", found["critical_gap"].values)]
        panels.append(_Panel("gap", "m", 1, gaps))
        open_ = np.asarray(found["percolates"].values, dtype=bool)
        panels = [panel._replace(curves=[(words, np.where(open_, values, np.nan)) for words, values in panel.curves]) for panel in panels]
        drawn = self._over_rows("leak", panels, axes, log_time, label, style, over=np.asarray(found["leak_time"].values))
        for ax in drawn.flat if open_.any() else ():
            ax.set_yscale("log", nonpositive="mask")
        return drawn

    def _over_rows(
        self, name: str, panels: list[_Panel], axes: Any, log_time: bool | None, label: str | None, style: dict[str, Any], over: Any = None
    ) -> npt.NDArray[Any]:
        """The panels over the rows, or over these times, each in axes of its own."""
        result = self._result
        lines, number = {4: (2, "four"), 2: (1, "two"), 1: (1, "one")}[len(panels)]
        columns = len(panels) // lines
        if "ax" in style:
            raise TypeError(f"{name} draws into {number} axes: give axes=, as plt.subplots({lines}, {columns}) returns them")
        _draw.check_style(style)
        if axes is None:
            import matplotlib.pyplot as plt

            _, axes = plt.subplots(lines, columns, figsize=(4 * columns, 2.7 * lines), layout="constrained")
        if np.size(axes) != len(panels):
            raise CaseError(f"axes holds {np.size(axes)} axes, but must hold {number}, as plt.subplots({lines}, {columns}) returns them")
        drawn: npt.NDArray[Any] = np.asarray(axes, dtype=object)
        over = result._table["time"] if over is None else over
        drawn_before = [ax for ax in drawn.flat if ax.lines]
        if log_time is None and drawn_before:
            log_time = drawn_before[0].get_xscale() == "log"
        elif log_time is None:
            log_time = _spans_a_decade(over) if result.is_sweep else _crowds_the_start(over)
        # A logarithmic axis has no place for the row at the time 0.
        rows = over > 0 if log_time else np.full(over.shape, True)
        along = result._axis
        for ax, panel in zip(drawn.flat, panels):
            # Decades on both sides of a second, or of 1 m/s, are powers of ten of it.
            wide = log_time and np.any(over[rows] < 1.0) and over[-1] > 1e6 * np.min(over[rows], initial=np.inf) and over[-1] > 1.0
            shift = _draw.scale(ax, along.name, 1.0 if wide else _draw.magnitude(over), along.unit, axis="x", log=log_time)
            factor = _draw.scale(ax, panel.title, _draw.magnitude(*(values for _, values in panel.curves)), panel.unit, panel.power)
            first = None
            for n, (words, values) in enumerate(panel.curves):
                told = ", ".join(str(part) for part in (label, words) if part not in (None, ""))
                given = style if first is None else _another(style, n, first if label else None)
                (line,) = ax.plot(over[rows] * shift, values[rows] * factor, label=told or None, **_marked(given, values[rows]))
                first = first or line
            _draw.settle(ax)
            if log_time:
                # What another evolution has at the time 0 has no place here either.
                ax.set_xscale("log", nonpositive="mask")
            if label or any(words for words, _ in panel.curves):
                _draw.draw_legend(ax, _KINDS)
        return drawn

    def _panels(self) -> list[_Panel]:
        """The four panels of an evolution."""
        result = self._result
        area, load = result.contact_area, result.load
        touches = bool(np.any(area > 0))
        if result.is_line:
            contact = _Panel("contact length", "m", 1, [("", area)])
        else:
            contact = _Panel("contact area", "m", 2, [("counted", area), ("corrected", result.contact_area_corrected)])
        if np.any(result.capped_area > 0):
            contact.curves.append(("at the hardness", result.capped_area))
        # What presses on the cells that touch: where a fluid acts, its load is not among it; of surfaces that adhere less the attraction there,
        # which is the largest.
        adhesion = result._setup.get("adhesion")
        pressed = result.repulsive_load - adhesion["strength"] * area if adhesion else result._table.get("contact_load", load)
        over_contact = np.divide(pressed, area, out=np.full(area.shape, np.nan), where=area > 0)
        pressures = [("nominal mean", result.mean_pressure), ("largest", result.max_pressure), ("mean over the contact", over_contact)]
        third = _Panel("load", result.units("load"), 1, [("", load)])
        if result.is_sweep and "friction_coefficient" in result._table:
            # The load of a sweep is constant.
            third = _Panel("friction coefficient", "1", 1, [("", result.friction_coefficient)])
            if "friction_coefficient_total" in result._table:
                third.curves[:] = [("of the bulk", result.friction_coefficient), ("in total", result.friction_coefficient_total)]
        if not touches:
            contact.curves[:] = [("nothing touches", area)]
            pressures = [("nothing touches", result.mean_pressure)]
        return [contact, _Panel("approach", "m", 1, [("", result.approach)]), third, _Panel("pressure", "Pa", 1, pressures)]

    def load_displacement(self, *, last_cycle: bool | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Load over approach. A new figure of a cyclic run shows its last cycle beside, in axes of its own, ``ax.figure.axes[1]``: the
        last full period of a load that is a sine, else from peak to peak, where there are three peaks or more. `last_cycle` draws that
        alone (True), or leaves it out (False)."""
        result = self._result
        approach, load, unit = result.approach, result.load, result.units("load")
        cycle = _last_cycle_of(result)
        if last_cycle and cycle is None:
            raise CaseError("the result has no last cycle: its load is no sine of a full period, and neither load nor approach has three peaks")
        if cycle is None or last_cycle is False or (last_cycle is None and ax is not None):
            return _load_displacement(approach, load, unit, ax, style)
        if last_cycle:
            return _load_displacement(approach[cycle], load[cycle], unit, ax, style)
        import matplotlib.pyplot as plt

        _draw.check_style(style)
        _, (whole, last) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
        _load_displacement(approach, load, unit, whole, style)
        _load_displacement(approach[cycle], load[cycle], unit, last, style)
        # If there is a legend, the titles lie above it.
        pad = 2.0 * _draw.letter_size() if "label" in style else None
        from_, to = result.time[cycle][[0, -1]]
        whole.set_title("all cycles", pad=pad)
        last.set_title(f"last cycle, t = {quantity(from_, 's')} to {quantity(to, 's')}", pad=pad)
        drawn: Axes = whole
        return drawn

    def pressure(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the pressure at the stored time nearest to `time` [s] (of a sweep: velocity [m/s]), or with that index; default the
        last. Its colours begin at 0, and what is out of contact is light, unless `norm`, or a `vmin` other than 0, is given; with adhesion 0
        is in their middle. A narrow domain is
        stretched, as its title says, where `aspect` is not given. Of a line contact a curve over x."""
        return self._map("pressure", "inferno", (time, velocity, index), ax, style)

    def gap(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the gap, as :meth:`pressure`, but what is in contact is light. Where a few pits take more than a third of the range of the
        values, the colours end at the quantile of a thousandth, and an arrow of the bar points beyond."""
        return self._map("gap", "viridis", (time, velocity, index), ax, style)

    def displacement(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any
    ) -> Axes:
        """Map of the displacement, as :meth:`gap`, with its own colours everywhere."""
        return self._map("displacement", "viridis", (time, velocity, index), ax, style)

    def flattening(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any
    ) -> Axes:
        """Map of the permanent flattening, as :meth:`displacement`."""
        return self._map("flattening", "viridis", (time, velocity, index), ax, style)

    def contact(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the contact state: open, in contact, at the hardness."""
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        result, at = self._result, (time, velocity, index)
        if "contact" in result.fields:
            states = self._field("contact", at)
        else:
            states = result._touches(index=self._row(at)).astype(float)
        ax = _draw.axes(ax, style, "curve" if result.is_line else "map", result.size)
        self._tell(ax, at, notes=[] if result.is_line else [_draw.stretched(result.size, style)])
        if result.is_line:
            ax.step(result.x * _draw.scale(ax, "x", result.size[0], "m", axis="x"), states, **{"where": "mid", **style})
            _name_states(ax, states)
            return ax
        colours = [colour for _, colour in _STATES.values()]
        _draw.draw_map(ax, states, result.size, {"cmap": ListedColormap(colours), "vmin": 0, "vmax": 2, **style})
        if not {"cmap", "norm"} & style.keys():
            held = [_STATES[state] for state in _STATES if np.any(states == state)]
            handles = [Patch(facecolor=colour, edgecolor="k", linewidth=0.4, label=name) for name, colour in held]
            ax.legend(handles=handles, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
        return ax

    def spots(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the contact spots by their number, the largest first; what is open is light."""
        at = (time, velocity, index)
        labels = self._result.spots(time=time, velocity=velocity, index=index)
        if self._result.is_line:
            raise CaseError("a map of the spots needs a contact over a plane; result.spots() has the numbers")
        ax = _draw.axes(ax, style, "map", self._result.size)
        number_ = int(labels.max(initial=0))
        told = "1 contact spot" if number_ == 1 else f"{number_} contact spots" if number_ else ""
        self._tell(ax, at, told, [_draw.stretched(self._result.size, style)])
        # Neighbouring numbers get colours that differ, the same in each figure.
        shuffled = np.concatenate([[0], 1 + np.random.default_rng(0).permutation(number_)])
        numbers = np.where(labels > 0, shuffled[labels], np.nan)
        _draw.draw_map(ax, numbers, self._result.size, {"vmin": 1, "vmax": max(number_, 2), **style, "cmap": _draw.coloured(style.get("cmap", "turbo"), bad=_LIGHT)})
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
        """A field along x at `y` [m]; default the pressure through the middle. In a new figure the gap has the undeformed one beside,
        where no `label` is given."""
        result, at = self._result, (time, velocity, index)
        if result.is_line:
            return self._curve(field, at, ax, style)
        values = self._closed(self._field(field, at), at) if field == "gap" else self._field(field, at)
        place = 0.5 * result.size[1] if y is None else number("y", y)
        if not 0 <= place <= result.size[1]:
            raise CaseError(f"y is {place:g} m, but must lie in the domain, 0 m to {result.size[1]:g} m")
        # Of the two rows beside the middle the upper one.
        row = min(int(place / result.size[1] * result.cells[1]), result.cells[1] - 1)
        before = result.initial_gap[:, row] if field == "gap" else None
        return self._line(field, values[:, row], at, ax, style, f"y = {quantity(float(result.y[row]), 'm')}", before)

    def _curve(self, name: str, at: Any, ax: Axes | None, style: dict[str, Any]) -> Axes:
        """A field of a line contact over x."""
        values = self._closed(self._field(name, at), at) if name == "gap" else self._field(name, at)
        before = self._result.initial_gap if name == "gap" else None
        return self._line(name, np.where(np.isfinite(values), values, np.nan), at, ax, style, before=before)

    def _line(
        self, name: str, values: Any, at: Any, ax: Axes | None, style: dict[str, Any], place: str = "", before: Any = None
    ) -> Axes:
        """A field over x, and what it was `before` the bodies touched."""
        curves = [(style, values)]
        if before is not None and ax is None and "label" not in style:
            curves = [({"label": "now", **style}, values), ({"label": "undeformed", "color": "0.5", "linestyle": "--"}, before)]
        ax = _draw.axes(ax, style)
        x = _draw.scale(ax, "x", self._result.size[0], "m", axis="x")
        factor = _draw.scale(ax, name, _draw.magnitude(*(course for _, course in curves)), FIELDS[name].unit)
        for given, course in curves:
            ax.plot(self._result.x * x, course * factor, **_marked(given, course))
        _draw.settle(ax)
        if name == "contact":
            _name_states(ax, values)
        if "label" not in style:
            self._tell(ax, at, place, [_FLATTENED] if name == "gap" and np.any(values < 0) else [])
        if "label" in curves[0][0]:
            _draw.draw_legend(ax)
            # The title lies above the legend.
            ax.set_title(ax.get_title(), pad=2.0 * _draw.letter_size())
        return ax

    def _map(self, name: str, colours: str, at: Any, ax: Axes | None, style: dict[str, Any]) -> Axes:
        if self._result.is_line:
            return self._curve(name, at, ax, style)
        unit, size, values = FIELDS[name].unit, self._result.size, self._field(name, at)
        values = np.where(np.isfinite(values), values, np.nan)
        if name == "gap":
            values = self._closed(values, at)
        ax = _draw.axes(ax, style, "map", size)
        given = _draw.in_si(style, unit)
        style = {"cmap": colours, **given}
        light, told = _light(name, values, style)
        if name == "pressure" and self._result._setup.get("adhesion"):
            style, told = _about_zero(values, given), "below 0: the surfaces pull at each other"
        self._tell(ax, at, notes=[_draw.stretched(size, style), told])
        image = _draw.draw_map(ax, values, size, {**(style if name == "pressure" else _draw.robust(values, style)), **light})
        if not light or "vmax" in style or np.any(values > 0):
            _draw.bar(ax, image, name, unit)
        return ax

    def _field(self, name: Any, at: Any) -> Any:
        time, velocity, index = at
        return self._result.field(name, time=time, velocity=velocity, index=index)

    def _row(self, at: Any) -> int:
        """The number of the stored instant."""
        time, velocity, index = at
        return self._result._index(time, velocity, index)

    def _closed(self, gap: Any, at: Any) -> Any:
        """The gap, 0 in contact, where rounding errors remain; at the hardness it may be negative."""
        result, row = self._result, self._result._field_steps[self._row(at)]
        closed = np.abs(gap) < _ROUNDING * max(_draw.magnitude(result.initial_gap), abs(result.approach[row]))
        if "contact" in result.fields:
            closed |= self._field("contact", at) == 1
        elif result.capped_area[row] == 0:
            closed |= result._touches(index=self._row(at)) > 0
        return np.where(closed, 0.0, gap)

    def _touches(self, at: Any) -> bool:
        """Whether the bodies touch at the stored instant."""
        return bool(self._result.contact_area[self._result._field_steps[self._row(at)]] > 0)

    def _tell(self, ax: Any, at: Any, place: str = "", notes: Sequence[str] = ()) -> None:
        """Sets the title of the axes: the place, the time if fields of several times are stored, and notes below, one in each line."""
        result, when = self._result, ""
        if len(result.field_times) > 1:
            moment = float(result.field_times[self._row(at)])
            when = f"{result._axis.symbol} = {quantity(moment, result._axis.unit)}"
        notes = notes if self._touches(at) else ["no contact", *notes]
        lines = [", ".join(part for part in (place, when) if part), *notes]
        if told := "\n".join(line for line in lines if line):
            ax.set_title(told)


def _about_zero(values: Any, style: dict[str, Any]) -> dict[str, Any]:
    """The style of a map of numbers of both signs, where it gives no colours: 0 in their middle, and light."""
    if {"cmap", "norm", "vmin", "vmax"} & style.keys():
        return {"cmap": "RdBu_r", **style}
    most = _draw.magnitude(values) or 1.0
    return {"cmap": "RdBu_r", "vmin": -most, "vmax": most, **style}


def _light(name: str, values: Any, style: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """What is added to the style of a map so that 0 is light, and words on it: what is out of contact is no small pressure, and contact
    is no small gap. Zeros lie below the scale, which begins at the smallest number above 0."""
    if name not in ("pressure", "gap"):
        return {}, ""
    if np.any(values < 0):
        return {}, _FLATTENED if name == "gap" else ""
    zeros, nothing = bool(np.any(values == 0)), not np.any(values > 0)
    other_ends = "norm" in style or style.get("vmin") not in (None, 0.0)
    if other_ends or (name == "gap" and not zeros):
        return {}, ""
    added = {"vmin": np.finfo(float).tiny, "cmap": _draw.coloured(style["cmap"], under=_LIGHT)}
    if nothing:
        return {**added, "vmax": style.get("vmax", 1.0)}, "the bodies touch everywhere" if name == "gap" else ""
    return added, "" if not zeros else "light: no contact" if name == "pressure" else "light: contact"


def _name_states(ax: Any, states: Any) -> None:
    """The names of the contact states on the vertical axis."""
    told = range(max(2, int(np.max(states, initial=0)) + 1))
    ax.set_yticks(list(told), [_STATES[state][0] for state in told])


def _marked(style: dict[str, Any], *courses: Any) -> dict[str, Any]:
    """The style of a curve over these courses; one of a single point is seen by its marker only."""
    single = np.count_nonzero(np.isfinite(courses[-1])) == 1 or (len(courses) > 1 and all(map(_draw.is_constant, courses)))
    return {"marker": "o", **style} if single else style


def _another(style: dict[str, Any], n: int, first: Any = None) -> dict[str, Any]:
    """The style of the second curve of axes, and of further ones, which must differ from the first: by its line where it has the colour
    of that curve, because colours are given or count the runs, else by the next colour."""
    if first is None and "color" not in style and "c" not in style:
        return style
    line = style.get("linestyle", style.get("ls", "-"))
    rest = {key: value for key, value in style.items() if key not in ("linestyle", "ls")}
    if first is not None and "c" not in style:
        rest = {"color": first.get_color(), **rest}
    if line in ("", " ", "none", "None"):
        return {**rest, "linestyle": "none", "fillstyle": ("none", "bottom")[n - 1]}
    named = {"solid": "-", "dashed": "--", "dotted": ":", "dashdot": "-."}
    return {**rest, "linestyle": [other for other in ("-", "--", ":", "-.") if other != named.get(line, line)][n - (line in ("-", "solid"))]}


def _spans_a_decade(velocities: Any) -> bool:
    return bool(len(velocities) and velocities[0] > 0 and velocities[-1] >= 10.0 * velocities[0])


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
        """Contact fraction over mean pressure; with `corrected` that of the area less its perimeter's share, of a line contact of the length
        less the share of its ends."""
        curve, ax = self._curve, _draw.axes(ax, style)
        factor = _draw.scale(ax, "mean pressure", _draw.magnitude(curve.mean_pressure), "Pa", axis="x")
        fraction, share = curve.contact_fraction, "contact length [% of the domain]" if curve[0].is_line else "contact area [% of nominal]"
        if corrected:
            fraction = curve.contact_area_corrected / math.prod(curve[0].size)
        ax.plot(curve.mean_pressure * factor, 100 * fraction, **{"marker": ".", **style})
        ax.set_ylabel(f"{'corrected ' if corrected else ''}{share}")
        if "label" in style:
            _draw.draw_legend(ax)
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
        """Map of the heights about their mean, undefined points left blank; of a profile a curve. Where a few pits or spikes take more
        than a third of the range, the colours end at the quantiles of a thousandth and of all but a thousandth, and arrows of the bar
        point beyond."""
        surface = self._surface
        z = np.where(np.isfinite(surface.heights), surface.heights, np.nan)
        z = z - np.nanmean(z)
        ax = _draw.axes(ax, style, "curve" if surface.is_line else "map", surface.size)
        if surface.is_line:
            along = _draw.scale(ax, "x", max(surface.size), "m", axis="x")
            ax.plot(surface.x * along, z * _draw.scale(ax, "height", _draw.magnitude(z), "m"), **style)
            return ax
        if told := _draw.stretched(surface.size, style):
            ax.set_title(told)
        image = _draw.draw_map(ax, z, surface.size, {"cmap": "viridis", **_draw.robust(z, _draw.in_si(style, "m"))})
        _draw.bar(ax, image, "height", "m")
        return ax

    def power_spectrum(self, *, per_decade: int = 16, periodic: bool = True, ax: Axes | None = None, **style: Any) -> Axes:
        """Radially averaged power spectrum over wavenumber, both logarithmic; of a profile its own. `periodic` as in
        :meth:`Surface.power_spectrum`."""
        q, c = self._surface.power_spectrum(per_decade, periodic=periodic)
        return _spectrum(q, c, "C1 [m³]" if self._surface.is_line else "C [m⁴]", ax, style)

    def power_spectrum_1d(self, *, direction: Axis = "x", ax: Axes | None = None, **style: Any) -> Axes:
        """Mean power spectrum of the profiles along "x" or "y"."""
        return _spectrum(*self._surface.power_spectrum_1d(direction), "C1 [m³]", ax, style)

    def power_spectrum_2d(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the logarithm of the power spectrum over the wavenumbers along x and y."""
        qx, qy, c = self._surface.power_spectrum_2d()
        ax = _draw.axes(ax, style, "map")
        # Below is the rounding of the transform, where a synthetic surface has no waves.
        powers = np.log10(np.where(c > 1e-20 * c.max(initial=0.0), c, np.nan))
        half = [0.5 * (q[1] - q[0]) if len(q) > 1 else 0.5 for q in (qx, qy)]
        # Wave numbers of 1/µm, 1/mm or 1/m.
        longest = max(qx[-1] + half[0], qy[-1] + half[1])
        factor, text = (1e-6, "µm") if longest >= 1e6 else (1e-3, "mm") if longest >= 1e3 else (1.0, "m")
        extent = tuple(end * factor for end in (qx[0] - half[0], qx[-1] + half[0], qy[0] - half[1], qy[-1] + half[1]))
        image = _draw.placed(ax, powers, extent, (extent[1] - extent[0], extent[3] - extent[2]), {"cmap": "viridis", **style})
        ax.set_xlabel(f"qx [1/{text}]")
        ax.set_ylabel(f"qy [1/{text}]")
        _draw.beside(ax, image, "log10 of the power spectrum C [m⁴]")
        return ax

    def autocorrelation(self, *, periodic: bool | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the autocorrelation function over the lags."""
        found = self._surface.autocorrelation(periodic=periodic)
        ax = _draw.axes(ax, style, "map", self._surface.size)
        if told := _draw.stretched(self._surface.size, style):
            ax.set_title(told)
        factor, text = shown(float(max(np.abs(found.x).max(), np.abs(found.y).max())), "m")
        half = [0.5 * side / n for side, n in zip(self._surface.size, self._surface.cells)]
        extent = [end * factor for end in (found.x[0] - half[0], found.x[-1] + half[0], found.y[0] - half[1], found.y[-1] + half[1])]
        image = _draw.placed(ax, found.values, extent, self._surface.size, {"cmap": "RdBu_r", "vmin": -1.0, "vmax": 1.0, **style})
        ax.set_xlabel(f"lag along x [{text}]")
        ax.set_ylabel(f"lag along y [{text}]")
        _draw.beside(ax, image, "autocorrelation")
        return ax

    def height_distribution(self, *, bins: int = 100, ax: Axes | None = None, **style: Any) -> Axes:
        """Density of the points over height."""
        z, density = self._surface.height_distribution(bins)
        ax = _draw.axes(ax, style)
        factor, text = shown(_draw.magnitude(z), "m")
        ax.plot(z * factor, density / factor, **style)
        ax.set_xlabel(f"height [{text}]")
        ax.set_ylabel(f"density [1/{text}]")
        return ax

    def bearing_curve(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Height over the share of the surface above it."""
        z, share = self._surface.bearing_curve()
        ax = _draw.axes(ax, style)
        ax.plot(100 * share, z * _draw.scale(ax, "height", _draw.magnitude(z), "m"), **style)
        ax.set_xlabel("share of the surface above [%]")
        ax.set_xlim(0, 100)
        return ax


def _load_displacement(approach: Any, load: Any, unit: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    ax = _draw.axes(ax, style)
    across = _draw.scale(ax, "load", _draw.magnitude(load), unit)
    along = _draw.scale(ax, "approach", _draw.magnitude(approach), "m", axis="x")
    if not np.any(load) and not ax.lines and "label" not in style:
        style = {**style, "label": "nothing touches"}
    ax.plot(approach * along, load * across, **_marked(style, approach, load))
    _draw.settle(ax)
    _draw.settle(ax, "x")
    if "label" in style:
        _draw.draw_legend(ax)
    return ax


def _two_or_five(value: float) -> str:
    """The label of 2 or 5 times a power of ten, written for matplotlib; empty for other numbers."""
    power = math.floor(math.log10(value) + 1e-9) if value > 0 else 0
    first = round(value / 10.0**power)
    return f"${first}\\times10^{{{power}}}$" if first in (2, 5) else ""


def _few_numbers(axis: Any, ends: tuple[float, float]) -> None:
    """Numbers at 2 and 5 times the powers of ten of a logarithmic axis of a decade or two, where powers of ten are few; all numbers
    between them would overlap."""
    from matplotlib.ticker import FuncFormatter

    # Of 1, 2 and 5 times the powers of ten two at least lie in a range of 2.5 * 2.5; a shorter one keeps all numbers.
    if ends[1] < 6.25 * ends[0]:
        return
    few = ends[1] < 300.0 * ends[0]
    axis.set_minor_formatter(FuncFormatter(lambda value, _: _two_or_five(value) if few else ""))


def _spectrum(q: Any, c: Any, words: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    ax = _draw.axes(ax, style)
    # Below is the rounding of the transform, where a synthetic surface has no waves.
    seen = c > 1e-20 * np.max(c, initial=0.0)
    ax.loglog(q[seen], c[seen], **{"marker": ".", **style})
    _few_numbers(ax.xaxis, ax.get_xlim())
    ax.set_xlabel("wavenumber q [1/m]")
    ax.set_ylabel(f"power spectrum {words}")
    if "label" in style:
        _draw.draw_legend(ax)
    return ax


def fitted(fit: Fit, ax: Axes | None) -> Any:
    """Points and curves of a fit."""
    ax = _draw.axes(ax)
    dma = fit.kind == "dma"
    fine = np.geomspace(fit.x[fit.x > 0].min(), fit.x.max(), 400)
    labels = {"relaxation": ["modulus"], "creep": ["compliance"], "dma": ["storage modulus", "loss modulus"]}[fit.kind]
    for k, (label, data, curve) in enumerate(zip(labels, fit.curves, fit.curve(fine))):
        ax.loglog(fit.x, data, "o^"[k], color=f"C{k}", markersize=3, alpha=0.6, label=f"{label}, measured")
        ax.loglog(fine, curve, color=f"C{k}", label=f"{label}, fitted")
    _few_numbers(ax.xaxis, ax.get_xlim())
    _few_numbers(ax.yaxis, ax.get_ylim())
    reduced = "reduced " if fit.shift is not None else ""
    ax.set_xlabel(f"{reduced}angular frequency [rad/s]" if dma else f"{reduced}time [s]")
    letter = "E" if fit.modulus == "young" else "G"
    names = {"relaxation": f"{letter}(t) [Pa]", "creep": f"{'D' if letter == 'E' else 'J'}(t) [1/Pa]"}
    ax.set_ylabel(names.get(fit.kind, f"{letter}′, {letter}″ [Pa]"))
    _draw.draw_legend(ax)
    return ax


def recorded(along: tuple[str, str, Floats], name: str, measured: Floats, model: Floats, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """The load or depth of a test as points, and of its model as a line, over what `along` has: name, unit and numbers."""
    ax = _draw.axes(ax, style)
    words, unit, over = along
    across = over * _draw.scale(ax, words, _draw.magnitude(over), unit, axis="x")
    up = _draw.scale(ax, name, _draw.magnitude(measured), {"load": "N", "depth": "m"}[name])
    ax.plot(across, measured * up, ".", markersize=3, color="0.6", label="measured")
    ax.plot(across, model * up, **{"label": "model", **style})
    _draw.draw_legend(ax)
    return ax


#: What the maps of force curves show.
_OF_CURVES = {"young": ("Young's modulus", "Pa"), "work": ("work of adhesion", "J/m²")}
_ENDS = {"": "", "_low": ", lower end of the 95 % interval", "_high": ", upper end of the 95 % interval"}


def force_map(found: ForceMap, what: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """A quantity of a map of force curves."""
    names = {name + end: (words, told, unit) for name, (words, unit) in _OF_CURVES.items() for end, told in _ENDS.items()}
    words, told, unit = names[choice("quantity", what, tuple(names))]
    values = getattr(found, what)
    size = found.size or tuple(float(count) for count in values.shape)
    ax = _draw.axes(ax, style, "map", size)
    colours = {"cmap": "viridis", **_draw.in_si(style, unit)}
    # Intervals may have no upper end.
    shown_ = np.where(np.isfinite(values), values, np.nan)
    style = {**_draw.robust(shown_, colours), "cmap": _draw.coloured(colours["cmap"], bad=_LIGHT)}
    if found.size is None:
        image = _draw.placed(ax, shown_, (0, size[0], 0, size[1]), size, style)
        ax.set_xlabel("x [pixels]")
        ax.set_ylabel("y [pixels]")
    else:
        image = _draw.draw_map(ax, shown_, size, style)
    _draw.bar(ax, image, words, unit)
    empty = int(np.sum(np.isnan(shown_)))
    missing = f"{empty} of {values.size} pixels without a value (light)" if empty else ""
    ax.set_title("; ".join(part for part in (told.removeprefix(", "), missing, _draw.stretched(size, style)) if part))
    return ax
