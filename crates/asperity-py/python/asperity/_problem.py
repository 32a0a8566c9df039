"""What a run is given: the arguments of :func:`asperity.solve` and of its relatives, as the keys of a case."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, get_args

import numpy as np

from ._adhesion import Adhesion
from ._fluid import Fluid
from ._arrays import AnyPath, ArrayLike, Floats, Scalar, Size, as_plane, check_places, distinct, in_order, line, number
from ._core import CaseError
from ._declared import Table, check
from ._fit import Fit
from ._histories import Function, History, Stage, Times, as_history, as_times, one_of
from ._layers import Body
from ._materials import Material
from ._rows import Field, Quantity
from ._shifts import temperature_keys
from ._surface import Surface, SurfaceLike, check_boundary, per_cell, surface_of
from ._tangential import Friction, Tangential
from ._units import UNITS, bare
from ._wear import Wear
from ._words import Boundary, Method, Plasticity, Scheme

if TYPE_CHECKING:
    from ._solve import Step


@dataclass
class Problem:
    """What each kind of run takes; :func:`asperity.solve` describes the fields."""

    surface: SurfaceLike | None = None
    material: Material | Fit | Body | Sequence[Material | Fit | Body] | None = None
    _: KW_ONLY
    load: History | Function | Scalar | None = None
    pressure: History | Function | Scalar | None = None
    gap: SurfaceLike | None = None
    size: Size = None
    hardness: float | ArrayLike | None = None
    temperature: float | Sequence[tuple[float, float]] | None = None
    boundary: Boundary = "free"
    method: Method = "projected-cg"
    tolerance: float = 1e-6
    max_iterations: int = 5000
    plasticity: Plasticity = "cap"
    quantities: Sequence[Quantity] = ()
    bins: int = 50
    largest_pressure: float | None = None
    largest_gap: float | None = None
    fields: Sequence[Field] = ()
    every: int | None = None
    field_times: ArrayLike | None = None
    title: str = ""
    #: Of each history that was given as a function: the points of its table, and the largest distance that was found.
    sampled: dict[str, dict[str, Any]] = field(init=False, default_factory=dict)

    #: Groups of fields of which exactly one is given.
    alternatives: ClassVar[list[tuple[str, ...]]] = [("load", "pressure"), ("surface", "gap")]

    def __post_init__(self) -> None:
        check(self)

    def parts(self) -> tuple[Surface, dict[str, Any], dict[str, Floats]]:
        """The surface, the keys of the case, and the arrays that the keys name."""
        if isinstance(self.surface, (Material, Body)):
            raise CaseError("the surface is a material: the surface comes first, as in solve(surface, material, ...)")
        shape = surface_of(self.surface, self.gap, self.size)
        check_boundary(shape, self.boundary)
        check_places("hardness", self.hardness, self.surface if self.gap is None else self.gap)
        bodies = [dict(body._keys) for body in bodies_of(self.material)]
        arrays = {"heights": as_plane(shape.heights)}
        limit = hardness_of(self.hardness, shape)
        if isinstance(limit, np.ndarray):
            bodies[0]["hardness_array"], arrays["hardness"] = "hardness", as_plane(limit)
        elif limit is not None:
            bodies = [{**body, "hardness": limit} for body in bodies]
        ends = {"pressure": self.largest_pressure, "gap": self.largest_gap}
        histogram = {name: end for name, end in ends.items() if end is not None}
        for name, end in histogram.items():
            if not 0.0 < end < float("inf"):
                raise CaseError(f"largest_{name} is {end:g} {'Pa' if name == 'pressure' else 'm'}, but must be finite and greater than 0")
        keys: dict[str, Any] = {
            "domain": {"cells": list(shape.cells), "size": list(shape.size), "boundary": self.boundary},
            "surface": [{"kind": "array", "array": "heights", "single": bool(shape.metadata.get("single")), "history": [str(step) for step in shape.history]}],
            "body": bodies,
            "load": self.load_keys("N/m" if shape.is_line else "N"),
            "solver": {name: getattr(self, name) for name in ("method", "tolerance", "max_iterations", "plasticity")},
            "output": {"quantities": distinct("quantities", self.quantities, get_args(Quantity)), "histogram": {"bins": self.bins, **histogram}},
            **self.course_keys(),
        }
        if self.temperature is not None:
            keys["temperature"] = temperature_keys(self.temperature)
        return shape, keys, arrays

    def given(self, shape: Surface, keys: dict[str, Any]) -> dict[str, Any]:
        """The keys of the case as they were given, without arrays: surfaces by what they were made or read from."""
        bodies = [{key: value for key, value in body.items() if key != "hardness_array"} for body in keys["body"]]
        # Each of them is a step.
        kept = {} if self.field_times is None else {"times": line("field_times", self.field_times).tolist()}
        found: dict[str, Any] = in_json({**keys, "surface": shape._origin, "body": bodies, "output": {**keys["output"], **kept}})
        return found

    def load_keys(self, load_unit: str) -> dict[str, Any]:
        """The keys of `[load]`; the unit of a load is N, or N/m of a line contact."""
        control, value = one_of(self.controls(), "give")
        return {"control": control, "history": self.history_keys(control, value, load_unit if control == "load" else None)}

    def history_keys(self, what: str, value: Any, unit: str | None = None) -> dict[str, Any]:
        """The keys of a history."""
        return as_history(what, value, unit)._keys

    def controls(self) -> dict[str, Any]:
        """What may be prescribed."""
        return {"load": self.load, "pressure": self.pressure}

    def course_keys(self) -> dict[str, Any]:
        """The keys of `[time]` and `[motion]`."""
        raise NotImplementedError


@dataclass(kw_only=True)
class InTime(Problem):
    """A run in time."""

    times: Times | ArrayLike
    scheme: Scheme = "linear"
    breaks: Sequence[float] = ()
    wear: Wear | float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        # Once: a generator gives its times only once.
        self.times = as_times(self.times)

    def parts(self) -> tuple[Surface, dict[str, Any], dict[str, Floats]]:
        shape, keys, arrays = super().parts()
        if self.wear is not None:
            given = self.wear if isinstance(self.wear, Wear) else Wear(self.wear)
            keys["wear"], factors = given._parts(shape, self.history_keys)
            arrays |= factors
        return shape, keys, arrays

    def history_keys(self, what: str, value: Any, unit: str | None = None) -> dict[str, Any]:
        if np.size(self.breaks) and not any(map(callable, self._courses())):
            raise CaseError(f"breaks goes with a {what} that is a function: a history has its own")
        history = as_history(what, value, unit, over=as_times(self.times), breaks=self.breaks)
        if history.error is not None:
            self.sampled[what] = {"points": len(history.points), "error": history.error, "unit": unit or UNITS.get(what, "")}
        return history._keys

    def _courses(self) -> list[Any]:
        """All that may be a function of time."""
        given = [getattr(self, name, None) for name in ("load", "pressure", "approach", "velocity", "path")]
        return [*given, getattr(self.wear, "velocity", None), *getattr(getattr(self, "tangential", None), "course", ())]

    def course_keys(self) -> dict[str, Any]:
        return {"time": {**as_times(self.times)._keys, "scheme": self.scheme}}


@dataclass(kw_only=True)
class InStages(InTime):
    """A run in time at rest, whose control may switch: the arguments of :func:`asperity.march`."""

    approach: History | Function | Scalar | None = None
    stages: Sequence[Stage] | None = None
    adhesion: Adhesion | None = None
    fluid: Fluid | None = None
    friction: Friction | float | ArrayLike | None = None
    tangential: Tangential | None = None

    alternatives: ClassVar[list[tuple[str, ...]]] = [("load", "pressure", "approach", "stages"), ("surface", "gap")]

    def parts(self) -> tuple[Surface, dict[str, Any], dict[str, Floats]]:
        shape, keys, arrays = super().parts()
        if self.tangential is not None:
            if not isinstance(self.tangential, Tangential):
                raise CaseError(f"tangential is {self.tangential!r}, but must be asperity.tangential(force=...) or (displacement=...)")
            keys["tangential"] = self.tangential._keys(shape.is_line, self.history_keys)
        if self.friction is not None:
            given = self.friction if isinstance(self.friction, Friction) else Friction(self.friction)
            keys["friction"], coefficients = given._parts(shape)
            arrays |= coefficients
        return shape, keys, arrays

    def controls(self) -> dict[str, Any]:
        return {**super().controls(), "approach": self.approach, "stages": self.stages}

    def course_keys(self) -> dict[str, Any]:
        return {**super().course_keys(), **table_keys(self, "adhesion", Adhesion, "adhesion"), **table_keys(self, "fluid", Fluid, "leakage")}

    def load_keys(self, load_unit: str) -> dict[str, Any]:
        if self.stages is None:
            return super().load_keys(load_unit)
        one_of(self.controls(), "give")
        programme = list(self.stages)
        if not programme or not all(isinstance(stage, Stage) for stage in programme):
            raise CaseError("stages is a list of asperity.Stage, one at least")
        return {"stages": [stage._given(load_unit) for stage in programme]}


@dataclass(kw_only=True)
class Run(Problem):
    """A run to its end."""

    fields: Sequence[Field] = ("pressure",)
    output: AnyPath | None = None
    force: bool = False
    progress: bool | None = None
    on_step: Callable[[Step], object] | None = None


@dataclass(kw_only=True)
class Solve(Run, InStages):
    """The arguments of :func:`asperity.solve`."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.fields == ("pressure",):
            # With adhesion or a fluid it does not follow from the pressure which cells touch.
            attracted = self.adhesion is not None or self.fluid is not None
            along: Sequence[Field] = () if self.tangential is None else ("contact", "traction_x", "traction_y")
            self.fields = ("pressure", "contact_pressure") if attracted else ("pressure", *along)


def in_json(value: Any) -> Any:
    """Keys without infinite numbers, which JSON does not have: as text, as a case file takes them too."""
    if isinstance(value, dict):
        return {key: in_json(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [in_json(one) for one in value]
    return str(value) if isinstance(value, float) and not np.isfinite(value) else value


def table_keys(given: Problem, name: str, kind: type[Table], section: str) -> dict[str, Any]:
    """The table of the case that an argument is, where it is given."""
    if (value := getattr(given, name)) is not None and not isinstance(value, kind):
        raise CaseError(f"{name} is {value!r}, but must be an asperity.{kind.__name__}")
    return {} if value is None else {section: value._keys}


def bodies_of(material: Any) -> list[Material | Body]:
    """The deformable bodies, one or two."""
    given = list(material) if isinstance(material, (list, tuple)) else [material]
    bodies = [one.material if isinstance(one, Fit) else one for one in given]
    if 1 <= len(bodies) <= 2 and all(isinstance(body, (Material, Body)) for body in bodies):
        return bodies
    shown = repr(material) if len(repr(material)) < 60 else type(material).__name__
    raise CaseError(
        f"material is {shown}, but must be a material, such as asperity.Elastic(young=1e6, poisson=0.5), asperity.Prony(...) or "
        "asperity.Zener(...), an asperity.Body of layers, or a pair of them for two deformable bodies"
    )


def hardness_of(hardness: Any, shape: Surface) -> float | Floats | None:
    """The hardness [Pa] of each cell of the domain of this surface, or of all."""
    if hardness is None:
        return None
    if np.ndim(bare("hardness", in_order("hardness", hardness, shape.size))) != len(shape.size):
        return number("hardness", hardness)
    return per_cell("hardness", hardness, shape)
