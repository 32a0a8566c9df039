"""Elastic contacts."""

from __future__ import annotations

import functools
import json
import math
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypedDict, overload

import numpy as np

from . import _core, _html
from ._arrays import AnyArray, AnyPath, ArrayLike, Counts, Floats, Labels, Scalar, Size, array, as_plane, cells_of, check_places, choice, count, field, frozen, number
from ._columns import FIELDS, ROW, frame, told
from ._core import CaseError
from ._findings import Finding, findings_of, warn
from ._grid import OnGrid
from ._histories import one_of
from ._problem import hardness_of, in_json
from ._result import Result, attributes_of
from ._rows import OF_CONTACT, ContactColumns, ContactNumbers
from ._sealed import ReadOnlyArrays, Sealed
from ._spoken import spoken
from ._states import NO_HALF_SPACE, State, touching
from ._surface import Surface, SurfaceLike, check_boundary, per_cell, surface_of
from ._units import bare, is_labelled
from ._words import Boundary, Method
from .plot import CurvePlots, Plots

if TYPE_CHECKING:
    import pandas  # type: ignore[import-not-found,import-untyped,unused-ignore]
    import xarray
    from typing_extensions import Unpack

#: A kernel: numbers, or a function of two coordinates that gives them.
Kernel = ArrayLike | Callable[[Floats, Floats], ArrayLike]


@dataclass(frozen=True, eq=False)
class ConvergenceHistory(ReadOnlyArrays):
    """What a solver did, one entry for each iteration, and the state in which it stopped."""

    iteration: Counts
    #: Largest violation of the contact conditions over the mean displacement, before the step.
    residual: Floats
    #: Cells in the working set.
    working_cells: Floats
    #: Kind of the step, "converged" at the end.
    step: tuple[str, ...]
    #: Convolutions so far.
    convolutions: Counts

    def __len__(self) -> int:
        return len(self.iteration)

    def to_dataframe(self) -> pandas.DataFrame:
        """The history as pandas.DataFrame."""
        return frame(vars(self)).set_index("iteration")

    def __repr__(self) -> str:
        return f"<ConvergenceHistory: {len(self)} entries, residual {self.residual[0]:.2e} to {self.residual[-1]:.2e}>"


class _Planned:
    """The contact of one surface, planned for any number of loads."""

    def __init__(self, surface: Surface, modulus: float, hardness: Any, kernel: Any, keys: dict[str, Any]) -> None:
        self.gap: Floats = frozen(surface.gap())
        self.origin, self.history, self.since = surface._origin, surface.history, surface._since
        self.size, self.keys, self.kernel = surface.size, {"contact_modulus": modulus, **keys}, kernel
        # The array of the caller may change.
        self.hardness: Any = np.array(hardness) if isinstance(hardness, np.ndarray) else hardness

    @functools.cached_property
    def core(self) -> _core.Elastic:
        """The plan; a copy makes its own when it needs one."""
        limit = self.hardness if isinstance(self.hardness, float) else math.inf
        cells = as_plane(self.hardness) if isinstance(self.hardness, np.ndarray) else None
        with spoken():
            return _core.Elastic(gap=as_plane(self.gap), size=list(self.size), hardness=limit, hardness_map=cells, kernel=self.kernel, **self.keys)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "core"}

    def is_for(self, surface: Surface, modulus: float, hardness: Any, kernel: Any, keys: dict[str, Any]) -> bool:
        """Whether it was planned for this."""
        same = self.keys == {"contact_modulus": modulus, **keys} and self.size == surface.size
        return same and np.array_equal(self.hardness, hardness) and np.array_equal(self.kernel, kernel) and np.array_equal(self.gap, surface.gap())

    def solve(self, control: str, value: float, start: Floats | None, history: bool, out: Any) -> ElasticContact:
        """One contact."""
        core = self.core
        with spoken():
            found = core.solve(control, value, None if start is None else as_plane(start), history)
        fields = {name: found.pop(name).reshape(self.gap.shape) for name in ("pressure", "displacement")}
        lent = {name: out[name].view() for name in fields if name in out}
        for name, values in lent.items():
            values[...] = fields[name]
        findings, iterations = findings_of(json.loads(found.pop("findings"))), found.pop("history")
        told = None
        if history:
            numbers, residual, working, steps, convolutions = zip(*iterations)
            counts = (np.array(values, dtype=np.int64) for values in (numbers, convolutions))
            told = ConvergenceHistory(next(counts), np.array(residual), np.array(working), steps, next(counts))
        contact = ElasticContact(self, found, fields | lent, findings, told, lent)
        if "gap" in out:
            out["gap"][...] = contact.gap
        return contact


class ElasticContact(OnGrid, ContactNumbers, Sealed):
    """The solution of one elastic contact; made by :func:`elastic`. Fields have the shape (nx, ny), of a line contact (n,).

    Its numbers are those of a row of a :class:`Result`; all arrays are read-only.
    """

    #: Pressure [Pa], positive in compression.
    pressure: Floats
    #: Normal displacement [m].
    displacement: Floats
    #: Undeformed gap [m].
    initial_gap: Floats
    #: Lengths of the domain [m].
    size: tuple[float, ...]
    #: E* [Pa].
    contact_modulus: float
    #: "free" or "periodic".
    boundary: Boundary
    #: "projected-cg" or "polonsky-keer", and the largest residual that it was to leave.
    method: Method
    tolerance: float
    #: Largest pressure [Pa], of all cells or of each; None where there is none.
    hardness: float | Floats | None
    #: What the solver did, where it was asked for.
    history: ConvergenceHistory | None

    def __init__(
        self, planned: _Planned, row: dict[str, Any], fields: dict[str, Floats], findings: list[Finding], history: ConvergenceHistory | None, lent: dict[str, Floats]
    ) -> None:
        self._planned, self._row, self._findings = planned, row, findings
        self._stiffness: float | None = None
        # Fields in arrays of the caller, which may change: each with its checksum.
        self._lent = {name: (frozen(values), _checksum(values)) for name, values in lent.items()}
        given = {name: planned.keys[name] for name in ("contact_modulus", "boundary", "method", "tolerance")}
        self._hold(**fields, **given, initial_gap=planned.gap, size=planned.size, hardness=planned.hardness, history=history)

    def _number(self, name: str) -> Any:
        return self._row[name]

    @property
    def findings(self) -> list[Finding]:
        """Where the numbers may be off (docs/findings.md)."""
        return findings_of(self._findings)

    def _whole(self, what: str) -> None:
        """Refuses to work with fields that were changed since the contact was solved."""
        for name, (values, checksum) in self._lent.items():
            if _checksum(values) != checksum:
                raise CaseError(
                    f"{what} needs the {name} of this contact, but the array that was given as out= has changed since, by another solve "
                    "perhaps: ask for it before that, or give each contact an array of its own"
                )

    @property
    def gap(self) -> Floats:
        """Gap of the deformed surfaces [m]; below zero where the pressure is cut off."""
        if "displacement" in self._lent:
            self._whole("the gap")
        return frozen(self.initial_gap + self.displacement - self.approach)

    @property
    def cells(self) -> tuple[int, ...]:
        """Number of cells along x and y; of a line contact along x."""
        return self.pressure.shape

    @property
    def stiffness(self) -> float:
        """Contact stiffness dW/dw [N/m], of a line contact per length [N/m^2]: at a contact of that area, of cells below the hardness.
        Computed when it is first asked for.
        """
        if self._stiffness is None:
            self._whole("the stiffness")
            self._stiffness = self._planned.core.stiffness(np.array(as_plane(self.pressure)))
        return self._stiffness

    def spots(self) -> Labels:
        """The contact spots as a labelled image; see :meth:`Result.spots`."""
        self._whole("a map of the spots")
        return _core.spot_labels(np.array(as_plane(self.pressure)), self.boundary).reshape(self.pressure.shape)

    def _state(self) -> State:
        self._whole("its state")
        other = None if self._planned.kernel is None else NO_HALF_SPACE
        return State(self.size, self.boundary, self.gap, self.pressure, touching(self.pressure), no_stress=other)

    @property
    def _setup(self) -> dict[str, Any]:
        """The contact in numbers, as a result has them."""
        known = {"boundary": self.boundary, "contact_modulus": self.contact_modulus, "solver_method": self.method, "solver_tolerance": self.tolerance}
        of_cells = isinstance(self.hardness, np.ndarray)
        kernel = "half-space" if self._planned.kernel is None else "given"
        told = {"hardness": None if of_cells else self.hardness, "hardness_of_cells": of_cells, "kernel": kernel, "steps": self._planned.history, "since": self._planned.since}
        return {**known, **told, **({} if kernel == "given" else {"given": in_json(self._case)})}

    @property
    def _case(self) -> dict[str, Any]:
        """A case of the same contact: an elastic body of that contact modulus on a rigid one."""
        body: dict[str, Any] = {"poisson": 0.0, "material": {"model": "elastic", "young": self.contact_modulus}}
        limit = {"hardness": self.hardness} if isinstance(self.hardness, float) else {}
        return {
            "domain": {"cells": list(self.cells), "size": list(self.size), "boundary": self.boundary},
            "surface": self._planned.origin,
            "body": [{**body, **limit}],
            "load": {"control": "load", "history": {"kind": "step", "value": self.load}},
            "solver": {"method": self.method, "tolerance": self.tolerance},
            "time": {"times": [1.0]},
        }

    def methods(self, *, bibtex: bool = False, case: bool = True) -> str:
        """A paragraph on what was computed, as :meth:`Result.methods`."""
        return _result([self], False).methods(bibtex=bibtex, case=case)

    def to_result(self) -> Result:
        """The contact as a result of one row at the time 0, with the fields "pressure", "gap" and "displacement"."""
        return _result([self], True)

    def to_xarray(self) -> xarray.Dataset:
        """The contact as xarray.Dataset with coordinates and units."""
        return self.to_result().to_xarray().isel(time=0, field_time=0, drop=True).drop_vars(["time_error", "stage"])

    def save(self, path: AnyPath, *, force: bool = False) -> None:
        """Writes the contact as a result of one row, as :meth:`Result.save`."""
        self.to_result().save(path, force=force)

    @property
    def plot(self) -> Plots:
        """Figures by matplotlib: ``contact.plot.pressure()``, ``contact.plot.gap()``, ..."""
        return self.to_result().plot

    def __getstate__(self) -> dict[str, Any]:
        # The copy has fields of its own.
        self._whole("a copy")
        own = {name: np.array(values) for name, (values, _) in self._lent.items()}
        return {**self.__dict__, "_lent": {}, **own}

    def _repr_html_(self) -> str:
        numbers = told({name: self._row[name] for name in OF_CONTACT}, self.is_line)
        return f"<b>Elastic contact</b>, {cells_of(self.pressure)}{_html.table(numbers)}"

    def __repr__(self) -> str:
        return (
            f"<ElasticContact: {cells_of(self.pressure)}, load {self.load:.4g} {self._load_unit}, approach {self.approach:.4g} m, "
            f"contact {'length' if self.is_line else 'area'} {100 * self.contact_fraction:.4g} %, certified error {self.certificate:.1e}>"
        )


class ElasticCurve(ContactColumns, Sealed, Sequence[ElasticContact]):
    """Elastic contacts of one surface under a list of loads, pressures or approaches; made by :func:`elastic`.

    ``curve[n]`` is a contact with its fields; `load`, `approach`, `contact_area`, ... are arrays over all of them.
    """

    def __init__(self, contacts: list[ElasticContact], control: str, prescribed: Sequence[float]) -> None:
        self._contacts = contacts
        # "load", "pressure" or "approach", and its values [N, Pa or m] as they were given.
        self._control, self._prescribed = control, tuple(prescribed)

    def _column(self, name: str) -> Floats:
        return frozen(np.array([contact._row[name] for contact in self._contacts]))

    @property
    def stiffness(self) -> Floats:
        """Contact stiffness dW/dw [N/m] of each."""
        return frozen(np.array([contact.stiffness for contact in self._contacts]))

    @property
    def findings(self) -> list[Finding]:
        """Where the numbers may be off, of any of the contacts."""
        return list({finding["code"]: finding for contact in reversed(self._contacts) for finding in contact.findings}.values())

    @overload
    def __getitem__(self, index: int) -> ElasticContact: ...
    @overload
    def __getitem__(self, index: slice) -> ElasticCurve: ...
    def __getitem__(self, index: int | slice) -> ElasticContact | ElasticCurve:
        if isinstance(index, slice):
            return ElasticCurve(self._contacts[index], self._control, self._prescribed[index])
        return self._contacts[index]

    def __len__(self) -> int:
        return len(self._contacts)

    def __iter__(self) -> Iterator[ElasticContact]:
        return iter(self._contacts)

    def methods(self, *, bibtex: bool = False, case: bool = True) -> str:
        """A paragraph on what was computed, as :meth:`Result.methods`; the case of it has a row for each contact."""
        return _result(self._contacts, False, self._control, self._prescribed).methods(bibtex=bibtex, case=case)

    def to_result(self) -> Result:
        """The contacts as the rows of a result, one each second, with the fields "pressure", "gap" and "displacement"."""
        return _result(self._contacts, True, self._control, self._prescribed)

    def to_dataframe(self) -> pandas.DataFrame:
        """The numbers as pandas.DataFrame, a row for each contact."""
        return frame({name: np.array(self._column(name)) for name in OF_CONTACT})

    def to_xarray(self) -> xarray.Dataset:
        """The numbers and the pressures as xarray.Dataset over what was prescribed, `load`, `mean_pressure` or `approach`, with the values
        as they were given: curves of other surfaces under the same values have the same index."""
        index = {"pressure": "mean_pressure"}.get(self._control, self._control)
        rows = _result(self._contacts, False).to_xarray().drop_vars(["time_error", "stage", "field_time"])
        rows = rows.assign_coords({index: ("time", np.array(self._prescribed), rows[index].attrs)}).swap_dims(time=index).drop_vars("time")
        pressures = [contact.pressure for contact in self._contacts]
        return rows.assign(pressure=FIELDS["pressure"].variable((index, *self._contacts[0]._axes), pressures))

    @property
    def plot(self) -> CurvePlots:
        """Figures by matplotlib: ``curve.plot.area()``, ``curve.plot.load_displacement()``."""
        return CurvePlots(self)

    def __repr__(self) -> str:
        first, last = self._contacts[0], self._contacts[-1]
        return (
            f"<ElasticCurve: {len(self)} contacts of {cells_of(first.pressure)}, load {first.load:.4g} to {last.load:.4g} {first._load_unit}, contact "
            f"{100 * first.contact_fraction:.4g} to {100 * last.contact_fraction:.4g} %>"
        )


class _How(TypedDict, total=False):
    """What the contacts of :func:`elastic` have in common, one or several."""

    gap: SurfaceLike | None
    size: Size
    hardness: float | ArrayLike | None
    boundary: Boundary
    kernel: Kernel | None
    start: ElasticContact | ArrayLike | None
    history: bool
    method: Method
    tolerance: float
    max_iterations: int


#: Values of several contacts.
_Several = Sequence[float] | AnyArray | None


def _checksum(values: Floats) -> int:
    return zlib.crc32(np.ascontiguousarray(values).data)


def _course(control: str, values: Sequence[float]) -> dict[str, Any]:
    """The keys with which an elastic body goes through the contacts of a curve, one each second."""
    if len(values) == 1:
        return {"load": {"control": control, "history": {"kind": "step", "value": values[0]}}}
    points = [[float(n), value] for n, value in enumerate(values)]
    return {"load": {"control": control, "history": {"kind": "table", "points": points}}, "time": {"times": [time for time, _ in points[1:]]}}


def _result(contacts: list[ElasticContact], with_fields: bool, control: str = "", values: Sequence[float] = ()) -> Result:
    """Contacts as the rows of a result; those of a curve know what was prescribed."""
    first = contacts[0]
    setup = first._setup
    if values:
        setup["curve"] = {"control": control, "first": values[0], "last": values[-1]}
        setup["given"] = {**setup["given"], **_course(control, values)} if "given" in setup else None
    for contact in contacts:
        contact._whole("a result")
    names = ("pressure", "gap", "displacement") if with_fields else ()
    table = {name: np.array([contact._row[name] for contact in contacts]) for name in ROW}
    if values:
        table["time"] = np.arange(len(contacts), dtype=np.float64)
    return Result(
        table=table,
        fields={name: np.array([getattr(contact, name) for contact in contacts]) for name in names},
        field_steps=range(len(contacts)) if with_fields else [],
        initial_gap=first.initial_gap,
        size=first.size,
        attributes=attributes_of("Elastic contact", "complete", setup, first.findings),
    )


@overload
def elastic(
    surface: SurfaceLike | None = ..., contact_modulus: Scalar | None = ..., *, load: Scalar | None = ..., pressure: Scalar | None = ..., approach: Scalar | None = ...,
    out: Floats | Mapping[str, Floats] | None = ..., **how: Unpack[_How]
) -> ElasticContact: ...
@overload
def elastic(
    surface: SurfaceLike | None = ..., contact_modulus: Scalar | None = ..., *, load: _Several = ..., pressure: _Several = ..., approach: _Several = ..., **how: Unpack[_How]
) -> ElasticCurve: ...
def elastic(
    surface: SurfaceLike | None = None, contact_modulus: Scalar | None = None, *, load: Any = None, pressure: Any = None, approach: Any = None,
    gap: SurfaceLike | None = None, size: Size = None, hardness: float | ArrayLike | None = None,
    boundary: Boundary = "free", kernel: Kernel | None = None, start: ElasticContact | ArrayLike | None = None,
    out: Floats | Mapping[str, Floats] | None = None, history: bool = False, method: Method = "projected-cg",
    tolerance: float = 1e-6, max_iterations: int = 5000
) -> ElasticContact | ElasticCurve:
    """Solves an elastic contact, or those of a list of loads.

    Parameters
    ----------
    surface : as in :func:`solve`: a Surface, or heights [m] as array (nx, ny), or (n,) of a line contact in plane strain, whose load
        is per length [N/m]
    contact_modulus : E* [Pa], (1 - nu1^2)/E1 + (1 - nu2^2)/E2 = 1/E*
    load, pressure, approach : normal load [N], load over nominal area [Pa], or approach [m], exactly one of them; a list gives an
        :class:`ElasticCurve`, in which each contact starts from the one before
    gap : instead of the surface the undeformed gap [m], infinite where nothing can touch; it is shifted to the least value 0
    size : lengths of the domain along x and y [m], of a line its length, where the surface is an array
    hardness : largest pressure [Pa], of all cells or as array (nx, ny)
    boundary : "free" or "periodic"
    kernel : of another body than the half-space, K in u = K p/E* [m]; without a contact_modulus [m/Pa]. Periodic: its symbol K(qx, qy) as
        a function of wave numbers [rad/m], or as array (nx//2 + 1, ny//2 + 1) on 2 pi (k/Lx, l/Ly); that of the uniform
        pressure may be infinite. Free: the influence coefficients K(x, y), the displacement at that distance [m] from a cell under
        unit pressure, as a function or as array (nx, ny) at (i dx, j dy). It must be even in x and in y
    start : warm start: a pressure [Pa], or a contact. Where a contact of the same surface is given, its plan is used again: for thousands
        of solves
    out : array (nx, ny) that takes the pressure, or a dictionary of arrays for "pressure", "displacement", "gap"; the fields of the
        contact are views of them. When the array has changed, by another solve say, the contact refuses what follows from its fields:
        stiffness, spots, plots, to_result() and save()
    history : keep what the solver did as `history`: residual, working cells and kind of step of each iteration
    method : "projected-cg" or "polonsky-keer"
    tolerance : largest residual
    max_iterations : iterations after which it gives up

    Raises
    ------
    CaseError : the input is wrong, or the load is more than the hardness can carry
    ConvergenceError : not solved to the tolerance; carries the best pressure as `best`
    KeyboardInterrupt : Ctrl-C

    An error that comes after the first of a list of loads has the contacts so far as `error.result`.

    Warns
    -----
    ResultWarning : the numbers may be off; the `findings` say where and why

    Examples
    --------
    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(128, 128), size=(1e-3, 1e-3), radius=5e-3)
    >>> hertz = asp.elastic(sphere, 1e9, load=1.0)
    >>> exact = (9 * 1.0**2 / (16 * 5e-3 * 1e9**2)) ** (1 / 3)
    >>> abs(hertz.approach / exact - 1) < 1e-3
    True
    >>> bool(abs(hertz.stiffness / (1.5 * hertz.load / hertz.approach) - 1) < 0.02)
    True
    >>> curve = asp.elastic(sphere, 1e9, load=[0.25, 0.5, 1.0])
    >>> curve.contact_area.shape, curve[-1].pressure.shape
    ((3,), (128, 128))
    """
    boundary, method = choice("boundary", boundary, Boundary), choice("method", method, Method)
    shape = surface_of(surface, gap, size)
    check_boundary(shape, boundary)
    if contact_modulus is None and kernel is None:
        raise CaseError("give contact_modulus, E* [Pa] in (1 - nu1^2)/E1 + (1 - nu2^2)/E2 = 1/E*")
    modulus, table = 1.0 if contact_modulus is None else number("contact_modulus", contact_modulus), None
    for what, value in (("hardness", hardness), ("start of the pressure", start)):
        check_places(what, value, surface if gap is None else gap)
    if kernel is not None:
        table = _table(kernel, shape, boundary, "m/Pa" if contact_modulus is None else "m")
        factor = _scale(table, shape, boundary)
        table, modulus = table * factor, modulus * factor
    solver = {"method": method, "tolerance": number("tolerance", tolerance), "max_iterations": count("max_iterations", max_iterations)}
    wanted = shape, modulus, hardness_of(hardness, shape), table, {"boundary": boundary, **solver}
    held = start._planned if isinstance(start, ElasticContact) else None
    planned = held if held is not None and held.is_for(*wanted) else _Planned(*wanted)

    what, values = one_of({"load": load, "pressure": pressure, "approach": approach}, "give")
    unit = {"load": "N/m" if shape.is_line else "N", "pressure": "Pa", "approach": "m"}[what]
    scale = math.prod(shape.size) if what == "pressure" else 1.0
    given = bare(what, list(values) if isinstance(values, Iterator) else values, unit)
    several = np.ndim(given) > 0
    numbers = [number(what, one, unit) for one in (given if several else [given])]
    if not numbers:
        raise CaseError(f"{what} holds no number, but must hold one at least")
    receives = _receivers(out, shape)
    if several and receives:
        raise CaseError("out is for one contact, but a list is given: the contacts of a curve have fields of their own")
    begin = start.pressure if isinstance(start, ElasticContact) else start
    first = None if begin is None else per_cell("start of the pressure", begin, shape)
    contacts: list[ElasticContact] = []
    try:
        for value in numbers:
            control = "approach" if what == "approach" else "load"
            contacts.append(planned.solve(control, value * scale, contacts[-1].pressure if contacts else first, history, receives))
    except BaseException as error:
        if contacts:
            error.result = ElasticCurve(contacts, what, numbers[: len(contacts)])  # type: ignore[attr-defined]
        raise
    warn({finding["code"]: finding for contact in contacts for finding in contact.findings}.values())
    return ElasticCurve(contacts, what, numbers) if several else contacts[0]


def _receivers(out: Any, shape: Surface) -> dict[str, Floats]:
    """The arrays that take the fields, by name."""
    given = {} if out is None else dict(out) if isinstance(out, Mapping) else {"pressure": out}
    for name, held in given.items():
        if name not in ("pressure", "displacement", "gap"):
            raise CaseError(f"out holds {name!r}, but may hold pressure, displacement, gap")
        if any(held is other or (np.may_share_memory(held, other) and np.shares_memory(held, other)) for key, other in given.items() if key != name):
            raise CaseError(f"out gives the same array for {name} and another field, but each needs an array of its own")
        if not isinstance(held, np.ndarray) or held.dtype != np.float64 or held.shape != shape.heights.shape or not held.flags.writeable:
            raise CaseError(f"out must be a writable float64 array of shape {shape.heights.shape}")
    return given


def _scale(table: Floats, shape: Surface, boundary: str) -> float:
    """The power of two that brings a kernel near to that of the half-space, which tolerances are made for: its mean symbol, or the
    displacement of the loaded cell."""
    lengths, cells = shape.size, shape.cells
    if boundary == "periodic":
        waves = np.meshgrid(*(2.0 * np.pi / length * np.arange(n // 2 + 1) for n, length in zip(cells, lengths)), indexing="ij")
        usual = np.mean(2.0 / np.sqrt(sum(q**2 for q in waves)).ravel()[1:])
        found = np.mean(table.ravel()[1:])
    else:
        usual, found = lengths[0] / cells[0], table.ravel()[0]
    return float(2.0 ** np.round(np.log2(usual / found))) if np.isfinite(found) and found > 0.0 else 1.0


def _table(kernel: Any, shape: Surface, boundary: str, unit: str) -> Floats:
    """The numbers of a kernel that the core needs, in that SI unit."""
    if not callable(kernel):
        names = sorted(map(str, kernel.dims)) if is_labelled(kernel) else []
        ordered = kernel.transpose(*names) if names in (["x", "y"], ["qx", "qy"]) else kernel
        return as_plane(field("kernel", bare("kernel", ordered, unit), line=True))
    sides = [*zip(shape.cells, shape.size), (1, 1.0)][:2]
    waves = [2.0 * np.pi / length * np.arange(n // 2 + 1) for n, length in sides]
    at = np.meshgrid(*(waves if boundary == "periodic" else [length / n * np.arange(n) for n, length in sides]), indexing="ij")

    def values(x: Floats, y: Floats) -> Floats:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.array(np.broadcast_to(array("kernel", kernel(x, y), unit), x.shape))

    table = values(*at)
    # Only half of the numbers are asked for: the others must be their mirror images.
    for mirrored in (values(-at[0], at[1]), values(at[0], -at[1])):
        if not np.allclose(mirrored, table, rtol=1e-9, atol=0.0, equal_nan=True):
            raise CaseError("kernel must be even in both of its coordinates, but takes other values for negative ones")
    return table
