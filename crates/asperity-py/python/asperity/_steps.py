"""Steps of processing as the tables of `process` of a case, from their words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Operation = dict[str, Any]


def operations(steps: Sequence[str]) -> list[Operation] | None:
    """The tables of steps such as ``crop cells=512,512 from=0,0``; None where one leaves out the name of its first key, as ``level=plane``."""
    found = []
    for step in steps:
        name, *pairs = str(step).split()
        if "=" in name or not all(pair.count("=") == 1 for pair in pairs):
            return None
        found.append({"op": name, **{key: _value(text) for key, text in (pair.split("=") for pair in pairs)}})
    return found


def _value(text: str) -> Any:
    """A number, a pair of them, yes or no, or a word."""
    if "," in text:
        return [_value(part) for part in text.split(",")]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return {"true": True, "false": False}.get(text, text)


def with_steps(part: dict[str, Any], steps: Sequence[Operation]) -> dict[str, Any]:
    """The part of a file with its own level and filling, and then these steps, as one list."""
    level, fill = part.get("level"), part.get("fill")
    own = [{"op": "level", "form": level}] if level not in (None, "none") else []
    own += [{"op": "fill", "method": fill}] if fill is not None else []
    return {**{key: value for key, value in part.items() if key not in ("level", "fill")}, "process": [*own, *steps]}
