"""Parameter studies: many cases in parallel, as one dataset."""

from __future__ import annotations

import collections
import contextlib
import dataclasses
import importlib
import inspect
import itertools
import json
import os
import re
import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arrays import AnyPath, count, distinct, number
from ._core import CaseError
from ._declared import check_call
from ._findings import Finding, ResultWarning, warn_caller
from ._digest import Walk
from ._points import Point, Solved, base_of_case, base_of_function, found, label, label_all, note, solve_point, unseen
from ._processes import cores, shared, solved
from ._progress import line_of
from ._columns import COLUMNS, FIELDS, GAS_LEAKS, LEAKS, QUANTITIES, ROW, VECTORS, dataset
from ._histories import one_of
from ._motion import slide, steady
from ._units import UNITS, bare, carries, has_unit, is_labelled, unit_among
from ._result import Result
from ._solve import Case, overrides, solve, source
from ._study_folder import study_in_folder
from ._surface import Surface

if TYPE_CHECKING:
    import xarray

#: Names that a parameter may not have in the dataset.
_TAKEN = {*COLUMNS, *FIELDS, *LEAKS, "leak_step", "status", "error", "findings", "finding_codes", "steps", "step", "point", "normal_load"}
#: And where the dataset holds fields.
_TAKEN_BY_FIELDS = {"x", "y", "field_step", "field_time"}
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^\s\d].*?)?\s*")


def study(
    case: Case | Callable[..., Result], over: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None = None, *,
    vary: Mapping[str, Any] | None = None, directory: AnyPath | None = None, zip: bool = False, folder: AnyPath | None = None,
    fields: Sequence[str] = (), error_bars: bool = False, workers: int | None = None, threads: int | None = None,
    client: Any = None, retry: bool = False, progress: bool | None = None
) -> xarray.Dataset:
    """Solves a case for many values of its parameters, in parallel, and returns all results as one dataset.

    Parameters
    ----------
    case : path, text or dictionary of a case as in :func:`run`; or a dictionary of the parameters of :func:`solve`, with `velocities`
        of :func:`steady`, with `velocity` or `path` of :func:`slide`; or
        a function that takes the parameters of a point and returns a :class:`Result`, or what :func:`elastic` returns
    over : values by parameter; the study solves every combination. Parameters of a case are dotted keys,
        ``{"load.history.value": ["0.1 N", "0.5 N"]}``. Give values that are neither numbers nor text (materials,
        surfaces) with labels: ``{"material": {"soft": ..., "hard": ...}}``. Or a list of points, each a dictionary.
    vary : values by key of a case, in place of `over`: the study is that of the command ``asperity study``, with its folder. A list of
        values, or a text as the command takes it, ``"1..10"`` or ``"0.1 N:10 N:5:log"``
    directory : the folder of such a study; without `vary` the case says in ``[study]`` what varies. The dataset holds the answers of
        each run, with a dimension for each key
    zip : combine the first values of all parameters to the first point, and so on, instead of every combination
    folder : where the result of every point is stored. When a study is called again, finished points are read from it,
        stopped ones continue, and new ones are solved. Without a folder only the dataset is kept.
    fields : fields that become part of the dataset: "pressure", "gap", "displacement", "contact", "flattening"
    error_bars : compute the errors of the answers too, as ``asperity study --error-bars`` does; with `vary` or `directory`
    workers : number of processes; default: the number of processors, or of points if that is smaller
    threads : threads of each process; default: the number of processors divided by the number of workers
    client : a ``dask.distributed.Client``, whose workers solve the points, each with its own number of threads; they must be
        able to read the `folder` and the files that the case names
    retry : solve failed points again
    progress : show a line with the progress; default: in terminals and notebooks

    Returns
    -------
    xarray.Dataset : the numbers of all rows with dimensions (parameters..., step), NaN beyond the last row of a point;
        `time` of each step, common to all points or for each; `steps` (number of rows), `status` ("complete" or "failed"),
        `error` (the reason), `findings` (their number, -1 without a result) and `finding_codes` of each point ("interrupted" in the dataset of a study that was stopped). A parameter with the same name as one of these gets the suffix "_given". Points that
        are not all combinations have the dimension `point`.

    Raises
    ------
    CaseError : the parameters or the case are wrong, or there is no parameter or key of a name in `over`. A single point that fails raises nothing; see `status` and `error`.

    Notes
    -----
    Every point has the same numbers as a single run, to the last bit, for any number of workers and threads. Ctrl-C stops
    within one iteration of the solver; finished points are in the `folder`, and in the dataset `error.result` of the error. A stopped point of a case continues from its last
    checkpoint, one of :func:`solve` or of a function starts again. A point in the folder is identified by its settings and by
    everything that the points share: the text of the case and the files that it names, or the arguments and what the function reaches, its code,
    closure and globals, the functions, classes and modules among them, installed packages by their version. What cannot be known, the
    content of a file that the function names or what it runs by ``eval``, is told in a warning where points are read from the folder.

    Examples
    --------
    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    >>> data = asp.study(
    ...     dict(surface=sphere, material=zener, times=asp.uniform(5.0, 5)),
    ...     over={"load": [0.001, 0.002], "hardness": [1e5, 1e6]},
    ... )
    >>> dict(data.sizes)
    {'load_given': 2, 'hardness': 2, 'step': 6}
    >>> bool((data.status == "complete").all()), float(data["load"].sel(load_given=0.002).isel(hardness=0, step=-1).round(12))
    (True, 0.002)
    """
    try:
        import xarray  # noqa: F401
    except ImportError:
        raise ImportError("a study gives an xarray.Dataset: pip install xarray (or asperity[xarray])") from None
    if vary is not None or directory is not None:
        if over is not None or folder is not None or client is not None:
            raise CaseError("vary and directory make a study of the command: leave out over, folder and client")
        return study_in_folder(case, vary, directory, zip, error_bars, workers, threads, not progress)
    if error_bars:
        raise CaseError("error_bars belong to a study of the command: give vary= or directory=")
    if over is None:
        raise CaseError("over is missing: give the values of the parameters, as in over={'load': [0.1, 0.5]}")
    plan = _Plan(over, zip)
    distinct("fields", fields, list(FIELDS))
    for what, given in (("workers", workers), ("threads", threads)):
        if given is not None:
            count(what, given)
    common, walk = _common(case, plan.names)
    read = "which is what the processes of the study read: change it there, or give it as an argument"
    if walk.changed:
        raise CaseError(f"{'; '.join(walk.changed)}, {read}")
    if walk.older:
        warn_caller(f"{'; '.join(walk.older)}, {read}", UserWarning)
    _check_names(common, plan)
    _check_loads(common, over, plan)
    place = None if folder is None else os.path.abspath(os.fspath(folder))
    if place is not None:
        os.makedirs(place, exist_ok=True)
        if os.path.exists(os.path.join(place, "study.csv")):
            raise CaseError(f"{place} is the folder of a study of the command; give it as directory= with vary=, or choose another folder")
    shares: dict[str, Any] = {**common, "folder": place, "fields": tuple(fields), "threads": None if client is None else threads}
    points = [Point(**shares, settings=settings) for settings in plan.points]
    names = [point.name for point in points]
    if len(set(names)) < len(names):
        twice = next(n for n, name in enumerate(names) if name in names[:n])
        raise CaseError(f"the point {label_all(points[twice].settings)} appears twice")

    done: dict[int, Solved] = {}
    if place is not None:
        note(place, "study", {"asperity": _core.__version__, "parameters": plan.names, "points": names})
        done = {n: answer for n, point in enumerate(points) if (answer := found(point, retry)) is not None}
        _tell_unseen(walk, [points[n] for n, answer in done.items() if answer[2] is not None], place)
    left = [n for n in range(len(points)) if n not in done]
    show, started = line_of(progress) or (lambda text: None), time.monotonic()

    def so_far(ended: str = "") -> xarray.Dataset:
        """The points so far, those after a study that was ended without results."""
        stopped: Solved = ("interrupted", f"the study was stopped: {ended}", None)
        return _dataset(plan, [done.get(n, stopped) for n in range(len(points))], points, tuple(fields), common.get("case"))

    if left:
        tasks = [points[n] for n in left]
        answers = solved(tasks, *shared(len(tasks), workers, threads)) if client is None else _on_cluster(client, tasks)
        with contextlib.closing(answers):
            try:
                for here, (n, answer) in enumerate(answers, 1):
                    done[left[n]] = answer
                    failed = sum(one[0] == "failed" for one in done.values())
                    seconds = (time.monotonic() - started) / here * (len(points) - len(done))
                    show(f"{len(done)}/{len(points)} points{f', {failed} failed' if failed else ''}  {seconds:.0f} s left")
            except BaseException as error:
                with contextlib.suppress(Exception):
                    error.result = so_far(type(error).__name__)  # type: ignore[attr-defined]
                raise
            finally:
                show(None)
    data = so_far()
    try:
        _warn(points, done)
    except ResultWarning as error:
        error.result = data  # type: ignore[attr-defined]
        raise
    return data


def _tell_unseen(walk: Walk, points: list[Point], place: str) -> None:
    """A warning of what may have changed since points were stored: a result that is read is then that of something else."""
    held = list(dict.fromkeys(what for point in points for what in unseen(walk, point)))
    if held:
        warn_caller(
            f"{len(points)} point{'s were' if len(points) > 1 else ' was'} read from {place}, though it is not known whether this changed since: "
            f"{', '.join(held[:3])}{f' and {len(held) - 3} more' if len(held) > 3 else ''}. Choose another folder where it did", UserWarning
        )


def _warn(points: list[Point], done: dict[int, Solved]) -> None:
    """A warning for each kind of finding, which names the first of its points, and one for the points that failed. Findings of a case are in
    its results."""
    failed = [(point, done[n][1]) for n, point in enumerate(points) if done[n][0] == "failed"]
    if failed:
        place = ", ".join(f"{name} = {value}" for name, value in label_all(failed[0][0].settings).items())
        warn_caller(f"{len(failed)} of {len(points)} points failed; the first, {place}: {failed[0][1]}")
    held: dict[str, list[tuple[Any, Finding]]] = {}
    for n, point in enumerate(points):
        result = done[n][2]
        for finding in [] if result is None or point.case is not None else result.findings:
            if finding["severity"] == "warning":
                held.setdefault(finding["code"], []).append((point.settings, finding))
    for (settings, finding), *others in held.values():
        place = ", ".join(f"{name} = {value}" for name, value in label_all(settings).items())
        warn_caller(f"point {place}{f' and {len(others)} more' if others else ''}: {finding}")


class _Plan:
    """The points, and how they lie along the dimensions of the dataset."""

    def __init__(self, over: Any, zipped: bool) -> None:
        if isinstance(over, Mapping):
            columns = {str(name): _values(str(name), values) for name, values in over.items()}
            if not columns:
                raise CaseError("over names no parameter: give at least one, as in over={'load': [0.1, 0.5]}")
            self.names, self.product = list(columns), not zipped
            self.labels = {name: [pair[0] for pair in column] for name, column in columns.items()}
            lengths = tuple(len(column) for column in columns.values())
            if zipped and len(set(lengths)) > 1:
                told = ", ".join(f"{name} {n}" for name, n in zip(self.names, lengths))
                raise CaseError(f"zip needs the same number of values for every parameter; there are: {told}")
            for name, column in self.labels.items() if self.product else ():
                if len(set(column)) < len(column):
                    raise CaseError(f"the values of {name} must differ from each other; there are: {column}")
            rows: Any = itertools.product(*columns.values()) if self.product else zip(*columns.values())
            self.points = [{name: pair[1] for name, pair in zip(self.names, row)} for row in rows]
            self.shape = lengths if self.product else lengths[:1]
            return
        if isinstance(over, (str, bytes)) or not isinstance(over, Sequence) or not all(isinstance(p, Mapping) for p in over):
            raise CaseError(f"over is {over!r}, but must be values by parameter, or a list of points (dictionaries)")
        self.points = [{str(name): value for name, value in point.items()} for point in over]
        if not self.points or not self.points[0]:
            raise CaseError("over holds no points: give at least one, as in over=[{'load': 0.1}]")
        self.names = list(self.points[0])
        if other := [n for n, point in enumerate(self.points) if set(point) != set(self.names)]:
            raise CaseError(f"point {other[0]} has the parameters {list(self.points[other[0]])}, but the first {self.names}")
        self.labels = {name: [label(point[name]) for point in self.points] for name in self.names}
        self.shape, self.product = (len(self.points),), False


def _load_unit(values: Any) -> str | None:
    """The SI unit of loads that carry one: per length on a line contact."""
    return unit_among("load", list(values) if isinstance(values, (list, tuple)) else [values], ("N", "N/m"))


def _check_loads(common: dict[str, Any], over: Any, plan: _Plan) -> None:
    """Refuses loads with a unit that is not that of the contact, of a line or of a plane."""
    unit = _load_unit(over["load"]) if isinstance(over, Mapping) and "load" in over and has_unit(over["load"]) else None
    for point in plan.points if unit is not None and "fixed" in common else ():
        given = {**common["fixed"], **point}
        shape = given.get("surface", given.get("gap"))
        wanted = "N/m" if (shape.is_line if isinstance(shape, Surface) else np.ndim(np.asarray(shape)) == 1) else "N"
        if unit != wanted:
            raise CaseError(f"load is in {unit}, but must be in {wanted} or a unit of the same kind")


def _values(name: str, values: Any) -> list[tuple[Any, Any]]:
    """(label, value) pairs of a parameter."""
    if has_unit(values):
        if "." in name or name not in UNITS:
            raise CaseError(f"the values of {name} carry a unit, which is not converted here: write them as text, as in ['1 mN', '2 mN']")
        # Numbers in SI units, which are labels too.
        unit = _load_unit(values) if name == "load" else None
        values = [number(name, value, unit) for value in (np.atleast_1d(bare(name, values, unit)) if carries(values) or is_labelled(values) else values)]
    elif is_labelled(values) or (hasattr(values, "to_numpy") and getattr(values, "ndim", 0) == 1):
        values = np.asarray(values)
    elif isinstance(values, Iterator):
        values = list(values)
    if isinstance(values, Mapping):
        pairs = [(label(key), value) for key, value in values.items()]
    elif isinstance(values, (str, bytes)) or not isinstance(values, (Sequence, np.ndarray)):
        raise CaseError(f"the values of {name} are {values!r}, but must be a list, or values by label")
    else:
        pairs = [(label(value), value.item() if isinstance(value, np.generic) else value) for value in values]
    if not pairs:
        raise CaseError(f"there are no values of {name}")
    return pairs


def _common(case: Any, names: list[str]) -> tuple[dict[str, Any], Walk]:
    """What all points share, and the walk through what their function reaches."""
    if isinstance(case, Mapping) and ("material" in case or "material" in names):
        given = {str(key): value for key, value in case.items()}
        known = {*given, *names}
        function = steady if "velocities" in known else slide if known & {"velocity", "path"} else solve
        base, walk = base_of_function(function, given)
        return {"fixed": given, "function": function, "base": base}, walk
    if callable(case) and not isinstance(case, (str, os.PathLike)):
        base, walk = base_of_function(case, {})
        return {"function": case, "base": base}, walk
    path, text = source(case)
    try:
        whole = Path(path).read_text(encoding="utf-8") if text is None else text
    except UnicodeDecodeError as error:
        raise CaseError(f"the case {case} cannot be read: {error}") from None
    directory = os.path.abspath(os.path.dirname(path) if text is None else path)
    return {"case": whole, "directory": directory, "base": base_of_case(whole, directory)}, Walk()


def _check_names(common: dict[str, Any], plan: _Plan) -> None:
    """Refuses parameters that what is solved does not have: every point would fail."""
    if "case" in common:
        return _check_keys(common, plan)
    fixed, function = common.get("fixed", {}), common["function"]
    for name in plan.names if fixed else ():
        if name in UNITS and (text := [point[name] for point in plan.points if isinstance(point[name], str)]):
            raise CaseError(f"the values of {name} hold the text {text[0]!r}, but must be numbers [{UNITS[name]}] or quantities with a unit")
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # of some compiled functions it is not known
        return
    try:
        check_call(getattr(function, "__name__", str(function)), signature, (), {**fixed, **plan.points[0]})
    except TypeError as error:
        raise CaseError(f"no point can be solved: {error}") from None
    # Points that prescribe nothing, or two things at once.
    alternatives = getattr(getattr(function, "options", None), "alternatives", [])
    for point, names in itertools.product(plan.points, alternatives):
        whole = {**fixed, **point}
        one_of({name: whole.get(name) for name in names}, f"the point {label_all(point)} needs")
    if hasattr(function, "options"):
        _check_arguments(function.options, fixed, plan.points)


def _check_arguments(options: Any, fixed: dict[str, Any], points: list[dict[str, Any]]) -> None:
    """Refuses arguments that are wrong in every point; those of a single one are the error of that point."""
    first: str | None = None
    for point in points:
        try:
            options(**{**fixed, **point}).parts()
        except Exception as error:  # of a function of time too
            first = first or (str(error) if isinstance(error, CaseError) else f"{type(error).__name__}: {error}")
        else:
            return
    raise CaseError(f"no point can be solved: {first}")


def _fault(common: dict[str, Any], keys: list[str]) -> str | None:
    """What is wrong with a case; None where nothing is, or where a file is missing, which the points say."""
    try:
        _core.check(common["directory"], common["case"], keys)
    except CaseError as error:
        return str(error)
    except OSError:
        pass
    return None


def _check_keys(common: dict[str, Any], plan: _Plan) -> None:
    """Refuses keys that a case does not have, and a case that is wrong without them too; wrong values are errors of their points."""
    fault = _fault(common, overrides(plan.points[0]))
    if fault is None:
        return
    if told := [line for line in fault.splitlines() if "has no key" in line]:
        raise CaseError("\n".join(told))
    if fault == _fault(common, []):
        raise CaseError(f"no point can be solved: {fault}")


def _on_cluster(client: Any, points: list[Point]) -> Generator[tuple[int, Solved], None, None]:
    """The points on the workers of a dask client, as they are done."""
    distributed: Any = importlib.import_module("distributed")

    busy = _tasks_by_host(client)
    futures = [
        client.submit(_with_threads, point, busy, pure=False, key=f"asperity-{point.name}-{os.getpid()}-{time.monotonic_ns()}")
        for point in points
    ]
    number = {future.key: n for n, future in enumerate(futures)}
    finished = False
    try:
        for future in distributed.as_completed(futures):
            if future.status == "finished":
                answer: Solved = future.result()
            else:
                error = future.exception() if future.status == "error" else None
                answer = ("failed", f"{type(error).__name__}: {error}" if error else f"the task was {future.status}", None)
            future.release()
            yield number[future.key], answer
        finished = True
    finally:
        if not finished:
            client.cancel(futures)


def _tasks_by_host(client: Any) -> dict[str, int]:
    """How many tasks the workers of each machine run at once."""
    tasks: dict[str, int] = collections.Counter()
    try:
        known = client.scheduler_info(n_workers=-1)
    except TypeError:  # before version 2025.4
        known = client.scheduler_info()
    for address, worker in known["workers"].items():
        tasks[_host(address)] += int(worker["nthreads"])
    return tasks


def _host(address: str) -> str:
    return address.rsplit(":", 1)[0]


def _with_threads(point: Point, busy: dict[str, int]) -> Solved:
    """A point on a worker of dask; the tasks on its machine share the processors."""
    if point.threads is None:
        distributed: Any = importlib.import_module("distributed")

        tasks = busy.get(_host(distributed.get_worker().address), 1)
        point = dataclasses.replace(point, threads=max(1, cores() // max(1, tasks)))
    return solve_point(point)


class _Table:
    """A dataset of all points that grows by arrays with a value, or a row of values, for each point."""

    def __init__(self, plan: _Plan, points: list[Point], answers: list[Solved], taken: set[str]) -> None:
        self.results = [answer[2] for answer in answers]
        self.whole = [result for result in self.results if result is not None]
        self.shape = plan.shape
        given = {name: f"{name}_given" if name in taken else name for name in plan.names}
        self.dims = tuple(given.values()) if plan.product else ("point",)
        self.columns: dict[str, Any] = {}
        self.coordinates: dict[str, Any] = {}
        for name, column in plan.labels.items():
            values, attributes = _coordinate(column)
            if points[0].fixed and name in UNITS and values.dtype.kind in "fiu":
                attributes = {"units": self.whole[0].units("load") if name == "load" and self.whole else UNITS[name]}
            self.coordinates[given[name]] = (given[name] if plan.product else "point", values, {"long_name": name, **attributes})

    def array(self, values: Any, attributes: dict[str, str], *dims: str) -> Any:
        """An array over the points, and these dimensions of each."""
        values = np.asarray(values)
        return (*self.dims, *dims), values.reshape(*self.shape, *values.shape[1:]), attributes

    def padded(self, columns: Callable[[Result], Any], most: int, cells: tuple[int, ...] = ()) -> Any:
        """A column of each point, or a stack of its fields, with NaN beyond its end."""
        table = np.full((len(self.results), most, *cells), np.nan)
        for row, result in zip(table, self.results):
            if result is not None and (column := columns(result)) is not None:
                row[: len(column)] = column
        return table

    def add_rows(self) -> None:
        """The numbers of the rows."""
        steps = np.array([0 if result is None else len(result) for result in self.results])
        most = int(steps.max(initial=0))
        asked = dict.fromkeys(name for result in self.whole for name in result._table if name not in ROW)
        for name, entry in {**ROW, **{name: QUANTITIES[name] for name in asked}}.items():
            table = self.padded(lambda result: result._table.get(name), most, (2,) if name in VECTORS else ())
            units = {result.units(name) for result in self.whole}
            attributes = {"units": " or ".join(sorted(units)) or entry.unit, "long_name": entry.words}
            if name != "time":
                self.columns[name] = self.array(table, attributes, "step", *["axis"] * (name in VECTORS))
                if name == "load":  # a method of datasets
                    self.columns["normal_load"] = self.columns[name]
                continue
            full = table[steps == most] if most else table
            along = "velocity" if any(result.is_sweep for result in self.whole) else "time"
            attributes["long_name"] = along
            common = len(full) and bool(np.all(full == full[0])) and bool(np.all((steps == most) | (steps == 0)))
            self.coordinates[along] = ("step", full[0], attributes) if common else self.array(table, attributes, "step")
        self.columns["steps"] = self.array(steps, {"units": "1", "long_name": "number of rows"})

    def add_answers(self, answers: list[Solved]) -> None:
        """What became of the points."""
        findings = [None if result is None else result.findings for result in self.results]
        for name, words, values in (
            ("status", "status", [answer[0] for answer in answers]),
            ("error", "why it failed", [answer[1] for answer in answers]),
            ("findings", "number of findings, -1 without a result", [-1 if held is None else len(held) for held in findings]),
            ("finding_codes", "codes of the findings", [" ".join(sorted({finding["code"] for finding in held or ()})) for held in findings]),
        ):
            self.columns[name] = self.array(values, {"long_name": words})

    def add_leaks(self) -> None:
        """Leaks that the cases ask for, at the times of their fields."""
        leaks = [result._leaks for result in self.whole if result._leaks]
        most = max((len(table["leak_step"]) for table in leaks), default=0)
        entries = GAS_LEAKS if any("leak_rate_standard" in table for table in leaks) else LEAKS
        for name in (name for name in entries if any(name in table for table in leaks)):
            into = self.coordinates if name == "leak_time" else self.columns
            into[name] = self.array(self.padded(lambda result: result._leaks.get(name), most), entries[name].attributes(), "leak_step")

    def add_fields(self, names: tuple[str, ...]) -> None:
        """Fields of these names, where the grids of all points are the same."""
        grids = {(result.cells, result.size) for result in self.whole}
        if names and len(grids) > 1:
            warn_caller("the points have different grids: the dataset holds no fields", UserWarning)
        if not names or len(grids) != 1:
            return
        first = self.whole[0]
        most = max(len(result.field_times) for result in self.whole)
        times = self.padded(lambda result: result.field_times, most)
        self.coordinates["field_time"] = self.array(times, {"units": "s", "long_name": "time of the fields"}, "field_step")
        self.coordinates |= first._coordinates
        for name in names:
            stack = self.padded(lambda result: result._stack(name), most, first.cells)
            self.columns[name] = self.array(stack, FIELDS[name].attributes(), "field_step", *first._axes)


def _dataset(plan: _Plan, answers: list[Solved], points: list[Point], names: tuple[str, ...], case: str | None) -> xarray.Dataset:
    table = _Table(plan, points, answers, _TAKEN | _TAKEN_BY_FIELDS if names else _TAKEN)
    table.add_rows()
    table.add_answers(answers)
    table.add_leaks()
    table.add_fields(names)
    attributes = {"asperity_version": _core.__version__, **({} if case is None else {"case": case})}
    return dataset(table.columns, table.coordinates, attributes)


def _coordinate(column: list[Any]) -> tuple[Any, dict[str, str]]:
    """Values of a coordinate; quantities in one unit become numbers with that unit."""
    if all(isinstance(value, str) for value in column):
        matches = [_QUANTITY.fullmatch(value) for value in column]
        units = {match and match.group(2) for match in matches}
        if None not in matches and len(units) == 1:
            (unit,) = units
            return np.array([float(match.group(1)) for match in matches if match is not None]), {} if unit is None else {"units": unit}
    if not all(isinstance(value, (bool, int, float)) for value in column):
        column = [value if isinstance(value, str) else json.dumps(value) for value in column]
    return np.array(column), {}
