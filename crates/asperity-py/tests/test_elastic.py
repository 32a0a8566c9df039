"""Elastic contacts: what they are made of, many of them, their solver's history, other kernels."""

import copy
import pickle

import numpy as np
import pytest

import asperity as asp

E = 1e9


@pytest.fixture(scope="module")
def rough():
    return asp.Surface.self_affine(cells=(48, 40), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.05, longest=5e-4, shortest=1e-4, seed=2)


@pytest.fixture(scope="module")
def sphere():
    return asp.Surface.sphere(cells=(48, 40), size=(1e-3, 1e-3), radius=5e-3)


def test_an_array_holds_heights_and_a_gap_is_named(sphere):
    by_surface = asp.elastic(sphere, E, load=1.0)
    for same in (
        asp.elastic(sphere.heights, E, load=1.0, size=sphere.size),
        asp.elastic(gap=sphere.gap(), contact_modulus=E, load=1.0, size=sphere.size),
        # A gap counts from first touch.
        asp.elastic(gap=sphere.gap() + 1e-6, contact_modulus=E, load=1.0, size=sphere.size),
    ):
        assert same.approach == pytest.approx(by_surface.approach, rel=1e-9)
    rubber = asp.Elastic(young=E * 0.75, poisson=0.5)
    over_time = asp.solve(sphere.heights, rubber, load=1.0, times=[1.0], size=sphere.size)
    assert np.array_equal(over_time.approach, asp.solve(gap=sphere.gap(), material=rubber, load=1.0, times=[1.0], size=sphere.size).approach)
    assert over_time.approach[-1] == pytest.approx(by_surface.approach, rel=1e-6)
    for wrong in (dict(), dict(surface=sphere, gap=sphere.gap()), dict(gap=sphere), dict(gap=np.full((4, 4), np.nan), size=(1, 1))):
        with pytest.raises(asp.CaseError, match="gap"):
            asp.elastic(**wrong, contact_modulus=E, load=1.0)


def test_a_contact_has_what_a_row_has(rough, tmp_path):
    contact = asp.elastic(rough, E, load=2.0, boundary="periodic")
    row = asp.solve(rough, asp.Elastic(young=E * 0.75, poisson=0.5), load=2.0, times=[1.0], boundary="periodic", fields=["pressure", "gap"])
    for name in ("contact_area", "contact_area_corrected", "contact_fraction"):
        assert getattr(contact, name) == getattr(row, name)[-1], name
    for name in ("load", "approach", "mean_pressure", "max_pressure", "mean_gap"):
        assert getattr(contact, name) == pytest.approx(getattr(row, name)[-1], rel=1e-5), name
    assert contact.size == rough.size and contact.cells == rough.cells and np.array_equal(contact.x, rough.x)
    assert contact.boundary == "periodic" and contact.spots().max() >= 1
    # dW/dw is the limit of a difference; its error is that of the approach, 1e-6 of it over a step of 1e-3.
    steps = asp.elastic(rough, E, approach=[contact.approach * 0.999, contact.approach * 1.001], boundary="periodic", tolerance=1e-9)
    assert contact.stiffness == pytest.approx(np.diff(steps.load)[0] / np.diff(steps.approach)[0], rel=0.05)
    contact.save(tmp_path / "a.zarr")
    back = asp.open(tmp_path / "a.zarr")
    assert back.load[0] == contact.load and np.array_equal(back.field("gap"), contact.gap)
    again = pickle.loads(pickle.dumps(contact))
    assert np.array_equal(again.pressure, contact.pressure) and not again.pressure.flags.writeable
    assert repr(copy.copy(contact)) == repr(contact) and len(repr(contact)) < 200
    # A copy plans the same contact again: the same bits.
    assert again.stiffness == contact.stiffness == copy.deepcopy(contact).stiffness
    assert not again.initial_gap.flags.writeable and asp.elastic(rough, E, load=contact.load, boundary="periodic", start=again)._planned is again._planned
    data = pytest.importorskip("xarray") and contact.to_xarray()
    assert data.pressure.dims == ("x", "y") and float(data.contact_fraction) == contact.contact_fraction


def test_a_curve_is_indexed_by_what_was_prescribed():
    xarray = pytest.importorskip("xarray")
    pressures = [1e5, 3e5, 1e6]
    surfaces = [
        asp.Surface.self_affine(cells=(32, 32), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.1, longest=5e-4, shortest=1e-4, seed=seed)
        for seed in range(3)
    ]
    curves = [asp.elastic(surface, E, pressure=pressures, boundary="periodic") for surface in surfaces]
    data = xarray.concat([curve.to_xarray() for curve in curves], dim="seed", join="outer")
    assert data.mean_pressure.values.tolist() == pressures and data.sizes["seed"] == 3 and data.mean_pressure.attrs["units"] == "Pa"
    assert np.isfinite(data.contact_fraction).all() and data.pressure.dims == ("seed", "mean_pressure", "x", "y")
    # The load is what was computed, and meets the pressure to the tolerance of the solver.
    assert np.allclose(data["load"] / 1e-6, pressures, rtol=1e-6)
    assert curves[0][1:].to_xarray().mean_pressure.values.tolist() == pressures[1:]
    loads = asp.elastic(surfaces[0], E, load=[0.1, 0.3], boundary="periodic").to_xarray()
    assert loads["load"].values.tolist() == [0.1, 0.3] and loads.contact_area.dims == ("load",)
    heights = asp.elastic(surfaces[0], E, approach=[1e-7, 3e-7], boundary="periodic").to_xarray()
    assert heights.approach.values.tolist() == [1e-7, 3e-7] and heights["load"].dims == ("approach",)


def test_controls_agree(rough):
    by_load = asp.elastic(rough, E, load=2.0, boundary="periodic", tolerance=1e-9)
    by_pressure = asp.elastic(rough, E, pressure=2.0 / 1e-6, boundary="periodic", tolerance=1e-9)
    by_approach = asp.elastic(rough, E, approach=by_load.approach, boundary="periodic", tolerance=1e-9)
    assert by_pressure.load == pytest.approx(2.0, rel=1e-12) and by_approach.load == pytest.approx(2.0, rel=1e-6)
    with pytest.raises(asp.CaseError, match="load, pressure"):
        asp.elastic(rough, E, load=1.0, pressure=1.0)


def test_a_list_gives_a_curve_and_a_plan_is_used_again(rough):
    loads = [0.5, 1.0, 2.0, 4.0]
    curve = asp.elastic(rough, E, load=loads, boundary="periodic")
    assert len(curve) == 4 and curve.load == pytest.approx(loads, rel=1e-9)
    assert np.all(np.diff(curve.contact_fraction) > 0) and curve.stiffness.shape == (4,)
    alone = asp.elastic(rough, E, load=4.0, boundary="periodic")
    # Both are solved to the tolerance, from different starts.
    assert curve[-1].approach == pytest.approx(alone.approach, rel=1e-5)
    assert isinstance(curve[1:], asp.ElasticCurve) and len([*curve]) == 4
    warm = asp.elastic(rough, E, load=4.0, boundary="periodic", start=alone)
    assert warm._planned is alone._planned and warm.iterations < alone.iterations
    # Another modulus, load or surface is never solved with the plan of the first.
    other = asp.elastic(rough, 2 * E, load=4.0, boundary="periodic", start=alone)
    assert other._planned is not alone._planned and other.approach == pytest.approx(asp.elastic(rough, 2 * E, load=4.0, boundary="periodic").approach, rel=1e-5)
    assert asp.elastic(rough * 2, E, load=4.0, boundary="periodic", start=alone)._planned is not alone._planned
    pressure = np.empty(rough.cells)
    into = asp.elastic(rough, E, load=4.0, boundary="periodic", out=pressure)
    assert np.shares_memory(into.pressure, pressure) and np.array_equal(pressure, alone.pressure)
    with pytest.raises(ValueError, match="read-only"):
        into.pressure[0] = 1.0
    for wrong in (np.empty((3, 3)), np.empty(rough.cells, dtype=np.float32), {"contact": pressure}):
        with pytest.raises(asp.CaseError, match="out"):
            asp.elastic(rough, E, load=4.0, boundary="periodic", out=wrong)
    with pytest.raises(asp.CaseError, match="start"):
        asp.elastic(rough, E, load=4.0, boundary="periodic", start=np.zeros((3, 3)))
    with pytest.raises(asp.CaseError, match="holds no number"):
        asp.elastic(rough, E, load=[])


@pytest.mark.parametrize("method", ["projected-cg", "polonsky-keer"])
def test_the_history_tells_how_the_solver_converged(rough, method):
    contact = asp.elastic(rough, E, load=2.0, boundary="periodic", method=method, history=True)
    told = contact.history
    assert told.iteration[-1] == contact.iterations and told.convolutions[-1] == contact.convolutions
    assert told.residual[-1] == contact.residual < 1e-6 and told.residual[0] > 10 * told.residual[-1]
    assert np.all(np.diff(told.iteration) >= 0) and told.step[-1] == "converged" and len(told) >= 3
    # At the end the working set is the contact, or a little more.
    assert told.working_cells[-1] == pytest.approx(contact.contact_fraction * 48 * 40, rel=0.2)
    assert asp.elastic(rough, E, load=2.0, boundary="periodic").history is None


def test_the_kernel_of_a_half_space_gives_the_half_space(rough, sphere):
    def symbol(qx, qy):
        return 2.0 / np.hypot(qx, qy)

    plain = asp.elastic(rough, E, load=2.0, boundary="periodic", tolerance=1e-9)
    same = asp.elastic(rough, E, load=2.0, boundary="periodic", tolerance=1e-9, kernel=symbol)
    assert same.contact_area == plain.contact_area
    assert np.allclose(same.pressure, plain.pressure, rtol=0, atol=1e-6 * plain.max_pressure)
    in_metres = asp.elastic(rough, load=2.0, boundary="periodic", tolerance=1e-9, kernel=lambda qx, qy: symbol(qx, qy) / E)
    assert in_metres.approach == pytest.approx(same.approach, rel=1e-6)
    # A Winkler foundation: u = k p, so that the pressure is (w - h)/k, from whatever start.
    k = 2e-15
    foundation = asp.elastic(rough, approach=1e-6, boundary="periodic", kernel=np.full((25, 21), k), tolerance=1e-10)
    expected = np.maximum(1e-6 - foundation.initial_gap, 0.0) / k
    assert np.allclose(foundation.pressure, expected, rtol=0, atol=1e-8 * expected.max())
    # Free: only the cell itself yields.
    alone = np.zeros(sphere.cells)
    alone[0, 0] = k
    foundation = asp.elastic(sphere, approach=1e-6, kernel=alone, tolerance=1e-10)
    expected = np.maximum(1e-6 - foundation.initial_gap, 0.0) / k
    assert np.allclose(foundation.pressure, expected, rtol=0, atol=1e-8 * expected.max())
    for kernel, words in (
        (np.ones((3, 3)), "shape"),
        (np.full((25, 21), -1.0), "greater than 0"),
        (lambda qx, qy: 2.0 + np.tanh(qx + qy), "even"),
    ):
        with pytest.raises(asp.CaseError, match=words):
            asp.elastic(rough, E, load=2.0, boundary="periodic", kernel=kernel)
    with pytest.raises(asp.CaseError, match="contact_modulus"):
        asp.elastic(rough, load=1.0)


def test_findings_of_a_contact_warn(sphere):
    with pytest.warns(asp.ResultWarning, match="contact-at-border"):
        contact = asp.elastic(sphere, 1e6, load=1.0)
    assert "contact-at-border" in [found.code for found in contact.findings]


def test_a_contact_knows_that_its_lent_array_has_changed(sphere, tmp_path):
    loads = (1.0, 2.0, 4.0)
    alone = [asp.elastic(sphere, E, load=load) for load in loads]
    lent, several, previous = np.zeros(sphere.cells), [], None
    for load in loads:
        previous = asp.elastic(sphere, E, load=load, start=previous, out=lent)
        several.append(previous)
    for contact in several[:2]:
        for use in (lambda c: c.stiffness, lambda c: c.to_result(), lambda c: c.save(tmp_path / "a.zarr"), lambda c: c.plot, lambda c: c.spots(), copy.copy):
            with pytest.raises(asp.CaseError, match="out="):
                use(contact)
    # The last one has its pressure still; a stiffness that was asked for in time is kept.
    assert several[-1].stiffness == pytest.approx(alone[-1].stiffness, rel=1e-4)
    assert several[-1].to_result().field("pressure").sum() == pytest.approx(alone[-1].pressure.sum(), rel=1e-6)
    kept = asp.elastic(sphere, E, load=1.0, out=lent)
    stiffness, copied = kept.stiffness, copy.copy(kept)
    lent[...] = 0.0
    assert copied.to_result().field("pressure").sum() == pytest.approx(alone[0].pressure.sum(), rel=1e-6)
    assert kept.stiffness == stiffness == pytest.approx(alone[0].stiffness, rel=1e-4)
    fields = {"pressure": lent, "displacement": np.zeros(sphere.cells)}
    moved = asp.elastic(sphere, E, load=1.0, out=fields)
    assert np.allclose(moved.gap, alone[0].gap, rtol=0, atol=1e-10)
    fields["displacement"][...] = 0.0
    with pytest.raises(asp.CaseError, match="displacement"):
        moved.gap
    with pytest.raises(asp.CaseError, match="the same array"):
        asp.elastic(sphere, E, load=1.0, out={"gap": lent, "pressure": lent})
    with pytest.raises(asp.CaseError, match="the same array"):
        asp.elastic(sphere, E, load=1.0, out={"gap": lent, "pressure": lent[::-1]})


def test_what_was_computed_cannot_be_set(sphere):
    contact = asp.elastic(sphere, E, load=1.0)
    result = contact.to_result()
    for holder, name in ((contact, "load"), (contact, "foo"), (result, "foo"), (result, "load")):
        with pytest.raises(AttributeError, match="cannot be set"):
            setattr(holder, name, 99.0)
    assert "99" not in repr(contact)
    for values in (contact.gap, contact.x, contact.pressure, result.x, result.field_times, sphere.x):
        assert not values.flags.writeable
    assert "evolution()" in repr(result.plot) and "heights()" in repr(sphere.plot)


def test_a_curve_that_stops_keeps_its_contacts(sphere):
    with pytest.raises(asp.CaseError) as caught:
        asp.elastic(sphere, E, load=[1.0, 2.0, 1e9], hardness=1e9)
    assert np.allclose(caught.value.result.load, [1.0, 2.0])
