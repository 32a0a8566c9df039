"""Contacts over time: from numpy to a result in memory, or from a case file to a result on disk."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, as_plane, count, field, line, number
from ._core import CaseError
from ._findings import Finding, findings_of, warn
from ._histories import History, Stage, Times, as_history, as_stage, as_times, one_of
from ._layers import Body, hardness_of, parts_of, with_hardness
from ._materials import Material
from ._motion import Motion
from ._progress import Progress
from ._result import FIELDS, HISTOGRAMS, ROW, Result, open
from ._shifts import temperatures
from ._surface import as_surface


class Step:
    """The state after one row of a march: its numbers as attributes, its fields as arrays.

    `time`, `load`, `approach`, `contact_area`, ... as in results. A step is a view: when the march has moved on, its fields can
    no longer be read.
    """

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
        values: Floats = self._march._core.field(name)
        return values.reshape(self._march.initial_gap.shape)

    @property
    def pressure(self) -> Floats:
        """Pressure [Pa], shape (nx, ny)."""
        return self.field("pressure")

    @property
    def gap(self) -> Floats:
        """Gap of the deformed surfaces [m], shape (nx, ny)."""
        return self.field("gap")

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_row"][name]
        except KeyError:
            raise AttributeError(f"a step has no {name!r}; it has {', '.join(ROW)} and field(name)") from None

    def __repr__(self) -> str:
        row, unit = self._row, "N/m" if self._march.initial_gap.ndim == 1 else "N"
        return (
            f"Step({self._index}, t = {row['time']:g} s, load {row['load']:g} {unit}, approach {row['approach']:g} m, "
            f"contact {100 * row['contact_fraction']:.3g} %)"
        )


class March:
    """A simulation that is solved step by step: iterate over it for its :class:`Step` s. Made by :func:`march`."""

    def __init__(self, core: _core.March, initial_gap: Floats, size: tuple[float, ...], setup: dict[str, Any]) -> None:
        self._core = core
        #: Undeformed gap [m], shape (nx, ny), of a line contact (n,).
        self.initial_gap = initial_gap
        #: Lengths of the domain along x and y [m], of a line contact along x.
        self.size = size
        self._setup = setup

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
        if not self._core.advance():
            raise StopIteration
        return Step(self, self._core.row(), self._core.done - 1)


def march(
    surface: Any,
    material: Material | Body | Sequence[Material | Body],
    *,
    times: Times | Sequence[float],
    load: History | float | None = None,
    pressure: History | float | None = None,
    approach: History | float | None = None,
    stages: Sequence[Stage] | None = None,
    size: float | Sequence[float] | None = None,
    hardness: float | npt.ArrayLike | None = None,
    temperature: float | Sequence[tuple[float, float]] | None = None,
    boundary: str = "free",
    scheme: str = "linear",
    method: str = "projected-cg",
    tolerance: float = 1e-6,
    max_iterations: int = 5000,
    plasticity: str = "cap",
    quantities: Sequence[str] = (),
    bins: int = 50,
    largest_pressure: float | None = None,
    largest_gap: float | None = None,
    include: Sequence[float] = (),
    _motion: Motion | None = None,
) -> March:
    """A simulation, step by step; the parameters are those of :func:`solve`.

    >>> import asperity as asp
    >>> cone = asp.Surface.cone(cells=(32, 32), size=(1e-3, 1e-3), slope=0.1)
    >>> for step in asp.march(cone, asp.Elastic(young=1e6, poisson=0.5), approach=1e-5, times=[1.0]):
    ...     print(step.index, step.time, step.pressure.shape)
    0 0.0 (32, 32)
    1 1.0 (32, 32)
    """
    shape = as_surface(surface, size)
    gap = shape.gap()
    bodies = [material] if isinstance(material, (Material, Body)) else list(material)
    if not 1 <= len(bodies) <= 2 or not all(isinstance(body, (Material, Body)) for body in bodies):
        raise CaseError(
            f"material is {material!r}, but must be a material or an asperity.Body, or a pair of them for two deformable bodies"
        )
    cells = None
    if hardness is not None and np.ndim(hardness) == gap.ndim:
        cells = field("hardness", hardness, line=True)
    elif hardness is not None:
        limit = number("hardness", hardness)
        bodies = [with_hardness(body, limit) for body in bodies]
    given = {"load": load, "pressure": pressure, "approach": approach}
    if stages is not None:
        if any(value is not None for value in given.values()):
            raise CaseError("give load, pressure, approach or stages, exactly one of them")
        programme = list(stages)
        if not programme or not all(isinstance(stage, Stage) for stage in programme):
            raise CaseError("stages is a list of asperity.Stage, one at least")
        control, history = "stages", repr(programme)
    else:
        control, value = one_of(given, "give load, pressure, approach or stages")
        prescribed = as_history(control, value)
        programme = [as_stage(control, prescribed)]
        history = repr(prescribed)
    grid = as_times(times)
    parts = [parts_of(body) for body in bodies]
    names = [str(name) for name in quantities]
    of_motion = [] if _motion is None else _motion.quantities(shape, boundary)
    core = _core.March(
        gap=as_plane(gap),
        size=list(shape.size),
        boundary=boundary,
        bodies=[material for materials, _ in parts for material in materials],
        stacks=[stack for _, stack in parts],
        stages=[stage._parts() for stage in programme],
        times=grid.kind,
        times_numbers=list(grid.numbers),
        include=[float(t) for t in line("include", np.asarray(include, dtype=float))],
        temperatures=temperatures(temperature),
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
        "bodies": [repr(body) for body in bodies],
        # None where it changes with time.
        "poisson": [ratio for ratio, _ in ratios],
        "control": control,
        "history": history,
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
        setup["temperature"] = temperatures(temperature)
    if any(isinstance(body, Body) for body in bodies):
        setup["layer_separable"], setup["layer_misfit"] = True, 0.0
    limits = [limit for limit in map(hardness_of, bodies) if limit is not None]
    if limits:
        setup["hardness"] = float(min(limits))
    return March(core, gap, shape.size, setup)


def solve(
    surface: Any,
    material: Material | Body | Sequence[Material | Body],
    *,
    times: Times | Sequence[float],
    load: History | float | None = None,
    pressure: History | float | None = None,
    approach: History | float | None = None,
    stages: Sequence[Stage] | None = None,
    size: float | Sequence[float] | None = None,
    hardness: float | npt.ArrayLike | None = None,
    temperature: float | Sequence[tuple[float, float]] | None = None,
    boundary: str = "free",
    scheme: str = "linear",
    method: str = "projected-cg",
    tolerance: float = 1e-6,
    max_iterations: int = 5000,
    plasticity: str = "cap",
    quantities: Sequence[str] = (),
    bins: int = 50,
    largest_pressure: float | None = None,
    largest_gap: float | None = None,
    fields: Sequence[str] = ("pressure",),
    every: int | None = None,
    field_times: Sequence[float] | None = None,
    title: str = "",
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
        "contact_perimeter", "contact_percolation", "gap_percolation", "rms_gap", "elastic_energy", "dissipated_energy",
        "flattening_work", "external_work", and "spot_histogram", "pressure_histogram", "gap_histogram" of that many `bins` up to `largest_pressure` [Pa] (by default the
        hardness) and `largest_gap` [m] (by default that of the undeformed gap)
    fields : fields to keep: "pressure", "gap", "displacement", "contact", "flattening"
    every : keep the fields of every n-th row, and of the first and the last; default: of every row, up to 20 rows
    field_times : instead, times at which fields are kept [s]; each becomes a step
    progress : show a line with the progress; default: in terminals and notebooks
    on_step : called with each Step

    Raises
    ------
    CaseError : the input is wrong
    ConvergenceError : a step was not solved to the tolerance; its `best` is the best state that was found

    Returns
    -------
    Result

    Warns
    -----
    ResultWarning : the numbers may be off; the result's `findings` say where and why
    """
    kept = [str(name) for name in fields]
    if unknown := [name for name in kept if name not in FIELDS]:
        raise CaseError(f"fields holds {unknown[0]!r}, but may hold {', '.join(FIELDS)}")
    wanted = None if field_times is None else line("field_times", field_times)
    if wanted is not None and every is not None:
        raise CaseError("give every or field_times, exactly one of them")
    run = march(
        surface,
        material,
        times=times,
        load=load,
        pressure=pressure,
        approach=approach,
        stages=stages,
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
        include=[] if wanted is None or (_motion is not None and _motion.steady) else [t for t in wanted.tolist() if t > 0],
        _motion=_motion,
    )
    # Adaptive steps find their rows as they go.
    rows = run._core.rows_expected
    stride = count("every", every) if every is not None else max(1, -(-((rows or 1) - 1) // 20))

    def kept_at(step: Step) -> bool:
        if step.index == 0 or step.index + 1 == rows:
            return True
        if wanted is None:
            return step.index % stride == 0
        return bool(np.any(np.abs(wanted - step.time) <= 1e-12 * end))

    end = run._core.times()[-1]
    edges = {name: np.array(ends) for name, ends in run._core.columns()}
    table: dict[str, list[Any]] = {name: [] for name in [*ROW, *edges]}
    maps: dict[str, list[Any]] = {name: [] for name in kept}
    steps: list[int] = []
    teller = Progress(rows, progress)
    last: Step | None = None
    try:
        for step in run:
            for name, values in table.items():
                values.append(step.row[name])
            if kept_at(step):
                steps.append(step.index)
                for name in kept:
                    maps[name].append(step.field(name))
            last = step
            if on_step is not None:
                on_step(step)
            teller.tell(step.row, step.index + 1)
        if last is not None and last.index not in steps:
            steps.append(last.index)
            for name in kept:
                maps[name].append(last.field(name))
    finally:
        teller.end()
    found = run.findings
    warn(found, 2 if _motion is None else 3)
    return Result(
        table={name: np.array(values) for name, values in table.items() if name not in HISTOGRAMS},
        histograms={name: (ends, np.array(table[name])) for name, ends in edges.items() if name in HISTOGRAMS},
        fields={name: np.array(stack) for name, stack in maps.items()},
        field_steps=np.array(steps),
        initial_gap=run.initial_gap,
        size=run.size,
        attributes={
            "title": title,
            "version": _core.__version__,
            "status": "complete",
            "setup": json.dumps(run._setup),
            "findings": [dict(finding) for finding in found],
        },
    )


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
    return os.fspath(case), None


def _keys(given: dict[str, Any] | Sequence[str] | None) -> list[str]:
    if given is None:
        return []
    if isinstance(given, dict):
        return [f"{key}={value if _is_toml(value) else json.dumps(value)}" for key, value in given.items()]
    return [str(key) for key in given]


def _is_toml(value: Any) -> bool:
    """Text goes as it is: the core takes it as TOML or as a word."""
    return isinstance(value, str)
