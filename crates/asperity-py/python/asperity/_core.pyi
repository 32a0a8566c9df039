"""The compiled part."""

from collections.abc import Callable
from typing import Any, final

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float64]
_Shift = tuple[str, list[float], list[tuple[float, float]], tuple[float | None, list[tuple[float, float]]] | None]
_Grid = tuple[str, list[float]]
# What, history, points, start, direction with its angle, cells to a step, shear stress, whether it rolls.
_Motion = tuple[str, _Grid, list[tuple[float, float]], float, tuple[str, float], float, float | None, bool]
_Stage = tuple[str, _Grid, list[tuple[float, float]], float | None, tuple[str, float] | None, bool, _Grid | None]

__all__ = [
    "command",
    "Elastic",
    "spot_labels",
    "unit_factor",
    "Writer",
    "CaseError",
    "FormatError",
    "ConvergenceError",
    "cycles_of",
    "March",
    "quantities",
    "fit",
    "fit_file",
    "fit_indentation",
    "Body",
    "layer_compliance",
    "leakage",
    "judge_leaks",
    "derive_again",
    "read_shift_table",
    "shift_factor",
    "vertical_shift_factor",
    "case_text",
    "check",
    "report",
    "run",
    "Persson",
    "profile_parameters",
    "Store",
    "save",
    "stress_check",
    "stress_depths",
    "stress_field",
    "stress_survey",
    "stress_transverse",
    "autocorrelation",
    "bearing_curve",
    "describe",
    "gap",
    "height_distribution",
    "power_spectrum",
    "process",
    "read_surface",
    "roughness",
    "self_affine",
    "shape",
    "write_surface",
    "set_threads",
    "threads",
    "__version__",
    "LAYERED_STRESS",
]

def command(words: list[str]) -> int: ...

__version__: str
LAYERED_STRESS: str

class CaseError(ValueError): ...

class ConvergenceError(RuntimeError):
    residual: float
    tolerance: float
    certificate: float
    iterations: int
    time: float | None
    best: Any
    #: Rows before it, where :func:`asperity.solve` raises it.
    result: Any

def cycles_of(
    time: list[float], load: list[float], approach: list[float], frequency: float, start: float
) -> list[tuple[float, float, float, float, float, float]]: ...
@final
class Body:
    def __new__(
        cls,
        model: str,
        measure: str,
        numbers: list[float],
        terms: list[tuple[float, float]],
        poisson: float | None,
        bulk_modulus: float | None,
        hardness: float | None,
        name: str,
        shift: _Shift | None,
        temperature: float | None,
    ) -> Body: ...
    def creep(self, times: _Floats) -> _Floats: ...
    def relaxation(self, times: _Floats) -> _Floats: ...
    def complex(self, omega: _Floats) -> tuple[_Floats, _Floats]: ...
    def poisson(self) -> tuple[float | None, str | None]: ...
    def contact_creep(self, times: _Floats) -> _Floats: ...
    def creep_terms(self) -> tuple[float, list[tuple[float, float]], float]: ...
    @property
    def error(self) -> float | None: ...
    def relaxation_terms(self) -> tuple[float, list[tuple[float, float]]]: ...

@final
class Elastic:
    def __new__(
        cls,
        *,
        gap: _Floats,
        size: list[float],
        contact_modulus: float,
        hardness: float,
        hardness_map: _Floats | None,
        boundary: str,
        method: str,
        tolerance: float,
        max_iterations: int,
        kernel: _Floats | None,
    ) -> Elastic: ...
    def solve(self, load: float | None, approach: float | None, start: _Floats | None, history: bool) -> dict[str, Any]: ...
    def stiffness(self, pressure: _Floats) -> float: ...

@final
class Writer:
    def __new__(
        cls,
        path: str,
        force: bool,
        title: str,
        setup: str,
        size: list[float],
        initial_gap: _Floats,
        fields: list[str],
        quantities: list[tuple[str, _Floats]],
        rows: int | None,
    ) -> Writer: ...
    @property
    def rows(self) -> int: ...
    def append(self, row: dict[str, Any], quantities: list[float], fields: dict[str, Any]) -> None: ...
    def finish(self, status: str, findings: str, message: str | None) -> None: ...

@final
class March:
    def __new__(
        cls,
        *,
        gap: _Floats,
        size: list[float],
        boundary: str,
        bodies: list[Body],
        stacks: list[tuple[list[tuple[float, str]], bool]],
        stages: list[_Stage],
        times: str,
        times_numbers: list[float],
        include: list[float],
        temperatures: list[tuple[float, float]],
        scheme: str,
        method: str,
        tolerance: float,
        max_iterations: int,
        hardness_map: _Floats | None,
        plasticity: str,
        quantities: list[str],
        bins: int,
        largest_pressure: float | None,
        largest_gap: float | None,
        motion: _Motion | None,
    ) -> March: ...
    def columns(self) -> list[tuple[str, list[float]]]: ...
    def advance(self) -> bool: ...
    def creep(self) -> list[tuple[float, list[tuple[float, float]], float]]: ...
    def layer_misfit(self) -> float | None: ...
    def findings(self) -> str: ...
    def __len__(self) -> int: ...
    @property
    def rows_expected(self) -> int | None: ...
    @property
    def finished(self) -> bool: ...
    @property
    def settled(self) -> bool: ...
    @property
    def done(self) -> int: ...
    def times(self) -> list[float]: ...
    def row(self) -> dict[str, Any]: ...
    def field(self, name: str) -> Any: ...

@final
class Persson:
    def __new__(
        cls,
        heights: _Floats,
        size: list[float],
        body: Body,
        temperature: float | None,
        pressure: float,
        direction: str,
        angle: float,
        correction: str,
    ) -> Persson: ...
    def sweep(self, velocities: _Floats) -> tuple[_Floats, _Floats]: ...
    def magnification(self, velocity: float) -> tuple[_Floats, _Floats, _Floats]: ...

@final
class Store:
    def __new__(cls, path: str) -> Store: ...
    def series(self, name: str) -> _Floats: ...
    def field(self, name: str, index: int) -> Any: ...
    @property
    def quantities(self) -> list[str]: ...
    def histogram(self, name: str) -> tuple[_Floats, _Floats]: ...
    def initial_gap(self) -> _Floats: ...
    def stress(self) -> dict[str, _Floats] | None: ...
    @property
    def field_steps(self) -> list[int]: ...
    @property
    def field_times(self) -> list[float]: ...
    @property
    def fields(self) -> list[str]: ...
    @property
    def cells(self) -> list[int]: ...
    @property
    def size(self) -> list[float]: ...
    def leaks(self) -> dict[str, _Floats]: ...
    def fluid_pressure(self, index: int) -> _Floats: ...
    @property
    def has_fluid_pressure(self) -> bool: ...
    @property
    def stress_fields(self) -> list[str]: ...
    def stress_field(self, name: str, index: int, depth: int) -> _Floats: ...
    @property
    def attributes(self) -> str: ...

def stress_check(
    pressure: _Floats, size: list[float], boundary: str, poisson: float, transverse: tuple[_Floats, float] | None, depths: list[float]
) -> None: ...
def leakage(
    gap: _Floats,
    contact: Any,
    size: list[float],
    keys: str,
    temperatures: list[tuple[float, float]],
    time: float,
) -> dict[str, Any]: ...
def judge_leaks(
    states: list[tuple[int | None, float | None, int | None, float, float | None, float]],
) -> tuple[list[bool], str]: ...
def stress_depths(pressure: _Floats, size: list[float], boundary: str) -> list[float]: ...
def stress_field(
    name: str,
    pressure: _Floats,
    size: list[float],
    boundary: str,
    poisson: float,
    transverse: tuple[_Floats, float] | None,
    depths: list[float],
) -> _Floats: ...
def stress_transverse(creep: str, times: list[float], pressures: _Floats) -> tuple[_Floats, float]: ...
def stress_survey(
    pressure: _Floats,
    size: list[float],
    boundary: str,
    poisson: float,
    transverse: tuple[_Floats, float] | None,
    depths: list[float],
    threshold: float | None,
    rolling: str | None,
) -> dict[str, Any]: ...
def run(
    path: str,
    text: str | None,
    overrides: list[str],
    output: str | None,
    force: bool,
    resume: bool,
    told: Callable[[dict[str, Any], int, int], object] | None,
) -> dict[str, Any]: ...
def fit(
    kind: str, sweeps: list[tuple[float | None, _Floats, list[_Floats]]], options: dict[str, Any]
) -> dict[str, Any]: ...
def fit_file(
    path: str,
    kind: str | None,
    columns: list[tuple[str, str | None, int | None, str | None]],
    sheet: str | None,
    options: dict[str, Any],
) -> dict[str, Any]: ...
def fit_indentation(
    times: _Floats,
    loads: _Floats,
    depths: _Floats,
    profile: str,
    number: float,
    given: str | None,
    terms: int | None,
    long_time: str,
    fit_touch: bool,
    thin: tuple[float, float, str] | None,
    springs: int,
    limit: float,
) -> dict[str, Any]: ...
def layer_compliance(
    waves: _Floats, bodies: list[Body], stack: tuple[list[tuple[float, str]], bool], time: float
) -> _Floats: ...
def spot_labels(pressure: _Floats, boundary: str) -> npt.NDArray[np.uint32]: ...
def unit_factor(text: str, wanted: str) -> float | None: ...
def read_shift_table(path: str) -> _Shift: ...
def shift_factor(words: _Shift, temperatures: _Floats) -> _Floats: ...
def vertical_shift_factor(words: _Shift, temperatures: _Floats) -> _Floats: ...
def case_text(json: str) -> str: ...
def check(path: str, text: str | None, overrides: list[str]) -> str: ...
def report(result: str, output: str, force: bool, bytes: int) -> None: ...
def derive_again(source: str, copy: str) -> None: ...
def save(
    path: str,
    force: bool,
    title: str,
    setup: str,
    size: list[float],
    initial_gap: _Floats,
    columns: dict[str, _Floats],
    fields: list[tuple[str, Any]],
    field_steps: list[int],
    field_times: list[float],
    quantities: list[tuple[str, _Floats, _Floats]],
    findings: str,
    status: str,
) -> None: ...
def quantities() -> list[tuple[str, str, str, bool]]: ...
def set_threads(number: int | None) -> None: ...
def threads() -> int: ...
def roughness(keys: list[tuple[str, str]]) -> tuple[_Floats, list[float]]: ...
def process(heights: _Floats, size: list[float], steps: list[str]) -> tuple[_Floats, list[float], list[str]]: ...
def describe(heights: _Floats, size: list[float], periodic: bool, band: list[float] | None) -> dict[str, Any]: ...
def bearing_curve(heights: _Floats, size: list[float], levels: int) -> tuple[_Floats, _Floats]: ...
def height_distribution(heights: _Floats, size: list[float], bins: int) -> tuple[_Floats, _Floats]: ...
def autocorrelation(
    heights: _Floats, size: list[float], periodic: bool
) -> tuple[_Floats, float | None, float | None]: ...
def self_affine(
    cells: tuple[int, int],
    size: list[float],
    hurst: float,
    rms_gradient: float | None,
    rms_height: float | None,
    longest: float,
    shortest: float,
    roll_off: float | None,
    seed: int,
) -> _Floats: ...
def shape(kind: str, numbers: list[float], center: list[float], cells: tuple[int, int], size: list[float]) -> _Floats: ...
def gap(heights: _Floats, size: list[float]) -> _Floats: ...
class FormatError(OSError): ...

def profile_parameters(heights: _Floats, spacing: float, cutoff: float | None) -> dict[str, Any]: ...
def read_surface(path: str, size: list[float] | None, height_unit: float | None, channel: str | None) -> dict[str, Any]: ...
def write_surface(path: str, heights: _Floats, size: list[float], format: str, history: list[str]) -> None: ...
def power_spectrum(heights: _Floats, size: list[float], per_decade: int) -> tuple[_Floats, _Floats]: ...
