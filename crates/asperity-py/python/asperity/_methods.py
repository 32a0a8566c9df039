"""The paragraph on methods of a paper, from what a result says that was run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core, _given
from ._arrays import cells_of
from ._cite import entries
from ._core import __version__
from ._prefixes import quantity
from ._units import UNITS

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
#: Works that are cited, by the words that cite them.
_CITED = {"Spinu": "spinu2017", "Polonsky": "polonsky1999", "Yastrebov": "yastrebov2017"}


def paragraph(result: Result, bibtex: bool, case: bool) -> str:
    """What was run, in sentences, with `case` the case that runs it again, and with `bibtex` the entries of what the sentences cite."""
    return _written(_sentences(result), _given.text_of(result) if case else "", bibtex)


def of_seal(found: Mapping[str, Any], warned: Sequence[str], given: tuple[str, Sequence[str]], bibtex: bool, case: bool) -> str:
    """What was run for a whole seal; `given` are the text of its case and the changes of it."""
    text, changes = given
    known = _given.read(text) or {}
    left_out = [f"Changed is {one}." for one in (_given.change(known, changes) if known else changes)]
    whole = _given.headed(_core.case_text({**({"left_out": left_out} if left_out else {}), **known}) if changes and known else text, left_out)
    return _written(_of_seal(found, warned, known), whole if case else "", bibtex)


def _written(sentences: Iterator[str], case: str, bibtex: bool) -> str:
    text = " ".join(sentence for sentence in sentences if sentence) + (f"\n\n{case}" if case else "")
    return f"{text}\n\n{entries(['asperity', *(key for words, key in _CITED.items() if words in text)])}" if bibtex else text


def _of_seal(found: Mapping[str, Any], warned: Sequence[str], known: dict[str, Any]) -> Iterator[str]:
    seeds = found["seeds"]
    pressures = [point["pressure"] for seed in seeds for point in seed["seal_sweep"]]
    ends = " to ".join(quantity(float(end), "Pa") for end in (min(pressures), max(pressures)))
    cells, size = (known.get("domain", {}).get(name) for name in ("cells", "size"))
    patch = f" of {' x '.join(map(str, cells))} cells" if cells else ""
    patch += f" on {' x '.join(one if isinstance(one, str) else quantity(float(one), 'm') for one in size)}" if size else ""
    yield (
        f"The leak of a whole seal was computed with asperity {__version__} from the contact of a patch{patch}, which was solved under "
        f"{len(pressures)} mean pressures, {ends}{f', for {len(seeds)} seeds of the roughness' if len(seeds) > 1 else ''}."
    )
    yield _given.surfaces(known)
    ratios = [{key: body[key] for key in ("poisson", "bulk_modulus") if key in body} for body in known.get("body", [])]
    yield _given.materials({"body": [{**body, "material": {**body.get("material", {}), **ratio}} for body, ratio in zip(known.get("body", []), ratios)]})
    yield _given.seal(known)
    yield _given.motion(known)
    yield (
        "At each place across the seal the bodies touch as in the dry contact under the contact pressure less that of the fluid, and let through what the "
        f"patch lets through under that pressure; the {found['fluid']} flows from {quantity(float(found['inlet']), 'Pa')} to "
        f"{quantity(float(found['outlet']), 'Pa')}, and its pressure follows from the conservation of the flow (Reynolds' equation)."
    )
    low, high = found["seal_leak_bounds"]
    unit = found["unit"]
    if low is not None and high is not None:
        yield f"Between the pressures of the sweep the conductance was interpolated; the pressures allow mean leaks from {low:.3g} to {high:.3g} {unit}."
    if warned:
        yield f"The program warned of: {', '.join(warned)}."


def _sentences(result: Result) -> Iterator[str]:
    setup, known = result._setup, result._attributes
    creep = setup.get("contact_creep_compliance") or {}
    relaxes = bool(creep.get("terms") or creep.get("fluidity") or setup.get("retardation_times"))
    adheres, layered = bool(setup.get("adhesion")), "layer_separable" in setup
    kind = f"{'' if setup.get('friction') else 'frictionless '}{'adhesive ' if adheres else ''}normal contact{' with friction' if setup.get('friction') else ''}"
    bodies = "bodies of a given kernel" if setup.get("kernel") == "given" else "layered bodies" if layered else "half-spaces"
    domain = "periodic domain" if setup.get("boundary") == "periodic" else "free surface"
    yield (
        f"The {kind} of {'linear viscoelastic' if relaxes else 'linear elastic'} {bodies}{' in plane strain' if result.is_line else ''} was computed with "
        f"asperity {known.get('version', '')}{', by the model of Spinu and Cerlinca (2017)' if relaxes and not layered else ''}, on "
        f"{cells_of(result.initial_gap)} of a {domain} of {' x '.join(quantity(length, 'm') for length in result.size)}."
    )
    given = _given.given(result) or {}
    yield _given.surfaces(given)
    if steps := _given.steps(setup):
        yield f"The heights went through: {'; '.join(steps)}."
    yield _of_materials(setup)
    yield _given.materials(given) if setup.get("materials") else ""
    yield _of_hardness(setup)
    for name, sentence in (("adhesion", _of_adhesion), ("friction", _of_friction), ("wear", _of_wear)):
        if setup.get(name):
            yield sentence(setup[name])
    if (curve := setup.get("curve")) and len(result) > 1:
        unit = result.units("load") if curve["control"] == "load" else UNITS[curve["control"]]
        ends = " to ".join(quantity(float(curve[end]), unit) for end in ("first", "last"))
        yield f"The {_CONTROLS[curve['control']]} was prescribed in {len(result)} contacts, {ends}."
    elif not setup.get("stage_controls") and len(result) == 1:
        yield f"The load is {quantity(float(result.load[0]), result.units('load'))}."
    if setup.get("stage_controls"):
        yield _of_load(result, setup, given)
    yield from _given.courses(given, result.units("load"))
    if setup.get("motion"):
        yield _of_motion(result, setup["motion"])
    yield _given.motion(given)
    if len(result):
        # Results of an earlier release do not say how their steps were chosen.
        if not result.is_sweep and "end" in setup:
            yield _of_rows(result, setup, relaxes)
        yield _of_solver(result, setup)
    if not result.is_line:
        touching = "in contact" if adheres else "under pressure"
        yield f"Contact areas are those of the cells {touching}; corrected ones are reduced by a share of their perimeter (Yastrebov, Anciaux and Molinari 2017)."
    if known.get("status") not in (None, "complete"):
        yield f"The run is not complete: {known['status']}."
    bars = [bar for bar in result.error_bars if bar.get("error") is not None]
    if bars:
        words = [f"{bar['name']} {bar['value']:.4g} ± {bar['error']:.2g} {'' if bar['unit'] == '1' else bar['unit']}".strip() for bar in bars]
        yield f"With the errors of grid, steps and solver: {', '.join(words)}."
    if codes := sorted({finding["code"] for finding in result.findings if finding["severity"] == "warning"}):
        yield f"The program warned of: {', '.join(codes)}."


def _of_materials(setup: dict[str, Any]) -> str:
    told = []
    models = {material["body"]: material for material in setup.get("materials") or []}
    for name, ratio in zip(setup.get("bodies") or [], setup.get("poisson") or []):
        found = models.get(name, {})
        words = [f"{found.get('model', 'given')} model"]
        if found.get("terms"):
            words.append(f"{found['terms']} term{'s' if found['terms'] > 1 else ''}")
        words.append(f"Poisson's ratio {ratio:g}" if ratio is not None else "constant bulk modulus")
        if found.get("rms_misfit") is not None:
            words.append(f"fitted with an rms misfit of {100 * found['rms_misfit']:.2g} %")
        told.append(f"{name} ({', '.join(words)})")
    modulus, relaxed = (setup.get(name) for name in ("instantaneous_modulus" if told else "contact_modulus", "relaxed_modulus"))
    after = f" at once and {quantity(relaxed, 'Pa')} after relaxation" if told and relaxed is not None and relaxed != modulus else ""
    ends = "" if modulus is None else f"The contact modulus is {quantity(modulus, 'Pa')}{after}."
    one = len(told) == 1
    bodies = f"The deformable {'body is' if one else 'bodies are'} {' and '.join(told)}{'; the other body is rigid' if one else ''}. " if told else ""
    return (bodies + ends).rstrip()


def _of_hardness(setup: dict[str, Any]) -> str:
    hardness: Any = setup.get("hardness")
    if setup.get("hardness_of_cells"):
        return "The pressure of each cell is cut off at its hardness."
    stays = "stays on unloading" if setup.get("plasticity") == "accumulate" else "disappears on unloading"
    limited = isinstance(hardness, (int, float))
    return f"The pressure is cut off at the hardness, {quantity(float(hardness), 'Pa')}; the flattening {stays}." if limited else ""


def _of_adhesion(told: dict[str, Any]) -> str:
    reach = f"the range {quantity(told['range'], 'm')} (largest attraction {quantity(told['strength'], 'Pa')})"
    law = f" after the law {told['law']}" if "law" in told else ""
    sphere = f", Tabor's number {told['tabor']:.2g}" if told.get("tabor") is not None else ""
    work = f"{1e3 * told['work']:.4g} mJ/m²"
    return f"The surfaces attract each other{law}, with the work of adhesion {work} and {reach}{sphere}; the trap number of the grid is {told['trap']:.2g}."


def _of_friction(friction: dict[str, Any]) -> str:
    coefficient = friction.get("coefficient")
    words = "a coefficient for each cell" if coefficient is None else f"the coefficient {coefficient:g}"
    limit = f", up to a traction of {quantity(friction['shear_limit'], 'Pa')}" if friction.get("shear_limit") else ""
    effect = "whose effect on the pressure was neglected"
    if friction.get("coupling") == "full":
        effect = "and it and the pressure were found in turn until both agreed (Panagiotopoulos, 1975)"
    return (
        f"Friction with {words}{limit} acted against a prescribed tangential {friction['control']}; stick and slip followed from both components of "
        f"the tangential traction (Kalker, 1990), {effect}."
    )


def _of_wear(wear: dict[str, Any]) -> str:
    body, counterbody = wear["coefficients"]
    both = f" of the body and {counterbody:g} m²/N of the counterbody" if counterbody else ""
    limit = f" above a threshold of {quantity(wear['threshold'], 'Pa')}" if wear.get("threshold") else ""
    cycles = f" Each computed cycle stands for {wear['cycles']:g}." if wear.get("cycles", 1.0) != 1.0 else ""
    return f"The surfaces wear by Archard's law in each cell, with the coefficient {body:g} m²/N{both}{limit}, implicitly in each step.{cycles}"


def _of_load(result: Result, setup: dict[str, Any], given: dict[str, Any]) -> str:
    controls = [_CONTROLS.get(control, control) for control in setup["stage_controls"]]
    text = f"The {controls[0]} was prescribed{_given.load(given, result.units('load'))}." if len(controls) == 1 else f"{len(controls)} stages prescribed in turn {', '.join(controls)}."
    for name, told in (setup.get("sampled") or {}).items():
        unit = result.units(name) if name == "load" else told.get("unit") or UNITS[name]
        text += f" The {name} is a function of time, taken at {told['points']:.0f} points, within {quantity(told['error'], unit)} of it."
    if changes := len(setup.get("prescribed") or []):
        text += f" It was changed {'once' if changes == 1 else f'{changes} times'} between two rows."
    return text + (" The times of the materials follow the temperature." if setup.get("temperature") is not None else "")


def _of_motion(result: Result, motion: dict[str, Any]) -> str:
    moves = "rolls" if motion.get("rolls") else "slides"
    if not motion.get("steady"):
        return f"The contact {moves} over the body."
    first, last = (quantity(float(result.velocity[n]), "m/s") for n in (0, -1))
    return f"The contact {moves} in steady states at {len(result)} velocities, {first} to {last}."


def _of_rows(result: Result, setup: dict[str, Any], relaxes: bool) -> str:
    fixed = " in prescribed steps" if "solver_method" in setup else ""
    steps = f" in adaptive steps with the tolerance {setup['time_tolerance']:g}" if "time_tolerance" in setup else fixed
    pressure = f"; the pressure is {_SCHEMES.get(setup.get('scheme', ''), 'as given')}" if relaxes else ""
    errors = result.time_error[np.isfinite(result.time_error)]
    most = f", and the estimated error of the stress because of the steps is at most {errors.max():.1e}, relative" if relaxes and len(errors) else ""
    return f"The {len(result)} rows reach to {quantity(float(result.time[-1]), 's')}{steps}{pressure}{most}."


def _of_solver(result: Result, setup: dict[str, Any]) -> str:
    method = _SOLVERS.get(setup.get("solver_method", ""))
    to = f" to a relative residual of {setup['solver_tolerance']:g}" if "solver_tolerance" in setup else ""
    certified = result.certificate[np.isfinite(result.certificate)]
    bound = f"; the certified error of the pressure is at most {certified.max():.1e} (relative, energy norm)" if len(certified) else ""
    return f"Each row was solved{f' by {method}' if method else ''}{to}{bound}."
