"""Materials: fractional models, fits, shifts, and temperatures that change."""

import copy
import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import asperity as asp

EXAMPLES = Path(__file__).parents[3] / "examples"
T = np.geomspace(1e-2, 1e3, 60)
PMMA = dict(equilibrium=1973e6, terms=[(254.776e6, 8.93), (263.6628e6, 117.96)])
WLF = dict(c1=8.86, c2=101.6, reference=293.15)


def test_a_standard_linear_solid_is_the_zener_solid_of_the_same_relaxation():
    # Springs G and Gk in series: G Gk/(G + Gk) at rest; the relaxation time is the retardation time times Gk/(G + Gk).
    maxwell = asp.StandardLinearSolid(shear_equilibrium=0.75e6, shear_instantaneous=1e6, relaxation_time=1.5, poisson=0.5)
    zener = asp.Zener(shear=1e6, shear_kelvin=3e6, retardation_time=2.0, poisson=0.5)
    # Only rounding differs.
    assert np.allclose(maxwell.relaxation_modulus(T), zener.relaxation_modulus(T), rtol=1e-12, atol=0)
    assert np.allclose(maxwell.creep_compliance(T), zener.creep_compliance(T), rtol=1e-12, atol=0)


def test_a_model_that_becomes_a_sum_asks_for_its_window():
    law = dict(time=1.0, order=0.4, poisson=0.5)
    for made in (
        lambda: asp.FractionalZener(shear_equilibrium=1e6, shear_instantaneous=30e6, **law),
        lambda: asp.FractionalMaxwell(shear=1e6, **law),
        lambda: asp.Springpot(shear=1e6, **law),
        lambda: asp.PowerLaw(shear=1e6, alpha=0.2, poisson=0.5),
    ):
        with pytest.raises(asp.CaseError, match=r"window of \w+ is not given.*window=\(first, last\)"):
            made()


def test_a_material_gives_the_modulus_that_is_asked_for():
    # E = 2 (1 + nu) G; with a bulk modulus B, 1/E = 1/(3 G) + 1/(9 B) for creep functions. Only rounding and the conversion differ, 1e-12.
    glass = asp.Maxwell(shear=1e9, relaxation_time=2.0, poisson=0.3)
    assert glass.measure == "shear" and asp.Prony(**PMMA, poisson=0.3).measure == "young"
    assert np.allclose(glass.relaxation_modulus(T, measure="young"), 2.6e9 * np.exp(-T / 2), rtol=1e-12, atol=0)
    assert np.allclose(glass.relaxation_modulus(T, measure="shear"), glass.relaxation_modulus(T), rtol=0, atol=0)
    assert np.allclose(glass.creep_compliance(T, measure="young") * 2.6, glass.creep_compliance(T), rtol=1e-12, atol=0)
    resin = asp.Zener(shear=1e9, shear_kelvin=1e9, retardation_time=2.0, bulk_modulus=5e9)
    young = resin.creep_compliance(T, measure="young")
    assert np.allclose(young, resin.creep_compliance(T) / 3 + 1 / 45e9, rtol=1e-12, atol=0)
    storage, loss = resin.storage_loss(1 / T, measure="young")
    shear = np.array([1, 1j]) @ resin.storage_loss(1 / T)
    assert np.allclose(storage + 1j * loss, 9 * 5e9 * shear / (15e9 + shear), rtol=1e-12, atol=0)
    # Young's modulus of an elastic end: 9 B G/(3 B + G).
    assert float(resin.relaxation_modulus(0.0, measure="young")) == pytest.approx(45e9 / 16, rel=1e-12)


def test_a_relaxation_test_gives_the_material_back():
    pmma = asp.Prony(**PMMA, poisson=0.38)
    fit = asp.fit_relaxation(T, pmma.relaxation_modulus(T), poisson=0.38, hardness=300e6, name="PMMA")
    # Exact data: what is left is the fit's own tolerance (some 1e-6).
    assert fit.max_misfit < 1e-5 and len(fit.terms) == 2 and fit.equilibrium == pytest.approx(1973e6, rel=1e-4)
    assert [time for _, time in fit.terms] == pytest.approx([8.93, 117.96], rel=1e-3)
    assert fit.window == (T[0], T[-1]) and fit.shift is None and "prony" in fit.case_block
    material = fit.material
    assert isinstance(material, asp.Prony) and material.contact_compliance(5.0) == pytest.approx(pmma.contact_compliance(5.0), rel=1e-5)
    table = fit.table()
    assert np.array_equal(table["time"], T) and np.abs(table["relaxation_modulus_misfit"]).max() == pytest.approx(fit.max_misfit, rel=1e-6)


def test_a_creep_test_gives_the_material_back():
    burgers = asp.Burgers(shear=1e6, relaxation_time=200.0, shear_kelvin=2e6, retardation_time=5.0, poisson=0.5)
    fit = asp.fit_creep(T, burgers.creep_compliance(T), modulus="shear", poisson=0.5)
    assert fit.max_misfit < 1e-4 and fit.instantaneous == pytest.approx(1e-6, rel=1e-3)
    assert fit.fluidity == pytest.approx(1 / (1e6 * 200.0), rel=1e-2)
    assert fit.material.creep_compliance(20.0) == pytest.approx(float(burgers.creep_compliance(20.0)), rel=1e-4)


def test_a_dma_at_several_temperatures_becomes_a_master_curve():
    shift = asp.wlf(**WLF)
    rubber = asp.FractionalZener(
        shear_equilibrium=1e6, shear_instantaneous=1e9, time=1e-6, order=0.5, window=(1e-12, 1e4), poisson=0.5
    )
    f = np.geomspace(0.1, 100, 13)
    kelvin = np.repeat([263.15, 273.15, 283.15, 293.15, 303.15], len(f))
    frequency = np.tile(f, 5)
    storage, loss = rubber.storage_loss(2 * np.pi * frequency * shift.factor(kelvin))
    given = asp.fit_dma(frequency, storage, loss, temperature=kelvin, shift=shift, modulus="shear", poisson=0.5)
    assert given.shift == shift and given.temperatures == pytest.approx([263.15, 273.15, 283.15, 293.15, 303.15])
    # Three terms per decade of time follow a fractional spectrum to about a percent.
    assert given.max_misfit < 0.03
    assert given.x.min() == pytest.approx(2 * np.pi * 0.1 * float(shift.factor(303.15)), rel=1e-12)
    estimated = asp.fit_dma(frequency, storage, loss, temperature=kelvin, shift="estimated", reference=293.15, modulus="shear")
    assert math.log10(float(estimated.shift.factor(263.15) / shift.factor(263.15))) == pytest.approx(0, abs=0.05)
    # In any order of rows.
    order = np.random.default_rng(1).permutation(5)
    shuffled = np.concatenate([np.arange(k * 13, k * 13 + 13) for k in order])
    again = asp.fit_dma(frequency[shuffled], storage[shuffled], loss[shuffled], temperature=kelvin[shuffled], shift=shift, modulus="shear")
    assert again.terms == given.terms
    with pytest.raises(asp.CaseError, match=r"5 temperatures.*asperity\.wlf"):
        asp.fit_dma(frequency, storage, loss, temperature=kelvin)


def test_a_file_is_fitted_as_the_command_does(tmp_path):
    path = EXAMPLES / "data" / "rubber-dma.csv"
    if not path.exists():
        pytest.skip("the examples are not here")
    fit = asp.fit_file(path, modulus="shear", shift=asp.wlf(**WLF), bulk_modulus=2e9)
    assert fit.kind == "dma" and len(fit.temperatures) == 8 and 0.01 < fit.rms_misfit < 0.03 and fit.noise == pytest.approx(0.02, rel=0.3)
    told = asp.check(EXAMPLES / "rubber-dma.toml")["materials"][0]
    assert fit.max_misfit == told["max_misfit"] and fit.rms_misfit == told["rms_misfit"] and len(fit.x) == told["points"]
    by_hand = asp.fit_file(path, kind="dma", columns={"frequency": 2, "storage": "G' [MPa]"}, units={"loss": "MPa"}, modulus="shear", shift=asp.wlf(**WLF))
    assert by_hand.terms == fit.terms
    with pytest.raises(OSError, match="none.csv"):
        asp.fit_file(tmp_path / "none.csv", kind="dma")
    (tmp_path / "bad.csv").write_text("t [s], E [MPa]\n1, 3\n2, x\n")
    with pytest.raises(asp.CaseError, match="line 3"):
        asp.fit_file(tmp_path / "bad.csv")
    with pytest.raises(asp.CaseError, match="stress"):
        asp.fit_file(path, columns={"stress": 1})


def test_the_material_of_a_fit_knows_the_times_of_its_data(tmp_path):
    pmma = asp.Prony(**PMMA, poisson=0.38)
    table = np.column_stack([T, pmma.relaxation_modulus(T)])
    np.savetxt(tmp_path / "pmma.csv", table, delimiter=",", header="t/s,E(t)/Pa", comments="")
    fit = asp.fit_file(tmp_path / "pmma.csv", poisson=0.38)
    assert fit.material.window == fit.window and fit.material.window == pytest.approx((T[0], T[-1]))
    sphere = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=5e-3)
    case = """
domain = { cells = [16, 16], size = ["1 mm", "1 mm"] }
surface = [{ kind = "sphere", radius = "5 mm" }]
load = { control = "load", history = { kind = "step", value = "0.1 N" } }
time = { end = "1e5 s", steps = 4 }

[[body]]
poisson = 0.38
"""
    (tmp_path / "file.toml").write_text(case + 'material = { model = "relaxation-table", modulus = "young", path = "pmma.csv" }')
    (tmp_path / "block.toml").write_text(case + fit.case_block)

    def told(findings):
        return [(one["value"], one["limit"]) for one in findings if one["code"] == "beyond-material-data"]

    # A run of 1e5 s needs times that were not measured: the same finding by file, by the printed block and in Python.
    expected = told(asp.check(tmp_path / "file.toml")["findings"])
    assert expected == [(1e5, pytest.approx(T[-1]))]
    assert told(asp.check(tmp_path / "block.toml")["findings"]) == expected
    for material in (fit.material, pickle.loads(pickle.dumps(fit.material)), fit.with_body(poisson=0.38)):
        with pytest.warns(asp.ResultWarning, match="beyond-material-data"):
            result = asp.solve(sphere, material, load=0.1, times=asp.uniform(1e5, 4))
        assert told(result.findings) == expected
    assert not told(asp.solve(sphere, fit.material, load=0.1, times=asp.uniform(100.0, 4)).findings)
    # A fractional model is a sum of exponentials, that holds only where it was fitted.
    springpot = asp.Springpot(shear=1e6, time=1.0, order=0.3, window=(1e-2, 1e3), poisson=0.5)
    with pytest.warns(asp.ResultWarning, match="beyond-material-data"):
        asp.solve(sphere, springpot, load=1e-3, times=asp.uniform(1e5, 4))
    with pytest.raises(asp.CaseError, match="window"):
        asp.Prony(**PMMA, poisson=0.38, window=(2.0, 1.0))
    assert asp.Prony(**PMMA, poisson=0.38, window=(1.0, 2.0)) != pmma


def test_the_header_of_a_file_says_which_modulus_it_holds(tmp_path):
    t = np.geomspace(0.1, 100, 40)
    table = np.column_stack([t, 1e3 * (1 + 2 * np.exp(-t / 10))])
    np.savetxt(tmp_path / "shear.csv", table, delimiter=",", header="t/s,G(t)/kPa", comments="")
    np.savetxt(tmp_path / "young.csv", table, delimiter=",", header="t/s,E(t)/kPa", comments="")
    shear, young = (asp.fit_file(tmp_path / f"{name}.csv", poisson=0.5) for name in ("shear", "young"))
    assert shear.modulus == "shear" and young.modulus == "young"
    # An incompressible body: E is 3 G, so that the contact is three times stiffer.
    assert shear.material.contact_compliance(0.0) == pytest.approx(young.material.contact_compliance(0.0) / 3, rel=1e-9)
    # What is said goes before the header, and a finding says that they differ.
    with pytest.warns(asp.ResultWarning, match="modulus-kind"):
        said = asp.fit_file(tmp_path / "shear.csv", modulus="young", poisson=0.5)
    assert said.modulus == "young" and said.terms == shear.terms and not shear.findings
    assert [finding.code for finding in said.findings] == ["modulus-kind"]


def test_sweeps_of_a_file_are_shifted_by_an_estimate_or_a_table(tmp_path):
    path = EXAMPLES / "data" / "rubber-dma.csv"
    if not path.exists():
        pytest.skip("the examples are not here")
    fit = asp.fit_file(path, modulus="shear", bulk_modulus=2e9)
    reference = min(fit.temperatures, key=lambda kelvin: abs(kelvin - 293.15))
    same = asp.fit_file(path, modulus="shear", bulk_modulus=2e9, shift="estimated", reference=reference)
    assert fit.shift == same.shift and fit.terms == same.terms and any("estimated" in note for note in fit.notes)
    law = asp.wlf(**WLF)
    # A degree beyond both ends, so that these do not lie outside by rounding.
    points = sorted([min(fit.temperatures) - 1.0, *fit.temperatures, max(fit.temperatures) + 1.0])
    rows = [(kelvin - 273.15, np.log10(law.factor(kelvin)).item()) for kelvin in points]
    np.savetxt(tmp_path / "shift.csv", rows, delimiter=",", header="T [°C],log_aT", comments="", encoding="utf-8")
    table = asp.shift_table(tmp_path / "shift.csv")
    assert np.allclose(table.factor(fit.temperatures), law.factor(fit.temperatures), rtol=1e-9)
    by_table = asp.fit_file(path, modulus="shear", bulk_modulus=2e9, shift=table)
    assert by_table.rms_misfit == pytest.approx(asp.fit_file(path, modulus="shear", bulk_modulus=2e9, shift=law).rms_misfit, rel=1e-3)
    with pytest.raises(OSError, match="none.csv"):
        asp.shift_table(tmp_path / "none.csv")


def test_a_vertical_shift_divides_the_moduli(tmp_path):
    times = np.geomspace(0.1, 100, 25)
    law = asp.wlf(**WLF)
    kelvin = np.repeat([283.15, 293.15, 303.15, 318.15], 25)
    t = np.tile(times, 4)
    modulus = 1e6 * (1 + 5 * np.exp(-((t / law.factor(kelvin) / 3) ** 0.4))) * kelvin / 293.15
    rows = np.column_stack([kelvin - 273.15, t, modulus])
    np.savetxt(tmp_path / "warm.csv", rows, delimiter=",", header="T [°C],t [s],E(t) [Pa]", comments="", encoding="utf-8")
    plain = asp.fit_file(tmp_path / "warm.csv", shift=law, poisson=0.5)
    assert plain.vertical_factors == []
    for fit in (
        asp.fit_file(tmp_path / "warm.csv", shift=law, vertical="density", poisson=0.5),
        asp.fit_file(tmp_path / "warm.csv", shift=law, vertical="free", poisson=0.5),
        asp.fit_file(tmp_path / "warm.csv", shift=asp.wlf(**WLF, vertical="density"), poisson=0.5),
    ):
        assert fit.max_misfit < 0.5 * plain.max_misfit
        assert [f[1] for f in fit.vertical_factors] == pytest.approx([293.15 / T for T in (283.15, 293.15, 303.15, 318.15)], rel=0.01)
        warm = fit.with_body(poisson=0.5, temperature=318.15)
        cold = fit.with_body(poisson=0.5)
        a = float(fit.shift.factor(318.15))
        ratio = warm.relaxation_modulus(2.0 * a) / cold.relaxation_modulus(2.0)
        assert float(np.squeeze(ratio)) == pytest.approx(318.15 / 293.15, rel=0.01)
    with pytest.raises(asp.CaseError, match="has one of its own"):
        asp.fit_file(tmp_path / "warm.csv", shift=asp.wlf(**WLF, vertical="density"), vertical="free")
    with pytest.raises(asp.CaseError, match="'density'"):
        asp.wlf(**WLF, vertical="dense")
    assert "vertical='density'" in repr(asp.wlf(**WLF, vertical="density"))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: asp.fit_relaxation([1.0, 2.0, 2.0], [3.0, 2.0, 1.0]), "point 3"),
        (lambda: asp.fit_relaxation([1.0, 2.0, 3.0], [3.0, -2.0, 1.0]), "point 2"),
        (lambda: asp.fit_relaxation([1.0, 2.0, 3.0], [1.0, 2.0, 4.0]), "point"),
        (lambda: asp.fit_relaxation([1.0, np.nan, 3.0], [3.0, 2.0, 1.0]), "point 2"),
        (lambda: asp.fit_relaxation([1.0], [3.0]), "points"),
        (lambda: asp.fit_relaxation([], []), "points|real numbers"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0]), "1 values for 2 points"),
        (lambda: asp.fit_relaxation("1 s", [3.0]), "time"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], modulus="bulk"), "'young' or 'shear'"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], shift="wlf"), "asperity.wlf"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], shift="estimated"), "reference"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], reference=300.0), "reference"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], long_time="liquid"), "'fluid'"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], per_decade=1e9), "decade"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], max_terms=0), "max_terms"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], window=(5.0, 6.0)), "window"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0], temperature=[300.0]), "temperature"),
        (lambda: asp.fit_relaxation([1.0, 2.0, 3.0, 4.0, 5.0], [5.0, 4.0, 3.0, 2.0, 1.0], temperature=[300.0, 300.9, 301.8, 302.7, 303.6], shift=asp.wlf(**WLF)), "held temperatures"),
        (lambda: asp.fit_relaxation([1.0, 2.0], [3.0, 2.0]).material, "poisson"),
        (lambda: asp.wlf(c1=-1.0, c2=50.0, reference=300.0), "c1"),
        (lambda: asp.wlf(c1=10.0, c2=50.0, reference=300.0).factor(240.0), "240"),
        (lambda: asp.arrhenius(activation_energy=0.0, reference=300.0), "energy is 0"),
        (lambda: asp.shift_table([(300.0, 0.0)]), "at least 2"),
        (lambda: asp.Elastic(young=1e6, poisson=0.5, temperature=300.0), "shift"),
        (lambda: asp.Elastic(young=1e6, poisson=0.5, shift="wlf"), "shift"),
    ],
)
def test_wrong_data_are_named(make, words):
    with pytest.raises(asp.CaseError, match=words):
        make()


def test_an_indentation_gives_the_material_back():
    # By the march itself: a sphere pressed, held, and drawn back; then with noise.
    truth = asp.Prony(equilibrium=1e6, terms=[(2e6, 1.5)], poisson=0.4)
    sphere = asp.Surface.sphere(cells=(96, 96), size=(3e-3, 3e-3), radius=10e-3)
    result = asp.solve(
        sphere, truth, approach=asp.table([(0.0, 0.0), (1.0, 5e-5), (6.0, 5e-5), (7.0, 3e-5), (10.0, 3e-5)]), times=asp.uniform(10.0, 100), fields=[], progress=False
    )
    fit = asp.fit_indentation(result.time, result.load, result.approach, radius=10e-3, poisson=0.4, given="depth")
    # A grid of 33 cells across the contact knows loads to half a percent.
    assert len(fit.terms) == 1 and fit.equilibrium[0] == pytest.approx(1e6, rel=0.02) and fit.terms[0][1][0] == pytest.approx(1.5, rel=0.02)
    assert fit.material.relaxation_modulus(0.0) == pytest.approx(3e6, rel=0.02) and fit.given == "depth"
    noisy = result.load + 0.01 * result.load.max() * np.random.default_rng(3).standard_normal(len(result))
    known = asp.fit_indentation(result.time, noisy, result.approach, radius=10e-3, poisson=0.4, given="depth", terms=1)
    low, high = known.equilibrium[1:]
    assert low < known.equilibrium[0] < high and low < 1.02e6 and high > 0.98e6 and 0.005 < known.relative_rms < 0.02
    assert "rows" in repr(known) and "<table>" in known._repr_html_() and pickle.loads(pickle.dumps(known)).rms == known.rms
    # The first 1.5 s cannot tell what is left in the end, and say so; the material is that of the best fit.
    first = result.time <= 1.5
    short = asp.fit_indentation(result.time[first], noisy[first], result.approach[first], radius=10e-3, poisson=0.4, given="depth")
    value, low, high = short.equilibrium
    assert math.isnan(value) and low <= 1e6 <= high and any("not determined by this record" in note for note in short.notes)
    assert short.material.relaxation_modulus(0.0) > 0.0 and sum(short.numbers_of_terms) == pytest.approx(1.0)
    t = np.arange(20.0)
    for change, words in (
        (dict(radius=None), "radius is missing"), (dict(angle=0.1), "angle is 0.1"), (dict(indenter="cone"), "radius is 0.01"), (dict(indenter="ball"), "ball"), (dict(poisson=0.6), "0.6"), (dict(radius=-1.0), "radius"),
        (dict(given="both"), "'depth' or 'load'"), (dict(terms=50), "terms"), (dict(springs=1), "springs"), (dict(max_misfit=-1.0), "misfit|limit"),
    ):
        with pytest.raises(asp.CaseError, match=words):
            asp.fit_indentation(t, t, t * 1e-6, **{**dict(radius=0.01, poisson=0.5), **change})
    for columns, words in (((t[:5], t[:5], t[:5]), "10"), ((t, t[:5], t), "same length"), ((t[::-1], t, t), "time"), ((t, t * np.nan, t), "load")):
        with pytest.raises(asp.CaseError, match=words):
            asp.fit_indentation(*columns, radius=0.01, poisson=0.5)


def test_a_thin_sample_gives_its_material_back():
    truth = asp.Prony(equilibrium=1e6, terms=[(2e6, 1.5)], poisson=0.4)
    sphere = asp.Surface.sphere(cells=(64, 64), size=(3e-3, 3e-3), radius=10e-3)
    held = dict(approach=asp.trapezoid(5e-5, rise=1.0, hold=8.0, fall=1.0), times=asp.uniform(9.0, 45), fields=[], progress=False)
    about = dict(radius=10e-3, poisson=0.4, given="depth", terms=1)
    for interface in ("bonded", "slip"):
        layer = asp.Layer(thickness=0.5e-3, material=truth, interface=interface)
        pressed = asp.solve(sphere, asp.Body(layers=[layer]), **held)
        record = (pressed.time, pressed.load, pressed.approach)
        fit = asp.fit_indentation(*record, thickness=0.5e-3, interface=interface, **about)
        # A contact of 22 cells across.
        assert fit.equilibrium[0] == pytest.approx(1e6, rel=0.02) and fit.terms[0][1][0] == pytest.approx(1.5, rel=0.02)
        assert fit.instantaneous[0] == pytest.approx(3e6, rel=0.02)
        # The base makes a half-space of it seem much stiffer.
        assert asp.fit_indentation(*record, max_misfit=1.0, **about).instantaneous[0] > 1.2 * 3e6
    t = np.arange(20.0)
    for change, words in ((dict(thickness=-1.0), "thickness"), (dict(interface="slip"), "thickness"), (dict(thickness=1e-3, interface="glued"), "glued")):
        with pytest.raises(asp.CaseError, match=words):
            asp.fit_indentation(t, t, t * 1e-6, **{**dict(radius=0.01, poisson=0.5), **change})


def test_a_power_law_is_its_springpot_and_comes_back_from_an_indentation():
    law = asp.PowerLaw(young=1e3, alpha=0.2, window=(1e-2, 1e2), poisson=0.5)
    t = np.geomspace(1e-2, 1e2, 9)
    np.testing.assert_allclose(law.relaxation_modulus(t), 1e3 * t**-0.2, rtol=1.01 * law.error)
    springpot = asp.Springpot(young=1e3 * math.gamma(0.8), time=1.0, order=0.2, window=(1e-2, 1e2), poisson=0.5)
    assert law.relaxation_terms == springpot.relaxation_terms and pickle.loads(pickle.dumps(law)) == law
    assert repr(law).startswith("PowerLaw(") and law.measure == "young"
    later = asp.PowerLaw(shear=500.0, time=4.0, alpha=0.5, window=(1e-2, 1e2), poisson=0.5)
    assert later.relaxation_modulus(1.0) == pytest.approx(1000.0, rel=2e-3)
    for alpha in (0.0, 1.0, -0.1):
        with pytest.raises(asp.CaseError, match="alpha"):
            asp.PowerLaw(young=1e3, alpha=alpha, window=(1e-2, 1e2), poisson=0.5)
    # W = (2/pi) tan E* 2 v^2 t^(2 - a)/((1 - a)(2 - a)) under a cone, by the integral of Lee and Radok.
    time = np.linspace(0.0, 2.0, 201)
    load = 2 / np.pi * np.tan(0.6) * 1e3 / 0.75 * 2e-12 * time**1.8 / (0.8 * 1.8)
    load += 0.005 * load.max() * np.random.default_rng(2).standard_normal(time.size)
    how = dict(indenter="cone", angle=0.6, poisson=0.5, model="power-law")
    fit = asp.fit_indentation(time, load, 1e-6 * time, **how)
    for (value, low, high), true in ((fit.modulus, 1e3), (fit.exponent, 0.2)):
        assert low < true < high and low < value < high and high < 1.2 * low
    assert fit.material.alpha == fit.exponent[0] and fit.material.window == fit.window and fit.given == "depth"
    assert "PowerLawFit" in repr(fit) and "<table>" in fit._repr_html_() and pickle.loads(pickle.dumps(fit)).rms == fit.rms
    for change, words in ((dict(terms=1), "terms"), (dict(long_time="solid"), "long_time"), (dict(range=1e-9), "range")):
        with pytest.raises(asp.CaseError, match=words):
            asp.fit_indentation(time, load, 1e-6 * time, **how, **change)


def test_fractional_models_keep_their_tolerance():
    # J of a fractional Maxwell element: (1 + (t/tau)^a / Gamma(1 + a)) / G.
    t = np.geomspace(1e-2, 1e2, 9)
    element = asp.FractionalMaxwell(shear=2e6, time=3.0, order=0.5, window=(1e-2, 1e2), tolerance=1e-4, poisson=0.5)
    exact = (1 + (t / 3.0) ** 0.5 / math.gamma(1.5)) / 2e6
    assert element.error <= 1e-4
    assert np.max(np.abs(element.creep_compliance(t) / exact - 1)) <= 1.01 * element.error
    assert asp.Elastic(young=1e6, poisson=0.5).error is None


def test_storage_and_loss_are_those_of_the_series():
    pmma = asp.Prony(**PMMA, poisson=0.38)
    w = np.geomspace(1e-3, 1e2, 11)
    z = [1j * w * t for _, t in PMMA["terms"]]
    exact = PMMA["equilibrium"] + sum(e * x / (1 + x) for (e, _), x in zip(PMMA["terms"], z))
    storage, loss = pmma.storage_loss(w)
    # Through the creep function and back.
    assert storage == pytest.approx(exact.real, rel=1e-11) and loss == pytest.approx(exact.imag, rel=1e-9)


def test_a_constant_temperature_stretches_all_times():
    shift = asp.wlf(**WLF)
    sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    zener = dict(shear=1e6, shear_kelvin=1e6, poisson=0.5)
    factor = float(shift.factor(283.15))
    kw = dict(load=1e-3, times=asp.uniform(10.0, 10), progress=False)
    cold = asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0, shift=shift), temperature=283.15, **kw)
    slow = asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0 * factor), **kw)
    assert cold.approach == pytest.approx(slow.approach, rel=1e-12)
    own = asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0, shift=shift, temperature=283.15), **kw)
    assert np.array_equal(own.approach, cold.approach)
    table = asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0, shift=shift), temperature=[(0.0, 283.15), (5.0, 283.15)], **kw)
    assert np.array_equal(table.approach, cold.approach)
    reference = asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0, shift=shift), **kw)
    assert np.array_equal(reference.approach, asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0), **kw).approach)
    with pytest.raises(asp.CaseError, match="shift"):
        asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0), temperature=300.0, **kw)
    with pytest.raises(asp.CaseError, match="shift"):
        asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0, shift=shift, temperature=300.0), temperature=300.0, **kw)
    for wrong in (-5.0, [(0.0, 300.0), (-1.0, 300.0)], [(1.0, 300.0)], "20 degC", [], float("nan")):
        with pytest.raises(asp.CaseError):
            asp.solve(sphere, asp.Zener(**zener, retardation_time=2.0, shift=shift), temperature=wrong, **kw)


def test_a_warming_body_has_the_bits_of_the_case(tmp_path, monkeypatch):
    case = tmp_path / "warm.toml"
    case.write_text("""
[domain]
cells = [32, 32]
size = ["1 mm", "1 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
[[body]]
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "2 s", shift = { model = "wlf", c1 = 8.86, c2 = "101.6 K", reference = "293.15 K" } }
[[body]]
poisson = 0.3
material = { model = "elastic", young = "100 MPa" }
[load]
control = "load"
history = { kind = "step", value = "1 mN" }
[temperature]
history = { kind = "ramp", from = "283.15 K", to = "303.15 K", duration = "5 s" }
[time]
end = "10 s"
steps = 10
""")
    monkeypatch.chdir(tmp_path)
    stored = asp.run(case)
    sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    rubber = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=2.0, poisson=0.5, shift=asp.wlf(**WLF))
    here = asp.solve(
        sphere, [rubber, asp.Elastic(young=100e6, poisson=0.3)], load=1e-3, times=asp.uniform(10.0, 10),
        temperature=[(0.0, 283.15), (5.0, 303.15)], progress=False,
    )
    for name in asp._result.ROW:
        assert np.array_equal(getattr(stored, name), getattr(here, name), equal_nan=True), name


def test_fits_shifts_and_materials_are_shown_copied_and_pickled():
    shift = asp.wlf(**WLF)
    fit = asp.fit_relaxation(T, asp.Prony(**PMMA, poisson=0.38).relaxation_modulus(T), poisson=0.38)
    material = asp.Maxwell(young=1e6, relaxation_time=1.0, poisson=0.5, shift=shift)
    for way in (copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))):
        assert way(shift) == shift and way(material) == material
        assert way(fit).terms == fit.terms and way(fit).material == fit.material
    assert eval(repr(shift), vars(asp)) == shift and eval(repr(material), vars(asp)) == material
    table = asp.shift_table([(283.15, 1.0), (293.15, 0.0)])
    assert eval(repr(table), vars(asp)).factor(288.15) == pytest.approx(float(table.factor(288.15)), rel=1e-14)
    assert "<table>" in fit._repr_html_() and "relaxation_time" in material._repr_html_() and "2 terms" in repr(fit)


def test_fits_are_drawn():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    rubber = asp.Prony(equilibrium=1e6, terms=[(5e6, 0.01), (2e6, 1.0)], poisson=0.5)
    f = np.geomspace(0.01, 100, 41)
    ax = asp.fit_dma(f, *rubber.storage_loss(2 * np.pi * f)).plot()
    assert ax.get_xlabel() == "angular frequency [rad/s]" and "[Pa]" in ax.get_ylabel()
    assert asp.fit_creep(T, rubber.creep_compliance(T), modulus="shear").plot().get_ylabel() == "J(t) [1/Pa]"
    plt.close("all")


def test_materials_tell_their_parameters_and_functions_in_short():
    zener = asp.Zener(shear=1e6, shear_kelvin=2e6, retardation_time=3.0, poisson=0.5, shift=asp.wlf(**WLF))
    assert (zener.shear, zener.shear_kelvin, zener.retardation_time, zener.young) == (1e6, 2e6, 3.0, None)
    assert (zener.shift.c1, zener.shift.reference) == (8.86, 293.15) and not hasattr(zener.shift, "activation_energy")
    assert asp.arrhenius(activation_energy=80e3, reference=300.0).activation_energy == 80e3
    same = asp.Zener(shear=1e6, shear_kelvin=2e6, retardation_time=3.0, poisson=0.5, shift=asp.wlf(**WLF))
    assert zener == same and zener != asp.Zener(shear=1e6, shear_kelvin=2e6, retardation_time=3.0, poisson=0.49)
    window = (1e-3, 1e3)
    models = [
        asp.Elastic(shear=1e6, poisson=0.5),
        asp.Maxwell(shear=1e6, relaxation_time=1.0, poisson=0.5),
        zener,
        asp.StandardLinearSolid(shear_equilibrium=1e6, shear_instantaneous=2e6, relaxation_time=1.0, poisson=0.5),
        asp.Burgers(shear=1e6, relaxation_time=100.0, shear_kelvin=2e6, retardation_time=5.0, poisson=0.5),
        asp.Prony(**PMMA, poisson=0.38),
        asp.Creep(instantaneous=1e-6, terms=[(1e-6, 1.0)], poisson=0.5),
        asp.Springpot(shear=1e6, time=1.0, order=0.3, window=window, poisson=0.5),
        asp.FractionalMaxwell(shear=1e6, time=1.0, order=0.3, window=window, poisson=0.5),
        asp.FractionalZener(shear_equilibrium=1e6, shear_instantaneous=1e9, time=1e-2, order=0.5, window=window, poisson=0.5),
    ]
    for model in models:
        assert np.array_equal(model.creep(T), model.creep_compliance(T)) and np.array_equal(model.relaxation(T), model.relaxation_modulus(T))
        storage, loss = model.storage_loss(1 / T)
        assert np.array_equal(model.storage(1 / T), storage) and np.array_equal(model.loss(1 / T), loss)
    # A Kelvin-Voigt body answers a step of the strain with a pulse at 0, which is no modulus, and with its spring.
    voigt = asp.KelvinVoigt(shear=1e6, retardation_time=2.0, poisson=0.5)
    assert float(voigt.creep(2.0)) == pytest.approx((1 - math.exp(-1)) / 1e6, rel=1e-12)
    assert float(voigt.storage(3.0)) == pytest.approx(1e6, rel=1e-12) and float(voigt.loss(3.0)) == pytest.approx(6e6, rel=1e-12)
    assert voigt.relaxation([0.0, 1.0]).tolist() == [1e6, 1e6]


@pytest.mark.parametrize(
    "made",
    [
        lambda: asp.Springpot(shear=1e6, time=1.0, order=0.5, poisson=0.5), lambda: asp.PowerLaw(young=1e3, alpha=0.2, poisson=0.5),
        lambda: asp.FractionalMaxwell(shear=1e6, time=1.0, order=0.5, poisson=0.5),
        lambda: asp.FractionalZener(shear_equilibrium=1e6, shear_instantaneous=1e8, time=1.0, order=0.5, poisson=0.5),
    ],
)
def test_a_fractional_model_asks_for_its_window(made):
    with pytest.raises(asp.CaseError, match=r"give window=\(first, last\)"):
        made()


def test_terms_the_wrong_way_round_are_told(recwarn):
    with pytest.warns(asp.ResultWarning, match=r"terms are \(modulus \[Pa\], time \[s\]\): the first has the modulus 8.93 Pa and the time 2.54776e\+08 s"):
        asp.Prony(equilibrium=1973e6, terms=[(time, modulus) for modulus, time in PMMA["terms"]], poisson=0.38)
    with pytest.warns(asp.ResultWarning, match="compliance 10 1/Pa and the time 1e-07 s"):
        asp.Creep(instantaneous=1e-9, terms=[(10.0, 1e-7)], poisson=0.38)
    recwarn.clear()
    asp.Prony(**PMMA, poisson=0.38)
    asp.Prony(equilibrium=100.0, terms=[(50.0, 1e4), (20.0, 1.0)], poisson=0.5)  # a soft gel
    asp.Prony(instantaneous=1e9, terms=[(0.5, 1e6)], poisson=0.38)
    asp.Creep(instantaneous=1e-9, terms=[(1e-3, 1.0)], poisson=0.38)
    assert not recwarn.list


def test_points_that_are_no_numbers_are_named_and_columns_are_not():
    f = np.geomspace(0.01, 100, 41)
    storage, loss = asp.Prony(equilibrium=1e6, terms=[(5e6, 0.01)], poisson=0.5).storage_loss(2 * np.pi * f)
    with pytest.raises(asp.CaseError, match=r"storage modulus of point 32 is nan, but must be a number \(10 of 41 are not finite\)"):
        asp.fit_dma(f, np.where(f > 10, np.nan, storage), loss)
    with pytest.raises(asp.CaseError, match="frequency of point 1 is inf"):
        asp.fit_dma(np.r_[np.inf, f[1:]], storage, loss)
    with pytest.raises(asp.CaseError, match="not greater than 0") as told:
        asp.fit_dma(f, -storage, loss)
    assert "columns=" not in str(told.value) and "name it" not in str(told.value)
