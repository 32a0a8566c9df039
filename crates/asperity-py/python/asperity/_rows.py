"""Attributes and words that the library's registry of columns, quantities and fields gives; `_rows.pyi`, which is generated, declares them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from ._columns import COLUMNS, FIELDS, HISTOGRAMS, QUANTITIES, ROW, STRESS, Held

#: The optional quantities of a row, and the fields.
Quantity = Literal[tuple(QUANTITIES)]
Field = Literal[tuple(FIELDS)]


def _holder(find: str, names: Iterable[str]) -> type:
    return type("Holder", (), {name: Held(find) for name in names if name not in HISTOGRAMS})


#: Numbers of a contact without time.
OF_CONTACT = [name for name in ROW if name not in ("time", "time_error", "stage")]
#: A holder of rows has a column for each number that rows may have, a row the number itself; the stress is that of the instants of a result.
Columns, StressColumns, ContactColumns = (_holder("_column", names) for names in (COLUMNS, STRESS, OF_CONTACT))
Numbers, ContactNumbers = (_holder("_number", names) for names in (COLUMNS, OF_CONTACT))
