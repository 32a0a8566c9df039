"""Force curves: models, units, uncertainties, files of instruments."""

import sys

import numpy as np
import pytest

import asperity as asp

RADIUS, YOUNG, WORK = 10e-6, 1e6, 5e-3
SPHERE = {"radius": RADIUS, "poisson": 0.5}


def jkr(n=200):
    """Load and depth of the JKR equations down to pull-off, then of the free sphere."""
    stiffness = 4 / 3 * YOUNG / 0.75
    a = np.linspace(2.2, 0.551, n)
    load = np.pi * WORK * RADIUS * (a**3 - np.sqrt(6) * a**1.5)
    depth = (np.pi**2 * WORK**2 * RADIUS / stiffness**2) ** (1 / 3) * (a**2 - 2 / 3 * np.sqrt(6 * a))
    return np.append(load, np.zeros(n // 2)), np.append(depth, depth[-1] - np.linspace(1e-9, 3e-7, n // 2))


def test_a_jkr_curve_gives_its_numbers_back():
    load, depth = jkr()
    fit = asp.fit_indentation(None, load + 1e-8, depth - 3e-7, model="jkr", range=1e-9, **SPHERE)
    # Exact numbers: the fit takes 1e-7 of the ranges as noise.
    assert fit.young[0] == pytest.approx(YOUNG, rel=1e-4) and fit.work[0] == pytest.approx(WORK, rel=1e-4)
    assert fit.touch[0] == pytest.approx(-3e-7, abs=1e-10) and fit.baseline[0] == pytest.approx(1e-8, abs=1e-11)
    assert fit.pull_off_force == pytest.approx(-5 / 6 * np.pi * WORK * RADIUS, rel=1e-3)
    assert fit.transition is None and "jkr" in repr(fit) and "<table" in fit._repr_html_()
    by_load = asp.fit_indentation(None, load, depth, model="jkr", control="load", **SPHERE)
    assert by_load.pull_off_force == pytest.approx(-1.5 * np.pi * WORK * RADIUS, rel=1e-3)
    # w goes as 1/R and as the spring constant.
    wide = asp.fit_indentation(
        None, load, depth, model="jkr", radius_uncertainty=0.3e-6, spring_constant=0.5, spring_constant_uncertainty=0.02, **SPHERE
    )
    assert np.log(wide.work[2] / wide.work[0]) / 1.959964 == pytest.approx(0.05, rel=1e-3)


def test_what_does_not_go_together_is_told():
    load, depth = jkr()
    for given, word in [
        ({"model": "jkr", "terms": 1}, "terms"),
        ({"model": "jkr", "thickness": 1e-6}, "thickness"),
        ({"model": "jrk"}, "jkr"),
        ({"range": 1e-9}, "range"),
        ({"model": "jkr", "sensitivity_uncertainty": 0.1}, "spring_constant"),
        ({"model": "jkr", "branch": "both"}, "branch"),
        ({"model": "jkr", "radius": -1.0}, "radius"),
    ]:
        with pytest.raises(asp.CaseError, match=word):
            asp.fit_indentation(None, load, depth, **{**SPHERE, **given})


def test_depth_is_height_less_deflection():
    load, depth = jkr()
    bent = load / 0.5
    curve = asp.ForceCurve.from_deflection(depth + bent, bent / 50e-9, spring_constant=0.5, sensitivity=50e-9)
    np.testing.assert_allclose(curve.force, load, rtol=1e-12, atol=1e-20)
    np.testing.assert_allclose(curve.depth, depth, rtol=1e-9, atol=1e-18)
    with pytest.raises(asp.CaseError, match="spring_constant"):
        asp.ForceCurve.from_deflection(depth, bent, spring_constant=0.0)


def test_files_need_the_reader(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "afmformats", None)
    with pytest.raises(ImportError, match="afm"):
        asp.read_force_curves(tmp_path / "curve.h5")


def test_a_file_of_an_instrument_gives_curves(tmp_path):
    afmformats = pytest.importorskip("afmformats")
    h5py = pytest.importorskip("h5py")
    load, depth = jkr()
    approach = (load[::-1], depth[::-1])
    force, deep = (np.concatenate(pair) for pair in zip(approach, (load, depth)))
    # Heights grow away from the sample: the tip is at height + force/k.
    columns = {
        "force": force,
        "height (measured)": -deep - force / 0.5,
        "segment": np.repeat(np.array([0, 1], dtype=np.uint8), len(load)),
        "time": 0.01 * np.arange(len(force)),
    }
    about = {"imaging mode": "force-distance", "spring constant": 0.5, "path": tmp_path / "curve.h5", "point count": len(force)}
    with h5py.File(tmp_path / "curve.h5", "w") as file:
        for n in range(2):
            data = afmformats.AFMForceDistance(columns, {**about, "enum": n, "grid index x": n})
            data.export_data(file, metadata=True, fmt="hdf5")
    curves = asp.read_force_curves(tmp_path / "curve.h5")
    assert [curve.metadata["grid index x"] for curve in curves] == [0, 1]
    for curve in curves:
        np.testing.assert_allclose(curve.force, force)
        np.testing.assert_allclose(curve.depth, deep, atol=1e-15)
        fit = asp.fit_indentation(None, curve.force, curve.depth, model="jkr", **SPHERE)
        assert fit.young[0] == pytest.approx(YOUNG, rel=1e-3)
    for name, text in [("no.h5", None), ("bad.h5", "text"), ("curve.xyz", "text")]:
        if text is not None:
            (tmp_path / name).write_text(text)
        with pytest.raises(asp.CaseError, match=name):
            asp.read_force_curves(tmp_path / name)
