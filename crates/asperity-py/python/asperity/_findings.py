"""Findings: where the numbers of a result may be off."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal


class ResultWarning(UserWarning):
    """A finding of severity "warning": the numbers of a result may be off."""


#: Words of a case file and of the command, and the parameters that they are in Python.
_WORDS = {
    "(domain.size)": "(size=)",
    "domain.size": "size",
    "(domain.cells)": "(cells=)",
    "domain.cells": "cells",
    'boundary = "': 'boundary="',
    "output.histogram.pressure": "largest_pressure=",
    "output.histogram.gap": "largest_gap=",
    "(surface info: --longest, --shortest)": "(longest=, shortest=)",
    '(border = "mirror", step border=mirror)': "(surface.mirrored())",
    '(border = "mirror")': "(surface.mirrored())",
}


class Finding(dict[str, Any]):
    """Something that a run found about itself; its keys are attributes too."""

    #: A word of docs/findings.md.
    code: str
    #: "warning" (the numbers may be off) or "note".
    severity: Literal["warning", "note"]
    #: What was found, and what to do.
    text: str
    #: The number that was judged, and its limit, in SI units.
    value: float | None
    limit: float | None
    #: First and last row; None where it is about the case.
    rows: list[int] | None

    if not TYPE_CHECKING:  # where it would hide misspelt names

        def __getattr__(self, name):
            try:
                return self[name]
            except KeyError:
                raise AttributeError(f"a finding has no {name!r}; it has {', '.join(self)}") from None

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self})

    def __str__(self) -> str:
        return f"{self['text']} [{self['code']}]"


def findings_of(objects: Iterable[Mapping[str, Any]], *, of_case: bool = False) -> list[Finding]:
    """The findings of a list of objects. Their texts name parameters of Python, or with `of_case` keys of the case file."""
    found = [Finding(one) for one in objects]
    for one in [] if of_case else found:
        for word, parameter in _WORDS.items():
            one["text"] = str(one["text"]).replace(word, parameter)
    return found


def warn(findings: Iterable[Finding]) -> None:
    """A :class:`ResultWarning` for each warning among the findings."""
    for found in findings:
        if found["severity"] == "warning":
            warn_caller(str(found))


def warn_caller(text: str, kind: type[Warning] = ResultWarning) -> None:
    """A warning at the line of the user's program that called this package."""
    package, frame, level = os.path.dirname(__file__), sys._getframe(), 1
    while frame.f_code.co_filename.startswith(package) and frame.f_back is not None:
        frame, level = frame.f_back, level + 1
    warnings.warn(text, kind, stacklevel=level)
