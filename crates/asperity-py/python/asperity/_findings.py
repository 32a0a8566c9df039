"""Findings: where the numbers of a result may be off."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from typing import Any


class ResultWarning(UserWarning):
    """A finding of severity "warning": the numbers of a result may be off."""


class Finding(dict[str, Any]):
    """Something that a run found about itself; its keys are attributes too.

    `code` (a word of docs/findings.md), `severity` ("warning": the numbers may be off, or "note"), `text`, `value` and `limit`
    (the number that was judged and its limit in SI units, or None), `rows` ([first, last], or None where it is about the case).
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"a finding has no {name!r}; it has {', '.join(self)}") from None

    def __str__(self) -> str:
        return f"{self['text']} [{self['code']}]"


def findings_of(objects: Iterable[Mapping[str, Any]]) -> list[Finding]:
    """The findings of a list of objects."""
    return [Finding(found) for found in objects]


def warn(findings: Iterable[Finding], stacklevel: int) -> None:
    """A :class:`ResultWarning` for each warning among the findings; `stacklevel` as of the caller."""
    for found in findings:
        if found["severity"] == "warning":
            warnings.warn(str(found), ResultWarning, stacklevel=stacklevel + 1)
