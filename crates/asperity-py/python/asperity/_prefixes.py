"""Numbers for people: units with the prefix and the power of ten that suit them, as the command writes them."""

from __future__ import annotations

import math

#: Prefixes by power of a thousand.
_PREFIXES = {-4: "p", -3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G"}
#: Units that take prefixes, with the powers of a thousand of the smallest and of the largest prefix in use.
_PREFIXED = {"m": (-4, 0), "s": (-3, 0), "m/s": (-3, 1), "Pa": (-1, 3), "N": (-3, 2), "N/m": (-3, 3)}
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
#: What four digits show as a thousand is one of the next prefix: half of the fourth digit, in decades.
_ROUNDING = 2.17e-5


def prefixed(largest: float, unit: str, power: int = 1) -> tuple[float, str]:
    """Factor and text of the unit whose prefix makes the largest number lie between 1 and 1000, of areas between 0.01 and 10000;
    `power` is 2 for the area that belongs to a length `unit`."""
    k = 0
    if math.isfinite(largest) and largest > 0:
        # Areas change by a million from unit to unit: from 0.01 mm² on they are in mm².
        shift = 0 if power == 1 else 2
        least, most = _PREFIXED.get(unit, (0, 0))
        k = min(max(math.floor((math.log10(largest) + shift + _ROUNDING) / (3 * power)), least), most)
    return 10.0 ** (-3 * k * power), f"{_PREFIXES[k]}{unit}{'²' if power == 2 else ''}"


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
        digits = 0 if number == 0 else max(0, 3 - math.floor(math.log10(abs(number))))
        written = f"{number:.{digits}f}"
        written = written.rstrip("0").rstrip(".") if digits else written
    else:
        first, tens = f"{number:.3e}".split("e")
        written = f"{first}×10{str(int(tens)).translate(_SUPERSCRIPT)}"
    return f"{written} {text}".replace("-", "\N{MINUS SIGN}")
