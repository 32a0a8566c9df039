"""What all holders of fields know of their domain."""

from __future__ import annotations

from typing import Any

from ._arrays import Floats, centres


class OnGrid:
    """Fields on the cells of a rectangle, or on those of a line, along which nothing changes in y."""

    size: tuple[float, ...]

    @property
    def cells(self) -> tuple[int, ...]:
        """Number of cells along x and y; of a line one number."""
        raise NotImplementedError

    @property
    def is_line(self) -> bool:
        """Whether the cells lie in a line: of a line contact loads are per length along y [N/m], the contact area is a length [m], and
        fields have one dimension."""
        return len(self.size) == 1

    @property
    def x(self) -> Floats:
        """Cell centres along x [m]."""
        return centres(self.cells[0], self.size[0])

    @property
    def y(self) -> Floats:
        """Cell centres along y [m]."""
        if self.is_line:
            raise AttributeError("a line of cells has no y: nothing changes along it")
        return centres(self.cells[1], self.size[1])

    @property
    def _axes(self) -> tuple[str, ...]:
        """Names of the dimensions of fields."""
        return ("x",) if self.is_line else ("x", "y")

    @property
    def _coordinates(self) -> dict[str, Any]:
        """The cell centres as coordinates of xarray."""
        return {axis: (axis, getattr(self, axis).copy(), {"units": "m", "long_name": axis}) for axis in self._axes}

    @property
    def _load_unit(self) -> str:
        """The unit of a load."""
        return "N/m" if self.is_line else "N"
