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
import re
import tempfile
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._contact import ElasticContact, ElasticCurve
from ._core import CaseError
from ._digest import Walk, digest
from ._findings import ResultWarning
from ._materials import Material
from ._result import Result, open as open_result
from ._solve import overrides

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


def base_of_function(function: Any, fixed: dict[str, Any]) -> tuple[str, Walk]:
    """Digest of a function and its arguments, and the walk through what they reach."""
    walk = Walk()
    return digest(repr([walk.parts(function), walk.parts(fixed)])), walk


def unseen(walk: Walk, point: Point) -> list[str]:
    """What may have changed, of what a function reaches, since the result of a point was stored."""
    assert point.folder is not None
    stored = os.path.getmtime(os.path.join(point.folder, f"{point.name}.zarr"))
    readers = [f"the files that {', '.join(sorted(walk.readers))} reads"] if walk.readers and not walk.files else []
    return [*walk.unknown, *readers, *(f"the file {file}" for file in sorted(walk.files) if os.path.exists(file) and os.path.getmtime(file) > stored)]


def _files(directory: str, text: str) -> dict[str, bytes]:
    """The files that a text names between quotes, digested: a file that has changed makes another point."""
    held = {}
    for word in sorted(set(re.findall(r"[\"']([^\"'\n]{1,4096})[\"']", text))):
        path = os.path.join(directory, word)
        if os.path.isfile(path):
            with open(path, "rb") as file:
                held[word] = hashlib.sha256(file.read()).digest()
    return held


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
    if isinstance(found, (ElasticContact, ElasticCurve)):
        found = found.to_result()
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
