"""Studies in the folder that ``asperity study`` reads and writes."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._command import answered, case_file
from ._core import CaseError
from ._solve import _toml

if TYPE_CHECKING:
    import xarray


def study_in_folder(
    case: Any,
    vary: Mapping[str, Any] | None,
    directory: Any,
    zipped: bool,
    error_bars: bool,
    jobs: int | None,
    threads: int | None,
    quiet: bool,
) -> xarray.Dataset:
    """Runs ``asperity study`` and returns its table: a dimension for each key, or `run` where values go together."""
    words = ["study", case_file(case, directory, "a study")]
    for key, values in (vary or {}).items():
        words += ["--vary", f"{key}={_written(key, values)}"]
    words += [] if directory is None else ["-o", os.fspath(directory)]
    for option, value in (("--jobs", jobs), ("--threads", threads)):
        words += [] if value is None else [option, str(value)]
    words += ["--zip"] * zipped + ["--error-bars"] * error_bars + ["-q"] * quiet
    return _dataset(answered(words, quiet))


def _written(key: str, values: Any) -> str:
    """The values of a key as the option --vary takes them."""
    if isinstance(values, str):
        return values
    if isinstance(values, np.ndarray):
        values = values.tolist()
    if not isinstance(values, (list, tuple, range)):
        raise CaseError(f"the values of {key} are {values!r}, but must be a list, or a text such as '1..10' or '0.1 N:10 N:5:log'")
    return ",".join(json.dumps(value, ensure_ascii=False) if isinstance(value, str) else _toml(key, value) for value in values)


def _dataset(found: dict[str, Any]) -> xarray.Dataset:
    import xarray

    keys, runs = found["keys"], found["runs"]
    zipped = found["zip"]
    dims = ("run",) if zipped else tuple(key["key"] for key in keys)
    shape = (len(runs),) if zipped else tuple(len(key["values"]) for key in keys)
    coordinates = {}
    for key in keys:
        attributes = {"long_name": key["key"], **({"units": key["unit"]} if key["unit"] else {})}
        coordinates[key["key"]] = ("run" if zipped else key["key"], np.array(key["values"]), attributes)
    columns: dict[str, Any] = {}

    def note(n: int, name: str, unit: str, words: str, value: float | None) -> None:
        if name not in columns:
            columns[name] = (dims, np.full(len(runs), np.nan), {"units": unit, "long_name": words})
        columns[name][1][n] = np.nan if value is None else value

    for n, run in enumerate(runs):
        errors = {bar["name"]: bar["error"] for bar in run["error_bars"]}
        for answer in run["answers"]:
            name, unit = answer["name"], answer["unit"]
            words = name.replace("_", " ")
            note(n, name, unit, words, answer["value"])
            if name in errors:
                note(n, f"{name}_error", unit, f"error of the {words}", errors[name])
    columns = {name: (dims, values.reshape(shape), attributes) for name, (dims, values, attributes) in columns.items()}
    findings = np.array([run["findings"] if run["status"] == "done" else -1 for run in runs]).reshape(shape)
    columns["findings"] = (dims, findings, {"long_name": "number of findings, -1 of runs that are not done"})
    for name, words in (
        ("finding_codes", "codes of the findings"),
        ("status", "how far the run is"),
        ("error", "why the run failed"),
        ("result", "path of the result"),
    ):
        values = np.array([run[name] or "" for run in runs]).reshape(shape)
        columns[name if name != "result" else "path"] = (dims, values, {"long_name": words})
    return xarray.Dataset(columns, coords=coordinates, attrs={"study": found["study"]})
