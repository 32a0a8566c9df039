"""Numbers for people: units with the prefix and the power of ten that suit them, as the command writes them."""

from __future__ import annotations

import math

from . import _core

_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def prefixed(largest: float, unit: str, power: int = 1) -> tuple[float, str]:
    """Factor and text of the unit whose prefix makes the largest number lie between 1 and 1000, of areas between 0.01 and 10000;
    `power` is 2 for the area that belongs to a length `unit`."""
    return _core.readable_unit(unit if power == 1 else f"{unit}{power}", largest)


def shown(largest: float, unit: str, power: int = 1) -> tuple[float, str]:
    """Factor and text of the unit of numbers up to this one: with a prefix, and a power of ten where they would have more than five
    digits."""
    factor, text = prefixed(largest, unit, power)
    number = largest * factor
    if not math.isfinite(number) or number <= 0 or 1e-3 <= number < 1e5:
        return factor, text
    tens = 3 * math.floor((math.log10(number) + 1e-9) / 3)
    return factor * 10.0**-tens, f"10{str(tens).translate(_SUPERSCRIPT)} {text}"


def quantity(value: float, unit: str) -> str:
    """A number with four digits, its prefix and its unit: "12.3 mm", "3.000×10⁸ s"."""
    factor, text = prefixed(abs(value), unit)
    number = value * factor
    if number == 0 or 1e-4 <= abs(number) < 1e6:
        digits = 1 if number == 0 else max(0, 3 - math.floor(math.log10(abs(number))))
        written = f"{number:.{digits}f}".rstrip("0").rstrip(".") if digits else f"{number:.0f}"
    else:
        first, tens = f"{number:.3e}".split("e")
        written = f"{first}×10{str(int(tens)).translate(_SUPERSCRIPT)}"
    return f"{written} {text}".replace("-", "\N{MINUS SIGN}")
