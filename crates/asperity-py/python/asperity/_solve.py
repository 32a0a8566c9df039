"""Contacts over time: from numpy to a result in memory, or from a case file to a result on disk."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import as_plane, cells_of, check_places, choice, count, field, in_order, number
from ._columns import HISTOGRAMS, ROW, Number
from ._core import CaseError, ConvergenceError
from ._findings import Finding, findings_of, warn
from ._histories import History, Stage, Times, as_history, as_stage, as_times, one_of, sines_of
from ._layers import Body, hardness_of, parts_of, with_hardness
from ._materials import Material
from ._motion import Motion
from ._progress import Progress
from ._record import Keep, Record, path_of
from ._result import Result, open
from ._sealed import Sealed
from ._shifts import temperatures
from ._surface import surface_of
from ._units import bare
from ._words import Boundary, Field, Method, Plasticity, Quantity, Scheme

if TYPE_CHECKING:
    from ._arrays import Floats


class Step(Sealed):
    """The state after one row of a march: its numbers as attributes, its fields as arrays.

    `time`, `load`, `approach`, `contact_area`, ... as in results. A step is a view: when the march has moved on, its fields can
    no longer be read.
    """

    time = Number()
    load = Number()
    approach = Number()
    contact_area = Number()
    contact_area_corrected = Number()
    contact_fraction = Number()
    capped_area = Number()
    mean_pressure = Number()
    max_pressure = Number()
    mean_gap = Number()
    iterations = Number()
    convolutions = Number()
    residual = Number()
    certificate = Number()
    time_error = Number()
    stage = Number()
    # Where they were requested, or the contact moves.
    contact_stiffness = Number()
    contact_spots = Number()
    largest_spot = Number()
    mean_spot = Number()
    contact_perimeter = Number()
    contact_percolation = Number()
    gap_percolation = Number()
    rms_gap = Number()
    contact_eccentricity = Number()
    elastic_energy = Number()
    dissipated_energy = Number()
    flattening_work = Number()
    external_work = Number()
    load_power = Number()
    velocity = Number()
    sliding_distance = Number()
    friction_force = Number()
    side_force = Number()
    friction_coefficient = Number()
    friction_coefficient_total = Number()
    friction_uncertainty = Number()
    rolling_moment = Number()
    dissipated_power = Number()

    def __init__(self, march: March, row: dict[str, Any], index: int) -> None:
        self._march = march
        self._row = row
        self._index = index

    @property
    def index(self) -> int:
        """Number of the row, from 0."""
        return self._index

    @property
    def row(self) -> dict[str, Any]:
        """All numbers of the row by name."""
        return dict(self._row)

    def field(self, name: str) -> Floats:
        """The field "pressure" [Pa], "gap", "displacement", "flattening" [m] or "contact" (0, 1, 2), shape (nx, ny), as a new
        array; of a line contact (n,), as all fields."""
        if self._march._core.done != self._index + 1:
            raise CaseError(f"the march has moved on from row {self._index}: read fields before the next row")
        return self._map(name).reshape(self._march.initial_gap.shape)

    def _map(self, name: str) -> Floats:
        """A field as the core gives it."""
        values: Floats = self._march._core.field(name)
        return values

    @property
    def pressure(self) -> Floats:
        """Pressure [Pa], shape (nx, ny)."""
        return self.field("pressure")

    @property
    def gap(self) -> Floats:
        """Gap of the deformed surfaces [m], shape (nx, ny)."""
        return self.field("gap")

    def _number(self, name: str) -> float:
        row = self.__dict__["_row"]
        if name not in row or name in HISTOGRAMS:
            numbers = ", ".join(key for key in row if key not in HISTOGRAMS)
            raise AttributeError(f"a step has no {name!r}; it has {numbers}, row and field(name)")
        value: float = row[name]
        return value

    if not TYPE_CHECKING:  # where it would hide misspelt names

        def __getattr__(self, name):
            return self._number(name)

    def __dir__(self) -> list[str]:
        # Numbers that it does not have are left out.
        numbers = {name for name, value in vars(Step).items() if isinstance(value, Number)}
        return sorted({*super().__dir__()} - numbers | {name for name in self._row if name not in HISTOGRAMS})

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

    def __init__(
        self,
        core: _core.March,
        initial_gap: Floats,
        size: tuple[float, ...],
        setup: dict[str, Any],
        keep: Keep,
        title: str,
        output: str | None,
        force: bool,
    ) -> None:
        self._core = core
        # Threads that share a march take turns.
        self._turn = threading.Lock()
        self._hold(initial_gap=initial_gap, size=size)
        self._setup = setup
        self._record = Record(self, keep, title, output, force)

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
        """Where the numbers of the rows so far may be off (docs/findings.md)."""
        return findings_of(json.loads(self._core.findings()))

    def __iter__(self) -> Iterator[Step]:
        return self

    def __next__(self) -> Step:
        with self._turn:
            if not self._core.advance():
                raise StopIteration
            step = self._step(self._core.done - 1)
            self._record.see(step)
            return step

    def _step(self, index: int) -> Step:
        return Step(self, self._core.row(), index)

    def result(self) -> Result:
        """The rows so far, with the fields that :func:`march` was told to keep, and those of the last row. The march can go on.

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


def march(
    surface: Any = None,
    material: Material | Body | Sequence[Material | Body] | None = None,
    *,
    times: Times | npt.ArrayLike,
    load: History | float | None = None,
    pressure: History | float | None = None,
    approach: History | float | None = None,
    stages: Sequence[Stage] | None = None,
    gap: Any = None,
    size: float | Sequence[float] | None = None,
    hardness: float | npt.ArrayLike | None = None,
    temperature: float | Sequence[tuple[float, float]] | None = None,
    boundary: Boundary = "free",
    scheme: Scheme = "linear",
    method: Method = "projected-cg",
    tolerance: float = 1e-6,
    max_iterations: int = 5000,
    plasticity: Plasticity = "cap",
    quantities: Sequence[Quantity] = (),
    bins: int = 50,
    largest_pressure: float | None = None,
    largest_gap: float | None = None,
    fields: Sequence[Field] = (),
    every: int | None = None,
    field_times: npt.ArrayLike | None = None,
    title: str = "",
    _motion: Motion | None = None,
    _output: str | None = None,
    _force: bool = False,
) -> March:
    """A simulation, step by step; the parameters are those of :func:`solve`. `fields` are those that :meth:`March.result` has: by
    default none.

    >>> import asperity as asp
    >>> cone = asp.Surface.cone(cells=(32, 32), size=(1e-3, 1e-3), slope=0.1)
    >>> for step in asp.march(cone, asp.Elastic(young=1e6, poisson=0.5), approach=1e-5, times=[1.0]):
    ...     print(step.index, step.time, step.pressure.shape)
    0 0.0 (32, 32)
    1 1.0 (32, 32)
    """
    for what, given_word, words in (
        ("boundary", boundary, Boundary),
        ("scheme", scheme, Scheme),
        ("method", method, Method),
        ("plasticity", plasticity, Plasticity),
    ):
        choice(what, given_word, get_args(words))
    if isinstance(surface, (Material, Body)):
        raise CaseError("the surface is a material: the surface comes first, as in solve(surface, material, ...)")
    keep = Keep(fields, every, field_times)
    shape = surface_of(surface, gap, size)
    check_places("hardness", hardness, surface if gap is None else gap)
    gap = shape.gap()
    bodies = bodies_of(material)
    cells, limit = hardness_parts(hardness, shape.size)
    if limit is not None:
        bodies = [with_hardness(body, limit) for body in bodies]
    given = {"load": load, "pressure": pressure, "approach": approach}
    load_unit = "N/m" if shape.is_line else "N"
    if stages is not None:
        if any(value is not None for value in given.values()):
            raise CaseError("give load, pressure, approach or stages, exactly one of them")
        programme = list(stages)
        if not programme or not all(isinstance(stage, Stage) for stage in programme):
            raise CaseError("stages is a list of asperity.Stage, one at least")
        control, history = "stages", repr(programme)
    else:
        control, value = one_of(given, "give load, pressure, approach or stages")
        prescribed = as_history(control, value, load_unit if control == "load" else None)
        programme = [as_stage(control, prescribed)]
        history = repr(prescribed)
    grid = as_times(times)
    parts = [parts_of(body) for body in bodies]
    if isinstance(quantities, str):
        raise CaseError(f"quantities is {quantities!r}, but must be a list, as in quantities=[{quantities!r}]")
    names = [str(choice("an entry of quantities", str(name), get_args(Quantity))) for name in quantities]
    steady = _motion is not None and _motion.steady
    include = [] if keep.times is None or steady else [t for t in keep.times.tolist() if t > 0]
    of_motion = [] if _motion is None else _motion.quantities(shape, boundary)
    kelvin = temperatures(temperature)
    core = _core.March(
        gap=as_plane(gap),
        size=list(shape.size),
        boundary=boundary,
        bodies=[material for materials, _ in parts for material in materials],
        stacks=[stack for _, stack in parts],
        stages=[stage._parts(load_unit) for stage in programme],
        times=grid.kind,
        times_numbers=list(grid.numbers),
        include=include,
        temperatures=kelvin,
        scheme=scheme,
        method=method,
        tolerance=number("tolerance", tolerance),
        max_iterations=count("max_iterations", max_iterations),
        hardness_map=None if cells is None else as_plane(cells),
        plasticity=plasticity,
        quantities=[*names, *(name for name in of_motion if name not in names)],
        bins=count("bins", bins),
        largest_pressure=None if largest_pressure is None else number("largest_pressure", largest_pressure),
        largest_gap=None if largest_gap is None else number("largest_gap", largest_gap),
        motion=None if _motion is None else _motion.parts(),
    )
    creeps = [{"instantaneous": first, "terms": terms, "fluidity": flow} for first, terms, flow in core.creep()]
    ratios = [body._body.poisson() if isinstance(body, Material) else (None, None) for body in bodies]
    setup: dict[str, Any] = {
        "boundary": boundary,
        "bodies": [body._whole if isinstance(body, Material) else repr(body) for body in bodies],
        # None where it changes with time.
        "poisson": [ratio for ratio, _ in ratios],
        "control": control,
        "history": history,
        "sines": sines_of(programme),
        "scheme": scheme,
        "method": method,
        "plasticity": plasticity,
        "solver_tolerance": float(tolerance),
        "end": core.times()[-1],
        "contact_creep_compliance": creeps[0],
        "retardation_times": [time for _, terms, _ in core.creep() for _, time in terms],
    }
    if temperature is None and any(creep is not None for _, creep in ratios):
        setup["poisson_creep"] = [None if creep is None else json.loads(creep) for _, creep in ratios]
    if len(creeps) > 1:
        setup["contact_creep_compliance_over_reduced_time"] = creeps[1:]
    if _motion is not None:
        setup["motion"] = _motion.setup()
    if temperature is not None:
        setup["temperature"] = kelvin
    if any(isinstance(body, Body) for body in bodies):
        misfit = core.layer_misfit()
        setup["layer_separable"], setup["layer_misfit"] = misfit is None, misfit or 0.0
        setup["layer_rigid_base"] = not any(on_half_space for _, (_, on_half_space) in parts)
    limits = [limit for limit in map(hardness_of, bodies) if limit is not None]
    if limits:
        setup["hardness"] = float(min(limits))
    return March(core, gap, shape.size, setup, keep, title, _output, _force)


def bodies_of(material: Any) -> list[Material | Body]:
    """The deformable bodies, one or two."""
    bodies = list(material) if isinstance(material, (list, tuple)) else [material]
    if 1 <= len(bodies) <= 2 and all(isinstance(body, (Material, Body)) for body in bodies):
        return bodies
    shown = repr(material) if len(repr(material)) < 60 else type(material).__name__
    raise CaseError(
        f"material is {shown}, but must be a material, such as asperity.Elastic(young=1e6, poisson=0.5), asperity.Prony(...) or "
        "asperity.Zener(...), an asperity.Body of layers, or a pair of them for two deformable bodies"
    )


def hardness_parts(hardness: Any, size: Sequence[float]) -> tuple[Floats | None, float | None]:
    """The hardness [Pa] of each cell of a domain of that size [m], or that of all."""
    if hardness is None:
        return None, None
    if np.ndim(bare("hardness", in_order("hardness", hardness, size))) == len(size):
        return field("hardness", hardness, line=True, size=size), None
    return None, number("hardness", hardness)


def solve(
    surface: Any = None,
    material: Material | Body | Sequence[Material | Body] | None = None,
    *,
    times: Times | npt.ArrayLike,
    load: History | float | None = None,
    pressure: History | float | None = None,
    approach: History | float | None = None,
    stages: Sequence[Stage] | None = None,
    gap: Any = None,
    size: float | Sequence[float] | None = None,
    hardness: float | npt.ArrayLike | None = None,
    temperature: float | Sequence[tuple[float, float]] | None = None,
    boundary: Boundary = "free",
    scheme: Scheme = "linear",
    method: Method = "projected-cg",
    tolerance: float = 1e-6,
    max_iterations: int = 5000,
    plasticity: Plasticity = "cap",
    quantities: Sequence[Quantity] = (),
    bins: int = 50,
    largest_pressure: float | None = None,
    largest_gap: float | None = None,
    fields: Sequence[Field] = ("pressure",),
    every: int | None = None,
    field_times: npt.ArrayLike | None = None,
    title: str = "",
    output: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: bool | None = None,
    on_step: Callable[[Step], object] | None = None,
    _motion: Motion | None = None,
) -> Result:
    """Solves a contact over time.

    Parameters
    ----------
    surface : Surface, or heights [m] as array (nx, ny) with `size`, or a SurfaceTopography or xarray array. A surface of one
        dimension, (n,) with size=(L,), is a line contact in plane strain: loads and energies are per length [N/m], [J/m], the
        contact area is a length [m], and fields have the shape (n,)
    gap : instead of the surface the undeformed gap [m], infinite where nothing can touch; it is shifted to the least value 0
    material : the deformable body (a material for a half-space, an asperity.Body for layers), or a pair of them
    times : times to solve for: uniform, log, adaptive, listed, or a sequence [s]; breaks of the history are added
    load, pressure, approach : what is prescribed [N], [Pa] or [m]: a history, or a number for a step
    stages : instead, a list of :class:`Stage` s: the control switches at a time or at an event
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
    fields : fields to keep: "pressure", "gap", "displacement", "contact", "flattening"
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
    run = march(
        surface,
        material,
        times=times,
        load=load,
        pressure=pressure,
        approach=approach,
        stages=stages,
        gap=gap,
        size=size,
        hardness=hardness,
        temperature=temperature,
        boundary=boundary,
        scheme=scheme,
        method=method,
        tolerance=tolerance,
        max_iterations=max_iterations,
        plasticity=plasticity,
        quantities=quantities,
        bins=bins,
        largest_pressure=largest_pressure,
        largest_gap=largest_gap,
        fields=fields,
        every=every,
        field_times=field_times,
        title=title,
        _motion=_motion,
        _output=path_of(output),
        _force=force,
    )
    if on_step is not None and not callable(on_step):
        raise CaseError(f"on_step is {on_step!r}, but must be a function that takes a Step")
    teller = Progress(run._core.rows_expected, progress)
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
    warn(run.findings, 2 if _motion is None else 3)
    return result


def run(
    case: str | os.PathLike[str] | Mapping[str, Any],
    *,
    set: dict[str, Any] | Sequence[str] | None = None,
    output: str | os.PathLike[str] | None = None,
    force: bool = False,
    resume: bool = False,
    progress: bool | None = None,
    on_row: Callable[[dict[str, Any], int, int], object] | None = None,
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
        summary = _core.run(*_source(case), _keys(set), None if output is None else os.fspath(output), force, resume, told)
    except BaseException as error:
        if output is not None and teller is not None:
            with contextlib.suppress(OSError, CaseError):
                error.result = open(output)  # type: ignore[attr-defined]
        raise
    finally:
        if teller is not None:
            teller.end()
    result = open(summary["result"])
    warn(result.findings, 2)
    return result


def check(case: str | os.PathLike[str] | Mapping[str, Any], *, set: dict[str, Any] | Sequence[str] | None = None) -> dict[str, Any]:
    """What a case (as in :func:`run`) will do, in numbers: cells, rows, moduli, memory [byte], ...; the inputs that a slip
    would hide in, the contact to be expected, and the findings that are known before the run."""
    out: dict[str, Any] = json.loads(_core.check(*_source(case), _keys(set)))
    return out


def _source(case: str | os.PathLike[str] | Mapping[str, Any]) -> tuple[str, str | None]:
    """The path of a case file; or where the files of a case lie that is given as text or keys, and its text."""
    if isinstance(case, Mapping):
        try:
            return os.curdir, _core.case_text(json.dumps(case, allow_nan=False))
        except (TypeError, ValueError) as error:
            if isinstance(error, CaseError):
                raise
            raise CaseError(f"the case holds what a case file cannot: {error}; write quantities as text with units") from None
    if isinstance(case, str) and "\n" in case:
        return os.curdir, case
    path = os.fspath(case)
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, "there is no case file of this name", path)
    return path, None


def _keys(given: dict[str, Any] | Sequence[str] | None) -> list[str]:
    if given is None:
        return []
    if isinstance(given, dict):
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
