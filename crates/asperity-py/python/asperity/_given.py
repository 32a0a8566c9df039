"""The case of a result as it was given: in words for a paper, and as the text of a case file that runs it again."""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._prefixes import quantity
from ._units import UNITS

if TYPE_CHECKING:
    from ._result import Result

#: Kinds of a part of the surface in words.
_PARTS = {"self-affine": "self-affine roughness", "file": "heights of a file", "array": "heights given as an array", "wave": "a wave", "ellipsoid": "an ellipsoid"}
_WORDS = {"hurst": "Hurst exponent", "rms_gradient": "rms gradient", "rms_height": "rms height", "roll_off": "roll-off", "poisson": "Poisson's ratio"}
#: What a control is measured in; values of a history have its unit.
_CONTROLLED = {"load": "N", "pressure": "Pa", "approach": "m"}
_VALUES = ("value", "peak", "mean", "amplitude", "from")
#: More numbers than these are left to the case.
_MOST = 12


def given(result: Result) -> dict[str, Any] | None:
    """The keys of the case; None where they are not known."""
    known: dict[str, Any] | None = result._setup.get("given")
    text = result._attributes.get("case")
    return read(text) if known is None and text else known


def read(text: str) -> dict[str, Any] | None:
    """The keys of the text of a case; None before Python 3.11, which has no reader of TOML."""
    try:
        return dict(importlib.import_module("tomllib").loads(text))
    except ImportError:
        return None


def change(known: dict[str, Any], changes: Sequence[str]) -> list[str]:
    """Changes keys of a case by words ``key=value``; those whose place is not there stay, and are returned."""
    others = []
    for change in changes:
        path, _, text = change.partition("=")
        *tables, key = re.sub(r"\[(\d+)\]", r".\1", path.strip()).split(".")
        table: Any = known
        try:
            for name in tables:
                table = table[int(name)] if isinstance(table, list) else table.setdefault(name, {})
            table[int(key) if isinstance(table, list) else key] = _toml(text.strip())
        except (AttributeError, IndexError, TypeError, ValueError):
            others.append(change)
    return others


def _toml(text: str) -> Any:
    """A value of TOML, or a word without quotes."""
    tomllib = importlib.import_module("tomllib")
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def text_of(result: Result) -> str:
    """The case as a file below a line that says so; empty where it is not known."""
    if text := result._attributes.get("case"):
        return headed(str(text), [])
    known = given(result)
    if known is None:
        return ""
    left_out = list(_left_out(result, known))
    return headed(_core.case_text({"left_out": left_out, **known} if left_out else known), left_out)


def headed(text: str, left_out: list[str]) -> str:
    """A case below a line that says so. What it leaves out is a key of it that no case has: it is refused, and never solves something else."""
    whole, told = "in full", ""
    if left_out:
        whole = "but for what it leaves out"
        told = "# This case does not run as it stands, because it leaves something out. Put that in, and delete the key left_out.\n"
    return f"The case {whole}, numbers without a unit in SI units:\n\n{told}{text.rstrip()}"


def _left_out(result: Result, known: dict[str, Any]) -> Iterator[str]:
    """What keys of a case do not say."""
    setup = result._setup
    if any(part.get("kind") == "array" for part in known.get("surface", [])):
        yield "The heights were given as an array: store them in a file, and name it in the part of the kind array."
    # Results of an earlier release do not say which steps came after the parts were made or read.
    if done := setup.get("since", steps(setup)):
        yield f"What was done to the heights: {'; '.join(done)}."
    if setup.get("hardness_of_cells"):
        yield "The hardness of each cell was given as an array."
    for table in ("friction", "wear"):
        if "array" in known.get(table, {}):
            yield f"The coefficients of [{table}] were given as an array."
    for one in setup.get("prescribed") or []:
        yield f"From row {one['row']} on was prescribed: {one['control']}, {_listed(one['history'], _CONTROLLED.get(one['control'], ''))}."


def steps(setup: dict[str, Any]) -> list[str]:
    """What was done to the heights since they were made or read."""
    return list(map(str, setup.get("steps") or setup.get("preparation") or []))


def surfaces(known: dict[str, Any]) -> str:
    """How the surfaces were made."""
    told = []
    for part in known.get("surface", []):
        name = _PARTS.get(part["kind"], f"a {part['kind'].replace('-', ' ')}")
        words = _listed({key: value for key, value in part.items() if key not in ("kind", "array", "single", "history", "process") and not _is_middle(key, value)})
        told.append(f"{name} ({words})" if words else name)
    return f"The surface is {' plus '.join(told)}." if told else ""


def _is_middle(key: str, value: Any) -> bool:
    return key == "center" and not np.any(np.asarray([0.0 if one in (0, "0 m") else 1.0 for one in value]))


def materials(known: dict[str, Any]) -> str:
    """The numbers of the materials."""
    told = []
    for n, body in enumerate(known.get("body", [])):
        for part in [body, *body.get("layer", [])]:
            model = dict(part.get("material") or {})
            if words := _listed({key: value for key, value in model.items() if key != "model"}):
                own = body.get("name", f"body {n + 1}")
                told.append(f"{own if part is body else 'a layer of ' + own}: {words}")
    return f"The parameters of the materials are {'; '.join(told)}." if told else ""


def load(known: dict[str, Any], unit: str) -> str:
    """The history that was prescribed, in brackets; empty of a table, which is long, and of stages."""
    table = known.get("load", {})
    history = table.get("history", {})
    if not history or history.get("kind") == "table":
        return ""
    return f" ({_listed(history, unit if table.get('control') == 'load' else _CONTROLLED.get(table.get('control', ''), ''))})"


def courses(known: dict[str, Any], unit: str) -> Iterator[str]:
    """What was prescribed along the surfaces, whose force has this unit, and the velocity with which they wear."""
    if along := known.get("tangential"):
        own = unit if along["control"] == "force" else "m"
        told = [f"along {axis} ({_listed(along[axis], own)})" for axis in "xy" if along.get(axis) and along[axis] != {"kind": "step", "value": 0.0}]
        yield f"The tangential {along['control']} is prescribed {' and '.join(told)}." if told else ""
    if isinstance(velocity := known.get("wear", {}).get("velocity"), dict):
        yield f"The velocity of the wear is prescribed ({_listed(velocity, 'm/s')})."


def seal(known: dict[str, Any]) -> str:
    """What the seal is of which the case is a patch."""
    told = known.get("seal", {})
    profile = str(told.get("profile", ""))
    words = f"has the profile {profile}" if profile in ("hertz", "uniform", "parabola") else f"is that of the file {profile}"
    return f"The contact pressure across the seal {words} ({_listed({key: value for key, value in told.items() if key != 'profile'})})."


def motion(known: dict[str, Any]) -> str:
    """How warm the surfaces become, what the fluid is, and the stress along the surfaces."""
    table = known.get("motion", {})
    told = [f" Along the surfaces acts the shear stress {_value('shear_stress', table['shear_stress'], '')}."] if "shear_stress" in table else []
    for name, words in (("flash", "The flash temperature is that of"), ("leakage", "The leak is that of")):
        if known.get(name):
            told.append(f" {words} {_listed(known[name])}.")
    return "".join(told).strip()


def _listed(table: dict[str, Any], unit: str = "") -> str:
    """Keys with their values; of a list that is long the number of its entries."""
    words = []
    for key, value in sorted(table.items(), key=lambda item: item[0] != "kind"):
        if value is None:
            continue
        shown = _value(key, value, unit if key in _VALUES else "")
        words.append(shown if key == "kind" else f"{_WORDS.get(key, key.replace('_', ' '))} {shown}")
    return ", ".join(words)


def _value(key: str, value: Any, unit: str) -> str:
    unit = unit or _UNITS.get(key, "")
    if isinstance(value, dict):
        return f"({_listed(value, unit)})"
    if isinstance(value, (list, tuple)):
        if len(value) > _MOST:
            return f"{len(value)} values"
        return f"[{', '.join(_value(key, one, unit) for one in value)}]"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return quantity(float(value), unit) if unit and np.isfinite(value) else f"{value:.12g}{f' {unit}' if unit else ''}"


#: Units of keys whose parameter has another name or more than one meaning.
_UNITS = {**UNITS, "conductivity": "W/(m K)", "diffusivity": "m2/s", "heated_for": "s", "shear_limit": "Pa", "instantaneous": ""}
