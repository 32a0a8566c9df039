"""Figures of results, surfaces and fits by matplotlib (an optional dependency: pip install asperity[plot]).

Each axis has a unit that suits its numbers; a second curve in the same axes keeps the unit of the first."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _drawing as _draw
from ._arrays import AnyArray, Floats, choice, number
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
_STATES = {0: ("open", _LIGHT), 1: ("contact", "#0072b2"), 2: ("at hardness", "#d55e00"), 3: ("slips", "#009e73")}
#: Gaps below this share of the largest undeformed gap, or of the approach, are rounding errors: the gap is closed.
_ROUNDING = 1e-12


#: What a negative gap is: the overlap where the pressure is cut off.
_FLATTENED = "below 0: flattened at the hardness"
#: Names of curves that an evolution has more than one of.
_KINDS = ("counted", "corrected", "at the hardness", "nominal mean", "largest", "mean over the contact", "of the bulk", "in total",
    "against motion", "across it", "solved", "critical constriction", "effective medium", "hydraulic", "critical")


#: Which of the stored instants is shown: `time`, `velocity` and `index`.
_At = dict[str, Any]


class _Panel(NamedTuple):
    """What one of the axes of an evolution shows."""

    title: str
    unit: str
    #: Numbers of the rows by their names in the legend.
    curves: dict[str, AnyArray]
    #: 2 for an area, whose unit is that of the length squared.
    power: int = 1


class Plots:
    """Each method draws one figure and returns its axes; `ax` draws into axes that are there.

    Further arguments go to matplotlib: of maps to ``imshow`` (cmap, norm, vmin, vmax in SI units, alpha, ...), of curves to ``plot``
    (label, color, linestyle, marker, ...).
    """

    def __init__(self, result: Result) -> None:
        self._result = result

    def __repr__(self) -> str:
        fields = {*self._result.fields}
        there = {name: name in fields for name in ("pressure", "gap", "displacement", "flattening")}
        rows = {"friction": "friction_coefficient", "tangential_loop": "tangential_force", "wear": "wear_volume"}
        there |= {name: column in self._result._table for name, column in rows.items()}
        there |= {"leak": bool(self._result._leaks) or "gap" in fields, "profile": bool(fields)}
        there |= dict.fromkeys(("contact", "spots"), bool({"pressure", "contact"} & fields))
        return _told(self, frozenset(name for name, drawn in there.items() if not drawn))

    def evolution(self, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> AnyArray:
        """Contact area, approach, load and pressure over time (of a sweep: friction in place of the load, over the velocity): four axes,
        in a new figure or the `axes` that another evolution returned. The pressure is the nominal mean (load by the area of the
        domain), the largest one and the mean over the contact. Time is logarithmic where half of the rows lie in the first tenth of
        the run (velocities where they span a decade), and where `log_time` says so; the row at the time 0 is not shown then."""
        return self._over_rows("evolution", self._panels(), axes, log_time, label, style)

    def friction(self, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> AnyArray:
        """Friction coefficient, force, contact area over that of the domain and lost power of a contact in motion, over time or, of
        steady states, over the velocity: four axes, as :meth:`evolution`."""
        result, coefficient = self._result, self._coefficient()
        force = {"": result.friction_force}
        if _draw.magnitude(result.side_force) > 1e-3 * _draw.magnitude(result.friction_force):
            force = {"against motion": result.friction_force, "across it": result.side_force}
        area = _Panel("contact over nominal area", "1", {"": result.contact_fraction})
        power = _Panel("power lost", result.units("dissipated_power"), {"": result.dissipated_power})
        panels = [coefficient, _Panel("force", result.units("friction_force"), force), area, power]
        return self._over_rows("friction", panels, axes, log_time, label, style)

    def leak(self, leaks: Any = None, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> AnyArray:
        """Leak rate with its two estimates, and hydraulic and critical gap over time, on logarithmic axes: two axes, or one (the gaps) where
        no fluid is given. `leaks` is what :meth:`Result.leakage` returns; by default the leaks that the run stored. Times at which the seal
        is tight are left out."""
        found = self._result.leakage() if leaks is None else leaks
        open_ = np.asarray(found["percolates"].values, dtype=bool)

        def panel(title: str, unit: str, **names: str) -> _Panel:
            curves = {words.replace("_", " "): np.where(open_, found[name].values, np.nan) for words, name in names.items() if name in found}
            return _Panel(title, unit, curves)

        estimates = dict(critical_constriction="leak_estimate_junction", effective_medium="leak_estimate_medium", if_the_fluid_did_not_act="leak_rate_one_way")
        panels = [panel("leak rate", found["leak_rate"].attrs["units"], solved="leak_rate", **estimates)] if "leak_rate" in found else []
        panels.append(panel("gap", "m", hydraulic="hydraulic_gap", critical="critical_gap"))
        drawn = self._over_rows("leak", panels, axes, log_time, label, style, over=np.asarray(found[self._result._leaks_along].values))
        for ax in drawn.flat if open_.any() else ():
            ax.set_yscale("log", nonpositive="mask")
        return drawn

    def _over_rows(
        self, name: str, panels: list[_Panel], axes: Any, log_time: bool | None, label: str | None, style: dict[str, Any], over: Any = None
    ) -> AnyArray:
        """The panels over the rows, or over these times, each in axes of its own."""
        result, along = self._result, self._result._axis
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
        drawn: AnyArray = np.asarray(axes, dtype=object)
        over = result._table["time"] if over is None else over
        if log_time is None:
            before = [ax.get_xscale() == "log" for ax in drawn.flat if ax.lines]
            log_time = before[0] if before else _spans_a_decade(over) if result.is_sweep else _crowds_the_start(over)
        # A logarithmic axis has no place for the row at the time 0.
        rows = over > 0 if log_time else np.full(over.shape, True)
        # Decades on both sides of a second, or of 1 m/s, are powers of ten of it.
        wide = log_time and np.any(over[rows] < 1.0) and over[-1] > 1e6 * np.min(over[rows], initial=np.inf) and over[-1] > 1.0
        for ax, panel in zip(drawn.flat, panels):
            shift = _draw.scale(ax, "x", along.name, along.unit, 1.0 if wide else over, log=log_time)
            factor = _draw.scale(ax, "y", panel.title, panel.unit, *panel.curves.values(), power=panel.power)
            first = None
            for n, (words, values) in enumerate(panel.curves.items()):
                told = ", ".join(str(part) for part in (label, words) if part not in (None, ""))
                given = style if first is None else _another(style, n, first if label else None)
                (line,) = ax.plot(over[rows] * shift, values[rows] * factor, label=told or None, **_marked(given, values[rows]))
                first = first or line
            _draw.settle(ax)
            if log_time:
                # What another evolution has at the time 0 has no place here either.
                ax.set_xscale("log", nonpositive="mask")
            if label or any(panel.curves):
                _draw.draw_legend(ax, _KINDS)
        return drawn

    def _coefficient(self) -> _Panel:
        result, bulk = self._result, self._result.friction_coefficient
        total = "friction_coefficient_total" in result._table
        return _Panel("friction coefficient", "1", {"of the bulk": bulk, "in total": result.friction_coefficient_total} if total else {"": bulk})

    def _panels(self) -> list[_Panel]:
        """The four panels of an evolution."""
        result = self._result
        area, load, capped = result.contact_area, result.load, result.capped_area
        # The load of a sweep is constant.
        third = self._coefficient() if result.is_sweep and "friction_coefficient" in result._table else _Panel("load", result.units("load"), {"": load})
        areas = {"": area} if result.is_line else {"counted": area, "corrected": result.contact_area_corrected}
        if np.any(capped > 0):
            areas["at the hardness"] = capped
        # What presses on the cells that touch: where a fluid acts, its load is not among it; of surfaces that adhere less the attraction there,
        # which is the largest.
        adhesion = result._setup.get("adhesion")
        pressed = result.repulsive_load - adhesion["strength"] * area if adhesion else result._table.get("contact_load", load)
        over_contact = np.divide(pressed, area, out=np.full(area.shape, np.nan), where=area > 0)
        pressures = {"nominal mean": result.mean_pressure, "largest": result.max_pressure, "mean over the contact": over_contact}
        if not np.any(area > 0):
            areas, pressures = {"nothing touches": area}, {"nothing touches": result.mean_pressure}
        contact = _Panel("contact length", "m", areas) if result.is_line else _Panel("contact area", "m", areas, 2)
        return [contact, _Panel("approach", "m", {"": result.approach}), third, _Panel("pressure", "Pa", pressures)]

    def load_displacement(self, *, last_cycle: bool | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Load over approach. A new figure of a cyclic run shows its last cycle beside, in axes of its own, ``ax.figure.axes[1]``: the
        last full period of a load that is a sine, else from peak to peak, where there are three peaks or more. `last_cycle` draws that
        alone (True), or leaves it out (False)."""
        result = self._result
        cycle = _last_cycle_of(result)
        if last_cycle and cycle is None:
            raise CaseError("the result has no last cycle: its load is no sine of a full period, and neither load nor approach has three peaks")

        def draw(rows: slice, ax: Axes | None) -> Axes:
            return _load_displacement(result.approach[rows], result.load[rows], result.units("load"), ax, style)

        if cycle is None or last_cycle is not None or ax is not None:
            return draw(cycle if cycle is not None and last_cycle else slice(None), ax)
        import matplotlib.pyplot as plt

        _draw.check_style(style)
        whole: Axes
        _, (whole, last) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
        draw(slice(None), whole)
        draw(cycle, last)
        # If there is a legend, the titles lie above it.
        pad = 2.0 * _draw.letter_size() if "label" in style else None
        from_, to = result.time[cycle][[0, -1]]
        whole.set_title("all cycles", pad=pad)
        last.set_title(f"last cycle, t = {quantity(from_, 's')} to {quantity(to, 's')}", pad=pad)
        return whole

    def pressure(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the pressure at the stored time nearest to `time` [s] (of a sweep: velocity [m/s]), or with that index; default the
        last. Its colours begin at 0, and what is out of contact is light, unless `norm`, or a `vmin` other than 0, is given; with adhesion 0
        is in their middle. A narrow domain is
        stretched, as its title says, where `aspect` is not given. Of a line contact a curve over x."""
        return self._map("pressure", "inferno", _At(time=time, velocity=velocity, index=index, method="nearest"), ax, style)

    def gap(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the gap, as :meth:`pressure`, but what is in contact is light. Where a few pits take more than a third of the range of the
        values, the colours end at the quantile of a thousandth, and an arrow of the bar points beyond."""
        return self._map("gap", "viridis", _At(time=time, velocity=velocity, index=index, method="nearest"), ax, style)

    def displacement(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any
    ) -> Axes:
        """Map of the displacement, as :meth:`gap`, with its own colours everywhere."""
        return self._map("displacement", "viridis", _At(time=time, velocity=velocity, index=index, method="nearest"), ax, style)

    def flattening(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any
    ) -> Axes:
        """Map of the permanent flattening, as :meth:`displacement`."""
        return self._map("flattening", "viridis", _At(time=time, velocity=velocity, index=index, method="nearest"), ax, style)

    def field(
        self, name: Field, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any
    ) -> Axes:
        """Map of any field that the result keeps, as :meth:`displacement`, such as "traction_x" or "wear_depth"; numbers of both signs have
        0 in the middle of their colours."""
        own = {"pressure": self.pressure, "gap": self.gap, "contact": self.contact}.get(name)
        if own is not None:
            return own(time=time, velocity=velocity, index=index, ax=ax, **style)
        return self._map(name, "viridis", _At(time=time, velocity=velocity, index=index, method="nearest"), ax, style)

    def tangential_loop(self, *, axis: Axis = "x", ax: Axes | None = None, **style: Any) -> Axes:
        """Tangential force over tangential displacement along an axis, of a contact with friction."""
        choice("axis", axis, ("x", "y"))
        result, n = self._result, "xy".index(axis)
        force, displacement = result.tangential_force[:, n], result.tangential_displacement[:, n]
        return _over_displacement((displacement, "tangential displacement"), (force, "tangential force", result.units("tangential_force")), ax, style)

    def wear(self, *, axes: Any = None, log_time: bool | None = None, label: str | None = None, **style: Any) -> AnyArray:
        """Worn volume, largest worn depth, roughness of the worn surfaces and largest pressure over time, of a contact that wears: four axes, as
        :meth:`evolution`."""
        result = self._result
        volumes = {"of both bodies": result.wear_volume, "of the counterbody": result.counterbody_wear_volume} if "counterbody_wear_volume" in result._table else {"": result.wear_volume}
        panels = [
            _Panel("worn volume", result.units("wear_volume"), volumes),
            _Panel("worn depth", "m", {"": result.wear_depth_max}),
            _Panel("roughness Sq", "m", {"": result.worn_roughness}),
            _Panel("largest pressure", "Pa", {"": result.max_pressure}),
        ]
        return self._over_rows("wear", panels, axes, log_time, label, style)

    def contact(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the contact state: open, in contact, at the hardness, and of a contact with friction where it slips."""
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        result, at = self._result, _At(time=time, velocity=velocity, index=index, method="nearest")
        states = result.field("contact", **at) if "contact" in result.fields else result._touches(**at).astype(float)
        ax = _draw.axes(ax, style, "curve" if result.is_line else "map", result.size)
        self._tell(ax, at, notes=[] if result.is_line else [_draw.stretched(result.size, style)])
        if result.is_line:
            ax.step(result.x * _draw.scale(ax, "x", "x", "m", result.size[0]), states, **{"where": "mid", **style})
            _name_states(ax, states)
            return ax
        colours = [colour for _, colour in _STATES.values()]
        _draw.draw_map(ax, states, result.size, {"cmap": ListedColormap(colours), "vmin": 0, "vmax": len(colours) - 1, **style})
        if not {"cmap", "norm"} & style.keys():
            held = [_STATES[state] for state in _STATES if np.any(states == state)]
            handles = [Patch(facecolor=colour, edgecolor="k", linewidth=0.4, label=name) for name, colour in held]
            ax.legend(handles=handles, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
        return ax

    def spots(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the contact spots by their number, the largest first; what is open is light."""
        result, at = self._result, _At(time=time, velocity=velocity, index=index, method="nearest")
        labels = result.spots(**at)
        if result.is_line:
            raise CaseError("a map of the spots needs a contact over a plane; result.spots() has the numbers")
        ax = _draw.axes(ax, style, "map", result.size)
        count = int(labels.max(initial=0))
        self._tell(ax, at, f"{count} contact spot{'s' if count > 1 else ''}" if count else "", [_draw.stretched(result.size, style)])
        # Neighbouring numbers get colours that differ, the same in each figure.
        shuffled = np.concatenate([[0], 1 + np.random.default_rng(0).permutation(count)])
        colours = _draw.coloured(style.get("cmap", "turbo"), bad=_LIGHT)
        _draw.draw_map(ax, np.where(labels > 0, shuffled[labels], np.nan), result.size, {"vmin": 1, "vmax": max(count, 2), **style, "cmap": colours})
        return ax

    def profile(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, y: float | None = None,
        field: Field = "pressure", ax: Axes | None = None, **style: Any
    ) -> Axes:
        """A field along x at `y` [m]; default the pressure through the middle. In a new figure the gap has the undeformed one beside,
        where no `label` is given."""
        result, at = self._result, _At(time=time, velocity=velocity, index=index, method="nearest")
        if result.is_line:
            return self._line(field, at, ax, style)
        place = 0.5 * result.size[1] if y is None else number("y", y)
        if not 0 <= place <= result.size[1]:
            raise CaseError(f"y is {place:g} m, but must lie in the domain, 0 m to {result.size[1]:g} m")
        # Of the two rows beside the middle the upper one.
        return self._line(field, at, ax, style, min(int(place / result.size[1] * result.cells[1]), result.cells[1] - 1))

    def _line(self, name: Any, at: _At, ax: Axes | None, style: dict[str, Any], row: int | None = None) -> Axes:
        """A field over x, along a row of a plane, and the gap before the bodies touched."""
        result, along = self._result, (slice(None),) if row is None else (slice(None), row)
        values = self._values(name, at)[along]
        curves = [(style, values)]
        if name == "gap" and ax is None and "label" not in style:
            curves = [({"label": "now", **style}, values), ({"label": "undeformed", "color": "0.5", "linestyle": "--"}, result.initial_gap[along])]
        ax = _draw.axes(ax, style)
        x = _draw.scale(ax, "x", "x", "m", result.size[0])
        factor = _draw.scale(ax, "y", name.replace("_", " "), FIELDS[name].unit, *(course for _, course in curves))
        for given, course in curves:
            ax.plot(result.x * x, course * factor, **_marked(given, course))
        _draw.settle(ax)
        if name == "contact":
            _name_states(ax, values)
        if "label" not in style:
            place = "" if row is None else f"y = {quantity(float(result.y[row]), 'm')}"
            self._tell(ax, at, place, [_FLATTENED] if name == "gap" and np.any(values < 0) else [])
        if "label" in curves[0][0]:
            _draw.draw_legend(ax)
            # The title lies above the legend.
            ax.set_title(ax.get_title(), pad=2.0 * _draw.letter_size())
        return ax

    def _map(self, name: Any, colours: str, at: _At, ax: Axes | None, style: dict[str, Any]) -> Axes:
        if self._result.is_line:
            return self._line(name, at, ax, style)
        unit, size, values = FIELDS[name].unit, self._result.size, self._values(name, at)
        ax = _draw.axes(ax, style, "map", size)
        given = _draw.in_si(style, unit)
        style = {"cmap": colours, **given}
        light, told = _light(name, values, style)
        if name == "pressure" and self._result._setup.get("adhesion"):
            style, told = _about_zero(values, given), "below 0: the surfaces pull at each other"
        elif name not in ("pressure", "gap", "displacement") and np.nanmin(values) < 0 < np.nanmax(values):
            style = _about_zero(values, given)
        self._tell(ax, at, notes=[_draw.stretched(size, style), told])
        image = _draw.draw_map(ax, values, size, {**(style if name == "pressure" else _draw.robust(values, style)), **light})
        if not light or "vmax" in style or np.any(values > 0):
            _draw.bar(ax, image, name.replace("_", " "), unit)
        return ax

    def _row(self, at: _At) -> int:
        """The row of the stored instant."""
        return int(self._result._field_steps[self._result._index(**at)])

    def _values(self, name: Any, at: _At) -> Any:
        """A field, NaN where it is not finite. Rounding errors of a gap in contact are left out; at the hardness it may be negative."""
        result, row = self._result, self._row(at)
        values = result.field(name, **at)
        values = np.where(np.isfinite(values), values, np.nan)
        if name != "gap":
            return values
        closed = np.abs(values) < _ROUNDING * max(_draw.magnitude(result.initial_gap), abs(result.approach[row]))
        if "contact" in result.fields:
            closed |= result.field("contact", **at) == 1
        elif result.capped_area[row] == 0:
            closed |= result._touches(**at) > 0
        return np.where(closed, 0.0, values)

    def _tell(self, ax: Any, at: _At, place: str = "", notes: Sequence[str] = ()) -> None:
        """Sets the title of the axes: the place, the time if fields of several times are stored, and notes below, one in each line."""
        result, when = self._result, ""
        if len(result.field_times) > 1:
            when = f"{result._axis.symbol} = {quantity(float(result.field_times[result._index(**at)]), result._axis.unit)}"
        touches = result.contact_area[self._row(at)] > 0
        lines = [", ".join(part for part in (place, when) if part), *([] if touches else ["no contact"]), *notes]
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
        factor = _draw.scale(ax, "x", "mean pressure", "Pa", curve.mean_pressure)
        fraction = curve.contact_area_corrected / math.prod(curve[0].size) if corrected else curve.contact_fraction
        ax.plot(curve.mean_pressure * factor, 100 * fraction, **{"marker": ".", **style})
        share = "contact length [% of the domain]" if curve[0].is_line else "contact area [% of nominal]"
        ax.set_ylabel(f"{'corrected ' if corrected else ''}{share}")
        _draw.name_runs(ax, style)
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
        z -= np.nanmean(z)
        ax = _draw.axes(ax, style, "curve" if surface.is_line else "map", surface.size)
        if surface.is_line:
            ax.plot(surface.x * _draw.scale(ax, "x", "x", "m", surface.size[0]), z * _draw.scale(ax, "y", "height", "m", z), **style)
            return ax
        ax.set_title(_draw.stretched(surface.size, style))
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
        # Wave numbers of 1/µm, 1/mm or 1/m.
        longest = max(qx[-1], qy[-1])
        factor, text = (1e-6, "µm") if longest >= 1e6 else (1e-3, "mm") if longest >= 1e3 else (1.0, "m")
        image = _draw.centred(ax, powers, qx, qy, factor, (np.ptp(qx), np.ptp(qy)), {"cmap": "viridis", **style})
        ax.set(xlabel=f"qx [1/{text}]", ylabel=f"qy [1/{text}]")
        _draw.beside(ax, image, "log10 of the power spectrum C [m⁴]")
        return ax

    def autocorrelation(self, *, periodic: bool | None = None, ax: Axes | None = None, **style: Any) -> Axes:
        """Map of the autocorrelation function over the lags."""
        found, size = self._surface.autocorrelation(periodic=periodic), self._surface.size
        ax = _draw.axes(ax, style, "map", size)
        ax.set_title(_draw.stretched(size, style))
        factor, text = shown(_draw.magnitude(found.x, found.y), "m")
        image = _draw.centred(ax, found.values, found.x, found.y, factor, size, {"cmap": "RdBu_r", "vmin": -1.0, "vmax": 1.0, **style})
        ax.set(xlabel=f"lag along x [{text}]", ylabel=f"lag along y [{text}]")
        _draw.beside(ax, image, "autocorrelation")
        return ax

    def height_distribution(self, *, bins: int = 100, ax: Axes | None = None, **style: Any) -> Axes:
        """Density of the points over height."""
        z, density = self._surface.height_distribution(bins)
        ax = _draw.axes(ax, style)
        factor, text = shown(_draw.magnitude(z), "m")
        ax.plot(z * factor, density / factor, **style)
        ax.set(xlabel=f"height [{text}]", ylabel=f"density [1/{text}]")
        return ax

    def bearing_curve(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Height over the share of the surface above it."""
        z, share = self._surface.bearing_curve()
        ax = _draw.axes(ax, style)
        ax.plot(100 * share, z * _draw.scale(ax, "y", "height", "m", z), **style)
        ax.set(xlabel="share of the surface above [%]", xlim=(0, 100))
        return ax


def _load_displacement(approach: Any, load: Any, unit: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    if not np.any(load) and not (ax is not None and ax.lines) and "label" not in style:
        style = {**style, "label": "nothing touches"}
    return _over_displacement((approach, "approach"), (load, "load", unit), ax, style)


def _over_displacement(along: tuple[Any, str], across: tuple[Any, str, str], ax: Axes | None, style: dict[str, Any]) -> Axes:
    """A load over a displacement [m], both with their names, the load with its unit."""
    (displacement, name), (load, force, unit) = along, across
    ax = _draw.axes(ax, style)
    up, right = _draw.scale(ax, "y", force, unit, load), _draw.scale(ax, "x", name, "m", displacement)
    ax.plot(displacement * right, load * up, **_marked(style, displacement, load))
    _draw.settle(ax)
    _draw.settle(ax, "x")
    _draw.name_runs(ax, style)
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
    ax.set(xlabel="wavenumber q [1/m]", ylabel=f"power spectrum {words}")
    _draw.name_runs(ax, style)
    return ax


def fitted(fit: Fit, ax: Axes | None) -> Any:
    """Points and curves of a fit."""
    ax = _draw.axes(ax)
    fine = np.geomspace(fit.x[fit.x > 0].min(), fit.x.max(), 400)
    labels = {"relaxation": ["modulus"], "creep": ["compliance"], "dma": ["storage modulus", "loss modulus"]}[fit.kind]
    for k, (label, data, curve) in enumerate(zip(labels, fit.curves, fit.curve(fine))):
        ax.loglog(fit.x, data, "o^"[k], color=f"C{k}", markersize=3, alpha=0.6, label=f"{label}, measured")
        ax.loglog(fine, curve, color=f"C{k}", label=f"{label}, fitted")
    _few_numbers(ax.xaxis, ax.get_xlim())
    _few_numbers(ax.yaxis, ax.get_ylim())
    letter, compliance = ("E", "D") if fit.modulus == "young" else ("G", "J")
    names = {"relaxation": f"{letter}(t) [Pa]", "creep": f"{compliance}(t) [1/Pa]", "dma": f"{letter}′, {letter}″ [Pa]"}
    along = "angular frequency [rad/s]" if fit.kind == "dma" else "time [s]"
    ax.set(xlabel=along if fit.shift is None else f"reduced {along}", ylabel=names[fit.kind])
    _draw.draw_legend(ax)
    return ax


def recorded(along: tuple[str, str, Floats], name: str, measured: Floats, model: Floats, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """The load or depth of a test as points, and of its model as a line, over what `along` has: name, unit and numbers."""
    ax = _draw.axes(ax, style)
    words, unit, over = along
    across = over * _draw.scale(ax, "x", words, unit, over)
    up = _draw.scale(ax, "y", name, {"load": "N", "depth": "m"}[name], measured)
    ax.plot(across, measured * up, ".", markersize=3, color="0.6", label="measured")
    ax.plot(across, model * up, **{"label": "model", **style})
    _draw.draw_legend(ax)
    return ax


#: What the maps of force curves show.
_OF_CURVES = {"young": ("Young's modulus", "Pa"), "work": ("work of adhesion", "J/m²"), "exponent": ("exponent of the power law", "1")}
_ENDS = {"": "", "_low": "lower end of the 95 % interval", "_high": "upper end of the 95 % interval"}


def force_map(found: ForceMap, what: str, ax: Axes | None, style: dict[str, Any]) -> Axes:
    """A quantity of a map of force curves."""
    names = {name + end: (words, told, unit) for name, (words, unit) in _OF_CURVES.items() for end, told in _ENDS.items()}
    words, told, unit = names[choice("quantity", what, tuple(names))]
    # Intervals may have no upper end.
    values = np.where(np.isfinite(getattr(found, what)), getattr(found, what), np.nan)
    size = found.size or tuple(float(count) for count in values.shape)
    ax = _draw.axes(ax, style, "map", size)
    colours = {"cmap": "viridis", **_draw.in_si(style, unit)}
    style = {**_draw.robust(values, colours), "cmap": _draw.coloured(colours["cmap"], bad=_LIGHT)}
    if found.size is None:
        image = _draw.placed(ax, values, (0, size[0], 0, size[1]), size, style)
        ax.set(xlabel="x [pixels]", ylabel="y [pixels]")
    else:
        image = _draw.draw_map(ax, values, size, style)
    _draw.bar(ax, image, words, unit)
    empty = int(np.sum(np.isnan(values)))
    missing = f"{empty} of {values.size} pixels without a value (light)" if empty else ""
    ax.set_title("; ".join(part for part in (told, missing, _draw.stretched(size, style)) if part))
    return ax
