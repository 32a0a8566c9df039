"""Force curves from the files of instruments."""

from __future__ import annotations

import contextlib
import errno
import io
import os
import tempfile
import zipfile
from typing import Any

import numpy as np

from . import _core
from ._arrays import AnyPath, Floats, NotThere, number
from ._core import CaseError
from ._force_curves import ForceCurve
from ._segments import found

#: What is read, and what to do with other files.
_READ = (
    "read are JPK (.jpk-force, .jpk-force-map, .jpk-qi-data), Bruker Nanoscope (.spm, .000: curves and volumes), Asylum Research (.ibw), NT-MDT "
    "and Optics11 (.txt, .zip), AFM workshop (.csv, .zip), HDF5 and .tab of nanite; export other files as text and make the curve by "
    "asperity.ForceCurve(force, depth, time=...) or ForceCurve.from_deflection(height, deflection, spring_constant=...)"
)


def read_force_curves(path: AnyPath, *, spring_constant: float | None = None, sensitivity: float | None = None) -> list[ForceCurve]:
    """The force curves of a file of an atomic force microscope or a nanoindenter.

    Curves and volumes of Bruker (Nanoscope) are read by this package; JPK, Asylum Research, NT-MDT, AFM workshop, Optics11 and other files by the
    package `afmformats`. A map gives one curve per pixel, with "grid index x" and "grid index y" in its `metadata`.

    Parameters
    ----------
    path : of the file
    spring_constant, sensitivity : [N/m], [m/V] in place of those of the file, or where it states none

    Raises
    ------
    ImportError : without the package that the file needs: ``pip install 'asperity[afm]'``
    FileNotFoundError : there is no such file
    CaseError : an unknown format, a file that cannot be read, or no curve with force and height
    """
    name = os.fspath(path)
    if not os.path.exists(name):
        raise NotThere(errno.ENOENT, "the file does not exist; check its name and folder", name)
    if not os.path.isfile(name):
        raise CaseError(f"{name} is no file")
    given = {"spring_constant": spring_constant, "sensitivity": sensitivity}
    stated = {what: None if value is None else number(what, value) for what, value in given.items()}
    for what, value in stated.items():
        if value is not None and not 0.0 < value < float("inf"):
            raise CaseError(f"{what} is {value}, but must be finite and greater than 0")
    if (read := _core.read_force_file(name, *stated.values())) is not None:
        return [_of_nanoscope(curve) for curve in read]
    if name.endswith(".zip") and (curves := _of_zip(name, stated)):
        return curves
    return _by_afmformats(name, stated)


def _of_nanoscope(read: dict[str, Any]) -> ForceCurve:
    """A curve of a Nanoscope file."""
    height, bent, approach = read["height"], read["deflection"], read["approach"]
    stiffness, place = read["spring_constant"], read["place"]
    metadata = {"spring constant": stiffness, "sensitivity": read["sensitivity"], "format": "Bruker Nanoscope"}
    if place is not None:
        index, shape, size = place
        for k, axis in enumerate("xy"):
            metadata |= {f"grid index {axis}": index[k], f"grid shape {axis}": shape[k]}
            metadata |= {f"grid size {axis}": size[k]} if size is not None else {}
    segments = found(height, bent, read["time"], [(0, approach), (approach, len(height))])
    return ForceCurve(stiffness * bent, height - bent, bent, height, metadata, read["time"], segments)


def _of_zip(name: str, stated: dict[str, float | None]) -> list[ForceCurve]:
    """The curves of the text files of a nanoindenter in an archive; none where it holds others."""
    curves = []
    with zipfile.ZipFile(name) as archive, tempfile.TemporaryDirectory() as folder:
        texts = sorted(entry for entry in archive.namelist() if entry.endswith(".txt"))
        for text in texts:
            head = archive.open(text).read(4096)
            if b"Chiaro" in head:
                curves += _by_afmformats(archive.extract(text, folder), stated)
    return curves


def _by_afmformats(name: str, stated: dict[str, float | None]) -> list[ForceCurve]:
    try:
        import afmformats  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("files of force curves are read by afmformats: pip install 'asperity[afm]'") from None
    override = {what.replace("_", " "): value for what, value in stated.items() if value is not None}
    unknown = os.path.splitext(name)[1] not in afmformats.formats.supported_extensions
    if unknown:
        raise CaseError(f"{name}: the format is not known: {_READ}")
    told = io.StringIO()
    try:
        # What other packages write about a damaged file is part of the error.
        with contextlib.redirect_stderr(told):
            curves = [_curve(data) for data in afmformats.load_data(name, meta_override=override)]
    except (afmformats.errors.MissingMetaDataError, afmformats.meta.MetaDataMissingError) as error:
        missing = ", ".join(sorted(str(key).replace(" ", "_") + "=" for key in getattr(error, "meta_keys", None) or ["spring constant"]))
        raise CaseError(f"{name} does not state what is needed: give {missing}") from error
    # Any reader fails in its own way on a damaged file, and the package's own errors are no Exceptions.
    except (Exception, afmformats.errors.AFMFileFormatError) as error:
        words = str(error) or type(error).__name__
        raise CaseError(f"{name}: afmformats {afmformats.__version__} cannot read it: {words}; {_READ}") from error
    known = [curve for curve in curves if curve is not None]
    if not known:
        raise CaseError(f"{name} holds no curve of force over height or tip position: give spring_constant= where it holds deflections")
    return known


def _curve(data: Any) -> ForceCurve | None:
    """A curve of afmformats, whose heights and tip positions grow away from the sample."""
    metadata = {key: data.metadata[key] for key in data.metadata}
    if "force" not in data:
        return None
    force = _column(data, "force")
    heights = (_column(data, name) for name in ("height (measured)", "height (piezo)") if name in data)
    away = next(heights, None)
    height = None if away is None else -away
    stiffness = metadata.get("spring constant")
    deflection = force / stiffness if stiffness is not None and np.isfinite(stiffness) and stiffness > 0 else None
    # Where the file states the position of the tip, it counts: formats differ in the sign of their heights.
    if "tip position" in data:
        depth = -_column(data, "tip position")
    elif height is not None and deflection is not None:
        depth = height - deflection
    else:
        return None
    time = _column(data, "time") if "time" in data else None
    parts = np.array(data["segment"], dtype=int) if "segment" in data else np.zeros(len(force), dtype=int)
    ends = [0, *(np.flatnonzero(np.diff(parts)) + 1).tolist(), len(force)]
    segments = found(depth if height is None else height, force, time, list(zip(ends, ends[1:])), metadata.get("imaging mode"))
    return ForceCurve(force, depth, deflection, height, metadata, time, segments)


def _column(data: Any, name: str) -> Floats:
    return np.array(data[name], dtype=float)
