"""Attributes and words that the library's registry of columns and quantities gives; `_rows.pyi`, which is generated, declares them."""

from __future__ import annotations

from typing import Literal

from ._columns import HISTOGRAMS, QUANTITIES, ROW, Column, Number

#: The optional quantities of a row.
Quantity = Literal[tuple(QUANTITIES)]

#: A holder of rows has a column for each number that rows may have, a row the number itself.
Columns = type("Columns", (), {name: Column() for name in {**ROW, **QUANTITIES} if name not in HISTOGRAMS})
Numbers = type("Numbers", (), {name: Number() for name in {**ROW, **QUANTITIES} if name not in HISTOGRAMS})
#: Those of a contact without time.
ContactColumns = type("ContactColumns", (), {name: Column() for name in ROW if name not in ("time", "time_error", "stage")})
