"""Functions of a state take the contact, the result or the row itself, with its boundary; what is left open is told or refused."""

from __future__ import annotations

import numpy as np
import pytest

import asperity as asp

SIZE = (1e-3, 1e-3)


@pytest.fixture(scope="module")
def rough() -> asp.Surface:
    return asp.Surface.self_affine(cells=(64, 64), size=SIZE, hurst=0.8, rms_gradient=0.05, longest=5e-4, shortest=1e-4, seed=2)


@pytest.fixture(scope="module")
def contact(rough: asp.Surface) -> asp.ElasticContact:
    return asp.elastic(rough, 1e8, pressure=2e6, boundary="periodic")


def test_stress_of_a_periodic_contact_is_periodic(contact: asp.ElasticContact) -> None:
    below = asp.stress(contact, poisson=0.3, depths=[0.0, 1e-4])
    assert np.array_equal(below.zz, asp.stress(contact.pressure, size=SIZE, poisson=0.3, depths=[0.0, 1e-4], boundary="periodic").zz)
    # The mean of the normal stress is that of the pressure at every depth of a periodic body, and not of a free one.
    assert below.zz[1].mean() == pytest.approx(-2e6, rel=1e-9)
    with pytest.warns(UserWarning, match='boundary="free" or "periodic"|boundary='):
        bare = asp.stress(contact.pressure, size=SIZE, poisson=0.3, depths=[0.0, 1e-4])
    assert abs(bare.zz[1].mean()) < 1.9e6


def test_results_and_rows_bring_their_ratio_and_boundary(rough: asp.Surface) -> None:
    rubber = asp.Elastic(young=1e8, poisson=0.4)
    march = asp.march(rough, rubber, pressure=1e6, times=[1.0], boundary="periodic", fields=["pressure", "gap"])
    for row in march:
        below, leak = asp.stress(row, depths=[5e-5]), asp.leakage(row)
    result = march.result()
    expected = asp.stress(result.field("pressure"), size=SIZE, poisson=0.4, depths=[5e-5], boundary="periodic").mises
    for found in (below, asp.stress(result, depths=[5e-5]), asp.stress(result.field("pressure"), size=SIZE, poisson=0.4, boundary="periodic", depths=[5e-5])):
        assert np.array_equal(found.mises, expected)
    # The same flow as that of the fields with their contact.
    bare = asp.leakage(result.field("gap"), result.field("pressure") > 0, size=SIZE, sides="periodic")
    for other in (leak, asp.leakage(result)):
        assert other.hydraulic_gap == bare.hydraulic_gap and other.open_fraction == bare.open_fraction


def test_what_a_contact_brings_is_not_given_twice(contact: asp.ElasticContact) -> None:
    with pytest.raises(asp.CaseError, match="takes boundary from the ElasticContact itself"):
        asp.stress(contact, poisson=0.3, boundary="free")
    with pytest.raises(asp.CaseError, match="takes contact, size from"):
        asp.leakage(contact, contact.pressure > 0, size=SIZE)
    with pytest.raises(asp.CaseError, match="does not say the Poisson's ratio"):
        asp.stress(contact)
    with pytest.raises(asp.CaseError, match="poisson is missing"):
        asp.stress(contact.pressure, size=SIZE, boundary="free")
    with pytest.raises(asp.CaseError, match="does not keep"):
        asp.leakage(asp.solve(np.zeros((8, 8)), asp.Elastic(young=1e6, poisson=0.5), size=SIZE, pressure=1.0, times=[1.0], boundary="periodic"))


def test_rounding_of_a_bare_gap_is_closed_and_told(contact: asp.ElasticContact) -> None:
    known = asp.leakage(contact, sides="periodic")
    bare = asp.leakage(contact.gap, size=SIZE, sides="periodic")
    # Few errors above zero are larger than the largest below zero.
    assert bare.percolates == known.percolates and bare.open_fraction == pytest.approx(known.open_fraction, abs=0.01)
    assert [finding.code for finding in bare.findings if finding.code == "gaps-below-error"]
    # An overlap of undeformed surfaces is no rounding.
    overlap = np.where(np.arange(8)[:, None] < 4, -1e-7, 1e-6) * np.ones((1, 8))
    assert asp.leakage(overlap, size=SIZE, sides="periodic").open_fraction == 0.5


def test_nine_tenths_of_rounding_are_tight(rough: asp.Surface) -> None:
    whole = asp.elastic(rough, 1e8, pressure=4e6, boundary="periodic", tolerance=1e-9)
    assert whole.contact_fraction > 0.88
    # Rounding that is not below zero: what double precision leaves of the difference of numbers as large as the gap.
    gap = np.where(whole.pressure > 0, np.spacing(whole.gap.max()), whole.gap)
    leak = asp.leakage(gap, size=SIZE, sides="periodic")
    assert not leak.percolates and leak.open_fraction < 0.12 and "gaps-below-error" in [finding.code for finding in leak.findings]


def test_quarter_turns_are_not_taken_for_degrees() -> None:
    surface = asp.Surface(np.arange(6.0).reshape(2, 3), size=(2.0, 3.0))
    for degrees in (90, -90, 180, 270, 4):
        with pytest.raises(asp.CaseError, match="quarter turns"):
            surface.rotate(degrees)
    assert surface.rotate(quarter_turns=5) == surface.rotate(1) == surface.rotate(quarter_turns=1) == surface.rotate(-3)


def test_a_field_is_at_a_stored_time_or_the_nearest_is_asked_for() -> None:
    ball = asp.Surface.sphere(cells=(16, 16), size=SIZE, radius=1e-2)
    rubber = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    result = asp.solve(ball, rubber, load=1e-3, times=asp.uniform(1.0, 10), fields=["pressure", "gap"])
    assert np.array_equal(result.field("pressure", time=0.1 + 0.2), result.field("pressure", index=3))
    with pytest.raises(KeyError, match='no fields were kept at time 0.44 s, but at 0.4 s and 0.5 s: give one of these, or method="nearest"') as error:
        result.field("pressure", time=0.44)
    assert isinstance(error.value, asp.CaseError)
    assert np.array_equal(result.field("pressure", time=0.44, method="nearest"), result.field("pressure", index=4))
    for wrong in (lambda: result.stress(time=0.44), lambda: result.spots(time=0.44)):
        with pytest.raises(KeyError):
            wrong()
    assert np.array_equal(result.spots(time=0.44, method="nearest"), result.spots(index=4))
    with pytest.raises(asp.CaseError, match="method is 'linear'"):
        result.field("pressure", time=0.44, method="linear")  # type: ignore[arg-type]
