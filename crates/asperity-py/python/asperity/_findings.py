"""Findings: where the numbers of a result may be off."""

from __future__ import annotations

import os
import sys
import types
import warnings
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal

from ._spoken import in_python


class ResultWarning(UserWarning):
    """A finding of severity "warning": the numbers of a result may be off."""


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
        one["text"] = in_python(str(one["text"]))
    return found


def warn(findings: Iterable[Finding]) -> None:
    """A :class:`ResultWarning` for each warning among the findings; of one kind at one line of a program, as in a loop, two at most."""
    for found in findings:
        if found["severity"] == "warning":
            warn_caller(str(found), code=found["code"])


def warn_caller(text: str, kind: type[Warning] = ResultWarning, *, code: str | None = None) -> None:
    """A warning at the line of the user's program that called this package."""
    package, frame, level = os.path.dirname(__file__), sys._getframe(), 1
    while frame.f_code.co_filename.startswith(package) and frame.f_back is not None:
        frame, level = frame.f_back, level + 1
    if code is not None and _is_collapsed(text, kind, frame):
        # Where Python keeps what a line has warned of, which it forgets with every change of the filters.
        held = frame.f_globals.setdefault("__warningregistry__", {})
        key = ("asperity", code, frame.f_code.co_filename, frame.f_lineno)
        held[key] = times = held.get(key, 0) + 1
        if times > 2:
            return
        text += " (more of this kind from this line are not shown; the findings of each result hold them)" if times == 2 else ""
        warnings.warn(text, kind, stacklevel=level)
        held[key] = times
        return
    warnings.warn(text, kind, stacklevel=level)


def _is_collapsed(text: str, kind: type[Warning], frame: types.FrameType) -> bool:
    """Whether Python's filters show such a warning once for its line, as they do unless they were changed."""
    module = str(frame.f_globals.get("__name__", ""))
    for action, message, category, place, line in warnings.filters:
        if issubclass(kind, category) and line in (0, frame.f_lineno) and _matches(message, text) and _matches(place, module):
            return action in ("default", "module", "once")
    return True


def _matches(pattern: Any, text: str) -> bool:
    return pattern is None or (text == pattern if isinstance(pattern, str) else pattern.match(text) is not None)
