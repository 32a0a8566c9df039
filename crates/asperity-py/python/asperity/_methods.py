"""The paragraph on methods of a paper, from what a result says that was run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import cells_of
from ._cite import entries
from ._prefixes import quantity

if TYPE_CHECKING:
    from ._result import Result

_SOLVERS = {
    "projected-cg": "preconditioned projected conjugate gradients",
    "polonsky-keer": "the method of Polonsky and Keer (1999) with a limited pressure",
}
_SCHEMES = {
    "linear": "linear in each step (second order)",
    "constant": "constant in each step, as by Spinu and Cerlinca (2017)",
    "direct": "linear in each step, by the full hereditary sum",
}
_CONTROLS = {"load": "load", "pressure": "mean pressure", "approach": "approach"}


def paragraph(result: Result, bibtex: bool) -> str:
    """What was run, in sentences, and with `bibtex` the entries of what they cite."""
    text = " ".join(sentence for sentence in _sentences(result) if sentence)
    if not bibtex:
        return text
    cited = ["asperity"] + [key for key, words in (("spinu2017", "Spinu"), ("polonsky1999", "Polonsky"), ("yastrebov2017", "Yastrebov")) if words in text]
    return f"{text}\n\n{entries(cited)}"


def _sentences(result: Result) -> list[str]:
    setup, known = result._setup, result._attributes
    creep = setup.get("contact_creep_compliance") or {}
    relaxes = bool(creep.get("terms") or creep.get("fluidity") or setup.get("retardation_times"))
    layered = "layer_separable" in setup
    bodies = "bodies of a given kernel" if setup.get("kernel") == "given" else "layered bodies" if layered else "half-spaces"
    material = "linear viscoelastic" if relaxes else "linear elastic"
    sides = " x ".join(quantity(length, "m") for length in result.size)
    domain = "periodic domain" if setup.get("boundary") == "periodic" else "free surface"
    strain = " in plane strain" if result.is_line else ""
    return [
        f"The {'' if setup.get('friction') else 'frictionless '}{'adhesive ' if setup.get('adhesion') else ''}normal contact{' with friction' if setup.get('friction') else ''} of {material} {bodies}{strain} was computed with asperity {known.get('version', '')}"
        f"{', by the model of Spinu and Cerlinca (2017)' if relaxes and not layered else ''}, on {cells_of(result.initial_gap)} of a {domain} of {sides}.",
        _of_materials(setup),
        _of_hardness(setup),
        _of_adhesion(setup.get("adhesion")),
        _of_friction(setup.get("friction")),
        _of_wear(setup.get("wear")),
        _of_load(result, setup),
        _of_motion(result, setup),
        _of_rows(result, setup, relaxes),
        _of_solver(result, setup),
        "Contact areas are those of the cells " + ("in contact" if setup.get("adhesion") else "under pressure") + "; corrected ones are reduced by a share of their perimeter (Yastrebov, Anciaux and Molinari 2017)."
        if not result.is_line
        else "",
        _of_errors(result),
    ]


def _of_materials(setup: dict[str, Any]) -> str:
    told = []
    ratios = setup.get("poisson") or []
    models = {material["body"]: material for material in setup.get("materials") or []}
    for name, ratio in zip(setup.get("bodies") or [], ratios):
        found = models.get(name, {})
        words = [f"{found.get('model', 'given')} model"]
        if found.get("terms"):
            words.append(f"{found['terms']} term{'s' if found['terms'] > 1 else ''}")
        words.append(f"Poisson's ratio {ratio:g}" if ratio is not None else "constant bulk modulus")
        if found.get("rms_misfit") is not None:
            words.append(f"fitted with an rms misfit of {100 * found['rms_misfit']:.2g} %")
        told.append(f"{name} ({', '.join(words)})")
    if not told and setup.get("contact_modulus") is not None:
        return f"The contact modulus is {quantity(setup['contact_modulus'], 'Pa')}."
    if not told:
        return ""
    modulus, relaxed = (setup.get(name) for name in ("instantaneous_modulus", "relaxed_modulus"))
    ends = ""
    if modulus is not None:
        ends = f" The contact modulus is {quantity(modulus, 'Pa')}" + (
            f" at once and {quantity(relaxed, 'Pa')} after relaxation." if relaxed is not None and relaxed != modulus else "."
        )
    alone = "; the other body is rigid" if len(told) == 1 else ""
    return f"The deformable {'body is' if alone else 'bodies are'} {' and '.join(told)}{alone}.{ends}"


def _of_hardness(setup: dict[str, Any]) -> str:
    hardness = setup.get("hardness")
    if setup.get("hardness_of_cells"):
        return "The pressure of each cell is cut off at its hardness."
    if not isinstance(hardness, (int, float)):
        return ""
    stays = "stays on unloading" if setup.get("plasticity") == "accumulate" else "disappears on unloading"
    return f"The pressure is cut off at the hardness, {quantity(float(hardness), 'Pa')}; the flattening {stays}."


def _of_adhesion(told: dict[str, Any] | None) -> str:
    if not told:
        return ""
    reach = f"the range {quantity(told['range'], 'm')} (largest attraction {quantity(told['strength'], 'Pa')})"
    law = f" after the law {told['law']}" if "law" in told else ""
    sphere = f", Tabor's number {told['tabor']:.2g}" if told.get("tabor") is not None else ""
    return f"The surfaces attract each other{law}, with the work of adhesion {1e3 * told['work']:.4g} mJ/m² and {reach}{sphere}; the trap number of the grid is {told['trap']:.2g}."


def _of_friction(friction: dict[str, Any] | None) -> str:
    if friction is None:
        return ""
    coefficient = friction.get("coefficient")
    words = "a coefficient for each cell" if coefficient is None else f"the coefficient {coefficient:g}"
    limit = f", up to a traction of {quantity(friction['shear_limit'], 'Pa')}" if friction.get("shear_limit") else ""
    neglected = friction.get("coupling") != "full"
    effect = "whose effect on the pressure was neglected" if neglected else "and it and the pressure were found in turn until both agreed (Panagiotopoulos, 1975)"
    return (
        f"Friction with {words}{limit} acted against a prescribed tangential {friction['control']}; stick and slip followed from both components of "
        f"the tangential traction (Kalker, 1990), {effect}."
    )


def _of_wear(wear: dict[str, Any] | None) -> str:
    if wear is None:
        return ""
    body, counterbody = wear["coefficients"]
    both = f" of the body and {counterbody:g} m²/N of the counterbody" if counterbody else ""
    limit = f" above a threshold of {quantity(wear['threshold'], 'Pa')}" if wear.get("threshold") else ""
    cycles = f" Each computed cycle stands for {wear['cycles']:g}." if wear.get("cycles", 1.0) != 1.0 else ""
    return f"The surfaces wear by Archard's law in each cell, with the coefficient {body:g} m²/N{both}{limit}, implicitly in each step.{cycles}"


def _of_load(result: Result, setup: dict[str, Any]) -> str:
    controls = [_CONTROLS.get(control, control) for control in setup.get("stage_controls") or []]
    if not controls:
        return ""
    text = f"The {controls[0]} was prescribed." if len(controls) == 1 else f"{len(controls)} stages prescribed in turn {', '.join(controls)}."
    for name, told in (setup.get("sampled") or {}).items():
        unit = {"velocity": "m/s", "path": "m", "pressure": "Pa", "approach": "m"}.get(name) or result.units(name)
        text += f" The {name} is a function of time, taken at {told['points']:.0f} points, within {quantity(told['error'], unit)} of it."
    if setup.get("prescribed"):
        text += f" It was changed {len(setup['prescribed'])} times between two rows."
    if setup.get("temperature") is not None:
        text += " The times of the materials follow the temperature."
    return text


def _of_motion(result: Result, setup: dict[str, Any]) -> str:
    motion = setup.get("motion")
    if not motion:
        return ""
    moves = "rolls" if motion.get("rolls") else "slides"
    if not motion.get("steady"):
        return f"The contact {moves} over the body."
    ends = [quantity(float(velocity), "m/s") for velocity in (result.velocity[0], result.velocity[-1])]
    return f"The contact {moves} in steady states at {len(result)} velocities, {ends[0]} to {ends[1]}."


def _of_rows(result: Result, setup: dict[str, Any], relaxes: bool) -> str:
    if result.is_sweep or "end" not in setup or len(result) == 0:
        return ""
    # Results of an earlier release do not say how their steps were chosen.
    fixed = " in prescribed steps" if "solver_method" in setup else ""
    steps = f" in adaptive steps with the tolerance {setup['time_tolerance']:g}" if "time_tolerance" in setup else fixed
    text = f"The {len(result)} rows reach to {quantity(float(result.time[-1]), 's')}{steps}"
    if not relaxes:
        return f"{text}."
    text += f"; the pressure is {_SCHEMES.get(setup.get('scheme', ''), 'as given')}"
    errors = np.asarray(result.time_error, dtype=float)
    errors = errors[np.isfinite(errors)]
    return f"{text}, and the estimated error of the stress because of the steps is at most {errors.max():.1e}, relative." if len(errors) else f"{text}."


def _of_solver(result: Result, setup: dict[str, Any]) -> str:
    if len(result) == 0:
        return ""
    method = _SOLVERS.get(setup.get("solver_method", ""), "")
    by = f"was solved by {method}" if method else "was solved"
    to = f" to a relative residual of {setup['solver_tolerance']:g}" if "solver_tolerance" in setup else ""
    certified = np.asarray(result.certificate, dtype=float)
    bound = f"; the certified error of the pressure is at most {np.nanmax(certified):.1e} (relative, energy norm)" if np.isfinite(certified).any() else ""
    return f"Each row {by}{to}{bound}."


def _of_errors(result: Result) -> str:
    text = []
    status = result._attributes.get("status")
    if status not in (None, "complete"):
        text.append(f"The run is not complete: {status}.")
    bars = [bar for bar in result.error_bars if bar.get("error") is not None]
    if bars:
        words = [f"{bar['name']} {bar['value']:.4g} ± {bar['error']:.2g} {'' if bar['unit'] == '1' else bar['unit']}".strip() for bar in bars]
        text.append(f"With the errors of grid, steps and solver: {', '.join(words)}.")
    codes = sorted({finding["code"] for finding in result.findings if finding["severity"] == "warning"})
    if codes:
        text.append(f"The program warned of: {', '.join(codes)}.")
    return " ".join(text)
