"""Messages of the core in the words of Python: they name keys of a case file, where a call has parameters."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator

from ._core import CaseError

#: Words of a case file and of the command, and the parameters that they are in Python.
_WORDS = {
    "(domain.size)": "(size=)",
    "(domain.cells)": "(cells=)",
    "output.histogram.pressure": "largest_pressure=",
    "output.histogram.gap": "largest_gap=",
    "(surface info: --longest, --shortest)": "(longest=, shortest=)",
    '(border = "mirror", step border=mirror)': "(surface.mirrored())",
    '(border = "mirror")': "(surface.mirrored())",
    'spacing = "adaptive"': "times=asperity.adaptive(end)",
    'spacing = "log"': "times=asperity.log(end, steps, first=...)",
    "a [motion]": "a motion (asperity.slide or asperity.steady)",
    "add [motion] (in Python use slide)": "use asperity.slide",
    "[motion]": "motion (asperity.slide or asperity.steady)",
    "[tangential]": "tangential=asperity.tangential(...)",
    "[friction]": "friction=",
    "[adhesion]": "adhesion=asperity.Adhesion(...)",
    "[flash]": "flash=asperity.Flash(...)",
    "leave the section out": "leave temperature= out",
}
#: Sections whose keys are parameters of a call, and those that are arguments of their own.
_PLAIN = "domain|solver|output|time|motion"
_OBJECTS = "adhesion|friction|tangential|wear|flash"
#: What makes each of them.
_MADE = {name: f"asperity.{name if name == 'tangential' else name.capitalize()}" for name in _OBJECTS.split("|")}


def _value(word: str) -> str:
    """A value of a case as Python writes it."""
    return {"true": "True", "false": "False"}.get(word, word)


_RULES: list[tuple[str, str | Callable[[re.Match[str]], str]]] = [
    (r"\bset (`end`, )?times=asperity\.adaptive\(end\)( and leave out `\w+`)?", "take times=asperity.adaptive(end)"),
    (r"\bSet (`end`, )?times=asperity\.adaptive\(end\)( and leave out `\w+`)?", "Take times=asperity.adaptive(end)"),
    (r"\[wear\] (\w+) = \"([^\"]*)\"", r"wear=asperity.Wear(..., \1=...), such as \2,"),
    (r"\[wear\]", "wear=asperity.Wear(...)"),
    (r"\[leakage\]", "fluid=asperity.Fluid(...)"),
    (rf"\b({_OBJECTS})\.([a-z_]+) = (\"[a-z-]+\"|true|false)", lambda found: f"{found[1]}={_MADE[found[1]]}(..., {found[2]}={_value(found[3])})"),
    (r'\bleakage\.([a-z_]+) = ("[a-z-]+")', r"fluid=asperity.Fluid(..., \1=\2)"),
    # What is prescribed, be it a load, a pressure or an approach, is the table [load] of a case.
    (r"\bload\.history\.(\w+)", r"\1 of the history of the load"),
    (r"\bload\.history\b", "the history of the load"),
    (r"\bload\.control\b", "the control of the load"),
    (rf"\b(?:{_PLAIN})\.([a-z_]+)", r"\1"),
    (rf"\b({_OBJECTS})\.([a-z_]+)", r"\2 of \1"),
    (r"\bleakage\.([a-z_]+)", r"\1 of the fluid"),
    (r'\bset ([a-z_]+) to ("[a-z-]+")', r"give \1=\2"),
    # coupling = "full", allow_unresolved = true; a quantity is a number here.
    (r'\b([a-z_]+) = ("[a-z-]+")', r"\1=\2"),
    (r"\b([a-z_]+) = (true|false)\b", lambda found: f"{found[1]}={_value(found[2])}"),
    (r'\b([a-z_]+) = (-?[0-9][0-9.e-]*)(?![0-9.])', r"\1=\2"),
    (r'\b([a-z_]+) = "(-?[0-9][^"]*)"', r"\1 of \2"),
    (r'such as "(-?[0-9][^"]*)"', r"such as \1"),
]


def in_python(text: str) -> str:
    """The text with parameters of Python in place of keys of a case."""
    for word, parameter in _WORDS.items():
        text = text.replace(word, parameter)
    for pattern, replacement in _RULES:
        text = re.sub(pattern, replacement, text)
    return text


@contextlib.contextmanager
def spoken() -> Iterator[None]:
    """Errors of the case from here on are in the words of Python."""
    try:
        yield
    except CaseError as error:
        error.args = (in_python(str(error)), *error.args[1:])
        raise
