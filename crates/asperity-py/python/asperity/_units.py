"""Numbers that carry a unit: quantities of pint, astropy and unyt, and xarray arrays with the attribute `units`.

They become plain numbers in the SI unit that is asked for, or they are refused. A number without a unit is in SI units.
"""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np

from . import _core, _unit_words
from ._core import CaseError

#: SI unit of each parameter, by its name in messages; parameters that are not listed have no unit.
UNITS: dict[str, str] = {
    name: unit
    for unit, names in {
        "m": "size, center, corner, sides, wavelength, amplitude, radius, radius_x, radius_y, heights, gap, initial gap, depth, depths, thickness, "
        "thickness of a layer, height, height_unit, deflection, smallest_gap, longest, shortest, roll_off, rms_height, largest_gap, depth_limit, x, y, approach, path, range, "
        "radius_uncertainty, thickness_uncertainty",
        "Pa": "young, young_kelvin, young_equilibrium, young_instantaneous, shear, shear_kelvin, shear_equilibrium, shear_instantaneous, E, modulus, "
        "bulk_modulus, contact_modulus, shear_moduli, equilibrium, equilibrium modulus, instantaneous modulus, relaxation modulus, storage modulus, "
        "loss modulus, hardness, strength, shear_limit, shear_stress, shear_stress peak, pressure, largest_pressure, start of the pressure, pressure_drop, inlet, outlet, threshold",
        "1/Pa": "compliance, creep compliance",
        "s": "time, times, end, first instant, first step, duration, start, rise, fall, hold, relaxation_time, retardation_time, characteristic_times, "
        "field_times, heated_for, first time of the window, last time of the window, include",
        "K": "temperature, temperatures, reference, c2",
        "m/s": "velocity, velocities, shear_stress velocity",
        "m^2/N": "coefficient",
        "W/(m K)": "conductivity",
        "m^2/s": "diffusivity",
        "N": "load, force",
        "N/m": "spring_constant, spring_constant_uncertainty",
        "J/m^2": "work",
        "Pa s": "viscosity",
        "1/(Pa s)": "fluidity",
        "kg/mol": "molar_mass",
        "J/mol": "activation_energy",
        "1/m": "wave numbers",
    }.items()
    for name in names.split(", ")
}
#: Units of an angle: packages of units take their numbers as plain ones, in radian.
_ANGLE = re.compile(r"rad|deg|rpm|rps|turn|revol|cycle|arc_?(min|sec)|gon\b|°(?![CF])|′|″", re.IGNORECASE)
#: Turns per time, as units of arrays.
_TURNS = {**dict.fromkeys(["rpm", "revolution_per_minute", "revolutions_per_minute"], "1/min"), **dict.fromkeys(["cycle/s", "cycles/s"], "1/s")}
#: Units of an angle in rad, as units of arrays.
_ANGLES = {**dict.fromkeys(["rad", "radian", "radians"], 1.0), **dict.fromkeys(["deg", "degree", "degrees", "°"], math.pi / 180.0)}
_NO_ANGLE = "{} is in {}, but must be a plain number: the tangent of an angle, where it is a slope"
#: Parameters that are differences of temperatures: a temperature in degC is none.
_DIFFERENCES = ("c2",)


def carries(value: Any) -> bool:
    """Whether it is a quantity of pint, astropy or unyt."""
    return hasattr(value, "m_as") or (hasattr(value, "to_value") and (hasattr(value, "unit") or hasattr(value, "units")))


def has_unit(value: Any) -> bool:
    """Whether numbers carry a unit: a quantity, a list of some, or an array of xarray with the attribute `units`."""
    if isinstance(value, (list, tuple)):
        return any(has_unit(one) for one in value)
    return carries(value) or (is_labelled(value) and ("units" in value.attrs or carries(value.data)))


def is_labelled(value: Any) -> bool:
    """Whether it is an array or a variable of xarray."""
    return hasattr(value, "dims") and hasattr(value, "attrs") and hasattr(value, "isel")


def unit_text(value: Any) -> str:
    """The unit of a quantity, or of an array of xarray, as its package writes it; "dimensionless" if it has none."""
    unit = value.attrs.get("units", "") if is_labelled(value) else getattr(value, "units", None)
    return str(getattr(value, "unit", "") if unit is None else unit) or "dimensionless"


def variable_of(what: str, value: Any) -> Any:
    """The one array of an xarray.Dataset; anything else as it is."""
    if not hasattr(value, "data_vars"):
        return value
    names = [name for name, held in value.data_vars.items() if held.ndim > 0]
    if len(names) != 1:
        raise CaseError(
            f"{what} is a Dataset that holds {', '.join(map(str, names)) or 'no array'}, but must be one array: select it, as in "
            f"dataset[{str(names[0]) if names else 'heights'!r}]"
        )
    return value[names[0]]


def is_angle(value: Any) -> bool:
    """Whether the unit of a quantity, or of an array of xarray, is one of an angle, or of an angle per time."""
    text = unit_text(value)
    return text != "dimensionless" and not re.search("celsius|fahrenheit|deg(ree)?_?[CF]|gradient", text, re.IGNORECASE) and bool(_ANGLE.search(text))


def frequency(what: str, value: Any, *, angular: bool) -> Any:
    """Numbers of frequencies: angular ones [rad/s], or cycles per second [Hz]. Quantities are converted: Hz, 1/s and rpm count cycles,
    rad/s is angular. Plain numbers are returned as they are."""
    if isinstance(value, (list, tuple)) and any(carries(one) or is_labelled(one) for one in value):
        return type(value)([frequency(what, one, angular=angular) for one in value])
    value = value.data if is_labelled(value) and carries(value.data) else value
    if not has_unit(value):
        return bare(what, value, "1/s")
    given = is_angle(value)
    if is_labelled(value):
        text = str(value.attrs["units"]).strip()
        given, value = given and text not in _TURNS, value.copy()
        value.attrs["units"] = _TURNS.get(text, re.sub(r"\brad(ian)?s?\b", "1", text))
    found = bare(what, value, "rad/s" if given and not is_labelled(value) else "1/s")
    return found * (1.0 if given == angular else 2.0 * math.pi if angular else 0.5 / math.pi)


def bare(what: str, value: Any, unit: str | None = None) -> Any:
    """`value` in the SI unit `unit`, by default that of the parameter `what`; what carries no unit is returned as it is."""
    unit = UNITS.get(re.sub(" along [xy]$", "", what), "") if unit is None else unit
    value = variable_of(what, value)
    if np.ma.isMaskedArray(value) and np.ma.getmaskarray(value).any():
        raise CaseError(f"{what} has masked values: leave them out, or fill them")
    if isinstance(value, (list, tuple)) and any(carries(one) or is_labelled(one) for one in value):
        return type(value)([bare(what, one, unit) for one in value])
    value = value.data if is_labelled(value) and carries(value.data) else value
    if not has_unit(value):
        return np.asarray(value.data) if is_labelled(value) else value
    text = unit_text(value)
    if unit == "" and is_angle(value):
        raise CaseError(_NO_ANGLE.format(what, text))
    if is_labelled(value):
        numbers = np.asarray(value.data)
        if unit == "K" and (scale := _unit_words.temperature(text.strip())) is not None:
            _check_temperature(what, text, True)
            return numbers * scale[1] + scale[0]
        factor = factor_of(what, text, unit)
        return numbers if factor == 1.0 else numbers * factor
    if unit == "K":
        _check_temperature(what, text, _has_offset(value))
    try:
        return value.m_as(unit or "dimensionless") if hasattr(value, "m_as") else value.to_value(unit)
    except Exception as error:  # each package has errors of its own
        raise CaseError(f"{what} is in {text}, but must be {expected(unit)}: {error}") from None


def _check_temperature(what: str, text: str, offset: bool) -> None:
    """Refuses a temperature for a difference of temperatures, and the reverse; `offset`: the zero of its unit is not that of kelvin."""
    if what in _DIFFERENCES and offset:
        raise CaseError(f"{what} is in {text}, but is a difference of temperatures: give it in K or delta_degC")
    if what not in _DIFFERENCES and _unit_words.is_difference(text):
        raise CaseError(f"{what} is in {text}, a difference of temperatures, but must be a temperature: give it in K or degC")


def _has_offset(value: Any) -> bool:
    """Whether the zero of its unit is not that of kelvin, as of degC."""
    try:
        zero = type(value)(0.0, value.units)
        return bool((zero.m_as("K") if hasattr(zero, "m_as") else zero.to_value("K")) != 0.0)
    except Exception:  # each package has errors of its own; then the conversion says what is wrong
        return False


def factor_of(what: str, given: Any, unit: str) -> float:
    """What a number in the unit `given`, the text of an array, is times in the SI unit `unit`."""
    text = str(given).strip()
    if unit == "K":
        _check_temperature(what, text, False)
    if unit == "rad" and text in _ANGLES:
        return _ANGLES[text]
    short, others = ("Å", 1.0) if text == "A" else _unit_words.short(text)
    try:
        factor = _core.unit_factor(short, "" if unit == "rad" else unit)
    except CaseError as error:
        raise CaseError(f"{what} has the unit {text!r}, which is not understood ({error}): convert it to SI units") from None
    if factor is None:
        raise CaseError(f"{what} is {f'in {text}' if short not in ('', '1') else f'a plain number (its units are {text!r})'}, but must be {expected(unit)}")
    return factor * others


def expected(unit: str) -> str:
    """What a message says is expected in this unit."""
    return f"in {unit} or a unit of the same kind" if unit else "a plain number"


def unit_among(what: str, values: list[Any], units: tuple[str, ...]) -> str | None:
    """The unit, out of these, that the values which carry one can be converted to; None where none carries one."""
    held = [value for value in values if carries(value) or (is_labelled(value) and "units" in value.attrs)]
    for unit in units:
        try:
            for value in held:
                bare(what, value, unit)
        except CaseError:
            continue
        return unit if held else None
    given = ", ".join(unit_text(value) for value in held)
    raise CaseError(f"{what} is in {given}, but must be in {', '.join(units[:-1])} or {units[-1]}, or a number in SI units")


def written(unit: str) -> str:
    """A unit as pint and UDUNITS both read it: m^2 for m2."""
    for power in "234":
        unit = unit.replace(f"m{power}", f"m^{power}")
    return unit
