"""Contacts over time: from numpy to a result in memory, or from a case file to a result on disk."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _core
from ._declared import arguments_of
from ._arrays import AnyPath, NotThere, cells_of, meant, path_of
from ._columns import HISTOGRAMS
from ._core import CaseError, ConvergenceError
from ._findings import Finding, findings_of, warn
from ._histories import History, Stage, as_times, one_of
from ._layers import materials_of
from ._problem import InStages, Problem, Run, Solve, bodies_of
from ._progress import Progress
from ._record import Keep, Record
from ._result import Result, open
from ._rows import Numbers
from ._sealed import Sealed
from ._spoken import spoken
from ._states import State

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._arrays import Floats, Scalar
    from ._histories import Times


#: A case: the path of its file, its text or its keys; and changed keys of it.
Case = AnyPath | Mapping[str, Any]
Changes = dict[str, Any] | Sequence[str] | None


class Step(Numbers, Sealed):
    """The state after one row of a march: its numbers as attributes, its fields as arrays.

    `time`, `load`, `approach`, `contact_area`, ... as in results. A step is a view: when the march has moved on, its fields can
    no longer be read.
    """

    def __init__(self, march: March, row: dict[str, Any], index: int) -> None:
        self._march, self._row, self._index = march, row, index

    @property
    def index(self) -> int:
        """Number of the row, from 0."""
        return self._index

    @property
    def row(self) -> dict[str, Any]:
        """All numbers of the row by name."""
        return dict(self._row)

    def field(self, name: str) -> Floats:
        """The field "pressure", "contact_pressure", "adhesive_traction" [Pa], "gap", "displacement", "flattening" [m] or "contact" (0, 1, 2), shape (nx, ny), as a new
        array; of a line contact (n,), as all fields."""
        if self._march._core.done != self._index + 1:
            raise CaseError(f"the march has moved on from row {self._index}: read fields before the next row")
        return self._map(name).reshape(self._march.initial_gap.shape)

    def _map(self, name: str) -> Floats:
        """A field as the core gives it."""
        return self._march._core.field(name)

    @property
    def pressure(self) -> Floats:
        """Pressure [Pa], shape (nx, ny)."""
        return self.field("pressure")

    @property
    def gap(self) -> Floats:
        """Gap of the deformed surfaces [m], shape (nx, ny)."""
        return self.field("gap")

    def _state(self) -> State:
        setup = self._march._setup
        contact = np.ascontiguousarray(self.field("contact") > 0, dtype=np.uint8)
        shear = (self.field("traction_x"), self.field("traction_y")) if "friction" in setup else None
        layered = _core.LAYERED_STRESS if "layer_separable" in setup else None
        return State(self._march.size, setup.get("boundary", "free"), self.gap, self.pressure, contact, setup.get("poisson") or (), shear, layered)

    def _number(self, name: str) -> float:
        row = self.__dict__["_row"]
        if name not in row or name in HISTOGRAMS:
            numbers = ", ".join(key for key in row if key not in HISTOGRAMS)
            near = meant(name, [*row, "field", "row", "index", "pressure", "gap"], 0.75)
            raise AttributeError(f"a step has no {name!r}{near or f'; it has {numbers}, row and field(name)'}")
        value: float = row[name]
        return value

    if not TYPE_CHECKING:  # where it would hide misspelt names

        def __getattr__(self, name):
            return self._number(name)

    def __dir__(self) -> list[str]:
        # Numbers that it does not have are left out.
        return sorted({*super().__dir__()} - {name for name in vars(Numbers) if name[0] != "_"} | {name for name in self._row if name not in HISTOGRAMS})

    def __repr__(self) -> str:
        row, unit = self._row, "N/m" if self._march.initial_gap.ndim == 1 else "N"
        return (
            f"Step({self._index}, t = {row['time']:g} s, load {row['load']:g} {unit}, approach {row['approach']:g} m, "
            f"contact {100 * row['contact_fraction']:.3g} %)"
        )


class March(Sealed):
    """A simulation that is solved step by step: iterate over it for its :class:`Step` s. Made by :func:`march`."""

    #: Undeformed gap [m], shape (nx, ny), of a line contact (n,).
    initial_gap: Floats
    #: Lengths of the domain along x and y [m], of a line contact along x.
    size: tuple[float, ...]

    def __init__(self, given: Problem, output: str | None = None, force: bool = False) -> None:
        keep = Keep(given)
        shape, keys, arrays = given.parts()
        with spoken():
            self._core = _core.March(keys, arrays, keep.steps)
        # Threads that share a march take turns.
        self._turn = threading.Lock()
        self._hold(initial_gap=shape.gap(), size=shape.size)
        told = {"given": given.given(shape, keys), "steps": shape.history, "since": shape._since, **({"sampled": given.sampled} if given.sampled else {})}
        self._setup: dict[str, Any] = {**json.loads(self._core.setup), **told}
        fits = [material.fit for body in bodies_of(given.material) for material in materials_of(body) if material.fit is not None]
        self._of_fits = [finding for fit in fits for finding in fit.findings]
        self._record = Record(self, keep, output, force)

    def __repr__(self) -> str:
        whole = self._core.rows_expected
        return f"<March: {len(self._record)} rows{'' if whole is None else f' of {whole}'} solved, {cells_of(self.initial_gap)}>"

    def __len__(self) -> int:
        """Number of rows, as far as it is known: with adaptive steps it is not known in advance."""
        return len(self._core)

    @property
    def times(self) -> Floats:
        """Times of all rows [s], as far as they are known: 0+, the steps, and the breaks and jumps of the history."""
        return np.array(self._core.times())

    @property
    def findings(self) -> list[Finding]:
        """Where the numbers of the rows so far may be off (docs/findings.md), and where the fits of their materials."""
        return findings_of(self._found())

    def _found(self) -> list[dict[str, Any]]:
        """The findings as the core tells them."""
        return [*json.loads(self._core.findings()), *self._of_fits]

    def __iter__(self) -> Iterator[Step]:
        return self

    def __next__(self) -> Step:
        with self._turn:
            with spoken():
                if not self._core.advance():
                    raise StopIteration
            step = self._step(self._core.done - 1)
            self._record.see(step)
            return step

    def prescribe(
        self,
        *,
        load: History | Scalar | None = None,
        pressure: History | Scalar | None = None,
        approach: History | Scalar | None = None,
        until: Literal["contact-lost"] | tuple[str, Any] | dict[str, Any] | None = None,
        times: Times | ArrayLike | None = None,
    ) -> None:
        """From the last row on this load [N], mean pressure [Pa] or approach [m] is prescribed, in place of what was to come: a stage that
        begins here. It ends at the event `until`, which is that of a :class:`Stage`, and with the last of its own `times`, which are counted
        from here; then the value reached is held, until something else is prescribed. Without both it lasts to the end of the run, with its times.

        A number is a step, which makes a row of no duration first, as at the start of a :class:`Stage`; ``ramp_to(value, duration=...)``
        goes on from the value reached, which a material without instantaneous compliance needs. The rows of the result have the number
        of their `stage`, and its attribute "setup" lists what was prescribed, under "prescribed".

        A constant contact area, by the load at which a cone has it:

        >>> import asperity as asp
        >>> cone = asp.Surface.cone(cells=(64, 64), size=(1e-3, 1e-3), slope=0.1)
        >>> rubber = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
        >>> run = asp.march(cone, rubber, load=5e-3, times=asp.uniform(2.0, 40))
        >>> areas = []
        >>> for row in run:
        ...     areas.append(row.contact_area)
        ...     if row.time < 2.0:
        ...         run.prescribe(load=asp.ramp_to(row.load * areas[0] / row.contact_area, duration=0.05))
        >>> bool(abs(areas[-1] / areas[0] - 1) < 0.05), bool(run.result().load[-1] < 3.5e-3)
        (True, True)

        A retraction in steps of its own, until a tenth of the load is left:

        >>> run = asp.march(cone, rubber, load=5e-3, times=asp.uniform(2.0, 2))
        >>> rows = [next(run), next(run)]
        >>> run.prescribe(approach=asp.ramp_to(0.0, duration=0.1), until=("load", 5e-4), times=asp.uniform(0.1, 10))
        >>> rows += list(run)
        >>> bool(1.0 < rows[-2].time < 1.1), round(rows[-2].load, 7), rows[-1].time
        (True, 0.0005, 2.0)
        """
        one_of({"load": load, "pressure": pressure, "approach": approach}, "prescribe")
        grid = None if times is None else as_times(times)
        stage = Stage(load=load, pressure=pressure, approach=approach, until=until, times=grid, duration=None if grid is None else grid.end)
        keys = stage._given("N/m" if len(self.size) == 1 else "N")
        with self._turn:
            with spoken():
                self._core.prescribe(keys)
            self._record.prescribed.append({"row": len(self._record), **keys})

    def _step(self, index: int) -> Step:
        return Step(self, self._core.row(), index)

    def result(self) -> Result:
        """The rows so far, with the `fields` that were given to :func:`march`, and those of the last row. The march can go on.

        >>> import asperity as asp
        >>> cone = asp.Surface.cone(cells=(32, 32), size=(1e-3, 1e-3), slope=0.1)
        >>> run = asp.march(cone, asp.Elastic(young=1e6, poisson=0.5), approach=1e-5, times=[1.0, 2.0], fields=["pressure"])
        >>> first = next(run)
        >>> len(run.result()), run.result().fields
        (1, ['pressure'])
        """
        rows = self._core.rows_expected
        done = len(self._record) > 0 and self._core.finished
        return self._record.result("complete" if done or len(self._record) == rows else "interrupted")


@arguments_of(InStages)
def march(given: InStages) -> March:
    """A simulation, step by step; the parameters are those of :func:`solve`. `fields` are those that :meth:`March.result` has: by
    default none.

    >>> import asperity as asp
    >>> cone = asp.Surface.cone(cells=(32, 32), size=(1e-3, 1e-3), slope=0.1)
    >>> for step in asp.march(cone, asp.Elastic(young=1e6, poisson=0.5), approach=1e-5, times=[1.0]):
    ...     print(step.index, step.time, step.pressure.shape)
    0 0.0 (32, 32)
    1 1.0 (32, 32)
    """
    return March(given)


@arguments_of(Solve)
def solve(given: Solve) -> Result:
    """Solves a contact over time.

    Parameters
    ----------
    surface : Surface, or heights [m] as array (nx, ny) with `size`, or a SurfaceTopography or xarray array. A surface of one
        dimension, (n,) with size=(L,), is a line contact in plane strain: loads and energies are per length [N/m], [J/m], the
        contact area is a length [m], and fields have the shape (n,)
    gap : instead of the surface the undeformed gap [m], infinite where nothing can touch; it is shifted to the least value 0
    material : the deformable body (a material for a half-space, an asperity.Body for layers), or a pair of them
    times : times to solve for: uniform, log, adaptive, listed, or a sequence [s]; breaks of the history are added
    load, pressure, approach : what is prescribed [N], [Pa] or [m]: a history, a number for a step, or a function of time [s], which
        becomes a table within a thousandth of its largest value (:func:`sampled`)
    breaks : times at which such a function has a jump or a kink [s]
    stages : instead, a list of :class:`Stage` s: the control switches at a time or at an event
    adhesion : an attraction between the surfaces, asperity.Adhesion; then loads may be negative, and each row also has "adhesive_load",
        "repulsive_load", "adhesion_energy", "outer_iterations", "adhesion_residual"
    fluid : a fluid whose pressure opens the contact, asperity.Fluid; each row then also has "fluid_load", "contact_load", "inlet_pressure",
        "connected", "film", "pocket_area", "pocket_pressure_max", "pocket_vapour", "latched_cells", "leak_spread", "fluid_residual"
    friction, tangential : a load along the surfaces, asperity.tangential(force=...) or (displacement=...), and the friction that holds it, a
        coefficient, one for each cell, or asperity.Friction; each row then also has "tangential_force" and "tangential_displacement" of
        shape (rows, 2), "tangential_stiffness", "stick_area", "slip_area", "slip_work", "friction_iterations", "friction_certificate"
    wear : what sliding takes off the surfaces, asperity.Wear, or a coefficient [m2/N]; each row then also has "wear_volume",
        "counterbody_wear_volume" (where it wears), "wear_rate", "wear_distance" or "wear_cycles", "wear_depth_max", "worn_roughness", "wear_error"
    hardness : largest pressure [Pa], for all cells or as array (nx, ny); default: that of the materials
    boundary : "free" (half-space) or "periodic"
    temperature : of the run [K], or (time [s], temperature [K]) points, linear in between and held after the last; it applies
        to every material that has a shift and no temperature of its own
    scheme : "linear" (second order), "constant" (SC17) or "direct" (full hereditary sum)
    method : "projected-cg" or "polonsky-keer"
    plasticity : what remains of flattening on unloading: "cap" (nothing) or "accumulate" (all of it; field "flattening")
    quantities : optional numbers of each row: "contact_stiffness", "contact_spots", "largest_spot", "mean_spot",
        "contact_perimeter", "contact_percolation", "gap_percolation", "rms_gap", "contact_eccentricity", "elastic_energy",
        "dissipated_energy", "flattening_work", "external_work", "load_power", and "spot_histogram", "pressure_histogram", "gap_histogram" of that many `bins` up to `largest_pressure` [Pa] (by default the
        hardness) and `largest_gap` [m] (by default that of the undeformed gap)
    fields : fields to keep: "pressure", "gap", "displacement", "contact", "flattening", with adhesion also "contact_pressure",
        "adhesive_traction", with a fluid "contact_pressure", with friction "traction_x", "traction_y", "slip_x", "slip_y", "slip_path", "friction_work",
        with wear "wear_depth", "counterbody_wear_depth", "undeformed_gap"
    every : keep the fields of every n-th row, and of the first and the last; default: of every row, up to 20 rows
    field_times : instead, times at which fields are kept [s]; each becomes a step
    output : path of a result on disk, which is written row by row; the result that is returned reads its fields from there. `force`
        replaces one that is there
    progress : show a line with the progress; default: in terminals and notebooks
    on_step : called with each Step; if it returns True, the run stops after that row, and its result has the status "interrupted"

    Raises
    ------
    CaseError : the input is wrong
    ConvergenceError : a step was not solved to the tolerance; its `best` is the best state that was found
    KeyboardInterrupt : Ctrl-C

    An error that comes after the first row has the rows so far as `error.result`; the fields of the last row are among them where it
    came between two steps.

    Returns
    -------
    Result

    Warns
    -----
    ResultWarning : the numbers may be off; the result's `findings` say where and why
    """
    return solved(given)


def solved(given: Run) -> Result:
    """Solves a problem to its end."""
    run, on_step = March(given, path_of("output", given.output), given.force), given.on_step
    if on_step is not None and not callable(on_step):
        raise CaseError(f"on_step is {on_step!r}, but must be a function that takes a Step")
    teller = Progress(run._core.rows_expected, given.progress)
    status, message = "complete", None
    try:
        for step in run:
            told = None if on_step is None else on_step(step)
            teller.tell(step.row, step.index + 1)
            if isinstance(told, (bool, np.bool_)) and told and not run._core.finished:
                status, message = "interrupted", "on_step returned True"
                break
    except BaseException as error:
        ended = "failed" if isinstance(error, Exception) else "interrupted"
        error.result = run._record.close(ended, str(error) or type(error).__name__)  # type: ignore[attr-defined]
        raise
    finally:
        teller.end()
    result = run._record.close(status, message)
    warn(run.findings)
    return result


def run(
    case: Case, *, set: Changes = None, output: AnyPath | None = None, force: bool = False, resume: bool = False,
    progress: bool | None = None, on_row: Callable[[dict[str, Any], int, int], object] | None = None
) -> Result:
    """Runs a case, as ``asperity run`` does, and opens its result.

    Parameters
    ----------
    case : path of a case file; or its text (of several lines), or its keys as a dictionary, with files relative to the
        working directory
    set : changed keys of the case: ``{"load.history.value": "2 N"}``
    output : path of the result; default: `output.path` of the case, or its name with .zarr
    force : replace a result that is there
    resume : continue a stopped run from its result; Ctrl-C leaves a readable result
    progress : a line with the progress; default: in terminals and notebooks
    on_row : called with the numbers of each row, the rows done, and those in all

    Raises
    ------
    CaseError : the case is wrong; names key and line
    ConvergenceError : a step was not solved to the tolerance; the rows before it are stored
    OSError : a file cannot be read or written

    With `output` an error that comes after the first row has the rows so far as `error.result`.

    Examples
    --------
    >>> import asperity as asp, tempfile
    >>> case = {
    ...     "domain": {"cells": [32, 32], "size": ["1 mm", "1 mm"]},
    ...     "surface": [{"kind": "sphere", "radius": "10 mm"}],
    ...     "body": [{"poisson": 0.5, "material": {"model": "elastic", "young": "3 MPa"}}],
    ...     "load": {"control": "load", "history": {"kind": "step", "value": "10 mN"}},
    ...     "time": {"end": "1 s", "steps": 1},
    ... }
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     result = asp.run(case, set={"load.history.value": "20 mN"}, output=folder + "/ball.zarr")
    ...     result.load.round(12).tolist()
    [0.02, 0.02]
    """
    teller: Progress | None = None

    def told(row: dict[str, Any], done: int, total: int) -> None:
        nonlocal teller
        if teller is None:
            teller = Progress(total, progress)
        teller.tell(row, done)
        if on_row is not None:
            on_row(row, done, total)

    try:
        stored = _core.run(*source(case), overrides(set), path_of("output", output), force, resume, told)
    except BaseException as error:
        if output is not None and teller is not None:
            with contextlib.suppress(OSError, CaseError):
                error.result = open(output)  # type: ignore[attr-defined]
        raise
    finally:
        if teller is not None:
            teller.end()
    result = open(stored)
    warn(result.findings)
    return result


def check(case: Case, *, set: Changes = None) -> dict[str, Any]:
    """What a case (as in :func:`run`) will do, in numbers: cells, rows, moduli, memory [byte], ...; the inputs that a slip
    would hide in, the contact to be expected, and the findings that are known before the run."""
    return dict(json.loads(_core.check(*source(case), overrides(set))))


def source(case: Case) -> tuple[str, str | None]:
    """The path of a case file; or where the files of a case lie that is given as text or keys, and its text."""
    if isinstance(case, Mapping):
        return os.curdir, _core.case_text(dict(case))
    if isinstance(case, str) and "\n" in case:
        return os.curdir, case
    path = os.fspath(case)
    if not os.path.exists(path):
        raise NotThere(errno.ENOENT, "there is no case file of this name", path)
    return path, None


def overrides(given: Mapping[str, Any] | Sequence[str] | None) -> list[str]:
    """Changed keys of a case, as the core takes them."""
    if given is None:
        return []
    if isinstance(given, Mapping):
        return [f"{key}={_toml(key, value)}" for key, value in given.items()]
    return [str(key) for key in given]


def _toml(key: str, value: Any) -> str:
    """A value as the core takes it: text as it is, which is TOML or a word."""
    if isinstance(value, str):
        return value
    try:
        return json.dumps(value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value)
    except TypeError:
        raise CaseError(f"{key} is {value!r}, which a case file cannot hold; write quantities as text, as in '0.2 N'") from None
