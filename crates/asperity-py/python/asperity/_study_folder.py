"""Studies in the folder that ``asperity study`` reads and writes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._columns import dataset
from ._command import answered
from ._core import CaseError
from ._solve import _toml

if TYPE_CHECKING:
    import xarray


def study_in_folder(
    case: Any, vary: Mapping[str, Any] | None, directory: Any, zipped: bool, error_bars: bool, jobs: int | None, threads: int | None, quiet: bool
) -> xarray.Dataset:
    """Runs ``asperity study`` and returns its table: a dimension for each key, or `run` where values go together."""
    words = [word for key, values in (vary or {}).items() for word in ("--vary", f"{key}={_written(key, values)}")]
    words += ["--zip"] * zipped + ["--error-bars"] * error_bars
    return _dataset(answered("study", case, directory, words, quiet, jobs=jobs, threads=threads))


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
    keys, runs, zipped = found["keys"], found["runs"], found["zip"]
    dims = ("run",) if zipped else tuple(key["key"] for key in keys)
    shape = (len(runs),) if zipped else tuple(len(key["values"]) for key in keys)

    def array(values: Any, words: str, unit: str | None = None) -> Any:
        return dims, np.array(values).reshape(shape), {"long_name": words, **({"units": unit} if unit else {})}

    #: Numbers of the runs by name, unit and words.
    numbers: dict[tuple[str, str, str], Any] = {}
    for n, run in enumerate(runs):
        errors = {bar["name"]: bar["error"] for bar in run["error_bars"]}
        for answer in run["answers"]:
            name, unit = answer["name"], answer["unit"]
            words = name.replace("_", " ")
            told = {(name, unit, words): answer["value"]} | ({(f"{name}_error", unit, f"error of the {words}"): errors[name]} if name in errors else {})
            for key, value in told.items():
                numbers.setdefault(key, np.full(len(runs), np.nan))[n] = np.nan if value is None else value
    columns = {name: array(values, words, unit) for (name, unit, words), values in numbers.items()}
    findings = [run["findings"] if run["status"] == "done" else -1 for run in runs]
    columns["findings"] = array(findings, "number of findings, -1 of runs that are not done")
    texts = {"finding_codes": "codes of the findings", "not_valid": "answers that the findings take back", "status": "how far the run is", "error": "why the run failed", "result": "path of the result"}
    for name, words in texts.items():
        columns["path" if name == "result" else name] = array([run[name] or "" for run in runs], words)
    places = {key["key"]: ("run" if zipped else key["key"], *_place_of(key)) for key in keys}
    return dataset(columns, places, {"study": found["study"]})


def _place_of(key: dict[str, Any]) -> tuple[Any, dict[str, str]]:
    """The values of a key, with their unit."""
    return np.array(key["values"]), {"long_name": key["key"], **({"units": key["unit"]} if key["unit"] else {})}
