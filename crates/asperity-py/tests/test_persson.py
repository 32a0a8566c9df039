"""Persson's theory of rubber friction."""

import numpy as np
import pytest

import asperity as asp


def rubber(**more):
    return asp.Prony(equilibrium=1e6, terms=[(1e6, 1e-1), (4e6, 1e-3), (20e6, 1e-5)], poisson=0.5, **more)


def road(seed: int = 1, **more):
    band = dict(hurst=0.8, rms_gradient=0.2, longest=5e-3, shortest=5e-4)
    return asp.Surface.self_affine(cells=(64, 48), size=(8e-3, 6e-3), **{**band, "seed": seed, **more})


def waves(surface, material, velocity, across=False):
    """Friction stress in full contact, by numpy: sum of |q| q_e |A|^2 E''(q_e v) / 2."""
    (nx, ny), (lx, ly) = surface.heights.shape, surface.size
    amplitudes = np.fft.fft2(surface.heights) / (nx * ny)
    qx, qy = np.meshgrid(2 * np.pi * np.fft.fftfreq(nx, lx / nx), 2 * np.pi * np.fft.fftfreq(ny, ly / ny), indexing="ij")
    along = np.abs(qy if across else qx)
    moving = along > 0
    loss = np.zeros_like(along)
    # 4 G of an incompressible body is (4/3) E.
    loss[moving] = 4 / 3 * material.storage_loss(along[moving] * velocity)[1]
    return float((0.5 * np.hypot(qx, qy) * along * np.abs(amplitudes) ** 2 * loss).sum())


def test_full_contact_is_the_sum_over_the_waves():
    for direction in ("x", "y"):
        pressure = 1e10
        found = asp.persson_friction(road(), rubber(), pressure=pressure, velocities=[1e-3, 1.0], direction=direction)
        assert (found.contact_fraction == 1.0).all()
        exact = [waves(road(), rubber(), v, direction == "y") for v in found.velocity]
        # Another order of the same sums, and a band-limited surface whose Nyquist waves are rounding errors.
        assert np.allclose(found.friction_coefficient * pressure, exact, rtol=1e-11)


def test_the_contact_shrinks_and_the_friction_has_a_maximum():
    velocities = np.geomspace(1e-7, 1e4, 23)
    found = asp.persson_friction(road(), rubber(), pressure=0.1e6, velocities=velocities)
    assert found.velocity.shape == found.friction_coefficient.shape == found.contact_fraction.shape == (23,)
    assert (np.diff(found.contact_fraction) <= 0).all()
    peak = int(np.argmax(found.friction_coefficient))
    assert 0 < peak < 22 and (found.friction_coefficient > 0).all()
    mirrored = asp.persson_friction(road(), rubber(), pressure=0.1e6, velocities=-velocities)
    assert (mirrored.friction_coefficient == found.friction_coefficient).all()
    plain = asp.persson_friction(road(), rubber(), pressure=0.1e6, velocities=velocities, correction="none")
    ratio = found.friction_coefficient / plain.friction_coefficient
    assert ((ratio >= 0.5) & (ratio < 1)).all()
    assert "23 velocities" in repr(found)


def test_the_magnification_ends_at_the_friction():
    found = asp.persson_friction(road(), rubber(), pressure=0.1e6, velocities=0.01)
    curve = found.magnification(0.01)
    assert curve.friction_coefficient[-1] == found.friction_coefficient[0]
    assert curve.contact_fraction[-1] == found.contact_fraction[0]
    assert curve.magnification[0] == 1.0 and (np.diff(curve.wave_number) > 0).all()


def test_an_elastic_body_has_no_friction_and_an_array_is_a_surface():
    steel = asp.Elastic(young=2e11, poisson=0.3)
    found = asp.persson_friction(road().heights, steel, pressure=1e7, velocities=[1.0], size=road().size)
    assert found.friction_coefficient[0] == 0.0


def test_the_temperature_moves_the_curve_along_the_velocity():
    shift = asp.wlf(c1=8.86, c2=101.6, reference=293.15)
    cold, given = 278.15, dict(pressure=0.1e6)
    at = asp.persson_friction(road(), rubber(shift=shift), velocities=[1e-3], temperature=cold, **given)
    factor = 10 ** (-8.86 * (cold - 293.15) / (101.6 + cold - 293.15))
    moved = asp.persson_friction(road(), rubber(), velocities=[1e-3 * factor], **given)
    own = asp.persson_friction(road(), rubber(shift=shift, temperature=cold), velocities=[1e-3], **given)
    # Rounding of the products of velocity and time.
    assert np.allclose(at.friction_coefficient, moved.friction_coefficient, rtol=1e-10)
    assert (at.friction_coefficient == own.friction_coefficient).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (dict(surface=asp.Surface(np.zeros((8, 8)), size=(1.0, 1.0))), "rms roughness of the surface"),
        (dict(surface=asp.Surface(np.full((8, 8), np.nan), size=(1.0, 1.0))), "undefined heights"),
        (dict(surface=np.ones((8, 8))), "size in m is needed"),
        (dict(material=asp.Maxwell(shear=1e6, relaxation_time=1.0, poisson=0.5)), "a fluid has no steady state"),
        (dict(material="rubber"), "must be a material"),
        (dict(pressure=0.0), "nominal pressure"),
        (dict(pressure=float("nan")), "nominal pressure"),
        (dict(velocities=[]), "velocities"),
        (dict(velocities=[np.inf]), "velocity"),
        (dict(velocities=["fast"]), "velocities"),
        (dict(correction="half"), "'yang-persson' or 'none'"),
        (dict(direction="z"), "'x', 'y'"),
        (dict(direction=float("inf")), "direction"),
        (dict(temperature=300.0), "temperature.*none has a shift"),
    ],
)
def test_wrong_input_is_told(change, words):
    given = dict(surface=road(), material=rubber(), pressure=1e5, velocities=[1.0])
    given |= change
    with pytest.raises(asp.CaseError, match=words):
        asp.persson_friction(given.pop("surface"), given.pop("material"), **given)
