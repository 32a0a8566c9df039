"""Misspelt words and values of the wrong kind are told at once, with what was meant."""

import inspect
import pathlib
import warnings

import numpy as np
import pytest

import asperity as asp

SIZE = (1e-3, 1e-3)


@pytest.fixture(scope="module")
def ball():
    return asp.Surface.sphere(cells=(16, 16), size=SIZE, radius=20e-3)


@pytest.fixture(scope="module")
def zener():
    return asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)


def test_words_get_a_hint(ball, zener):
    contact = asp.elastic(ball, 4e6, load=1e-3)
    solve = dict(load=1e-3, times=[1.0])
    for wrong, told in (
        (lambda: asp.leakage(contact.gap, size=SIZE, sides="perodic"), "'periodic'"),
        (lambda: asp.leakage(contact.gap, size=SIZE, direction="z"), "'x', 'y' or 'both'"),
        (lambda: contact.to_result().leakage(sides="close"), "'closed'"),
        (lambda: asp.solve(zener, ball, **solve), "the surface comes first"),
        (lambda: asp.solve(ball, zener, boundary="perodic", **solve), "did you mean 'periodic'"),
        (lambda: asp.elastic(ball, 4e6, load=1e-3, boundary="perodic"), "did you mean 'periodic'"),
        (lambda: asp.solve(ball, zener, scheme="liner", **solve), "did you mean 'linear'"),
        (lambda: asp.solve(ball, zener, fields=["presure"], **solve), "did you mean 'pressure'"),
        (lambda: asp.solve(ball, zener, quantities=["contact_spot"], **solve), "did you mean 'contact_spots'"),
        (lambda: contact.to_result().field("presure"), "did you mean 'pressure'"),
        (lambda: asp.elastic("rough.sur", 1e9, load=1.0), r"Surface\.read\('rough.sur'\)"),
        (lambda: asp.solve(pathlib.Path("rough.sur"), zener, **solve), r"Surface\.read\('rough.sur'\)"),
        (lambda: zener.relaxation_modulus(1.0, measure="bulk"), "'young' or 'shear'"),
        (lambda: asp.Stage(load=1.0, until="contact-los"), "'contact-lost'"),
        (lambda: asp.Stage(load=1.0, until=lambda row: row.load > 1.0), "until is <function.*'contact-lost'"),
        (lambda: asp.Stage(load=1.0, until=("load", 1.0, 2.0)), "'contact-lost'"),
        (lambda: asp.Stage(load=1.0, until={"contact_fraction": 0.1, "load": 1.0}), "one number of the rows"),
        (lambda: asp.Stage(load=1.0, until={"elastic_energy": 0.1}), "elastic_energy"),
        (lambda: asp.Stage(load=1.0, until={"aproach": 1.0}), "did you mean 'approach'"),
        (lambda: asp.Layer(thickness=1.0, material=zener, interface="glued"), "'bonded' or 'slip'"),
        (lambda: asp.persson_friction(ball, zener, pressure=1.0, velocities=[1.0], correction="persn"), "'yang-persson' or 'none'"),
        (lambda: asp.solve(ball, zener, on_step=5, **solve), "on_step is 5"),
        (lambda: asp.solve(ball, zener, quantities=["pressure_histogram"], largest_pressure=-1.0, **solve), "largest_pressure is -1 Pa"),
        (lambda: asp.solve(ball, zener, quantities=["gap_histogram"], largest_gap=float("nan"), **solve), "largest_gap is nan m"),
        (lambda: asp.run({}, set={"load.history.value": object()}), "load.history.value is .*as text"),
    ):
        with pytest.raises(asp.CaseError, match=told):
            wrong()
    for call, more in ((asp.slide, dict(velocity=1.0, times=[1.0])), (asp.steady, dict(velocities=[1.0]))):
        with pytest.raises(TypeError, match=f"{call.__name__}.*did you mean 'boundary'"):
            call(ball, zener, load=1e-3, boundry="free", **more)


def test_missing_attributes_are_missing(ball, zener):
    strip = asp.Surface.cylinder(cells=(64,), size=(1e-3,), radius=20e-3)
    contact = asp.elastic(strip, 4e6, load=10.0)
    plane = asp.solve(ball, zener, load=1e-3, times=[1.0])
    for holder, name, told in ((strip, "y", "no y"), (contact, "y", "no y"), (contact.to_result(), "y", "no y"), (plane, "field_velocities", "field_times")):
        assert not hasattr(holder, name)
        with pytest.raises(AttributeError, match=told):
            getattr(holder, name)
        assert inspect.getmembers(holder)


def test_findings_and_attributes_are_copies(ball):
    contact = asp.elastic(ball, 4e6, load=1e-3)
    leak = asp.leakage(contact.gap + 1e-9, size=SIZE)
    result = contact.to_result()
    for holder in (contact, leak, result):
        count = len(holder.findings)
        holder.findings.append(1)
        assert len(holder.findings) == count
    result.attributes["findings"].append(1)
    assert len(result.to_xarray().attrs["findings"]) == len(contact.to_xarray().attrs["findings"])


def test_generators_are_lists(ball, zener):
    assert asp.elastic(ball, 4e6, load=(n * 1e-3 for n in (1, 2))).load.tolist() == [1e-3, 2e-3]
    assert asp.solve(ball, zener, load=asp.table((t, 1e-3) for t in (0.0, 1.0)), times=(float(n) for n in (1, 2))).time[-1] == 2.0
    terms = [(1e6, 1.0), (2e6, 10.0)]
    assert asp.Prony(equilibrium=1e6, terms=iter(terms), poisson=0.5) == asp.Prony(equilibrium=1e6, terms=terms, poisson=0.5)
    assert asp.Creep(instantaneous=1e-6, terms=((1e-6, t) for t in (1.0, 2.0)), poisson=0.5).creep_terms[1] == [(1e-6, 1.0), (1e-6, 2.0)]


def test_a_study_warns_once_in_the_words_of_its_caller(ball, zener):
    pytest.importorskip("xarray")
    given = dict(case=dict(surface=ball, material=zener, times=[1.0]), over={"load": [1e-3, 2e-3]}, progress=False, workers=1)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        data = asp.study(**given)
    ours = [one for one in told if issubclass(one.category, asp.ResultWarning)]
    assert ours and len(ours) == len({str(one.message).rsplit("[", 1)[1] for one in ours})
    assert all("load = 0.001" in str(one.message) and one.filename == __file__ for one in ours)
    assert data.load_given.attrs["units"] == "N"
    with warnings.catch_warnings():
        warnings.simplefilter("error", asp.ResultWarning)
        with pytest.raises(asp.ResultWarning) as error:
            asp.study(**given)
    assert (error.value.result.status == "complete").all()
    with pytest.raises(asp.CaseError, match="'1 mN'"):
        asp.study(given["case"], over={"load": ["1 mN", "2 mN"]}, progress=False)


def test_arguments_of_the_wrong_kind_are_named(ball, zener):
    for wrong, told in (
        (dict(quantities=None), "quantities is None"),
        (dict(fields=None), "fields is None"),
        (dict(fields=["gap", "gap"]), "fields holds 'gap' twice"),
        (dict(output=1), "output is 1"),
        (dict(hardness=np.ones((3, 3))), r"\(3, 3\), but must have \(16, 16\)"),
    ):
        with pytest.raises(asp.CaseError, match=told):
            asp.solve(ball, zener, load=1e-3, times=[1.0], **wrong)
    with pytest.raises(TypeError, match="solve.*did you mean 'boundary'"):
        asp.solve(ball, zener, load=1e-3, times=[1.0], boundry="free")
    with pytest.raises(TypeError, match="solve.*'times'"):
        asp.solve(ball, zener, load=1e-3)
    parameters = inspect.signature(asp.solve).parameters
    assert list(parameters)[:2] == ["surface", "material"] and parameters["fields"].default == ("pressure",)


def test_counts_stay_whole_numbers_on_disk(ball, zener, tmp_path):
    result = asp.solve(ball, zener, load=1e-3, times=[1.0], output=tmp_path / "ball.zarr")
    held = asp.solve(ball, zener, load=1e-3, times=[1.0])
    for name in ("iterations", "convolutions", "stage"):
        assert getattr(result, name).dtype == getattr(held, name).dtype == np.int64


def test_a_missing_file_is_one(tmp_path):
    for read in (asp.Surface.read, asp.fit_file, asp.open, asp.shift_table, asp.run, asp.check):
        with pytest.raises(FileNotFoundError, match="none"):
            read(tmp_path / "none.x3p")
