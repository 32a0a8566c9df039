"""The same contacts by Tamaas and ContactMechanics, where they are installed: one elastic, and a viscoelastic one at once, after relaxation and
between."""

import numpy as np
import pytest

import asperity as asp

N, L, E, PRESSURE = 64, 1e-3, 4e6, 50e3
ROUGH = asp.Surface.self_affine(cells=(N, N), size=(L, L), hurst=0.8, rms_gradient=0.1, longest=L / 2, shortest=L / 8, seed=2)
#: E* = 4 G of an incompressible body: E after relaxation, 3 E at once.
RUBBER = asp.Prony(equilibrium=E / 4, terms=[(E / 2, 1.0)], modulus="shear", poisson=0.5)


def by_tamaas(modulus):
    tm = pytest.importorskip("tamaas")
    tm.set_log_level(tm.LogLevel.error)
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [L, L], [N, N])
    model.E, model.nu = modulus, 0.0
    assert tm.PolonskyKeerRey(model, np.array(ROUGH.heights), 1e-10).solve(PRESSURE) <= 1e-10
    return np.array(model.traction)


def by_contact_mechanics(modulus):
    substrates = pytest.importorskip("ContactMechanics")
    from ContactMechanics.Systems import NonSmoothContactSystem

    substrate = substrates.PeriodicFFTElasticHalfSpace((N, N), modulus, (L, L))
    system = NonSmoothContactSystem(substrate=substrate, surface=asp.compat.topography(ROUGH, periodic=True))
    found = system.minimize_proxy(external_force=PRESSURE * L**2, pentol=1e-10 * ROUGH.heights.std())
    assert found.success
    return found.jac / (L / N) ** 2


OTHERS = pytest.mark.parametrize("other", [by_tamaas, by_contact_mechanics], ids=["tamaas", "ContactMechanics"])


@OTHERS
def test_an_elastic_contact_has_the_same_pressures(other):
    own = asp.elastic(ROUGH, E, pressure=PRESSURE, boundary="periodic", tolerance=1e-10).pressure
    theirs = other(E)
    assert np.array_equal(own > 0, theirs > 0)
    # The same discrete problem; each program stops at 1e-10 of a length or a force, which the least eigenvalues of the operator enlarge.
    np.testing.assert_allclose(own, theirs, rtol=0.0, atol=1e-6 * own.max())


@OTHERS
def test_a_viscoelastic_contact_has_their_elastic_limits(other):
    run = asp.solve(ROUGH, RUBBER, pressure=PRESSURE, times=np.geomspace(0.1, 60.0, 12), boundary="periodic", tolerance=1e-9, fields=["pressure"])
    for index, modulus in ((0, 3 * E), (-1, E)):
        own, theirs = run.field("pressure", index=index), other(modulus)
        # At the end exp(-60/3), 2e-9, of the creep is left.
        assert abs(np.mean(own > 0) - np.mean(theirs > 0)) <= 1 / N**2
        np.testing.assert_allclose(own, theirs, rtol=0.0, atol=1e-4 * own.max())


def test_the_steps_of_tamaas_tend_to_the_same_area():
    tm = pytest.importorskip("tamaas")
    tm.set_log_level(tm.LogLevel.error)
    run = asp.solve(ROUGH, RUBBER, pressure=PRESSURE, times=asp.uniform(3.0, 20), boundary="periodic", tolerance=1e-9, fields=["pressure"])
    own = run.field("pressure", index=-1)
    apart = []
    for steps in (20, 80):
        model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [L, L], [N, N])
        # Its solver is right in units of the relaxed shear modulus; E and nu are those of the relaxed branch.
        unit = E / 4
        model.E, model.nu = 3.0, 0.5
        solver = tm.MaxwellViscoelastic(model, np.array(ROUGH.heights), 1e-9, 3.0 / steps, [E / 2 / unit], [1.0])
        for _ in range(steps):
            assert solver.solve(PRESSURE / unit) <= 1e-9
        apart.append(np.linalg.norm(np.array(model.traction) * unit - own) / np.linalg.norm(own))
    # Backward Euler is of first order: half of a step, 0.15 s, over the retardation time, 3 s, is 0.025. A quarter of the step leaves a quarter
    # of the error; cells that come into contact in between change it by a few per cent.
    assert apart[0] < 0.03 and apart[1] < 0.35 * apart[0], apart
