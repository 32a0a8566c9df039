"""Units written in words or with the operators of Python, as pint and CF attributes have them, in the short form of case files.

`newton / millimeter ** 2` becomes `N/mm^2`, which the core reads. Units outside of the SI become one of it and a factor.
"""

from __future__ import annotations

import re

_PREFIXES = {
    **{"femto": "f", "pico": "p", "nano": "n", "micro": "u", "milli": "m", "centi": "c", "deci": "d", "": "", "hecto": "h"},
    **{"kilo": "k", "mega": "M", "giga": "G", "tera": "T"},
}
_BASES = {
    **{"meter": "m", "metre": "m", "gram": "g", "second": "s", "kelvin": "K", "mole": "mol", "newton": "N", "pascal": "Pa"},
    **{"joule": "J", "watt": "W", "hertz": "Hz", "bar": "bar"},
}
#: Symbols by word, in lower case.
_WORDS = {
    **{f"{prefix}{base}": f"{p}{b}" for prefix, p in _PREFIXES.items() for base, b in _BASES.items()},
    **{"micron": "um", "angstrom": "Å", "sec": "s", "minute": "min", "hour": "h", "hr": "h", "day": "d"},
    **{"percent": "%", "dimensionless": "1", "per": "/", "delta_degc": "K", "delta_degree_celsius": "K", "δ°c": "K"},
}
#: Units outside of the SI: factor and unit.
_OTHERS = {
    **dict.fromkeys(["in", "inch", "inches"], (0.0254, "m")),
    **dict.fromkeys(["ft", "foot", "feet"], (0.3048, "m")),
    **dict.fromkeys(["mil", "thou"], (2.54e-5, "m")),
    **dict.fromkeys(["psi", "pound_force_per_square_inch"], (6894.757293168361, "Pa")),
    **dict.fromkeys(["ksi", "kip_per_square_inch"], (6894757.293168361, "Pa")),
    **dict.fromkeys(["atm", "standard_atmosphere"], (101325.0, "Pa")),
    **dict.fromkeys(["torr", "mmhg"], (101325.0 / 760.0, "Pa")),
    **dict.fromkeys(["lbf", "pound_force", "force_pound"], (4.4482216152605, "N")),
    **dict.fromkeys(["kgf", "kilogram_force", "force_kilogram"], (9.80665, "N")),
    **dict.fromkeys(["delta_degf", "delta_degree_fahrenheit", "δ°f"], (5.0 / 9.0, "K")),
}
_DIFFERENCE = re.compile(r"(delta_?|Δ\s*)(°|deg)", re.IGNORECASE)
_CELSIUS = re.compile(r"(degrees?|deg)?[\s_]*C(elsius)?|°\s*C|℃", re.IGNORECASE)
_FAHRENHEIT = re.compile(r"(degrees?|deg)?[\s_]*F(ahrenheit)?|°\s*F", re.IGNORECASE)
_SUPERSCRIPT = re.compile("[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+")
_PLAIN = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_TOKEN = re.compile(r"(?P<word>[^\W\d]+(?:°[CF])?|%)(?P<power>\^?-?\d+)?")


def short(text: str) -> tuple[str, float]:
    """A unit in the short form of case files, and what it is to be multiplied by."""
    text = re.sub(r"\s*(\*\*|\^)\s*", "^", text.strip())
    text = re.sub(r"\s*([/*()])\s*", r"\1", text)
    text = _SUPERSCRIPT.sub(lambda match: f"^{match[0].translate(_PLAIN)}", text)
    factor = 1.0

    def translated(match: re.Match[str]) -> str:
        nonlocal factor
        word, power = match["word"], match["power"] or ""
        if word.lower() in _OTHERS and word.upper() != word and "(" not in text:
            scale, symbol = _OTHERS[word.lower()]
            exponent = int(power.lstrip("^") or 1)
            factor *= scale ** (-exponent if match.string[: match.start()].endswith("/") else exponent)
            return f"{symbol}{power}"
        # Of short words, such as Pa and mN, the case counts: they are symbols.
        name = word.lower()
        for known in (name, name.removesuffix("s")) if len(name) > 2 else ():
            if known in _WORDS and (word == name or len(name) > 3):
                return f"{_WORDS[known]}{power}"
        return match[0]

    found = _TOKEN.sub(translated, text)
    return re.sub(r"\s*/\s*", "/", found), factor


def temperature(text: str) -> tuple[float, float] | None:
    """Zero [K] and degree [K] of a scale of temperature that is not kelvin's."""
    if _CELSIUS.fullmatch(text):
        return 273.15, 1.0
    return (459.67 * 5.0 / 9.0, 5.0 / 9.0) if _FAHRENHEIT.fullmatch(text) else None


def is_difference(text: str) -> bool:
    """Whether it is a unit of differences of temperatures, as delta_degC."""
    return _DIFFERENCE.match(text) is not None
