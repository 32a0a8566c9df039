"""Results: in memory or on disk, the same to use."""

from __future__ import annotations

import copy
import errno
import functools
import html
import json
import os
import tempfile
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _core, _html
from ._arrays import AnyArray, AnyPath, Floats, Labels, as_plane, cells_of, choice, frozen, in_hertz, meant, number, numbers_of, plain
from ._columns import COLUMNS, FIELDS, HISTOGRAMS, QUANTITIES, ROW, STRESS, VECTORS, dataset, frame, told, variable
from ._core import CaseError
from ._findings import Finding, findings_of, warn_caller
from ._given import given as case_of
from ._grid import OnGrid
from ._leakage import over_time, stored
from ._methods import paragraph
from ._rows import Columns, Field, StressColumns
from ._sealed import Sealed, read_only
from ._states import NO_HALF_SPACE, State
from ._stress import Stress, changing, stress
from ._units import written
from ._words import Flow, Gas, Nearest, Rarefaction, Sides
from .plot import Plots

if TYPE_CHECKING:
    import pandas  # type: ignore[import-not-found,import-untyped,unused-ignore]
    import xarray

    from ._converge import ErrorBar

class Axis(NamedTuple):
    """What the rows of a result follow one another in: times, or the velocities of steady states of motion."""

    #: Its name, also of its dimension.
    name: str
    #: Its symbol.
    symbol: str
    #: Its unit.
    unit: str


TIME = Axis("time", "t", "s")
VELOCITY = Axis("velocity", "v", "m/s")


class Cycle(NamedTuple):
    """One period of a cyclic load; made by :meth:`Result.cycles`."""

    #: Start of the period [s].
    start: float
    #: Its end [s].
    end: float
    #: External work over the period [J]: dissipated, where the cycle closes (`drift_work` is small).
    dissipated_energy: float
    #: Dynamic stiffness of the first harmonics [N/m].
    stiffness: float
    #: Loss angle of the first harmonics [rad]: the load leads the approach.
    loss_angle: float
    #: What of the work the mean load does over the drift of the approach from start to end [J]: 0 where the cycle closes.
    drift_work: float


class NotStored(CaseError, KeyError):
    """Nothing was stored at this time."""

    def __str__(self) -> str:
        return str(self.args[0])


class Result(OnGrid, Columns, StressColumns, Sealed):
    """What a run found: one-dimensional arrays over the rows, and fields at some of them.

    `time` [s], `load` [N], `approach` [m], `contact_area`, `contact_area_corrected`, `capped_area` [m^2],
    `contact_fraction`, `mean_pressure`, `max_pressure` [Pa], `mean_gap` [m], `iterations`, `convolutions`, `residual`,
    `certificate`, `time_error`, `stage` are attributes, and so are the requested quantities. The first row is
    the state right after t = 0.

    The arrays are read-only: take ``result.approach.copy()`` to change numbers. Fields of a result in memory are read-only views,
    those of a result on disk are read anew each time, into arrays of your own.
    """

    #: Lengths of the domain along x and y [m]; of a line contact along x.
    size: tuple[float, ...]
    #: Times at which fields were kept [s]; of a sweep the velocities [m/s].
    field_times: Floats
    #: Where the result is on disk; None for one in memory.
    path: str | None

    def __init__(
        self, *, table: dict[str, Any], fields: dict[str, Any], field_steps: Any, initial_gap: Any, size: Sequence[float],
        attributes: dict[str, Any], path: str | None = None, histograms: dict[str, tuple[Floats, Floats]] | None = None,
        field_times: Any = None, stress: dict[str, Floats] | None = None, leaks: dict[str, Floats] | None = None,
        store: _core.Store | None = None
    ) -> None:
        self._table: dict[str, Any] = read_only({name: np.asarray(values) for name, values in table.items()})
        self._fields: dict[str, Any] = read_only(dict(fields))
        self._field_steps = np.asarray(field_steps, dtype=np.int64)
        self._histograms: dict[str, tuple[Floats, Floats]] = read_only(histograms or {})
        self._stress, self._leaks = read_only(stress or {}), read_only(leaks or {})
        self._attributes, self._store = attributes, store
        # A field between two rows belongs to the later one, and has a time of its own.
        times = self._table["time"][self._field_steps] if field_times is None else np.asarray(field_times, dtype=np.float64)
        self._hold(size=tuple(float(length) for length in size), field_times=times, path=path)
        if initial_gap is not None:
            self._hold(initial_gap=np.asarray(initial_gap))
        # Of a sweep the velocities stand in place of the times.
        self._axis = VELOCITY if (self._setup.get("motion") or {}).get("steady") else TIME

    @functools.cached_property
    def initial_gap(self) -> Floats:
        """Undeformed gap [m], shape (nx, ny)."""
        store = self._disk()
        assert store is not None
        return frozen(_on_grid(store.initial_gap(), self.is_line))

    @property
    def _setup(self) -> dict[str, Any]:
        """The run in numbers."""
        return dict(json.loads(self._attributes.get("setup") or "{}"))

    def _column(self, name: str) -> Floats:
        """A column of the rows, or why there is none."""
        # A copy that is being made has no columns yet.
        held = self.__dict__
        columns: dict[str, Floats] = {**held.get("_stress", {}), **held.get("_table", {})}
        if "_axis" in held and self.is_sweep and "time" in columns:
            columns["velocity"] = columns.pop("time")
        if name in columns:
            return columns[name]
        reasons = {
            **{one: f"because it was not requested: quantities=[{one!r}]" for one in QUANTITIES},
            **{one: f"but one number for each bin: use histogram({one!r})" for one in held.get("_histograms", {})},
            **dict.fromkeys(STRESS, "which [stress] of a case, or `asperity stress RESULT`, stores; stress(time=...) computes it now"),
            "time": "because it is a sweep over velocities: use velocity",
            "field_velocities": "because it is a run in time: its fields have field_times",
            "y": "because a line contact has no y: nothing changes along it",
        }
        near = "" if name.startswith("_") else meant(name, [one for one in dir(self) if one[0] != "_"], 0.75)
        known = near or f"; it has {', '.join(ROW)}, field(name, time=...) and plot"
        raise AttributeError(f"the result has no {name!r}{f', {reasons[name]}' if name in reasons else known}")

    if not TYPE_CHECKING:  # where it would hide misspelt names

        def __getattr__(self, name):
            return self._column(name)

    def __dir__(self) -> list[str]:
        # Columns that it does not have are left out.
        here = {*self._table, *self._stress} - {"time"} | {self._axis.name}
        return sorted({*super().__dir__()} - {*COLUMNS, *STRESS} | here)

    def __len__(self) -> int:
        """Rows."""
        return len(self._table["time"])

    def __getstate__(self) -> dict[str, Any]:
        # Fields on disk are read, so that a pickle is whole.
        return {**self.__dict__, "_fields": {name: self._stack(name) for name in self._fields}, "initial_gap": self.initial_gap, "_store": None}

    @property
    def attributes(self) -> dict[str, Any]:
        """Title, version, status, the case and the work."""
        return copy.deepcopy(self._attributes)

    @property
    def error_bars(self) -> list[ErrorBar]:
        """The answers with their errors (``asperity run --error-bars``); empty where they were not computed."""
        return copy.deepcopy(self._attributes.get("error_bars", []))

    @property
    def findings(self) -> list[Finding]:
        """Where the numbers may be off (docs/findings.md): each with `code`, `severity`, `text`, `value`, `limit`, `rows`."""
        return findings_of(self._attributes.get("findings", []), of_case=bool(self._attributes.get("case")))

    @property
    def fields(self) -> list[str]:
        """Names of the fields that were kept."""
        return list(self._fields)

    @property
    def quantities(self) -> list[str]:
        """Names of the requested quantities."""
        return [*(name for name in self._table if name in QUANTITIES), *self._histograms]

    def histogram(self, name: str) -> tuple[Floats, Floats]:
        """Ends of the bins, and the numbers of all rows, shape (rows, bins), of "spot_histogram" (number of spots per class of
        area [m^2]), "pressure_histogram" or "gap_histogram" (probability densities [1/Pa], [1/m])."""
        if name not in self._histograms:
            raise CaseError(f"the histogram {name!r} was not requested; kept: {', '.join(self._histograms) or 'none'}")
        return self._histograms[name]

    @property
    def is_sweep(self) -> bool:
        """Whether its rows are steady states of motion, one for each `velocity`."""
        return self._axis == VELOCITY

    @property
    def field_velocities(self) -> Floats:
        """Velocities at which the fields of a sweep were kept [m/s]."""
        return self.field_times if self.is_sweep else self._column("field_velocities")

    def cycles(self, frequency: float, *, start: float = 0.0) -> list[Cycle]:
        """Dissipated energy, stiffness and loss angle of each full period 1/`frequency` [Hz] from `start` [s] on.

        The energy is the area of the hysteresis loop, the integral of W dw over the period; stiffness and loss angle are modulus and
        argument of the ratio of the first harmonics of load and approach (J. D. Ferry, Viscoelastic Properties of Polymers, 1980).
        Periods of fewer than 8 steps are left out.

        >>> import asperity as asp, numpy as np
        >>> punch = asp.Surface.flat_punch(cells=(32, 32), size=(1e-3, 1e-3), radius=0.3e-3)
        >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
        >>> load = asp.sine(mean=0.02, amplitude=0.01, frequency=0.2)
        >>> result = asp.solve(punch, zener, load=load, times=asp.uniform(20.0, 400), fields=[])
        >>> last = result.cycles(0.2)[-1]
        >>> storage, loss = zener.storage_loss(2 * np.pi * 0.2)        # full contact: the loss angle of the material
        >>> bool(abs(last.loss_angle - np.arctan2(loss, storage)) < 2e-3)
        True
        """
        time, load, approach = (self._table[name].tolist() for name in ("time", "load", "approach"))
        cycles, sines = in_hertz("frequency", frequency), [sine["frequency"] for sine in self._setup.get("sines") or []]
        if sines and not any(np.isclose(cycles, known, rtol=1e-6, atol=0.0) for known in sines):
            own = ", ".join(f"{known:g}" for known in dict.fromkeys(sines))
            angular = any(np.isclose(cycles, 2.0 * np.pi * known, rtol=1e-3, atol=0.0) for known in sines)
            hint = "; an angular frequency [rad/s] is divided by 2 pi" if angular else ""
            warn_caller(f"cycles of {cycles:g} Hz are asked for, but what was prescribed is a sine of {own} Hz{hint}")
        found = _core.cycles_of(time, load, approach, cycles, number("start", start))
        return [Cycle(*numbers) for numbers in found]

    @property
    def cells(self) -> tuple[int, ...]:
        """Number of cells along x and y; of a line contact along x."""
        return self.initial_gap.shape

    def units(self, name: str) -> str:
        """The unit of a number of the rows by its name, "1" where it has none: "N" or, of a line contact, "N/m" of the load."""
        if name == "time":
            return self._axis.unit
        if name not in COLUMNS:
            raise CaseError(f"{name!r} is no number of a row; there are {', '.join(COLUMNS)}")
        return COLUMNS[name].attributes(self.is_line)["units"]

    def field(
        self, name: Field, *, time: float | None = None, velocity: float | None = None, index: int | None = None, method: Nearest | None = None
    ) -> Floats:
        """A field of shape (nx, ny), of a line contact (n,), at the stored `time` [s], of a sweep the stored `velocity` [m/s], or with that
        index; default the last. Fields of a contact that moves are in its frame.

        A time at which nothing was stored is a KeyError that names its neighbours in `field_times`; with ``method="nearest"`` the field
        at the nearest stored time.

        "pressure" [Pa], "gap", "displacement", "flattening" [m], "contact" (0 out of contact, 1 in contact, 2 at the hardness, 3 slipping).
        Read-only for a result in memory, a new array for one on disk.
        """
        if name not in self._fields:
            choice("the field", name, list(FIELDS))
            raise CaseError(f"the field {name!r} was not kept; kept: {', '.join(self._fields) or 'none'}")
        values: Floats = self._fields[name][self._index(time, velocity, index, method)]
        return values

    def stress(
        self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, method: Nearest | None = None,
        depths: str | Sequence[float] = "auto", poisson: float | None = None, body: int = 0
    ) -> Stress:
        """The stress below the surface at the stored `time` [s], of a sweep the stored `velocity` [m/s], or with that index, or at the nearest
        time, as :meth:`field`; default the last.

        It follows from the stored pressure, under a tangential load also from the stored tractions, with the Poisson's ratio of the body of that number, or `poisson`; see
        :func:`asperity.stress`. Where that ratio changes with time (constant bulk modulus), the pressures of all rows must be kept. What a run or ``asperity stress`` stored are attributes over `field_times`: `max_mises` [Pa],
        `max_mises_depth`, `max_mises_x`, `max_mises_y` [m], the same for `tresca` and `tension`, and over `field_times` and
        `depth`: `mises_by_depth`, ...; NaN where the stress was not computed.

        >>> import asperity as asp
        >>> ball = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=20e-3)
        >>> steel = asp.Elastic(young=210e9, poisson=0.3)
        >>> result = asp.solve(ball, steel, load=10.0, times=[1.0])
        >>> below = result.stress()
        >>> bool(abs(below.survey()["max_mises"] / result.max_pressure[-1] - 0.62) < 0.03)
        True
        """
        setup = self._setup
        at: dict[str, Any] = {"time": time, "velocity": velocity, "index": index, "method": method}
        case = case_of(self) or {}
        if "shear_stress" in case.get("motion", {}) or case.get("flash", {}).get("friction"):
            warn_caller(
                "the stress is that of the pressure alone: the friction of the surfaces in motion is not in it. asperity.stress takes it with the bare "
                "pressure, as tractions=", UserWarning
            )
        if "layer_separable" in setup:
            raise CaseError(_core.LAYERED_STRESS)
        if setup.get("kernel") == "given":
            raise CaseError(NO_HALF_SPACE)
        if poisson is None:
            known = setup.get("poisson") or []
            if not 0 <= body < max(len(known), 1):
                raise CaseError(f"body is {body}, but the result has {len(known)} bodies, counted from 0")
            poisson = known[body] if known else None
            creep = (setup.get("poisson_creep") or [None] * (body + 1))[body]
            if poisson is None and creep is not None and "stage_controls" in setup:
                last = self._index(**at) + 1
                rows = self._table["time"][:last]
                if "motion" in setup:
                    raise CaseError("the stress of a contact that moves over a body of constant bulk modulus is not computed; give poisson=...")
                if not np.array_equal(self._field_steps, np.arange(len(self._field_steps))) or not np.array_equal(rows, self.field_times[:last]):
                    raise CaseError(
                        "the Poisson's ratio of the body changes with time (constant bulk modulus), so that the stress needs the pressures of "
                        "all rows, but not all were kept: keep every row, or give poisson=... for an estimate with a constant one"
                    )
                pressures = np.array([self._fields["pressure"][n] for n in range(last)])
                return changing(setup, body, (self._table["stage"][:last].astype(int).tolist(), rows.tolist()), pressures, self.size, depths)
            if poisson is None:
                raise CaseError("the result does not say the Poisson's ratio of the body, or it changes with the temperature; give poisson=...")
        pressure, tractions = self.field("pressure", **at), None
        if "friction" in setup:
            # What acts on the first body acts the other way on the second.
            tractions = [(-1.0 if body else 1.0) * self.field(name, **at) for name in ("traction_x", "traction_y")]
        return stress(pressure, size=self.size, poisson=poisson, depths=depths, boundary=setup.get("boundary", "free"), tractions=tractions)

    def to_xarray(self) -> xarray.Dataset:
        """The result as xarray.Dataset, as ``xarray.open_zarr`` gives it for one on disk, with the stress below the surface and the
        leaks that are stored in it. Its arrays are copies; their `units` are read by pint and cf-xarray. The load is ``data["load"]`` and `data.normal_load`:
        `data.load` is a method of xarray. What else was computed is merged, as in ``data.merge(result.stress().to_xarray())``."""
        along, at, line, table = self._axis.name, f"field_{self._axis.name}", self.is_line, self._table
        data: dict[str, Any] = {
            name: entry.variable((along, "axis")[: table[name].ndim], table[name], line)
            for name, entry in COLUMNS.items()
            if name != "time" and name in table
        }
        # Under this name too: `load` of a dataset is a method of xarray.
        data["normal_load"] = COLUMNS["load"].variable(along, table["load"], line)
        data |= {name: FIELDS[name].variable((at, *self._axes), self._stack(name)) for name in self._fields}
        stress = {name: STRESS[name].variable((at, "depth")[: values.ndim], values, line) for name, values in self._stress.items() if name != "depth"}
        for name in self._stress_fields:
            stress[name] = variable((at, "depth", *self._axes), self._stress_volume(name), "Pa", name.replace("_", " "))
        data |= {**stress, "initial_gap": variable(self._axes, self.initial_gap, "m", "undeformed gap")}
        coordinates = {
            along: variable(along, table["time"], self.units("time"), along),
            at: variable(at, self.field_times, self.units("time"), f"{along} of the fields"),
            **self._coordinates,
        }
        if any(name in table for name in VECTORS):
            coordinates["axis"] = variable("axis", [0.0, 1.0], "1", "0 along x, 1 along y")
        if "depth" in self._stress:
            coordinates["depth"] = STRESS["depth"].variable("depth", self._stress["depth"])
        for name, (edges, numbers) in self._histograms.items():
            places = _core.histogram_coordinates(name, edges, line)
            data[name] = QUANTITIES[name].variable((along, places[0][0]), numbers, line)
            coordinates |= {place: variable(place, ends, written(unit), words) for place, unit, words, ends in places}
        # Text, as all other attributes, so that the dataset can be written.
        lists: dict[str, Any] = {name: json.dumps(self._attributes[name]) for name in ("findings", "error_bars") if name in self._attributes}
        whole = dataset(data, coordinates, {**self._attributes, "findings": "[]", **lists})
        return whole.merge(stored(self), combine_attrs="override") if self._leaks else whole

    def leakage(
        self, *, direction: Flow | None = None, pressure_drop: float | None = None, viscosity: float | None = None,
        gas: Gas | None = None, molar_mass: float | None = None, temperature: float | None = None, inlet: float | None = None,
        outlet: float | None = None, rarefaction: Rarefaction | None = None, sides: Sides | None = None, smallest_gap: float | None = None,
        field: bool | None = None, time: float | None = None, velocity: float | None = None, index: int | None = None, method: Nearest | None = None
    ) -> xarray.Dataset:
        """Leakage at the times of the stored fields, or at one of them, as :meth:`field` takes it, as xarray.Dataset over `leak_time`, of
        steady states over `leak_velocity` (see :func:`leakage` and docs/leakage.md).

        Without arguments the leaks that the run stored. Otherwise those of a liquid (`pressure_drop` [Pa], `viscosity` [Pa s]), of a
        gas (`inlet`, `outlet` [Pa, absolute], `gas`, or `viscosity` and `molar_mass` [kg/mol]; `temperature` [K]; `rarefaction`), or
        without a fluid the gap alone. `field` adds `fluid_pressure`.
        """
        at: dict[str, Any] = {"time": time, "velocity": velocity, "index": index, "method": method}
        given = numbers_of({name: value for name, value in locals().items() if name not in ("self", "at", *at)})
        if any(one is not None for one in at.values()):
            return over_time(self, given, [self._index(**at)])
        return over_time(self, given) if given or not self._leaks else stored(self)

    def methods(self, *, bibtex: bool = False, case: bool = True) -> str:
        """A paragraph on what was run, for the methods section of a paper: model, surface, materials, load, steps, solver, errors and
        warnings; with `case` the text of a case file that runs it again follows, where arrays were given with remarks on them; with
        `bibtex` the entries of what the paragraph cites.

        >>> import asperity as asp
        >>> ball = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=20e-3)
        >>> rubber = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
        >>> result = asp.solve(ball, rubber, load=1e-3, times=asp.uniform(5.0, 20), fields=[])
        >>> print(result.methods().split(". ")[1])
        The surface is a sphere (radius 20 mm)
        >>> again = result.methods().split("SI units:")[1]
        >>> import tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     same = asp.run(again, output=folder + "/again.zarr")
        >>> bool((same.approach == result.approach).all())
        True
        """
        return paragraph(self, bibtex, case)

    @property
    def plot(self) -> Plots:
        """Figures by matplotlib: ``result.plot.evolution()``, ``result.plot.pressure(time=500.0)``, ..."""
        return Plots(self)

    def spots(self, *, time: float | None = None, velocity: float | None = None, index: int | None = None, method: Nearest | None = None) -> Labels:
        """The contact spots as a labelled image of shape (nx, ny): the number of the spot of each cell, 1 for the largest, 0 where
        nothing touches. Cells that share an edge are of one spot, on a periodic domain also across the borders. At a stored
        time, as :meth:`field`.

        >>> import asperity as asp
        >>> wave = asp.Surface.wave(cells=(32, 32), size=(1e-3, 1e-3), amplitude=1e-6, wavelength=(5e-4, 5e-4))
        >>> result = asp.solve(wave, asp.Elastic(young=1e9, poisson=0.3), pressure=1e4, times=[1.0], boundary="periodic")
        >>> int(result.spots().max())
        8
        """
        touches = self._touches(time=time, velocity=velocity, index=index, method=method).astype(np.float64)
        return _core.spot_labels(plain(as_plane(touches)), self._setup.get("boundary", "free")).reshape(touches.shape)

    def _state(self) -> State:
        """The last fields that were kept."""
        setup, gap = self._setup, self.field("gap") if "gap" in self._fields else None
        pressure = self.field("pressure") if "pressure" in self._fields else np.zeros(self.cells)
        return State(self.size, setup.get("boundary", "free"), gap, pressure, self._touches(), setup.get("poisson") or ())

    def _touches(self, **at: Any) -> AnyArray:
        """Where the surfaces touch at a stored instant: from the field that tells it."""
        coupling = (self._setup.get("leakage") or {}).get("coupling")
        pressure: Field = "contact_pressure" if self._setup.get("adhesion") or coupling else "pressure"
        for name in ("contact", pressure):
            if name in self._fields:
                return np.ascontiguousarray(self.field(name, **at) > 0, dtype=np.uint8)
        if "gap" not in self._fields:
            raise CaseError(f'the contact is told by one of the fields "contact", "{pressure}" and "gap"; the result keeps {", ".join(self._fields)}')
        gap = self.field("gap", **at)
        deepest = np.abs(gap[np.isfinite(gap)]).max(initial=0.0)
        return np.ascontiguousarray(gap <= 1e-9 * deepest, dtype=np.uint8)

    def to_dataframe(self) -> pandas.DataFrame:
        """The rows as pandas.DataFrame, with the time (of a sweep the velocity) as index and a column for each number, of a vector two,
        as `tangential_force_x`; units are in ``frame.attrs["units"]``."""
        along = self._axis.name
        columns: dict[str, AnyArray] = {}
        units = {along: self.units("time")}
        for name in (name for name in COLUMNS if name != "time" and name in self._table):
            values = self._table[name]
            parts = {f"{name}_{axis}": values[:, n] for n, axis in enumerate("xy")} if name in VECTORS else {name: values}
            columns |= {part: np.array(column) for part, column in parts.items()}
            units |= dict.fromkeys(parts, self.units(name))
        rows = frame({along: np.array(self._table["time"]), **columns}).set_index(along)
        rows.attrs["units"] = units
        return rows

    def save(self, path: AnyPath, *, force: bool = False) -> None:
        """Writes the result as a Zarr group, as a run of a case file does: :func:`open` and xarray read it. Stress below the surface
        and leaks that are stored with the result are written too.

        Raises
        ------
        OSError : something is at the path already (and `force` is not given), or the disk refuses
        """
        if len(self) == 0:
            raise CaseError("the result has no rows to save")
        attributes = self._attributes
        if not force and os.path.exists(path):
            raise FileExistsError(errno.EEXIST, "exists already; choose another path or replace it with force=True", os.fspath(path))
        histograms = {name: (plain(edges), plain(numbers)) for name, (edges, numbers) in self._histograms.items()}
        quantities = {name: (np.empty(0), self._table[name].reshape(len(self), -1)) for name in self._table if name in QUANTITIES}
        columns = {**quantities, **histograms}
        ends = [(name, edges) for name, (edges, _) in columns.items()]
        # All of it is read first: it may be replaced.
        stacks = {name: self._stack(name).reshape(-1, *self.cells, *[1] * self.is_line) for name in self._fields}
        title, setup, gap = str(attributes.get("title") or ""), str(attributes.get("setup") or "{}"), plain(as_plane(self.initial_gap))
        writer = _core.Writer(os.fspath(path), force, title, setup, list(self.size), gap, list(self._fields), ends, len(self))
        for n in range(len(self)):
            row = {name: float(self._table[name][n]) for name in ROW}
            maps: dict[str, Any] = {}
            for k in np.flatnonzero(self._field_steps == n).tolist():
                fields = {name: np.require(stack[k], None, ["C_CONTIGUOUS", "ALIGNED"]) for name, stack in stacks.items()}
                # A state between the row before and this one has a time of its own.
                if self.field_times[k] < row["time"]:
                    writer.stage(float(self.field_times[k]), fields)
                else:
                    maps = fields
            writer.append(row, [float(number) for _, numbers in columns.values() for number in numbers[n]], maps)
        writer.finish(str(attributes.get("status") or "complete"), json.dumps(attributes.get("findings", [])), None)
        if self.path is not None and (self._stress or self._leaks):
            _core.derive_again(self.path, os.fspath(path))

    def report(self, path: AnyPath, *, force: bool = False, megabytes: int = 12) -> None:
        """Writes the result as one HTML page with maps and curves, of that size at most.

        It shows the fields that were kept.
        """
        if self.path is not None:
            _core.report(self.path, os.fspath(path), force, megabytes * 1_000_000)
            return
        with tempfile.TemporaryDirectory() as folder:
            stored = os.path.join(folder, "result.zarr")
            self.save(stored)
            _core.report(stored, os.fspath(path), force, megabytes * 1_000_000)

    def __repr__(self) -> str:
        title = self._attributes.get("title") or "Result"
        cells = cells_of(self.initial_gap)
        if len(self) == 0:
            return f"<{title}: no rows yet, {cells}>"
        return (
            f"<{title}: {len(self)} rows to {self._axis.symbol} = {self._table['time'][-1]:g} {self._axis.unit}, {cells}; "
            f"approach {self.approach[-1]:.4g} m, contact {100 * self.contact_fraction[-1]:.4g} %; "
            f"fields {', '.join(self._fields) or 'none'} at {len(self._field_steps)} times>"
        )

    def _repr_html_(self) -> str:
        title = html.escape(str(self._attributes.get("title") or "Result"))
        size = " x ".join(f"{length:g} m" for length in self.size)
        rows = [("domain", f"{cells_of(self.initial_gap)}, {size}"), ("rows", str(len(self)))]
        if len(self):
            last = {name: self._table[name][-1] for name in ROW}
            rows += [(self._axis.name, f"{last.pop('time'):.6g} {self._axis.unit}"), *told(last, self.is_line)]
        return f"<b>{title}</b>, last row:{_html.table(rows)}"

    def _index(
        self, time: float | None = None, velocity: float | None = None, index: int | None = None, method: Nearest | None = None
    ) -> int:
        """The number of the stored instant."""
        if method is not None:
            choice("method", method, Nearest)
        kept = len(self._field_steps)
        if kept == 0:
            raise CaseError("no fields were kept")
        if (time if self.is_sweep else velocity) is not None:
            raise CaseError("velocity= is for a sweep over velocities, time= for a run in time")
        given = velocity if self.is_sweep else time
        if given is not None and index is not None:
            raise CaseError("give time or index, exactly one of them")
        if given is not None:
            what, unit = self._axis.name, self._axis.unit
            wanted, end = number(what, given), max(np.max(self._table["time"]), np.max(self.field_times))
            # Times that are written with 12 digits are those of rows.
            if not -1e-12 * end <= wanted <= (1 + 1e-12) * end:
                raise CaseError(f"{what} is {wanted:g} {unit}, but must be one of the run, 0 {unit} to {end:g} {unit}")
            # Of two at the same time, before and after a jump, the later.
            nearest = int(kept - 1 - np.argmin(np.abs(self.field_times - wanted)[::-1]))
            # Times that were computed in another way differ by rounding.
            if method is None and abs(self.field_times[nearest] - wanted) > 1e-9 * abs(wanted) + 1e-12 * end:
                raise NotStored(self._neighbours(what, unit, wanted))
            return nearest
        if not -kept <= (place := -1 if index is None else index) < kept:
            raise CaseError(f"index is {index}, but fields were kept at {kept} times")
        return int(place) % kept

    def _neighbours(self, what: str, unit: str, wanted: float) -> str:
        """Where the fields beside a time or velocity are."""
        stored = np.unique(self.field_times)
        beside = [f"{float(one):.9g} {unit}" for one in (*stored[stored < wanted][-1:], *stored[stored > wanted][:1])]
        return f'no fields were kept at {what} {wanted:.9g} {unit}, but at {" and ".join(beside)}: give one of these, or method="nearest"'

    def _stress_volume(self, name: str) -> Floats:
        """A stored stress field of shape (field_time, depth, x, y), of a line (field_time, depth, x)."""
        store = self._disk()
        assert store is not None
        depths = range(len(self._stress["depth"]))
        found = np.array([[store.stress_field(name, n, depth) for depth in depths] for n in range(len(self._field_steps))])
        return _on_grid(found, self.is_line)

    @property
    def _leaks_along(self) -> str:
        """What the leaks follow one another in: `leak_time`, or `leak_velocity` in a sweep."""
        return f"leak_{self._axis.name}"

    @property
    def _fluid_pressures(self) -> Floats | None:
        """Pressures of the fluid of shape (leak_time, x, y), where they are stored."""
        if (store := self._disk()) is None or not store.has_fluid_pressure:
            return None
        return np.array([store.fluid_pressure(n) for n in range(len(self._leaks[self._leaks_along]))])

    @property
    def _stress_fields(self) -> list[str]:
        """Names of the stress fields that are stored."""
        return [] if not self._stress or (store := self._disk()) is None else store.stress_fields

    def _disk(self) -> _core.Store | None:
        """The result on disk; a copy in another process opens it again."""
        return self._store if self._store is not None or self.path is None else _core.Store(self.path)

    def _stack(self, name: str) -> Floats:
        """A field at all kept times."""
        return np.asarray(self._fields[name])


class _OnDisk:
    """A field of a result on disk, at all its kept times; each is read when it is used."""

    def __init__(self, store: _core.Store, name: str) -> None:
        self._store, self._name = store, name

    def __getitem__(self, index: int) -> Floats:
        return _on_grid(self._store.field(self._name, index), len(self._store.size) == 1)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        maps = [self[n] for n in range(len(self._store.field_steps))]
        return np.array(maps) if maps else np.empty((0, *self._store.cells))


def _on_grid(values: Floats, line: bool) -> Floats:
    """Values of cells as the core gives them, (..., nx, ny); those of a line as (..., nx)."""
    return values[..., 0] if line else values


def attributes_of(title: str, status: str, setup: dict[str, Any], findings: list[Finding]) -> dict[str, Any]:
    """The attributes of a result in memory, as a run of a case file stores them."""
    layers = {"layer_separable": int(setup["layer_separable"]), "layer_misfit": setup["layer_misfit"]} if "layer_separable" in setup else {}
    known = {"title": title, "version": _core.__version__, "status": status, "setup": json.dumps(setup)}
    return {**known, **layers, "findings": [dict(finding) for finding in findings]}


def _stored(store: _core.Store, name: str) -> Floats:
    """A column of the rows; of a vector of shape (rows, 2)."""
    return np.column_stack([store.series(f"{name}_{axis}") for axis in "xy"]) if name in VECTORS else store.series(name)


def open(path: AnyPath) -> Result:
    """Opens a result on disk, finished or not; its fields are read when they are used."""
    store = _core.Store(os.fspath(path))
    table = {name: _stored(store, name) for name in [*ROW, *store.quantities] if name not in HISTOGRAMS}
    histograms = {name: store.histogram(name) for name in store.quantities if name in HISTOGRAMS}
    fields = {name: _OnDisk(store, name) for name in store.fields}
    return Result(
        table=table, histograms=histograms, fields=fields, field_steps=store.field_steps, field_times=store.field_times, initial_gap=None,
        size=store.size, attributes=json.loads(store.attributes), path=os.fspath(path), stress=store.stress(), leaks=store.leaks(), store=store
    )
