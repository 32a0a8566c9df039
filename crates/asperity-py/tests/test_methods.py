"""What a result writes for a paper, and its figures of friction and leaks."""

import numpy as np
import pytest

import asperity as asp

BALL = asp.Surface.sphere(cells=(24, 24), size=(1e-3, 1e-3), radius=20e-3)
ZENER = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5, name="rubber")
WAVE = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))


def test_the_methods_are_those_of_the_run():
    adaptive = asp.solve(BALL, ZENER, load=1e-3, times=asp.adaptive(3.0, tolerance=2e-3), tolerance=1e-7, fields=[])
    text = adaptive.methods()
    for words in (
        f"asperity {asp.__version__}, by the model of Spinu and Cerlinca (2017), on 24 x 24 cells of a free surface of 1 mm x 1 mm",
        "rubber (zener model, 1 term, Poisson's ratio 0.5); the other body is rigid",
        # E* = 4 G of an incompressible body; two equal springs in series halve it.
        "The contact modulus is 4 MPa at once and 2 MPa after relaxation.",
        f"The {len(adaptive)} rows reach to 3 s in adaptive steps with the tolerance 0.002",
        f"at most {adaptive.time_error.max():.1e}, relative",
        "by preconditioned projected conjugate gradients to a relative residual of 1e-07",
        f"{adaptive.certificate.max():.1e} (relative, energy norm)",
    ):
        assert words in text, (words, text)
    assert "hardness" not in text and "polonsky1999" not in adaptive.methods(bibtex=True)
    told = adaptive.methods(bibtex=True)
    assert told.startswith(text) and [line.split("{")[1][:-1] for line in told.splitlines() if line.startswith("@")] == ["asperity", "spinu2017", "yastrebov2017"]

    other = asp.solve(BALL, ZENER, pressure=lambda t: 1e2 * t, times=asp.uniform(2.0, 4), method="polonsky-keer", hardness=1e6, fields=[])
    text = other.methods(bibtex=True)
    for words in ("The mean pressure was prescribed.", "in prescribed steps", "taken at 5 points", "cut off at the hardness, 1 MPa", "Polonsky and Keer (1999)", "@article{polonsky1999"):
        assert words in text, (words, text)
    warned = sorted({finding.code for finding in other.findings if finding.severity == "warning"})
    assert warned and f"The program warned of: {', '.join(warned)}." in text


def test_the_methods_of_a_stored_case_and_of_motion(tmp_path):
    stored = asp.run("examples/hertz.toml", set={"domain.cells": [32, 32]}, output=tmp_path / "hertz.zarr")
    text = stored.methods()
    assert "linear elastic half-spaces" in text and "ball (elastic model, Poisson's ratio 0.3) and plate" in text and "Spinu" not in text
    assert "by preconditioned projected conjugate gradients to a relative residual of 1e-06" in text
    steady = asp.steady(WAVE, ZENER, pressure=20e3, velocities=[1e-3, 1e-2], boundary="periodic", fields=[])
    assert "periodic domain of 1 mm x 125" in steady.methods() and "slides in steady states at 2 velocities, 1 mm/s to 10 mm/s" in steady.methods()
    stopped = asp.march(BALL, ZENER, load=1e-3, times=[1.0, 2.0])
    next(stopped)
    assert "not complete: interrupted" in stopped.result().methods()


def test_elastic_results_carry_what_they_were_made_with(tmp_path):
    contact = asp.elastic(BALL, 2e6, load=1e-3, tolerance=1e-8, method="polonsky-keer", hardness=1e5)
    assert (contact.contact_modulus, contact.tolerance, contact.method, contact.hardness) == (2e6, 1e-8, "polonsky-keer", 1e5)
    text = contact.methods()
    assert "The contact modulus is 2 MPa." in text and "residual of 1e-08" in text and "hardness, 100 kPa" in text
    contact.save(tmp_path / "contact.zarr")
    assert asp.open(tmp_path / "contact.zarr").methods() == text
    assert asp.elastic(BALL, 2e6, load=[1e-3, 2e-3])[1].methods().count("2 MPa") == 1


def test_friction_and_leaks_are_drawn():
    pytest.importorskip("matplotlib").use("Agg")
    pytest.importorskip("xarray")
    import matplotlib.pyplot as plt

    steady = asp.steady(WAVE, ZENER, pressure=20e3, velocities=np.geomspace(1e-5, 1e-1, 5), boundary="periodic", shear_stress=1e3, fields=[])
    axes = steady.plot.friction()
    assert axes.shape == (2, 2) and axes[0, 0].get_xscale() == "log"
    bulk, total = (line.get_ydata() for line in axes[0, 0].lines)
    assert np.array_equal(bulk, steady.friction_coefficient) and np.array_equal(total, steady.friction_coefficient_total)
    assert "friction()" in repr(steady.plot) and "leak()" not in repr(steady.plot)
    again = steady.plot.friction(axes=axes, label="again")
    assert len(again[0, 0].lines) == 4
    still = asp.solve(WAVE, ZENER, pressure=1e3, times=[1.0], boundary="periodic", fields=["gap"])
    with pytest.raises(AttributeError, match="friction_coefficient"):
        still.plot.friction()

    rough = asp.Surface.self_affine(cells=(32, 32), size=(1e-4, 1e-4), hurst=0.8, rms_gradient=0.1, longest=5e-5, shortest=2e-5, seed=1)
    pressed = asp.solve(rough, ZENER, pressure=asp.ramp(1.5e5, duration=5.0), times=asp.uniform(5.0, 5), boundary="periodic", fields=["pressure", "gap"])
    leaks = pressed.leakage(pressure_drop=1e5, viscosity=1e-3)
    axes = pressed.plot.leak(leaks)
    shown = axes.flat[0].lines[0].get_ydata()
    scale = np.nanmax(shown) / leaks["leak_rate"].values.max()
    assert axes.size == 2 and axes.flat[0].get_yscale() == "log" and len(axes.flat[0].lines) == 3
    # The same numbers in the unit of the axis; where the seal is tight there is none.
    open_ = leaks["percolates"].values.astype(bool)
    assert np.allclose(shown[open_], scale * leaks["leak_rate"].values[open_], rtol=1e-12) and np.isnan(shown[~open_]).all()
    assert pressed.plot.leak(pressed.leakage(direction="x")).size == 1
    with pytest.raises(TypeError, match=r"leak draws into two axes"):
        pressed.plot.leak(leaks, ax=plt.gca())
    plt.close("all")


def test_leaks_and_stresses_tell_how_they_were_computed():
    contact = asp.elastic(BALL, 4e6, load=1e-3)
    text = asp.leakage(contact, direction="y", smallest_gap=1e-8).methods(bibtex=True)
    for words in ("The flow along y", "24 x 24 cells of 1 mm x 1 mm with closed sides", "nor do gaps below 10 nm", "The hydraulic gap is", "@software"):
        assert words in text, (words, text)
    tight = asp.leakage(np.full((4, 4), 1e-6), np.eye(4)[::-1] + np.eye(4) + np.eye(4, k=1) + np.eye(4, k=-1), size=(1e-3, 1e-3), sides="closed")
    assert ("The seal is tight." in tight.methods()) == (not tight.percolates)
    below = asp.stress(contact, poisson=0.3, depths=[0.0, 1e-4])
    assert "from the pressure on 24 x 24 cells of a free surface of 1 mm x 1 mm, with the Poisson's ratio 0.3, at 2 depths from 0 m to 100 µm." in below.methods()
    pressed = asp.stress(contact.pressure, size=(1e-3, 1e-3), poisson=0.5, boundary="periodic", tractions=[contact.pressure, contact.pressure], depths=1e-4)
    assert "the pressure and the tangential tractions on 24 x 24 cells of a periodic domain" in pressed.methods() and "at the depth 100 µm" in pressed.methods()


def test_fits_tell_what_was_fitted():
    rubber = asp.Prony(equilibrium=1e6, terms=[(5e6, 0.01), (2e6, 1.0)], poisson=0.5)
    f = np.geomspace(0.01, 100, 41)
    text = asp.fit_dma(f, *rubber.storage_loss(2 * np.pi * f)).methods()
    for words in ("A Prony series with 2 terms", "41 points of the storage and loss modulus (Young's)", "from 0.06283 rad/s to 628.3 rad/s", "(5e+06 Pa, 0.01 s), (2e+06 Pa, 1 s)"):
        assert words in text, (words, text)
    creep = asp.fit_creep(f, rubber.creep_compliance(f), modulus="shear").methods()
    assert "A creep series with 2 terms" in creep and "creep compliance (shear)" in creep and "1/Pa" in creep
    depth = np.linspace(1e-6, -2e-7, 100)
    force = np.where(depth > 0, 4 / 3 * 2e4 / 0.75 * np.sqrt(5e-6) * np.maximum(depth, 0.0) ** 1.5 - 2 * np.pi * 5e-6 * 1e-4, 0.0)
    pulled = asp.fit_indentation(None, force, depth, radius=5e-6, poisson=0.5, model="dmt", range=1e-8)
    assert "(DMT) was fitted" in pulled.methods() and "Young's modulus 2e+04 Pa (95 %" in pulled.methods() and "the work of adhesion 0.0001 J/m2" in pulled.methods()
    t = np.linspace(0.0, 20.0, 101)
    zener = asp.Zener(young=2e6, young_kelvin=2e6, retardation_time=4.0, poisson=0.5)
    record = t, np.ones_like(t), (9 / 16 / 0.01 * zener.contact_compliance(t) ** 2) ** (1 / 3)
    pressed = asp.fit_indentation(*record, radius=0.01, poisson=0.5, given="load").methods()
    assert "A Prony series with 1 term was fitted" in pressed and "whose load was controlled" in pressed and "tau_1 2" in pressed
    power = asp.fit_indentation(*record, radius=0.01, poisson=0.5, given="load", model="power-law", max_misfit=1.0).methods(bibtex=True)
    assert power.startswith("A power law was fitted") and "@software" in power
