"""Attributes and words that the library's registry of columns, quantities and fields gives; `_rows.pyi`, which is generated, declares them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from ._columns import COLUMNS, FIELDS, HISTOGRAMS, QUANTITIES, ROW, STRESS, Held

#: The optional quantities of a row, and the fields.
Quantity = Literal[tuple(QUANTITIES)]
Field = Literal[tuple(FIELDS)]


def _holder(find: str, sealed: str, names: Iterable[str]) -> type:
    return type("Holder", (), {name: Held(find, sealed) for name in names if name not in HISTOGRAMS})


def _columns(names: Iterable[str]) -> type:
    return _holder("_column", "a result is what was computed; work on a copy of its numbers", names)


def _numbers(names: Iterable[str]) -> type:
    return _holder("_number", "a step is what was computed", names)


#: Numbers of a contact without time.
OF_CONTACT = [name for name in ROW if name not in ("time", "time_error", "stage")]
#: A holder of rows has a column for each number that rows may have, a row the number itself; the stress is that of the instants of a result.
Columns, StressColumns, ContactColumns = _columns(COLUMNS), _columns(STRESS), _columns(OF_CONTACT)
Numbers, ContactNumbers = _numbers(COLUMNS), _numbers(OF_CONTACT)
