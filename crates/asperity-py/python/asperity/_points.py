"""The points of a study: what each solves, its name on disk, and how it is solved.

A point is named by a digest of all that it solves, so that a study which is called again, with more values say, finds
what it has.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import pickle
import re
import tempfile
import types
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._core import CaseError
from ._findings import ResultWarning
from ._materials import Material
from ._result import Result, open as open_result
from ._motion import slide, steady
from ._solve import overrides, solve
from ._surface import Surface

#: Answer to a point: a result, or why there is none.
Solved = tuple[str, str, Result | None]


@dataclass(frozen=True)
class Point:
    """One point: a case file with changed keys, or a function with its arguments."""

    #: What all points have in common, digested: see :func:`base_of`.
    base: str
    settings: dict[str, Any]
    #: Text of the case; None of a function.
    case: str | None = None
    #: Where the files of the case lie.
    directory: str = ""
    #: None: :func:`asperity.solve`.
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


def base_of(case: str | None, directory: str, function: Any, fixed: dict[str, Any]) -> str:
    """Digest of a case with the files that it names, or of a function and its arguments."""
    if case is not None:
        return digest(case, _files(directory, case))
    return digest(None if function is solve else function, fixed)


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
    hasher = hashlib.sha256()
    for value in values:
        _feed(hasher.update, value)
    return hasher.hexdigest()


def _feed(update: Callable[[bytes], None], value: Any) -> None:
    def tag(word: str) -> None:
        update(word.encode() + b"\0")

    if value is None or isinstance(value, (bool, int, float, complex, str)):
        tag(f"{type(value).__name__} {value!r}")
    elif isinstance(value, bytes):
        tag(f"bytes {len(value)}")
        update(value)
    elif isinstance(value, np.generic):
        _feed(update, value.item())
    elif isinstance(value, np.ndarray) and value.dtype.kind != "O":
        tag(f"array {value.dtype.str} {value.shape}")
        update(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, (list, tuple)):
        tag(f"{type(value).__name__} {len(value)}")
        for item in value:
            _feed(update, item)
    elif isinstance(value, Mapping):
        tag(f"mapping {len(value)}")
        for key in sorted(value, key=repr):
            _feed(update, key)
            _feed(update, value[key])
    elif isinstance(value, Material):
        tag(type(value).__name__)
        _feed(update, value._given)
    elif isinstance(value, Surface):
        tag("Surface")
        _feed(update, [value.heights, value.size])
    elif is_dataclass(value) and not isinstance(value, type):
        tag(type(value).__qualname__)
        _feed(update, {one.name: getattr(value, one.name) for one in fields(value)})
    elif isinstance(value, functools.partial):
        tag("partial")
        _feed(update, [value.func, value.args, value.keywords])
    elif isinstance(value, types.FunctionType):
        # A function that was changed is another one.
        tag(f"function {value.__module__} {value.__qualname__}")
        _feed(update, value.__code__)
        _feed(update, [value.__defaults__, value.__kwdefaults__])
        _feed(update, [cell.cell_contents for cell in value.__closure__ or ()])
    elif isinstance(value, types.CodeType):
        tag("code")
        update(value.co_code)
        _feed(update, [value.co_names, value.co_varnames, value.co_consts])
    else:
        tag(type(value).__qualname__)
        try:
            update(pickle.dumps(value, protocol=4))
        except Exception as error:
            raise CaseError(f"a point of the study holds {value!r}, which cannot be sent to another process: {error}") from None


def solve_point(point: Point) -> Solved:
    """Solves a point: ("complete", "", result) or ("failed", error, None). An interruption goes on to the caller.

    The study warns of its findings, where the filters of the caller hold."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResultWarning)
        return _solve_point(point)


def _solve_point(point: Point) -> Solved:
    if point.threads is not None:
        _core.set_threads(point.threads)
    try:
        if point.folder is None:
            with tempfile.TemporaryDirectory() as folder:
                return "complete", "", trimmed(_solved(point, folder), point.fields)
        return "complete", "", trimmed(_solved(point, point.folder), point.fields)
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
    call = solve if point.function is None else point.function
    given = {**point.fixed, **point.settings}
    if call in (solve, slide, steady):
        given = {"progress": False, "fields": point.fields, **given}
    found = call(**given)
    if not isinstance(found, Result):
        raise TypeError(f"the function of a study must return an asperity.Result, but returned {type(found).__name__}")
    found.save(path, force=True)
    return found


def trimmed(result: Result, names: tuple[str, ...]) -> Result:
    """The result with these fields only, in memory."""
    missing = [name for name in names if name not in result.fields]
    if missing:
        raise CaseError(f"the field {missing[0]!r} was not kept; kept: {', '.join(result.fields) or 'none'}")
    return Result(
        table={name: np.asarray(values) for name, values in result._table.items()},
        fields={name: result._stack(name) for name in names},
        field_steps=result._field_steps,
        field_times=result.field_times,
        initial_gap=result.initial_gap if names else np.empty((0, 0)),
        size=result.size,
        attributes=result.attributes,
        histograms=result._histograms,
        leaks=result._leaks,
    )


def found(point: Point, again: bool) -> Solved | None:
    """What the folder holds of a point that needs no more work; `again`: failed ones do."""
    assert point.folder is not None
    path = os.path.join(point.folder, f"{point.name}.zarr")
    try:
        result = open_result(path)
        if result.attributes.get("status") == "complete":
            return "complete", "", trimmed(result, point.fields)
    except (OSError, CaseError):
        pass
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
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Material):
        return str(value._given.get("name") or value._whole)
    return repr(value)


def label_all(settings: dict[str, Any]) -> dict[str, Any]:
    """Settings as text and numbers."""
    return {key: label(value) for key, value in settings.items()}
