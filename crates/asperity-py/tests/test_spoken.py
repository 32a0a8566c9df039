"""Messages in the words of Python, units in all tables, misspelt attributes, and warnings of loops."""

from __future__ import annotations

import inspect
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import asperity as asp
from asperity._spoken import in_python

SIZE = (1e-3, 1e-3)
BALL = asp.Surface.sphere(cells=(16, 16), size=SIZE, radius=1e-2)
RUBBER = asp.Elastic(young=1e6, poisson=0.5)
WAVE = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
ZENER = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (dict(quantities=["plastic_volume"]), 'give plasticity="accumulate"'),
        (dict(tolerance=-1.0), "tolerance is -1.0"),
        (dict(load=-1.0), "value of the history of the load is -1.0, but must be a force not less than 0, such as 0.5 N"),
        (dict(friction=0.3), "add tangential=asperity.tangential(...)"),
        (dict(adhesion=asp.Adhesion(work=1.0, range=1e-9)), "allow_unresolved=True"),
        (dict(wear=1e-15), "wear=asperity.Wear(..., velocity=...), such as 0.1 m/s"),
    ],
)
def test_errors_name_parameters(given, words) -> None:
    with pytest.raises(asp.CaseError) as error:
        asp.solve(BALL, RUBBER, **{"load": 1e-3, "times": [1.0], **given})
    text = str(error.value)
    assert words in text and ' = "' not in text and "solver." not in text and "load.history" not in text, text


def test_findings_name_parameters() -> None:
    slow = asp.solve(BALL, asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5), load=asp.ramp(1e-3, duration=0.1), times=[1.0, 2.0])
    assert any("or take times=asperity.adaptive(end)" in finding.text for finding in slow.findings), slow.findings
    assert in_python('Set `end`, spacing = "adaptive" and leave out `times`: why.') == "Take times=asperity.adaptive(end): why."
    # A case file keeps its own words.
    with pytest.raises(asp.CaseError, match="solver.tolerance"):
        asp.check({"domain": {"cells": [8, 8], "size": [1.0, 1.0]}, "solver": {"tolerance": -1.0}})


def test_tables_take_quantities() -> None:
    pint = pytest.importorskip("pint", reason="pint is not installed")
    q = pint.UnitRegistry().Quantity
    assert asp.Wear(q(1e-6, "mm^3/(N m)"), threshold=q(1, "MPa")) == asp.Wear(1e-6 * 1e-9, threshold=1e6)
    pair = asp.Wear((q(1, "um^2/N"), q(2, "um^2/N"))).coefficient
    assert pair == pytest.approx((1e-12, 2e-12), rel=1e-12)
    flash = asp.Flash(q(0.2, "W/m/K"), q([0.1, 0.2], "mm^2/s"), friction=q(50, "percent"), heated_for=q(3, "ms"))
    assert (flash.conductivity, flash.friction, flash.heated_for) == pytest.approx((0.2, 0.5, 3e-3)) and flash.diffusivity == pytest.approx((1e-7, 2e-7))
    assert asp.Friction(0.3, shear_limit=q(50, "MPa")).shear_limit == pytest.approx(50e6)
    with pytest.raises(asp.CaseError, match=r"coefficient is in meter, but must be in m\^2/N"):
        asp.Wear(q(1, "m"))
    plain = asp.steady(WAVE, ZENER, pressure=2e4, velocities=[0.05], boundary="periodic", shear_stress=[(0.01, 1e3), (0.1, 2e3)])
    given = [(q(10, "mm/s"), q(1, "kPa")), (q(0.1, "m/s"), q(2, "kPa"))]
    same = asp.steady(WAVE, ZENER, pressure=2e4, velocities=[0.05], boundary="periodic", shear_stress=given)
    assert same.friction_coefficient_total == pytest.approx(plain.friction_coefficient_total, rel=1e-12)
    course = {"peak": q(1, "kPa"), "velocity": q(50, "mm/s"), "width": 2.0}
    bell = asp.steady(WAVE, ZENER, pressure=2e4, velocities=[0.05], boundary="periodic", shear_stress=course)
    assert bell.friction_coefficient_total[0] > bell.friction_coefficient[0]


def test_a_fit_is_a_material() -> None:
    t = np.geomspace(0.01, 100, 40)
    curve = 1e6 + 2e6 * np.exp(-t / 5.0)
    fit = asp.fit_relaxation(t, curve, poisson=0.5)
    given = dict(load=1e-3, times=[1.0])
    assert np.array_equal(asp.solve(BALL, fit, **given).approach, asp.solve(BALL, fit.material, **given).approach)
    bare = asp.fit_relaxation(t, curve)
    with pytest.raises(asp.CaseError, match="knows no Poisson's ratio"):
        asp.solve(BALL, bare, **given)
    assert asp.Layer(thickness=1e-3, material=bare, poisson=0.49).material.poisson == 0.49


def test_the_nearest_attribute_is_proposed() -> None:
    result = asp.solve(BALL, RUBBER, load=1e-3, times=[1.0])
    contact = asp.elastic(BALL, 1e6, load=1e-3)
    for held, wrong, right in (
        (result, "contact_aera", "contact_area"), (contact, "presure", "pressure"), (BALL, "hights", "heights"), (RUBBER, "poison", "poisson"),
        (asp.stress(contact, poisson=0.3), "misses", "mises"), (asp, "Zenner", "Zener"), (asp, "solv", "solve"),
    ):
        with pytest.raises(AttributeError, match=f"did you mean '{right}'"):
            getattr(held, wrong)
    # What a parameter says itself stays.
    with pytest.raises(AttributeError, match="was made with"):
        BALL.slope
    with pytest.raises(AttributeError, match="no y"):
        asp.Surface.cylinder(cells=8, size=1e-3, radius=1e-2).y


def test_the_warnings_of_a_loop_collapse(tmp_path) -> None:
    script = tmp_path / "loop.py"
    script.write_text(textwrap.dedent("""
        import asperity as asp
        ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=1e-2)
        for n in range(5):
            asp.solve(ball, asp.Elastic(young=1e6, poisson=0.5), load=1e-4 * (n + 1), times=[1.0], progress=False)
        asp.solve(ball, asp.Elastic(young=1e6, poisson=0.5), load=1e-4, times=[1.0], progress=False)
    """))
    told = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True).stderr
    assert told.count("[few-contact-cells]") == 3 and told.count("are not shown") >= 1, told
    every = subprocess.run([sys.executable, "-W", "always", script], capture_output=True, text=True, check=True).stderr
    assert every.count("[few-contact-cells]") == 6


def test_every_public_object_proposes_the_nearest_attribute() -> None:
    t = np.geomspace(0.1, 10.0, 20)
    contact = asp.elastic(BALL, 1e6, load=[1e-3, 2e-3])
    made = [
        asp.fit_relaxation(t, 1e6 + 1e6 * np.exp(-t), poisson=0.5), asp.wlf(c1=8.86, c2=101.6, reference=293.15), asp.step(1.0), asp.uniform(1.0, 2),
        asp.Adhesion(work=0.1, range=1e-6), asp.Friction(0.3), asp.Wear(1e-15), asp.Flash(0.2, 1e-7, friction=0.3), asp.tangential(force=1.0), asp.Stage(load=1.0, duration=1.0),
        asp.Body(layers=[asp.Layer(thickness=1e-4, material=RUBBER)]), asp.Layer(thickness=1e-4, material=RUBBER), asp.Fluid(inlet=2e5, outlet=1e5, gas="air"),
        contact, contact[0], contact[0].to_result(), asp.leakage(contact[0]), asp.stress(contact[0], poisson=0.3), asp.march(BALL, RUBBER, load=1e-3, times=[1.0]),
        asp.ForceCurve([1.0, 2.0], [1.0, 2.0]), BALL, RUBBER,
    ]
    for held in made:
        name = next(one for one in dir(held) if one[0] != "_" and len(one) > 4)
        with pytest.raises(AttributeError, match=f"did you mean '{name}'"):
            getattr(held, name + "_")


def test_options_of_a_table_are_written_as_python_writes_them() -> None:
    assert in_python('leakage.coupling = "two-way" computes it') == 'fluid=asperity.Fluid(..., coupling="two-way") computes it'
    assert in_python('friction.coupling = "full" computes it') == 'friction=asperity.Friction(..., coupling="full") computes it'
    assert in_python("adhesion.allow_unresolved = true") == "adhesion=asperity.Adhesion(..., allow_unresolved=True)"


def test_the_nearest_argument_of_a_class_is_proposed() -> None:
    for made, wrong, right in (
        (lambda: asp.Zener(shear=1e6, shear_kelvin=1e6, retardation=1.0, poisson=0.5), "retardation", "retardation_time"),
        (lambda: asp.Adhesion(work=0.1, rnge=1e-6), "rnge", "range"), (lambda: asp.Wear(1e-15, velocty=0.1), "velocty", "velocity"),
        (lambda: asp.Stage(laod=1.0), "laod", "load"), (lambda: asp.Surface(np.zeros((2, 2)), sise=(1.0, 1.0)), "sise", "size"),
    ):
        with pytest.raises(TypeError, match=rf"\(\) takes no argument '{wrong}'; did you mean '{right}'"):
            made()
    # What a class takes, and errors from within, stay as they are.
    assert list(inspect.signature(asp.Wear).parameters)[:2] == ["coefficient", "velocity"]
    with pytest.raises(TypeError, match="missing 1 required positional argument"):
        asp.Wear()

    class Own(asp.Wear):
        def __post_init__(self) -> None:
            raise TypeError("of its own")

    with pytest.raises(TypeError, match="of its own"):
        Own(1e-15)
