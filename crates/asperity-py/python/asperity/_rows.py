"""Attributes and words that the library's registry of columns, quantities and fields gives; `_rows.pyi`, which is generated, declares them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from ._columns import COLUMNS, FIELDS, HISTOGRAMS, QUANTITIES, ROW, STRESS, Column, Number

#: The optional quantities of a row, and the fields.
Quantity = Literal[tuple(QUANTITIES)]
Field = Literal[tuple(FIELDS)]


def _holder(name: str, kind: type[Column] | type[Number], names: Iterable[str]) -> type:
    return type(name, (), {one: kind() for one in names if one not in HISTOGRAMS})


#: A holder of rows has a column for each number that rows may have, a row the number itself.
Columns = _holder("Columns", Column, COLUMNS)
Numbers = _holder("Numbers", Number, COLUMNS)
#: The stress of the instants of a result.
StressColumns = _holder("StressColumns", Column, STRESS)
#: Those of a contact without time.
OF_CONTACT = [name for name in ROW if name not in ("time", "time_error", "stage")]
ContactColumns = _holder("ContactColumns", Column, OF_CONTACT)
ContactNumbers = _holder("ContactNumbers", Number, OF_CONTACT)
