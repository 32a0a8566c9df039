"""Force curves: models, units, uncertainties, files of instruments."""

import sys

import numpy as np
import pytest

import asperity as asp
from instrument_files import RADIUS, WORK, YOUNG, jkr, stiffness_of, write_force_map

SPHERE = {"radius": RADIUS, "poisson": 0.5}


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


def test_fits_draw_record_and_model():
    plt = pytest.importorskip("matplotlib.pyplot")
    load, depth = jkr()
    fit = asp.fit_indentation(None, load + 1e-8, depth - 3e-7, model="jkr", **SPHERE)
    ax = fit.plot(color="k")
    measured, model = ax.lines
    # From the free sphere and the first touch, in nanometres and micronewtons.
    np.testing.assert_allclose(measured.get_xdata(), depth[fit.rows] * 1e9, atol=0.2)
    assert ax.get_xlabel() == "depth [nm]" and model.get_color() == "k"
    np.testing.assert_allclose(model.get_ydata(), measured.get_ydata(), atol=1e-3 * np.abs(measured.get_ydata()).max())
    time = np.linspace(0.0, 10.0, 101)
    depth = 1e-6 * np.minimum(time, 1.0)
    load = 4 / 3 * 1e6 / 0.75 * np.sqrt(10e-6) * depth**1.5
    for given in ("depth", "load"):
        fit = asp.fit_indentation(time, load, depth, terms=0, given=given, **SPHERE)
        ax = fit.plot()
        assert ax.get_ylabel() == {"depth": "load [µN]", "load": "depth [µm]"}[given] and ax.get_xlabel() == "time [s]"
        measured, model = ax.lines
        # 150 springs: 1/150² and the digits.
        np.testing.assert_allclose(model.get_ydata()[20:], measured.get_ydata()[20:], rtol=1e-3)
    plt.close("all")


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
    (tmp_path / "curve.h5").write_text("text")
    with pytest.raises(ImportError, match="afm"):
        asp.read_force_curves(tmp_path / "curve.h5")


def test_a_file_of_an_instrument_gives_curves(tmp_path):
    pytest.importorskip("afmformats")
    pytest.importorskip("h5py")
    write_force_map(tmp_path / "curve.h5", (2, 1), noise=0.0)
    curves = asp.read_force_curves(tmp_path / "curve.h5")
    assert [curve.metadata["grid index x"] for curve in curves] == [0, 1]
    for curve, young in zip(curves, stiffness_of((2, 1)).flat):
        load, depth = jkr(young=young)
        np.testing.assert_allclose(curve.force, np.concatenate([load[::-1], load]), atol=1e-20)
        np.testing.assert_allclose(curve.depth, np.concatenate([depth[::-1], depth]), atol=1e-15)
        fit = asp.fit_indentation(None, curve.force, curve.depth, model="jkr", **SPHERE)
        assert fit.young[0] == pytest.approx(young, rel=1e-3)
    for name in ["bad.h5", "curve.xyz"]:
        (tmp_path / name).write_text("text")
        with pytest.raises(asp.CaseError, match=name):
            asp.read_force_curves(tmp_path / name)


def test_a_map_of_curves_gives_maps_with_intervals(tmp_path):
    pytest.importorskip("afmformats")
    pytest.importorskip("h5py")
    shape = (6, 5)
    write_force_map(tmp_path / "map.h5", shape)
    curves = asp.read_force_curves(tmp_path / "map.h5")
    found = asp.fit_force_map(curves, model="jkr", range=1e-9, **SPHERE)
    truth = stiffness_of(shape)
    assert found.young.shape == shape and found.size == pytest.approx((12e-6, 10e-6)) and not found.failures
    # 95 % intervals of 30 pixels: 25 or fewer would hold the truth once in 300 maps (binomial), and the seed is fixed.
    for low, high, true in [(found.young_low, found.young_high, truth), (found.work_low, found.work_high, WORK)]:
        assert np.sum((low <= true) & (true <= high)) >= 26
    # The intervals are those of the single fits.
    (curve,) = (c for c in curves if (c.metadata["grid index x"], c.metadata["grid index y"]) == (1, 2))
    one = asp.fit_indentation(curve, model="jkr", range=1e-9, **SPHERE)
    assert one.young == (found.young[1, 2], found.young_low[1, 2], found.young_high[1, 2])
    with pytest.raises(ValueError, match="read-only"):
        found.young[0, 0] = 0.0
    data = found.to_xarray()
    assert data.young.attrs["units"] == "Pa" and float(data.x[0]) == pytest.approx(1e-6)
    # A wider radius widens every interval: ln E by half of it.
    wide = asp.fit_force_map([curve], model="jkr", radius_uncertainty=2e-6, **SPHERE)
    assert wide.young_high[1, 2] / wide.young[1, 2] > np.exp(1.9 * 0.1)


def test_a_pixel_that_cannot_be_fitted_is_left_out_and_named():
    pytest.importorskip("matplotlib").use("Agg")
    load, depth = jkr()

    def curve(x, y, load=load, **more):
        return asp.ForceCurve(load, depth, metadata={"grid index x": x, "grid index y": y, **more})

    free = np.zeros_like(load)
    found = asp.fit_force_map([curve(0, 0), curve(2, 1, free)], model="jkr", **SPHERE)
    assert found.young.shape == (3, 2) and found.size is None
    assert np.isfinite(found.young).sum() == 1 and found.young[0, 0] == pytest.approx(YOUNG, rel=1e-3)
    assert list(found.failures) == [(2, 1)] and "1 without a fit" in repr(found)
    ax = found.plot("work", vmin=0.0)
    assert "5 of 6 pixels without a value" in ax.get_title() and ax.get_xlabel() == "x [pixels]"
    with pytest.raises(asp.CaseError, match="young_low"):
        found.plot("young low")
    with pytest.raises(TypeError, match="cmap"):
        found.plot(cmp="gray")
    for curves, how, words in [
        ([], {}, "no curves"),
        ([curve(0, 0), curve(0, 0)], {}, "another one"),
        ([asp.ForceCurve(load, depth)], {}, "grid index x"),
        ([curve(0.5, 0)], {}, "whole number"),
        ([load], {}, "ForceCurve"),
        ([curve(0, 0, free)], {}, "none of the 1 curves"),
        ([curve(0, 0)], {"model": "viscoelastic"}, "viscoelastic"),
    ]:
        with pytest.raises(asp.CaseError, match=words):
            asp.fit_force_map(curves, **{"model": "jkr", **SPHERE, **how})


def test_stated_uncertainties_are_in_the_intervals_of_a_relaxation():
    # Elastic, pressed by a controlled depth: E goes as R^(-1/2) and as the spring constant.
    time = np.linspace(0.0, 10.0, 101)
    depth = 1e-6 * np.minimum(time, 1.0)
    load = 4 / 3 * 1e6 / 0.75 * np.sqrt(10e-6) * depth**1.5
    load *= 1.0 + 1e-3 * np.random.default_rng(1).normal(size=load.size)
    how = {"terms": 0, "given": "depth", "indenter": "paraboloid", **SPHERE}
    plain = asp.fit_indentation(time, load, depth, **how)
    stated = asp.fit_indentation(
        time, load, depth, radius_uncertainty=0.8e-6, spring_constant=0.2, spring_constant_uncertainty=0.006, **how
    )
    half = np.log([fit.equilibrium[2] / fit.equilibrium[0] for fit in (plain, stated)]) / 1.959964
    assert np.sqrt(half[1] ** 2 - half[0] ** 2) == pytest.approx(0.05, rel=1e-2)
    # A thin sample: more than the half-space, whose modulus does not depend on the thickness.
    thin = [asp.fit_indentation(time, load, depth, thickness=3e-6, thickness_uncertainty=u, **how) for u in (0.0, 0.3e-6)]
    assert thin[1].equilibrium[2] > 1.05 * thin[0].equilibrium[2]
    for given, word in [
        ({"thickness_uncertainty": 1e-7}, "give thickness too"),
        ({"spring_constant_uncertainty": 1e-3}, "give spring_constant too"),
        ({"sensitivity_uncertainty": 0.1}, "give spring_constant too"),
        ({"model": "jkr", "terms": None, "given": None, "thickness_uncertainty": 1e-7}, "thickness_uncertainty"),
        ({"model": "jkr", "terms": None, "given": None, "thickness": 1e-6}, "half-space"),
    ]:
        with pytest.raises(asp.CaseError, match=word):
            asp.fit_indentation(time, load, depth, **{**how, **given})
    with pytest.raises(asp.CaseError, match="give radius too"):
        asp.fit_indentation(time, load, depth, poisson=0.5, indenter="cone", angle=1.4, radius_uncertainty=1e-7)


def test_tips_of_other_shapes_give_the_modulus_back_in_maps_too():
    depth = np.linspace(5e-6, -2e-6, 300)
    pressed = np.maximum(depth, 0.0)
    # A ball of 5 um to its radius (Sneddon 1965): depth = a artanh(a/R), by Newton's method from above.
    a = np.minimum(np.sqrt(5e-6 * pressed), 0.9 * 5e-6)
    for _ in range(60):
        s = a / 5e-6
        a = a - np.where(s > 0, (a * np.arctanh(s) - pressed) / np.where(s > 0, np.arctanh(s) + s / (1 - s**2), 1.0), 0.0)
    ball = (a**2 + 25e-12) * np.arctanh(a / 5e-6) - 5e-6 * a
    pyramid = 0.7453 * np.tan(0.35) * pressed**2
    for load, tip in ((ball, dict(radius=5e-6)), (pyramid, dict(indenter="pyramid", angle=0.35))):
        fit = asp.fit_indentation(None, 1e3 / 0.75 * load, depth, poisson=0.5, model="hertz", **tip)
        assert fit.young[0] == pytest.approx(1e3, rel=1e-3)
        curves = [asp.ForceCurve(e / 0.75 * load, depth, metadata={"grid index x": n, "grid index y": 0}) for n, e in enumerate((1e3, 2e3))]
        found = asp.fit_force_map(curves, poisson=0.5, model="hertz", **tip)
        np.testing.assert_allclose(found.young[:, 0], [1e3, 2e3], rtol=1e-3)
    with pytest.raises(asp.CaseError, match="hertz"):
        asp.fit_indentation(None, pyramid, depth, poisson=0.5, model="jkr", indenter="pyramid", angle=0.35)
    with pytest.raises(asp.CaseError, match="35 degrees are 0.610865 rad"):
        asp.fit_indentation(None, pyramid, depth, poisson=0.5, model="hertz", indenter="pyramid", angle=35.0)


def test_the_columns_of_a_curve_are_of_one_length_and_in_si():
    depth = np.linspace(0.0, 1e-6, 9)
    for wrong in ((depth[1:], depth), (depth, depth, depth[1:]), (depth, depth[:, None])):
        with pytest.raises(asp.CaseError, match="length|shape"):
            asp.ForceCurve(*wrong)
    with pytest.raises(asp.CaseError, match="one point at least"):
        asp.ForceCurve([], [])
    curve = asp.ForceCurve([1, 2, 3], [1.0, 2.0, 3.0])
    assert curve.force.dtype == np.float64 and not curve.force.flags.writeable
    with pytest.raises(AttributeError, match="did you mean 'depth'"):
        curve.dpth
    u = pytest.importorskip("pint", reason="pint is not installed").UnitRegistry()
    curve = asp.ForceCurve(u.Quantity([1.0, 2.0], "nN"), u.Quantity([1.0, 2.0], "um"))
    assert np.allclose(curve.force, [1e-9, 2e-9]) and np.allclose(curve.depth, [1e-6, 2e-6])


def test_a_file_that_is_not_there_is_an_os_error():
    pytest.importorskip("afmformats")
    with pytest.raises(FileNotFoundError, match="none.jpk"):
        asp.read_force_curves("none.jpk")


def test_nanometres_are_no_metres(recwarn):
    depth = np.linspace(0.0, 1e-6, 40)[::-1]
    load = 4 / 3 * 1e6 / 0.75 * np.sqrt(RADIUS) * depth**1.5
    asp.fit_indentation(None, load, depth, radius=RADIUS, indenter="paraboloid", poisson=0.5, model="hertz")
    assert not recwarn.list
    with pytest.warns(asp.ResultWarning, match="the depth is up to 1000 m: lengths are in m and loads in N"):
        asp.fit_indentation(None, load, 1e9 * depth, radius=RADIUS, indenter="paraboloid", poisson=0.5, model="hertz")
    with pytest.warns(asp.ResultWarning, match="the radius is 10 m"):
        asp.fit_indentation(None, load, depth, radius=10.0, indenter="paraboloid", poisson=0.5, model="hertz")
