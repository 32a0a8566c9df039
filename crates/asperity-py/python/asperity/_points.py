"""The points of a study: what each solves, its name on disk, and how it is solved.

A point is named by a digest of all that it solves, so that a study which is called again, with more values say, finds
what it has.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import os
import pickle
import re
import tempfile
import types
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._core import CaseError
from ._findings import ResultWarning
from ._materials import Material
from ._result import Result, open as open_result
from ._solve import overrides
from ._surface import Surface

#: Answer to a point: a result, or why there is none.
Solved = tuple[str, str, Result | None]


@dataclass(frozen=True)
class Point:
    """One point: a case file with changed keys, or a function with its arguments."""

    #: What all points have in common, digested.
    base: str
    settings: dict[str, Any]
    #: Text of the case; None of a function.
    case: str | None = None
    #: Where the files of the case lie.
    directory: str = ""
    function: Any = None
    fixed: dict[str, Any] = field(default_factory=dict)
    #: Where points are kept; None: nowhere.
    folder: str | None = None
    #: Fields that the answer holds.
    fields: tuple[str, ...] = ()
    #: Threads for it, where its process is not the study's own.
    threads: int | None = None

    @functools.cached_property
    def name(self) -> str:
        """Digest of what is solved."""
        return digest(self.base, self.settings, _files(self.directory, repr(self.settings)))[:16]


def base_of_case(case: str, directory: str) -> str:
    """Digest of a case with the files that it names."""
    return digest(case, _files(directory, case))


def base_of_function(function: Any, fixed: dict[str, Any]) -> str:
    """Digest of a function and its arguments; those of this package count by their names."""
    return digest(function.__name__ if hasattr(function, "options") else function, fixed)


def _files(directory: str, text: str) -> dict[str, bytes]:
    """The files that a text names between quotes, digested: a file that has changed makes another point."""
    held = {}
    for word in set(re.findall(r"[\"']([^\"'\n]{1,4096})[\"']", text)) if directory else ():
        path = os.path.join(directory, word)
        if os.path.isfile(path):
            with open(path, "rb") as file:
                held[word] = hashlib.sha256(file.read()).digest()
    return held


def digest(*values: Any) -> str:
    """The same for the same values, in this process and in the next."""
    return hashlib.sha256(repr([_parts(value) for value in values]).encode()).hexdigest()


def _parts(value: Any) -> Any:
    """What tells a value from others, in text, numbers and bytes."""
    name = type(value).__qualname__
    if value is None or isinstance(value, (bool, int, float, complex, str, bytes)):
        return name, value
    if isinstance(value, np.generic):
        return _parts(value.item())
    if isinstance(value, np.ndarray) and value.dtype.kind != "O":
        return "array", value.dtype.str, value.shape, hashlib.sha256(np.ascontiguousarray(value).tobytes()).digest()
    if isinstance(value, (list, tuple)):
        return name, [_parts(item) for item in value]
    if isinstance(value, Mapping):
        return "mapping", [(_parts(key), _parts(value[key])) for key in sorted(value, key=repr)]
    if isinstance(value, Material):
        return name, _parts(value._given)
    if isinstance(value, Surface):
        return name, _parts([value.heights, value.size])
    if is_dataclass(value) and not isinstance(value, type):
        return name, _parts({one.name: getattr(value, one.name) for one in fields(value)})
    if isinstance(value, functools.partial):
        return name, _parts([value.func, value.args, value.keywords])
    if isinstance(value, types.FunctionType):
        # A function that was changed is another one.
        held = [cell.cell_contents for cell in value.__closure__ or ()]
        return value.__module__, value.__qualname__, _parts([value.__code__, value.__defaults__, value.__kwdefaults__, held])
    if isinstance(value, types.CodeType):
        return name, value.co_code, _parts([value.co_names, value.co_varnames, value.co_consts])
    try:
        return name, pickle.dumps(value, protocol=4)
    except Exception as error:
        raise CaseError(f"a point of the study holds {value!r}, which cannot be sent to another process: {error}") from None


def solve_point(point: Point) -> Solved:
    """Solves a point: ("complete", "", result) or ("failed", error, None). An interruption goes on to the caller.

    The study warns of its findings, where the filters of the caller hold."""
    if point.threads is not None:
        _core.set_threads(point.threads)
    with warnings.catch_warnings(), contextlib.ExitStack() as until_done:
        warnings.simplefilter("ignore", ResultWarning)
        try:
            folder = point.folder or until_done.enter_context(tempfile.TemporaryDirectory())
            return "complete", "", trimmed(_solved(point, folder), point.fields)
        except Exception as error:
            message = f"{type(error).__name__}: {error}"
            if point.folder is not None:
                note(point.folder, point.name, {"status": "failed", "error": message, "settings": label_all(point.settings)})
            return "failed", message, None


def _solved(point: Point, folder: str) -> Result:
    path = os.path.join(folder, f"{point.name}.zarr")
    if point.case is not None:
        keys = overrides(point.settings)
        there = os.path.exists(path)
        try:
            _core.run(point.directory, point.case, keys, path, False, there, None)
        except OSError:
            if not there:
                raise
            # What a killed process left of it cannot be continued: from the beginning.
            _core.run(point.directory, point.case, keys, path, True, False, None)
        return open_result(path)
    given = {**point.fixed, **point.settings}
    if hasattr(point.function, "options"):
        given = {"progress": False, "fields": point.fields, **given}
    found = point.function(**given)
    if not isinstance(found, Result):
        raise TypeError(f"the function of a study must return an asperity.Result, but returned {type(found).__name__}")
    found.save(path, force=True)
    return found


def trimmed(result: Result, names: tuple[str, ...]) -> Result:
    """The result with these fields only, in memory."""
    for name in (name for name in names if name not in result.fields):
        raise CaseError(f"the field {name!r} was not kept; kept: {', '.join(result.fields) or 'none'}")
    gap = result.initial_gap if names else np.empty((0, 0))
    return Result(
        table=result._table, histograms=result._histograms, fields={name: result._stack(name) for name in names}, field_steps=result._field_steps,
        field_times=result.field_times, initial_gap=gap, size=result.size, attributes=result.attributes, leaks=result._leaks
    )


def found(point: Point, again: bool) -> Solved | None:
    """What the folder holds of a point that needs no more work; `again`: failed ones do."""
    assert point.folder is not None
    path = os.path.join(point.folder, f"{point.name}.zarr")
    with contextlib.suppress(OSError, CaseError):
        result = open_result(path)
        if result.attributes.get("status") == "complete":
            return "complete", "", trimmed(result, point.fields)
    try:
        told = json.loads(Path(point.folder, f"{point.name}.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    if again or not isinstance(told, dict) or told.get("status") != "failed":
        return None
    return "failed", str(told.get("error", "")), None


def note(folder: str, name: str, content: dict[str, Any]) -> None:
    """Writes a small file that is whole or not there."""
    path = os.path.join(folder, f"{name}.json")
    partial = f"{path}.{os.getpid()}"
    with open(partial, "w", encoding="utf-8") as file:
        json.dump(content, file, indent=1)
    os.replace(partial, path)


def label(value: Any) -> Any:
    """A value as a coordinate: a number or text."""
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Material):
        return str(value._given.get("name") or value._whole)
    return repr(value)


def label_all(settings: dict[str, Any]) -> dict[str, Any]:
    """Settings as text and numbers."""
    return {key: label(value) for key, value in settings.items()}
