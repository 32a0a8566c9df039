"""A fluid that opens the contact."""

import numpy as np
import pytest

import asperity as asp

WAVE = asp.Surface.wave(cells=(16, 64), size=(1e-3, 1e-3), amplitude=1e-6, wavelength=(float("inf"), 1e-3))
RUBBER = asp.Elastic(young=3e6, poisson=0.5)
FIELDS = {False: ["gap", "pressure"], True: ["gap", "pressure", "contact_pressure"]}


def pressed(pressure, **fluid):
    given = {"fluid": asp.Fluid(outlet=0.0, viscosity=1e-3, **fluid)} if fluid else {}
    return asp.solve(WAVE, RUBBER, pressure=pressure, times=[1.0], boundary="periodic", tolerance=1e-8, fields=FIELDS[bool(fluid)], **given)


def test_a_uniform_pressure_leaves_the_dry_contact_under_the_rest_of_the_load():
    wet, dry = pressed(5e3, inlet=2e3, coupling="uniform"), pressed(3e3)
    # Both are solved to 1e-8.
    np.testing.assert_allclose(wet.field("gap", index=-1), dry.field("gap", index=-1), atol=1e-6 * dry.approach[-1])
    np.testing.assert_allclose(wet.field("pressure", index=-1), dry.field("pressure", index=-1) + 2e3, atol=1e-4 * 2e3)


def test_the_fluid_and_the_contact_carry_the_load():
    wet = pressed(5e3, inlet=4e3)
    np.testing.assert_allclose(wet.fluid_load + wet.contact_load, wet.load, rtol=1e-12)
    assert 0.0 < wet.fluid_load[-1] < wet.load[-1] and wet.connected[-1] == 1.0
    assert wet.contact_area[-1] < pressed(5e3).contact_area[-1]


def test_the_mean_pressure_over_the_contact_is_that_of_the_cells_in_contact():
    pytest.importorskip("matplotlib").use("Agg")
    wet = pressed(5e3, inlet=4e3)
    (line,) = (line for ax in wet.plot.evolution().flat for line in ax.lines if line.get_label() == "mean over the contact")
    touches = wet.field("contact_pressure", index=-1) > 0.0
    # In kilopascal.
    np.testing.assert_allclose(line.get_ydata()[-1], wet.field("pressure", index=-1)[touches].mean() / 1e3, rtol=1e-9)


@pytest.mark.parametrize(
    ("fluid", "words"),
    [({"inlet": -1.0}, "inlet"), ({"inlet": 1e3, "pockets": "sealed"}, "bulk_modulus"), ({"inlet": 1e3, "bulk_modulus": 2e9}, "bulk_modulus"), ({"inlet": 1e3, "coupling": "one-way"}, "coupling")],
)
def test_what_a_fluid_cannot_be_is_named(fluid, words):
    with pytest.raises(asp.CaseError, match=words):
        pressed(5e3, **fluid)


def test_water_in_a_sealed_valley_carries_what_is_added():
    # Crests at both ends close the valleys of a flow along y. On rubber this soft water is all but incompressible.
    waves = asp.Surface.wave(cells=(16, 64), size=(1e-3, 1e-3), amplitude=1e-6, wavelength=(float("inf"), 5e-4))
    water = asp.Fluid(inlet=0.0, outlet=0.0, viscosity=1e-3, direction="y", pockets="sealed", bulk_modulus=2.2e9)
    load = asp.table([(0.0, 1e3), (1.0, 5e3)])
    result = asp.solve(waves, RUBBER, pressure=load, times=[1.0], boundary="periodic", tolerance=1e-8, fluid=water)
    np.testing.assert_allclose(result.pocket_pressure_max, [0.0, 4e3], atol=4.0)
    np.testing.assert_allclose(result.contact_area[1], result.contact_area[0], rtol=1e-9)


def test_a_run_stores_what_it_computes_beside_the_leak(tmp_path):
    pytest.importorskip("xarray")
    wave = {"kind": "wave", "amplitude": "1 um", "wavelength": ["1 mm", "1 mm"]}
    case = {
        "domain": {"cells": [16, 16], "size": ["1 mm", "1 mm"], "boundary": "periodic"},
        "surface": [wave],
        "body": [{"poisson": 0.5, "material": {"model": "elastic", "shear": "1 MPa"}}],
        "load": {"control": "pressure", "history": {"kind": "step", "value": "2 kPa"}},
        "time": {"end": "1 s", "steps": 1},
        "leakage": {"viscosity": "1 mPa s", "inlet": "1.005 bar", "outlet": "1 bar", "coupling": "two-way", "opening": True, "one_way": True},
    }
    leaks = asp.run(case, output=tmp_path / "wet.zarr").leakage()
    assert float(leaks.leak_rate[-1]) > float(leaks.leak_rate_one_way[-1]) > 0.0
    # It is open already.
    assert float(leaks.opening_pressure[-1]) == 1e5 and leaks.opening_pressure.attrs["units"] == "Pa"
