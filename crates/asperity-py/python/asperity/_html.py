"""Tables that notebooks show."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence


def table(rows: Iterable[Sequence[object]], head: Sequence[object] = ()) -> str:
    """A table whose rows begin with their names, below a line of heads."""
    top = f"<tr>{''.join(f'<th>{_escaped(cell)}</th>' for cell in head)}</tr>" if head else ""
    lines = (
        f"<tr><th style='text-align:left'>{_escaped(name)}</th>{''.join(f'<td>{_escaped(cell)}</td>' for cell in cells)}</tr>"
        for name, *cells in rows
    )
    return f"<table>{top}{''.join(lines)}</table>"


def _escaped(cell: object) -> str:
    return html.escape(str(cell))
