"""Answers with their errors: of a case, a result, a contact, or the arguments of a call."""

from __future__ import annotations

import inspect
import json
import os
import tempfile
from collections.abc import Mapping
from typing import Any, TypedDict

import numpy as np

from . import _core
from ._arrays import Floats, as_plane
from ._contact import ElasticContact, ElasticCurve
from ._core import CaseError
from ._given import given
from ._motion import slide, steady
from ._result import Result
from ._declared import check_call
from ._solve import Case, Changes, March, overrides, solve, source

__all__ = ["ErrorBar", "converge"]


class ErrorBar(TypedDict, total=False):
    """An answer with its error, all SI; None where a number is not known."""

    #: Name of the answer: `contact_area`, `friction_coefficient`, `leak_rate`, ...
    name: str
    value: float | None
    #: "1" if it has none.
    unit: str
    #: Estimated error: the root of the sum of the squares of the three that follow.
    error: float | None
    #: What the size of the cells causes of it.
    grid: float | None
    #: What the length of the steps causes of it.
    time: float | None
    #: What the tolerance of the solver causes of it.
    solver: float | None
    #: Time [s] or velocity [m/s] of the row that it belongs to.
    at: float | None
    #: Observed order of convergence with the cells, with `refine`.
    order: float
    #: What limits the estimate.
    note: str


def converge(case: Case | Result | ElasticContact, *, set: Changes = None, refine: bool = False) -> list[ErrorBar]:
    """The answers of a run with their errors, as ``asperity converge`` prints them.

    The case is solved, and again with half and a quarter of the cells along each side, with steps of twice the length and with ten
    times the tolerance (docs/howto/error-bars.md).

    Parameters
    ----------
    case : path of a case file; or its text, or its keys as a dictionary, as in :func:`asperity.run`; or what :func:`solve`, :func:`steady`,
        :func:`slide` or :func:`elastic` returned; or a dictionary of the arguments of one of the first three, as in :func:`study`. Heights
        that were given as an array are resampled by their waves, as a measured surface
    set : changed keys of the case
    refine : solve it with twice the cells as well, and extrapolate the answers to vanishing cells

    Raises
    ------
    CaseError : the case is wrong
    ConvergenceError : it was not solved to its tolerance

    Examples
    --------
    >>> import asperity as asp
    >>> case = {
    ...     "domain": {"cells": [32, 32], "size": ["1 mm", "1 mm"]},
    ...     "surface": [{"kind": "sphere", "radius": "10 mm"}],
    ...     "body": [{"poisson": 0.5, "material": {"model": "elastic", "young": "3 MPa"}}],
    ...     "load": {"control": "load", "history": {"kind": "step", "value": "10 mN"}},
    ...     "time": {"end": "1 s", "steps": 1},
    ... }
    >>> bars = {bar["name"]: bar for bar in asp.converge(case)}
    >>> hertz = (9 * 0.01**2 / (16 * 0.01 * 4e6**2)) ** (1 / 3)  # approach of a sphere [m]
    >>> abs(bars["approach"]["value"] - hertz) < bars["approach"]["error"] < 0.05 * hertz
    True
    >>> sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    >>> same = {bar["name"]: bar for bar in asp.converge(asp.elastic(sphere, 4e6, load=10e-3))}
    >>> abs(same["approach"]["value"] - hertz) < same["approach"]["error"] < 0.05 * hertz
    True
    """
    if isinstance(case, ElasticContact):
        case = case.to_result()
    if isinstance(case, Result):
        text, keys = case.attributes.get("case"), None if case.attributes.get("case") else _of_result(case)
        # The command solves a case of its own.
        return _errors(text, set, refine) if keys is None else _of_keys(keys, case._setup.get("steps"), -case.initial_gap, case.size, set, refine)
    if isinstance(case, (ElasticCurve, March)):
        one = "one of its contacts, as in curve[-1]" if isinstance(case, ElasticCurve) else "its result(), or the arguments of solve"
        raise CaseError(f"converge takes one case, but is given a {type(case).__name__}: give it {one}")
    if isinstance(case, Mapping) and "material" in case:
        function: Any = steady if "velocities" in case else slide if {"velocity", "path"} & case.keys() else solve
        options = function.options
        check_call(function.__name__, inspect.signature(function), (), case)
        problem = options(**case)
        shape, keys, _ = problem.parts()
        _check_arrays(keys)
        return _of_keys(problem.given(shape, keys), shape.history, shape.heights, shape.size, set, refine)
    return _errors(case, set, refine)


def _errors(case: Any, set: Changes, refine: bool) -> list[ErrorBar]:
    return list(json.loads(_core.converge(*source(case), overrides(set), refine)))


def _of_result(result: Result) -> dict[str, Any]:
    """The keys of the case of a result in memory."""
    keys, setup = given(result), result._setup
    if keys is None:
        raise CaseError("the result does not say its case, as one of a given kernel or of an earlier release: give converge the arguments of the call, or a case")
    if setup.get("prescribed"):
        raise CaseError("what was prescribed between the rows of a march cannot be repeated on other cells: give converge a case with stages")
    if setup.get("hardness_of_cells"):
        keys = {**keys, "hardness": "array"}
    _check_arrays(keys)
    return keys


def _check_arrays(keys: dict[str, Any]) -> None:
    """Refuses arrays over the cells, which other cells do not have."""
    told = [name for name in ("friction", "wear") if "array" in keys.get(name, {})]
    told += ["hardness"] if "hardness" in keys or any("hardness_array" in body for body in keys["body"]) else []
    if told:
        raise CaseError(f"{told[0]} is an array over the cells, and converge solves on other cells: give one number for it")


def _of_keys(keys: dict[str, Any], steps: Any, heights: Floats, size: tuple[float, ...], set: Changes, refine: bool) -> list[ErrorBar]:
    """The errors of a case in memory, whose heights are stored where they are no known shape."""
    with tempfile.TemporaryDirectory() as folder:
        if steps or any(part["kind"] == "array" for part in keys["surface"]):
            path = os.path.join(folder, "heights" + (".txt" if heights.ndim == 1 else ".npz"))
            if not np.isfinite(heights).all():
                raise CaseError("the heights are an array with cells that cannot touch, which cannot be resampled: make the surface by Surface.flat_punch(...)")
            if heights.ndim == 1:
                places = (np.arange(len(heights)) + 0.5) * (size[0] / len(heights))
                np.savetxt(path, np.column_stack([places, heights]), header="position (m) height (m)", fmt="%.17g")
            else:
                _core.Heights(as_plane(heights), list(size)).write(path, "npz", [])
            keys = {**keys, "surface": [{"kind": "file", "path": path, "level": "none", "size": list(size)}]}
        return _errors(keys, set, refine)
