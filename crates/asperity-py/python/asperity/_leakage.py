"""Leakage: flow of a fluid through the gap."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arrays import ArrayLike, Floats, Scalar, Size, centres, choice, field, in_order, number, numbers_of, pair
from ._columns import GAS_LEAKS, LEAKS, dataset, variable
from ._findings import Finding, findings_of, warn, warn_caller
from ._paragraphs import of_leak
from ._sealed import Sealed
from ._states import HasState, refuse_beside, said
from ._surface import Labelled, SurfaceLike, _parts
from ._words import Flow, Gas, Rarefaction, Sides

if TYPE_CHECKING:
    import xarray

    from ._result import Result

#: Numbers of a leak that say yes or no.
_FLAGS = ("percolates", "leak_resolved")


class Leakage(Sealed):
    """The flow through one gap: numbers as attributes, lengths in m.

    Whether inlet and outlet are connected (`percolates`); the gap of the parallel plates that leak as much (`hydraulic_gap`); the
    narrowest place of the widest path (`critical_gap`, NaN for a tight seal, at `critical_x`, `critical_y`, `critical_width` open cells
    across it or None); the hydraulic gap of Bruggeman's effective medium (`medium_gap`); `open_fraction`; pockets (`trapped_area`,
    `trapped_volume`); `conductance` (2, 2) [m^3] where both directions were asked for. Fields of shape (nx, ny): `pressure` (1 at the
    inlet to 0 at the outlet, NaN where there is no fluid or no connection) and `cells` (0 closed, 1 connected to inlet and outlet,
    2 to the inlet alone, 3 to the outlet alone, 4 pocket). `leak_resolved` is False where the constriction is less than four cells
    wide (`findings` says so, and how many cells are closed because their gap is below its error; the error of the gap and the pressure of the contact are known of a :class:`Result` only).
    """

    percolates: bool
    hydraulic_gap: float
    critical_gap: float
    critical_x: float
    critical_y: float
    critical_width: int | None
    medium_gap: float
    open_fraction: float
    trapped_area: float
    trapped_volume: float
    pressure: Floats
    leak_resolved: bool
    cells: Any
    #: Effective conductance [m^3], where direction is "both".
    conductance: Floats | None

    def __init__(self, gap: Floats, contact: Any, size: tuple[float, float], keys: dict[str, Any]) -> None:
        # Leaks of a gas are computed later: the array of the caller may have changed until then.
        self._gap, self._contact, self._size, self._keys = np.array(gap), contact, size, keys
        found = self._solved({})
        self._findings = json.loads(found.pop("findings"))
        found["conductance"] = None if found["conductance"] is None else np.array(found["conductance"])
        # The leaks of a fluid are those of its pressures.
        self._hold(**{name: found[name] for name in Leakage.__annotations__})

    @property
    def findings(self) -> list[Finding]:
        """What was found against the numbers."""
        return findings_of(self._findings)

    def _solved(self, fluid: dict[str, Any]) -> dict[str, Any]:
        return _core.leakage(self._gap, self._contact, list(self._size), json.dumps({**self._keys, **fluid}), [], 0.0)

    def leak_rate(self, *, pressure_drop: float, viscosity: float) -> float:
        """Leak of a liquid [m^3/s] under a pressure drop [Pa], with a viscosity [Pa s] (water: 1e-3)."""
        along, across = self._size if self._keys["direction"] != "y" else self._size[::-1]
        drop, mu = number("pressure_drop", pressure_drop), number("viscosity", viscosity)
        if not (drop > 0 and mu > 0 and np.isfinite([drop, mu]).all()):
            raise _core.CaseError(f"pressure_drop is {drop} Pa and viscosity {mu} Pa s, but both must be greater than 0")
        return self.hydraulic_gap**3 * drop * across / (12 * mu * along)

    def gas_leak_rate(
        self, *, inlet: float, outlet: float, gas: Gas | None = None, viscosity: float | None = None,
        molar_mass: float | None = None, temperature: float = 293.15, rarefaction: Rarefaction = "boltzmann", standard: bool = False
    ) -> float:
        """Leak of a gas [kg/s] between absolute pressures [Pa]; with `standard` in Pa m^3/s at 0 degC (1 mbar l/s = 0.1 Pa m^3/s).

        Parameters
        ----------
        inlet, outlet : absolute pressures [Pa], the inlet above the outlet, which may be 0
        gas : "air", "nitrogen", "oxygen", "helium" or "hydrogen"; or give `viscosity` [Pa s] and `molar_mass` [kg/mol]
        temperature : [K]
        rarefaction : "boltzmann", "slip" or "continuum"
        """
        fluid = {name: value for name, value in locals().items() if name not in ("self", "standard")}
        choice("rarefaction", rarefaction, Rarefaction)
        if gas is not None:
            choice("gas", gas, Gas)
        return float(self._solved(numbers_of(fluid))["leak_rate_standard" if standard else "leak_rate"])

    def to_xarray(self) -> xarray.Dataset:
        """The numbers of the leak and its fields, `fluid_pressure` (1 at the inlet to 0 at the outlet) and `leak_cells`, as xarray.Dataset.

        >>> import asperity as asp, numpy as np
        >>> data = asp.leakage(np.full((8, 4), 1e-6), size=(1e-3, 5e-4), sides="periodic").to_xarray()
        >>> data.hydraulic_gap.attrs["units"], data.fluid_pressure.dims
        ('m', ('x', 'y'))
        """
        numbers = {name: getattr(self, name) for name in LEAKS if name in Leakage.__annotations__}
        data = {name: LEAKS[name].variable((), bool(value) if name in _FLAGS else value) for name, value in numbers.items()}
        data["fluid_pressure"] = variable(("x", "y"), self.pressure, "1", "pressure of the fluid over the pressure drop")
        data["leak_cells"] = variable(("x", "y"), self.cells, "1", "0 closed, 1 through, 2 from the inlet, 3 from the outlet, 4 pocket")
        if self.conductance is not None:
            data["conductance"] = variable(("flow_direction", "gradient_direction"), self.conductance, "m^3", "effective conductance")
        places = {axis: variable(axis, centres(n, length), "m", axis) for axis, n, length in zip("xy", self._gap.shape, self._size)}
        return dataset(data, places)

    def methods(self, *, bibtex: bool = False) -> str:
        """A paragraph on what was computed, for the methods section of a paper; with `bibtex` the entry to cite."""
        return of_leak(self, bibtex)

    def __repr__(self) -> str:
        nx, ny = self._gap.shape
        if not self.percolates:
            return f"<Leakage: tight, {nx} x {ny} cells, {100 * self.open_fraction:.3g} % open>"
        return f"<Leakage: hydraulic gap {self.hydraulic_gap:.4g} m, critical gap {self.critical_gap:.4g} m, {nx} x {ny} cells>"


def leakage(
    gap: SurfaceLike | HasState, contact: ArrayLike | Labelled | None = None, *, size: Size = None, direction: Flow = "x", sides: Sides | None = None,
    smallest_gap: Scalar = 0.0
) -> Leakage:
    """The flow of a fluid through a gap, between opposite borders of the domain, by Reynolds' equation.

    Parameters
    ----------
    gap : an :class:`ElasticContact`, a :class:`Result` (its last fields) or a :class:`Step`, with its touching cells, size and boundary, or
        the gap between the surfaces [m], array (nx, ny)
    contact : where the surfaces touch (nonzero); default: where the gap is not above its error, the deepest negative gap (a note
        `gaps-below-error` in `findings` counts the cells that this closes)
    size : lengths of the domain along x and y [m]; a gap as xarray array with coordinates needs none
    direction : "x" or "y"; "both": along x, and the effective conductance of a gap that repeats in both directions
    sides : "periodic" or "closed"; default: those of the contact, and of a bare array "periodic", with a warning
    smallest_gap : cells with a smaller gap are closed [m]

    Raises
    ------
    CaseError : the input is wrong

    Examples
    --------
    A gap that varies along the flow: 1/T is the mean of 1/h^3, (1 - e^2)^(5/2)/(1 + e^2/2) for h = 1 + e cos.

    >>> import asperity as asp, numpy as np
    >>> x = (np.arange(128) + 0.5) / 128
    >>> gap = np.tile(1e-6 * (1 + 0.5 * np.cos(2 * np.pi * x))[:, None], (1, 4))
    >>> leak = asp.leakage(gap, size=(1e-3, 1e-4), sides="periodic")
    >>> bool(abs(leak.hydraulic_gap**3 / 1e-18 - 0.4330127018922193) < 1e-9)
    True
    >>> f"{leak.leak_rate(pressure_drop=2e5, viscosity=1e-3):.3e} m3/s"
    '7.217e-13 m3/s'
    >>> f"{10 * leak.gas_leak_rate(inlet=2e5, outlet=1e5, gas='air', standard=True):.2e} mbar l/s"
    '4.20e-05 mbar l/s'
    """
    keys = {"direction": choice("direction", direction, Flow), "smallest_gap": number("smallest_gap", smallest_gap)}
    if isinstance(gap, HasState):
        refuse_beside("leakage", gap, {"contact": contact, "size": size})
        state = gap._state()
        if state.gap is None:
            raise _core.CaseError("leakage needs the field 'gap', which the result does not keep: fields=['pressure', 'gap']")
        if len(state.size) == 1:
            raise _core.CaseError("leakage needs a contact over a plane: through a line contact nothing flows")
        usual: Sides = "periodic" if state.boundary == "periodic" else "closed"
        keys["sides"] = choice("sides", usual if sides is None else sides, Sides)
        if direction == "both" and state.boundary != "periodic":
            raise _core.CaseError("direction is 'both', the conductance of a gap that repeats, but the domain is free: use 'x' or 'y'")
        return Leakage(state.gap, state.touches, pair("size", state.size), keys)
    keys["sides"] = choice("sides", said("leakage", "sides", sides, "periodic", '"periodic" or "closed"'), Sides)
    values, extent, _ = _parts(gap, size, "gap")
    h = field("gap", values)
    extent = pair("size", extent)
    held = None if contact is None else in_order("contact", contact, extent)
    touches = None if held is None else np.ascontiguousarray(np.asarray(getattr(held, "magnitude", held)) != 0, dtype=np.uint8)
    if touches is not None and touches.shape != h.shape:
        raise _core.CaseError(f"contact has shape {touches.shape}, but gap has {h.shape}")
    widest = float(h[np.isfinite(h)].max(initial=0.0))
    if widest > max(extent):
        told = f"the gap is up to {widest:.4g} m wide on a domain of {max(extent):.4g} m: the gap [m] comes first, then where the surfaces touch"
        warn_caller(f"{told}; check the units too [unlikely-unit]")
    return Leakage(h, touches, extent, keys)


def over_time(result: Result, keys: dict[str, Any], instants: Sequence[int] | None = None) -> xarray.Dataset:
    """The leaks at the times of a result's fields, all of them or those with these numbers."""
    if result.is_line:
        raise _core.CaseError("leakage needs a contact over a plane: through a line contact nothing flows")
    if "gap" not in result.fields:
        raise _core.CaseError("leakage needs the field 'gap'; the result keeps " + (", ".join(result.fields) or "no fields"))
    setup = result._setup
    boundary = setup.get("boundary", "free")
    keys = {"sides": "periodic" if boundary == "periodic" else "closed", **keys}
    if keys.get("direction") == "both" and boundary != "periodic":
        raise _core.CaseError("direction is 'both', the conductance of a gap that repeats, but the domain is free: use 'x' or 'y'")
    for name, words in (("direction", Flow), ("sides", Sides), ("gas", Gas), ("rarefaction", Rarefaction)):
        if name in keys:
            choice(name, keys[name], words)
    temperatures = [(float(t), float(kelvin)) for t, kelvin in (setup.get("leakage") or {}).get("temperatures", [])]
    tolerance = float(setup.get("solver_tolerance", 1e-6))
    rows: list[dict[str, Any]] = []
    states: list[tuple[int | None, float | None, int | None, float, float | None, float]] = []
    drop = keys["inlet"] - keys["outlet"] if "inlet" in keys and "outlet" in keys else keys.get("pressure_drop")
    for index in range(len(result.field_times)) if instants is None else instants:
        time = result.field_times[index]
        gap = result.field("gap", index=index)
        contact = result._touches(index=index)
        found = _core.leakage(np.ascontiguousarray(gap), contact, list(result.size), json.dumps(keys), temperatures, float(time))
        step = int(result._field_steps[index])
        touching = (gap - result.initial_gap)[contact > 0]
        # The mean displacement in the contact, to which the tolerance is relative.
        displacement = float(touching.mean()) + float(result.approach[step]) if touching.size else 0.0
        narrowest = found["critical_gap"] if found["percolates"] else None
        states.append((step, narrowest, found["critical_width"], tolerance * abs(displacement), drop, float(result.mean_pressure[step])))
        rows.append(found)
    resolved, told = _core.judge_leaks(states, json.dumps({"preparation": setup.get("preparation", [])}))
    for row, good in zip(rows, resolved):
        row["leak_resolved"] = good
    warn(findings_of(json.loads(told)))
    columns = {name: np.array([row[name] for row in rows]) for name in (*LEAKS, "leak_rate_standard", "conductance") if rows[0].get(name) is not None}
    pressures = np.array([row["pressure"] for row in rows]) if keys.get("field") else None
    along = result.field_times if instants is None else result.field_times[list(instants)]
    return _dataset(result, {**columns, result._leaks_along: along}, pressures)


def stored(result: Result) -> xarray.Dataset:
    """The leaks that a result on disk holds."""
    return _dataset(result, result._leaks, result._fluid_pressures)


def _dataset(result: Result, columns: dict[str, Any], pressures: Any) -> xarray.Dataset:
    """Leaks over time with their units."""
    entries = GAS_LEAKS if "leak_rate_standard" in columns else LEAKS
    along, axis = result._leaks_along, result._axis
    values = {name: columns[name].astype(bool) if name in _FLAGS else columns[name] for name in columns if name in entries}
    data: dict[str, Any] = {name: entries[name].variable(along, column) for name, column in values.items()}
    data[along] = variable(along, columns[along], axis.unit, f"{axis.name} of the leak")
    if "conductance" in columns:
        tensor = columns["conductance"].reshape(-1, 2, 2)
        data["conductance"] = variable((along, "flow_direction", "gradient_direction"), tensor, "m^3", "effective conductance")
        data |= {axis: (axis, ["x", "y"]) for axis in ("flow_direction", "gradient_direction")}
    if pressures is not None:
        data["fluid_pressure"] = variable((along, "x", "y"), pressures, "Pa", "pressure of the fluid")
        data |= result._coordinates
    return dataset(data)
