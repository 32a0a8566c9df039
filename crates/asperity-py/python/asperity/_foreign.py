"""Formats that asperity does not read itself: by the package SurfaceTopography, where it is installed."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import CaseError
from ._findings import warn_caller

#: Cells of instruments that measure surfaces are smaller [m]: larger ones come from a unit that was taken for metres.
LARGEST_CELL = 1e-2


def read(path: str, size: list[float] | None, height_unit: float | None, channel: str | None, error: OSError) -> dict[str, Any]:
    """Heights [m], size [m] and what the file says, as ``_core.read_surface`` returns them; else raises `error`."""
    try:
        import SurfaceTopography as other  # type: ignore[import-not-found,import-untyped,unused-ignore]
        from SurfaceTopography.Support import UnitConversion  # type: ignore[import-not-found,import-untyped,unused-ignore]
    except ImportError:
        raise error from None
    try:
        reader = other.open_topography(path)
    except Exception as why:  # its readers raise errors of many kinds
        raise OSError(f"{error}; the package SurfaceTopography does not read it either: {_reason(why)}") from why

    names = [str(one.name) for one in reader.channels]
    index = _choose(names, reader.channels.index(reader.default_channel), channel, path)
    if reader.channels[index].dim != 2:
        raise CaseError(f"{path}: the channel {names[index]!r} is a profile, and not an area")

    sized = reader.channels[index].physical_sizes is not None
    if not sized and size is None:
        raise CaseError(f"{path}: the file holds no physical size; give the lengths along x and y (size=)")
    options = {} if sized else {"physical_sizes": tuple(size or ())}
    try:
        topography = reader.topography(channel_index=index, **options)
    except Exception as why:
        raise OSError(f"{path}: the package SurfaceTopography cannot read it: {_reason(why)}") from why

    unit: Any = UnitConversion.get_unit_conversion_factor(topography.unit, "m") if isinstance(topography.unit, str) else None
    if height_unit is None and unit is None:
        raise CaseError(f"{path}: the file holds no unit of length for its heights (it says {topography.unit!r}); give it (height_unit=)")
    if size is None:
        if unit is None:
            raise CaseError(f"{path}: the file holds no unit for its physical size; give the lengths along x and y (size=)")
        size = [float(length) * unit for length in topography.physical_sizes]
        _check_cells(path, size, topography.nb_grid_pts)
    heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan)
    heights = np.ascontiguousarray(heights * (height_unit if height_unit is not None else unit))
    found = {"format": str(reader.format()), "reader": f"SurfaceTopography {other.__version__}", "history": [], "size": size}
    repeats = {"repeats": True} if topography.is_periodic else {}
    return {**told(topography), **repeats, **found, "channel": names[index], "channels": names, "heights": heights}


def _check_cells(path: str, size: list[float], cells: Any) -> None:
    """Warns of a surface that no instrument measures."""
    cell = max(length / max(int(count), 1) for length, count in zip(size, cells))
    if not cell < LARGEST_CELL:
        shown = " x ".join(f"{length:.4g} m" for length in size)
        warn_caller(
            f"{path}: the package SurfaceTopography reads a size of {shown}, with cells of {cell:.2g} m, larger than those of any instrument: it "
            "may have taken another unit for metres. Compare with the program of the instrument, and give the lengths [m] (size=). [unlikely-unit]"
        )


def _reason(why: Exception) -> str:
    """What a reader says of a file; its own mistakes say nothing about that."""
    mistakes = (LookupError, AttributeError, TypeError, ArithmeticError, AssertionError, NameError, NotImplementedError)
    text = str(why).strip()
    if isinstance(why, mistakes) or type(why).__module__ == "struct" or not text:
        return "its reader fails on this file, which may be damaged, or of another version than it knows"
    return text


def told(topography: Any) -> dict[str, Any]:
    """What a topography of SurfaceTopography says about itself, as metadata of a surface."""
    info = getattr(topography, "info", None) or {}
    return {"metadata": [(str(key), str(value)) for key, value in info.items() if isinstance(value, (str, int, float))]}


def _choose(names: list[str], default: int, wanted: str | None, path: str) -> int:
    """Position of the channel wanted, by name (any case) or number."""
    if wanted is None:
        return default
    lower = [name.lower() for name in names]
    if wanted.lower() in lower:
        return lower.index(wanted.lower())
    if wanted.isdigit() and int(wanted) < len(names):
        return int(wanted)
    held = ", ".join(f"{n}: {name!r}" for n, name in enumerate(names))
    raise CaseError(f"{path}: no channel {wanted!r}; the file holds {held}")
