"""The compiled part."""

from collections.abc import Callable
from typing import Any, final

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float64]

__all__ = [
    "elastic",
    "CaseError",
    "ConvergenceError",
    "March",
    "Body",
    "check",
    "report",
    "run",
    "Store",
    "gap",
    "level",
    "power_spectrum",
    "read_surface",
    "self_affine",
    "shape",
    "statistics",
    "write_surface",
    "__version__",
]

__version__: str

class CaseError(ValueError): ...

class ConvergenceError(RuntimeError):
    residual: float
    tolerance: float
    certificate: float
    iterations: int
    time: float | None
    best: Any

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
    ) -> Body: ...
    def creep(self, times: _Floats) -> _Floats: ...
    def relaxation(self, times: _Floats) -> _Floats: ...
    def complex(self, omega: _Floats) -> tuple[_Floats, _Floats]: ...
    def contact_creep(self, times: _Floats) -> _Floats: ...
    def creep_terms(self) -> tuple[float, list[tuple[float, float]], float]: ...
    def relaxation_terms(self) -> tuple[float, list[tuple[float, float]]]: ...

@final
class March:
    def __new__(
        cls,
        *,
        gap: _Floats,
        size: list[float],
        boundary: str,
        bodies: list[Body],
        control: str,
        history: str,
        history_numbers: list[float],
        history_points: list[tuple[float, float]],
        times: str,
        times_numbers: list[float],
        include: list[float],
        scheme: str,
        method: str,
        tolerance: float,
        max_iterations: int,
    ) -> March: ...
    def advance(self) -> bool: ...
    def __len__(self) -> int: ...
    @property
    def done(self) -> int: ...
    def times(self) -> list[float]: ...
    def row(self) -> dict[str, Any]: ...
    def field(self, name: str) -> Any: ...

@final
class Store:
    def __new__(cls, path: str) -> Store: ...
    def series(self, name: str) -> _Floats: ...
    def field(self, name: str, index: int) -> Any: ...
    def initial_gap(self) -> _Floats: ...
    @property
    def field_steps(self) -> list[int]: ...
    @property
    def fields(self) -> list[str]: ...
    @property
    def cells(self) -> list[int]: ...
    @property
    def size(self) -> list[float]: ...
    @property
    def attributes(self) -> str: ...

def elastic(
    gap: _Floats,
    size: list[float],
    contact_modulus: float,
    load: float | None,
    approach: float | None,
    hardness: float,
    boundary: str,
    method: str,
    tolerance: float,
    max_iterations: int,
) -> dict[str, Any]: ...
def run(
    path: str,
    overrides: list[str],
    output: str | None,
    force: bool,
    resume: bool,
    told: Callable[[dict[str, Any], int, int], object] | None,
) -> dict[str, Any]: ...
def check(path: str, overrides: list[str]) -> str: ...
def report(result: str, output: str, force: bool, bytes: int) -> None: ...
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
def read_surface(path: str, size: list[float] | None, height_unit: float | None, channel: str | None) -> dict[str, Any]: ...
def write_surface(path: str, heights: _Floats, size: list[float], format: str) -> None: ...
def statistics(heights: _Floats, size: list[float]) -> dict[str, float]: ...
def power_spectrum(heights: _Floats, size: list[float], per_decade: int) -> tuple[_Floats, _Floats]: ...
def level(heights: _Floats, form: str) -> _Floats: ...
