"""Adhesion from Python: what it takes, and what a result with adhesion says, keeps and draws."""

import copy
import pickle
import re

import numpy as np
import pytest

import asperity as asp

SPHERE = asp.Surface.sphere(cells=(48, 48), size=(60e-6, 60e-6), radius=100e-6)
RUBBER = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5, name="rubber")
GLUE = asp.Adhesion(work=50e-3, range=500e-9)
PULL = dict(approach=asp.table([(0.0, 0.5e-6), (1.0, -1.2e-6)]), times=asp.uniform(1.0, 12), adhesion=GLUE)


@pytest.fixture(scope="module")
def pulled():
    return asp.solve(SPHERE, RUBBER, fields=["pressure", "gap", "contact_pressure"], **PULL)


def test_numbers_are_checked_where_they_are_given():
    for given, told in [
        ({}, "a range .* or a strength"),
        ({"range": 1e-7, "strength": 1e5}, "one of the two"),
        ({"range": 0.0}, "range is 0 m, but must be finite and greater than 0"),
        ({"range": 1e-7, "work": -1.0}, "work is -1 J/m2"),
        ({"range": 1e-7, "work": float("nan")}, "work is nan"),
        ({"range": 1e-7, "work": "50 mJ/m2"}, "number in SI units"),
        ({"strength": -1e5}, "strength is -100000 Pa"),
        ({"range": 1e-7, "law": "dugdal"}, "did you mean 'dugdale'"),
        ({"range": 1e-7, "tolerance": 0.0}, "tolerance is 0"),
        ({"range": 1e-7, "allow_unresolved": "yes"}, "True or False"),
    ]:
        with pytest.raises(asp.CaseError, match=told):
            asp.Adhesion(**{"work": 50e-3, **given})
    for wrong in ({"work": 50e-3, "range": 4e-7}, 0.05):
        with pytest.raises(asp.CaseError, match="must be an asperity.Adhesion"):
            asp.solve(SPHERE, RUBBER, load=1e-6, times=[1.0], adhesion=wrong)


def test_it_is_a_value():
    same = asp.Adhesion(work=50e-3, range=500e-9)
    assert same == GLUE and hash(same) == hash(GLUE) and GLUE != asp.Adhesion(work=50e-3, range=400e-9)
    for other in (pickle.loads(pickle.dumps(GLUE)), copy.deepcopy(GLUE), eval(f"asp.{GLUE!r}")):
        assert other == GLUE
    assert repr(GLUE) == "Adhesion(work=0.05, range=5e-07)"


def test_units_are_converted():
    u = pytest.importorskip("pint").UnitRegistry()
    given = asp.Adhesion(work=50 * u.mJ / u.m**2, range=500 * u.nm)
    assert given.work == pytest.approx(50e-3) and given.range == pytest.approx(500e-9)
    assert asp.Adhesion(work=50 * u.mN / u.m, strength=0.1 * u.MPa).strength == pytest.approx(1e5)
    with pytest.raises(asp.CaseError, match="J/m"):
        asp.Adhesion(work=50 * u.m, range=1e-7)


def test_a_result_keeps_all_its_columns(pulled, tmp_path):
    pytest.importorskip("xarray")
    assert pulled.load.min() < 0.0
    # The load is what presses less what pulls.
    np.testing.assert_allclose(pulled.load, pulled.repulsive_load - pulled.adhesive_load, rtol=0.0, atol=1e-12 * pulled.adhesive_load.max())
    pulled.save(tmp_path / "pulled.zarr")
    run = asp.march(SPHERE, RUBBER, fields=["pressure", "gap"], **PULL)
    assert min(row.load for row in run) == pulled.load.min()
    for other in (pickle.loads(pickle.dumps(pulled)), asp.open(tmp_path / "pulled.zarr"), run.result()):
        for name in ("load", "approach", "contact_area", *pulled.quantities):
            np.testing.assert_array_equal(getattr(other, name), getattr(pulled, name), err_msg=name)
    data = pulled.to_xarray()
    assert {*pulled.quantities} >= {"adhesive_load", "repulsive_load", "adhesion_energy"} and {*pulled.quantities} <= {*data.data_vars}


def test_the_methods_name_the_attraction(pulled):
    text = pulled.methods()
    for words in (
        "frictionless adhesive normal contact",
        "after the law exponential",
        "work of adhesion 50 mJ/m²",
        "range 500 nm",
        # The strength of the exponential law is w over the range.
        "largest attraction 100 kPa",
        "Tabor's number",
        "trap number",
    ):
        assert words in text, (words, text)
    plain = asp.solve(SPHERE, RUBBER, load=1e-5, times=[1.0]).methods()
    assert "adhes" not in plain and "attract" not in plain


def test_figures_show_tension(pulled):
    pytest.importorskip("matplotlib").use("Agg")
    import matplotlib.pyplot as plt

    (line,) = (line for ax in pulled.plot.evolution().flat for line in ax.lines if line.get_label() == "mean over the contact")
    # The mean of the pressure of the cells that touch, in kilopascal.
    fields = [(pulled.field("pressure", index=n), pulled.field("contact_pressure", index=n) > 0.0) for n in range(len(pulled))]
    expected = [pressure[touches].mean() / 1e3 if touches.any() else np.nan for pressure, touches in fields]
    # A gap that is closed to the tolerance of the solver, 1e-6 of the displacement, takes 1e-6 from the attraction.
    np.testing.assert_allclose(line.get_ydata(), expected, rtol=1e-4, atol=1e-3)
    ax = pulled.plot.pressure(index=2)
    low, high = ax.images[0].get_clim()
    assert low == -high < 0.0 and "pull at each other" in ax.get_title()
    assert pulled.plot.pressure(index=2, vmin=0.0, cmap="gray").images[0].get_cmap().name == "gray"
    plt.close("all")


def test_a_study_of_the_work(tmp_path):
    pytest.importorskip("xarray")
    works = [30e-3, 60e-3]
    rest = {name: value for name, value in PULL.items() if name != "adhesion"}
    over = {"adhesion": [asp.Adhesion(work=work, range=500e-9) for work in works]}
    data = asp.study(dict(surface=SPHERE, material=RUBBER, **rest), over=over, folder=tmp_path / "study")
    pull_off = -data["load"].min("step").values
    # Between 3/2 and 2 times pi w R, which viscoelastic loss adds to, and nearly in proportion to w.
    assert np.all(pull_off > 1.5 * np.pi * 100e-6 * np.array(works)) and 1.5 < pull_off[1] / pull_off[0] < 2.5
    assert re.search("work=0.03", str(data["adhesion"].values[0]))


def test_a_run_that_stops_keeps_its_rows(pulled):
    stopped = asp.solve(SPHERE, RUBBER, fields=[], on_step=lambda row: row.index >= 4, **PULL)
    assert len(stopped) == 5 and np.array_equal(stopped.load, pulled.load[:5]) and "not complete" in stopped.methods()
    with pytest.raises(asp.CaseError, match="stiffness"):
        asp.solve(SPHERE, RUBBER, quantities=["contact_stiffness"], **PULL)
