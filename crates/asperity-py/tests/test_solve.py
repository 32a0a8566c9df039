"""The package against closed forms and against the command: physics, bits, and what it says of wrong input."""

import json
import math
import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import asperity as asp

ROOT = Path(__file__).parents[3]
ZENER = dict(shear=25e6, shear_kelvin=25e6, retardation_time=1.0, poisson=0.5)


@pytest.fixture(scope="module")
def sphere():
    return asp.Surface.sphere(cells=(48, 40), size=(2e-3, 2e-3), radius=10e-3)


@pytest.fixture(scope="module")
def result(sphere):
    return asp.solve(sphere, asp.Zener(**ZENER), load=asp.step(1.0), times=asp.uniform(10.0, 10), fields=["pressure", "gap", "contact"])


def test_creep_of_a_sphere_grows_as_the_compliance_to_two_thirds(result):
    # While contact grows the approach is C(t)^(2/3) that of the first instant, exactly in the continuum; the error of
    # the grid, some 1e-3, is the same at both ends but for the radius it is seen with.
    for t, w in zip(result.time, result.approach):
        assert w / result.approach[0] == pytest.approx((2 - math.exp(-t)) ** (2 / 3), rel=2e-3)
    assert np.all(np.diff(result.contact_area) >= 0)
    assert np.allclose(result.load, 1.0, rtol=1e-12)


def test_fields_and_rows_agree(result):
    cell = result.size[0] * result.size[1] / (result.cells[0] * result.cells[1])
    for n, step in enumerate(result._field_steps):
        p = result.field("pressure", index=n)
        assert p.shape == (48, 40) and p.dtype == np.float64
        assert p.sum() * cell == pytest.approx(result.load[step], rel=1e-12)
        assert (p > 0).sum() * cell == pytest.approx(result.contact_area[step], rel=1e-12)
        assert np.array_equal(result.field("contact", index=n) > 0, p > 0)
    assert np.array_equal(result.field("pressure", time=9.6, method="nearest"), result.field("pressure"))


def test_the_same_bits_as_the_command(tmp_path, monkeypatch):
    case = tmp_path / "case.toml"
    case.write_text("""
[domain]
cells = [60, 48]
size = ["1 mm", "0.8 mm"]
[[surface]]
kind = "sphere"
radius = "5 mm"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_gradient = 0.05
longest = "0.4 mm"
shortest = "0.1 mm"
seed = 4
[[body]]
poisson = 0.38
hardness = "40 MPa"
material = { model = "prony", modulus = "young", equilibrium = "100 MPa", terms = [{ modulus = "50 MPa", time = "3 s" }] }
[load]
control = "load"
history = { kind = "trapezoid", peak = "0.5 N", rise = "1 s", hold = "4 s", fall = "2 s" }
[time]
end = "8 s"
steps = 16
[output]
fields = ["pressure", "gap"]
every = 1
""")
    monkeypatch.chdir(tmp_path)
    stored = asp.run(case, output=tmp_path / "case.zarr")
    kw = dict(cells=(60, 48), size=(1e-3, 8e-4))
    surface = asp.Surface.sphere(**kw, radius=5e-3) + asp.Surface.self_affine(**kw, hurst=0.8, rms_gradient=0.05, longest=4e-4, shortest=1e-4, seed=4)
    material = asp.Prony(equilibrium=100e6, terms=[(50e6, 3.0)], poisson=0.38)
    here = asp.solve(surface, material, load=asp.trapezoid(0.5, rise=1.0, hold=4.0, fall=2.0), times=asp.uniform(8.0, 16), hardness=40e6, fields=["pressure", "gap"], every=1)
    assert np.array_equal(stored.initial_gap, here.initial_gap)
    for name in asp._result.ROW:
        assert np.array_equal(getattr(stored, name), getattr(here, name), equal_nan=True), name
    for name in ("pressure", "gap"):
        assert np.array_equal(stored._stack(name), here._stack(name)), name
    # The command of the same source, where whoever runs the tests names it: one that lies about may be older.
    command = os.environ.get("ASPERITY_COMMAND")
    if command is not None:
        subprocess.run([command, "run", case, "--quiet", "-o", tmp_path / "cli.zarr"], check=True, capture_output=True)
        told = asp.open(tmp_path / "cli.zarr")
        assert np.array_equal(told.approach, here.approach)
        assert np.array_equal(told._stack("pressure"), here._stack("pressure"))


def test_a_march_lends_each_row(sphere):
    march = asp.march(sphere, asp.Zener(**ZENER), load=1.0, times=[0.5, 1.0])
    assert len(march) == 3 and march.times.tolist() == [0.0, 0.5, 1.0]
    steps = []
    for step in march:
        assert step.pressure.sum() > 0 and step.time == march.times[step.index]
        steps.append(step)
    with pytest.raises(asp.CaseError, match="moved on"):
        steps[0].pressure
    with pytest.raises(AttributeError, match="approach"):
        steps[0].aproach


@pytest.mark.parametrize(
    ("case", "words"),
    [
        ({"a": float("nan")}, "nan|NaN|float"),
        ({"a": None}, "table of keys"),
        ({"a": np.ones(3)}, "case file cannot"),
        ({"a": object()}, "case file cannot"),
        ("\n\0\n", "TOML"),
        ({"domain": {"cells": [8, 8]}}, "surface"),
    ],
)
def test_cases_as_text_and_keys_are_checked(case, words):
    for use in (asp.check, asp.run):
        with pytest.raises(asp.CaseError, match=words):
            use(case)


def test_controls_meet_each_other(sphere):
    material = asp.Elastic(young=1e8, poisson=0.3)
    by_load = asp.solve(sphere, material, load=2.0, times=[1.0])
    by_approach = asp.solve(sphere, material, approach=by_load.approach[-1], times=[1.0])
    assert by_approach.load[-1] == pytest.approx(2.0, rel=1e-5)
    by_pressure = asp.solve(sphere, material, pressure=2.0 / (2e-3 * 2e-3), times=[1.0])
    assert np.array_equal(by_pressure.field("pressure"), by_load.field("pressure"))


def test_an_elastic_contact_is_hertz(sphere):
    contact = asp.elastic(sphere, 1e9, load=20.0)
    exact = (9 * 20.0**2 / (16 * 10e-3 * 1e9**2)) ** (1 / 3)
    assert contact.approach == pytest.approx(exact, rel=3e-3)
    assert np.all(contact.gap[contact.pressure == 0] >= -1e-6 * contact.approach)
    assert contact.certificate < 1e-2


def test_a_flat_punch_presses_with_what_it_covers():
    punch = asp.Surface.flat_punch(cells=(32, 32), size=(1e-3, 1e-3), radius=2.5e-4)
    assert np.isinf(punch.gap()).any() and punch.gap().min() == 0
    contact = asp.elastic(punch, 1e9, load=1.0)
    # w = W / (2 a E*); a circle of cells has its radius to about half a cell of eight.
    assert contact.approach == pytest.approx(1.0 / (2 * 2.5e-4 * 1e9), rel=0.05)


def test_any_array_with_the_same_numbers_gives_the_same_result():
    z = asp.Surface.sphere(cells=(24, 20), size=(1e-3, 1e-3), radius=5e-3).heights
    micro = np.round(z * 1e9)
    kw = dict(load=0.1, times=[1.0], size=(1e-3, 1e-3))
    material = asp.Elastic(young=1e8, poisson=0.3)
    reference = asp.solve(z, material, **kw).approach
    # As arrays come out of files and sockets: eight bytes that begin anywhere.
    unaligned = np.frombuffer(b"?" + z.tobytes(), dtype=np.float64, offset=1).reshape(z.shape)
    assert not unaligned.flags.aligned
    for same in (unaligned, np.asfortranarray(z), np.repeat(z, 2, axis=0)[::2], z[::-1][::-1], z.astype(">f8"), np.ma.masked_array(z)):
        assert np.array_equal(asp.solve(same, material, **kw).approach, reference)
    whole = asp.solve(micro.astype(np.int64), material, **kw).approach
    assert np.array_equal(whole, asp.solve(micro, material, **kw).approach)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (dict(load=-1.0), "load"),
        (dict(load=float("nan")), "NaN"),
        (dict(load="1 N"), "SI units"),
        (dict(pressure=1.0), "one of them"),
        (dict(load=None), "none"),
        (dict(times=[1.0, 0.5]), "0.5"),
        (dict(times=[-1.0]), "-1"),
        (dict(boundary="open"), "'free' or 'periodic'"),
        (dict(scheme="euler"), "linear"),
        (dict(method="newton"), "projected-cg"),
        (dict(hardness=0.0), "hardness"),
        (dict(hardness=1.0), "hardness .*times the area"),
        (dict(fields=["stress"]), "stress"),
        (dict(tolerance=1.0), "tolerance"),
        (dict(every=2, field_times=[1.0]), "one of them"),
        (dict(field_times=[float("nan")]), "nan"),
        (dict(field_times=[-1.0]), "-1"),
        (dict(field_times=[0.5, 0.5]), "twice"),
        (dict(field_times=[1e9]), "the run ends"),
        (dict(material="rubber"), "material"),
        (dict(surface=np.zeros((4, 4))), "size"),
        (dict(surface=np.zeros(4), size=(1, 1)), "one length"),
        (dict(surface=np.zeros((4, 4), dtype=complex), size=(1, 1)), "real"),
        (dict(surface=np.full((4, 4), np.nan), size=(1, 1)), "NaN|nan"),
        (dict(surface=np.zeros((4, 4)), size=(1, 0)), "size"),
        (dict(surface=np.zeros((4, 4)), size="1 mm"), "two numbers"),
    ],
)
def test_wrong_input_is_named(sphere, change, words):
    given = dict(surface=sphere, material=asp.Elastic(young=1e8, poisson=0.3), load=1.0, times=[1.0])
    with pytest.raises(asp.CaseError, match=words):
        asp.solve(**{**given, **change})


def test_materials_name_what_is_wrong():
    for make, words in [
        (lambda: asp.Elastic(young=1e6), "poisson or bulk_modulus"),
        (lambda: asp.Elastic(young=1e6, shear=1e6, poisson=0.3), "only one of them"),
        (lambda: asp.Elastic(young=-1.0, poisson=0.3), "-1"),
        (lambda: asp.Elastic(young=1e6, poisson=0.6), "0.6"),
        (lambda: asp.Prony(equilibrium=1.0, terms=[(1.0, 0.0)], poisson=0.3), "0"),
        (lambda: asp.Prony(terms=[(1.0, 1.0)], poisson=0.3), "equilibrium"),
        (lambda: asp.Prony(equilibrium=1.0, terms=[1.0], poisson=0.3), "pairs"),
        (lambda: asp.Zener(shear=1.0, young_kelvin=1.0, retardation_time=1.0, poisson=0.3), "shear_kelvin"),
        (lambda: asp.Springpot(shear=1.0, time=1.0, order=2.0, window=(1.0, 2.0), poisson=0.3), "2"),
    ]:
        with pytest.raises(asp.CaseError, match=words):
            make()


def test_materials_meet_closed_forms():
    zener = asp.Zener(shear=2e6, shear_kelvin=1e6, retardation_time=3.0, poisson=0.5)
    t = np.array([[0.0, 1.0], [5.0, 50.0]])
    assert zener.creep_compliance(t) == pytest.approx(5e-7 + 1e-6 * (1 - np.exp(-t / 3)), rel=1e-13)
    assert zener.contact_compliance(t) == pytest.approx(zener.creep_compliance(t) / 4, rel=1e-13)
    # G(t) = G_inf + (G - G_inf) exp(-t / tau_R), tau_R = tau G_K / (G + G_K)
    equilibrium, pairs = zener.relaxation_terms
    assert equilibrium == pytest.approx(2e6 / 3, rel=1e-12)
    assert pairs == [(pytest.approx(4e6 / 3, rel=1e-12), pytest.approx(1.0, rel=1e-12))]
    springpot = asp.Springpot(shear=1e6, time=1.0, order=0.5, window=(1e-2, 1e2), poisson=0.5)
    assert springpot.creep_compliance([0.1, 10.0]) == pytest.approx(np.array([0.1, 10.0]) ** 0.5 / (1e6 * math.gamma(1.5)), rel=1e-3)
    abaqus = asp.Prony(instantaneous=10.0, terms=[(0.3, 1.0), (0.2, 5.0)], poisson=0.3)
    assert abaqus.relaxation_terms[0] == pytest.approx(5.0, rel=1e-14)


def test_pickles_and_copies_are_equal(result, tmp_path):
    material = asp.Prony(equilibrium=1e6, terms=[(1e6, 2.0)], poisson=0.3, hardness=1e7)
    again = pickle.loads(pickle.dumps(material))
    assert again == material and again.relaxation_terms == material.relaxation_terms
    copy = pickle.loads(pickle.dumps(result))
    assert np.array_equal(copy.approach, result.approach)
    assert np.array_equal(copy.field("gap"), result.field("gap"))
    assert "rows" in repr(copy) and "<table>" in copy._repr_html_()


def test_surfaces_are_written_read_and_described(tmp_path):
    surface = asp.Surface.self_affine(cells=(64, 48), size=(1e-3, 7.5e-4), hurst=0.8, rms_gradient=0.1, longest=5e-4, shortest=6e-5, seed=1)
    for ending in ("npz", "sdf", "x3p", "gwy", "nc"):
        path = tmp_path / f"rough.{ending}"
        surface.write(path)
        back = asp.Surface.read(path)
        assert back.cells == surface.cells and back.size == pytest.approx(surface.size, rel=1e-12)
        assert np.allclose(back.heights, surface.heights, rtol=0, atol=1e-12)
        with pytest.raises(FileExistsError, match="force"):
            surface.write(path)
    statistics = surface.statistics()
    assert statistics["sq"] == pytest.approx(np.sqrt(np.mean((surface.heights - surface.heights.mean()) ** 2)), rel=1e-12)
    assert statistics["m2"] * 2 == pytest.approx(0.1**2, rel=1e-9)
    q, c = surface.power_spectrum()
    assert np.all(np.diff(q) > 0) and np.all(c >= 0)
    (tmp_path / "bare.txt").write_text("1 2 3 4\n5 6 7 8\n9 10 11 13\n")
    with pytest.raises(OSError, match="height_unit"):
        asp.Surface.read(tmp_path / "bare.txt")
    with pytest.raises(OSError, match="size"):
        asp.Surface.read(tmp_path / "bare.txt", height_unit=1e-6)
    assert asp.Surface.read(tmp_path / "bare.txt", height_unit=1e-6, size=(1e-3, 1e-3)).heights[1, 0] == 2e-6
    with pytest.raises(OSError, match="none.sdf"):
        asp.Surface.read(tmp_path / "none.sdf")
    with pytest.raises(asp.CaseError, match="same cells"):
        surface + asp.Surface.sphere(cells=(4, 4), size=(1e-3, 7.5e-4), radius=1.0)


def test_a_solve_that_does_not_converge_carries_its_state(sphere):
    rough = sphere + asp.Surface.self_affine(cells=sphere.cells, size=sphere.size, hurst=0.8, rms_gradient=0.2, longest=1e-3, shortest=1e-4, seed=1)
    with pytest.raises(asp.ConvergenceError, match="tolerance") as caught:
        asp.solve(rough, asp.Zener(**ZENER), load=1.0, times=[1.0], max_iterations=2)
    error = caught.value
    assert error.residual > error.tolerance and error.iterations == 2 and error.time == 0.0
    assert error.best["pressure"].shape == sphere.cells
    with pytest.raises(asp.ConvergenceError) as caught:
        asp.elastic(rough, 1e9, load=1.0, max_iterations=2)
    assert caught.value.best.shape == sphere.cells


def test_results_become_xarray(result, tmp_path):
    xarray = pytest.importorskip("xarray")
    data = result.to_xarray()
    assert data.pressure.dims == ("field_time", "x", "y") and data.pressure.attrs["units"] == "Pa"
    assert float(data.pressure.sel(field_time=10.0).max()) == result.max_pressure[-1]
    assert asp.solve(data.initial_gap * -1, asp.Elastic(young=1e8, poisson=0.3), load=1.0, times=[1.0]).size == pytest.approx(result.size)
    assert isinstance(data, xarray.Dataset)


def test_results_are_drawn(result):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    axes = result.plot.evolution(log_time=True)
    assert axes.flat[1].get_ylabel() == "approach [µm]"
    assert result.plot.pressure(time=0.0).get_xlabel() == "x [mm]"
    for name in ("gap", "contact", "profile", "load_displacement"):
        getattr(result.plot, name)().figure.canvas.draw()
    plt.close("all")


def test_other_threads_run_and_interruption_is_heard(tmp_path):
    script = tmp_path / "long.py"
    script.write_text("""
import signal, threading, time
import asperity as asp
# A shell may start jobs that ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)
ticks = []
threading.Thread(target=lambda: [(ticks.append(1), time.sleep(0.01)) for _ in range(2000)], daemon=True).start()
surface = asp.Surface.self_affine(cells=(512, 512), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.3, longest=1e-3, shortest=5e-6, seed=1)
print("go", flush=True)
try:
    asp.solve(surface, asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5), load=0.2, times=asp.uniform(100.0, 5000), fields=[])
except KeyboardInterrupt:
    print("stopped", len(ticks), flush=True)
""")
    process = subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline().strip() == "go"
    time.sleep(1.0)
    pressed = time.monotonic()
    process.send_signal(signal.SIGINT)
    out = process.stdout.read().split()
    process.wait()
    # A second is promised; a busy machine gets a little more.
    assert time.monotonic() - pressed < 5.0
    assert out[0] == "stopped" and int(out[1]) >= 10, out


def test_adaptive_steps_have_the_bits_of_the_case(sphere, tmp_path):
    case = """
[domain]
cells = [48, 40]
size = ["2 mm", "2 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
[[body]]
poisson = 0.5
material = { model = "zener", shear = "25 MPa", shear_kelvin = "25 MPa", retardation_time = "1 s" }
[load]
control = "load"
history = { kind = "ramp", value = "1 N", duration = "1 s" }
[time]
end = "100 s"
spacing = "adaptive"
tolerance = 1e-3
first = "1 ms"
[output]
fields = ["pressure"]
every = 5
"""
    stored = asp.run(case, output=tmp_path / "case.zarr")
    here = asp.solve(sphere, asp.Zener(**ZENER), load=asp.ramp(1.0, duration=1.0), times=asp.adaptive(100.0, tolerance=1e-3, first=1e-3), every=5, progress=True)
    for name in asp._result.ROW:
        assert np.array_equal(getattr(stored, name), getattr(here, name), equal_nan=True), name
    assert np.array_equal(stored.field_times, here.field_times) and np.array_equal(stored._stack("pressure"), here._stack("pressure"))
    assert here.time[-1] == 100.0 and here.field_times[-1] == 100.0 and len(here) < 100
    # After the ramp the approach is known: C grows to twice its first value.
    w = here.approach[np.searchsorted(here.time, 50.0):]
    exact = (9 * 1.0 / (16 * 10e-3 * (2 / 100e6) ** -2)) ** (1 / 3)
    assert w == pytest.approx(exact, rel=5e-3)
    for wrong in (dict(tolerance=0.0), dict(first=-1.0), dict(first=float("nan"))):
        with pytest.raises(asp.CaseError):
            asp.solve(sphere, asp.Zener(**ZENER), load=1.0, times=asp.adaptive(100.0, **{**dict(tolerance=1e-3, first=1e-3), **wrong}), progress=False)


def test_a_forked_process_solves_too(sphere):
    # The threads of a pool do not live on in a fork; a process that waited for them would wait for ever.
    here = asp.solve(sphere, asp.Zener(**ZENER), load=1.0, times=[1.0], progress=False)
    if not hasattr(os, "fork"):
        pytest.skip("no fork here")
    code = """
import os, warnings, asperity as asp
warnings.simplefilter("ignore")
sphere = asp.Surface.sphere(cells=(48, 40), size=(2e-3, 2e-3), radius=10e-3)
solve = lambda: asp.solve(sphere, asp.Zener(shear=25e6, shear_kelvin=25e6, retardation_time=1.0, poisson=0.5), load=1.0, times=[1.0])
solve()
if os.fork() == 0:
    print(solve().approach[-1].hex(), flush=True)
    os._exit(0)
os.wait()
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == here.approach[-1].hex(), done.stderr


@pytest.mark.parametrize("number", [1, 2, 5])
def test_any_number_of_threads_gives_the_same_bits(sphere, number):
    rough = sphere + asp.Surface.self_affine(cells=sphere.cells, size=sphere.size, hurst=0.8, rms_gradient=0.05, longest=1e-3, shortest=1e-4, seed=1)
    reference = asp.solve(rough, asp.Zener(**ZENER), load=1.0, times=[1.0], progress=False)
    try:
        asp.set_threads(number)
        assert asp.threads() == number
        result = asp.solve(rough, asp.Zener(**ZENER), load=1.0, times=[1.0], progress=False)
    finally:
        asp.set_threads(None)
    assert np.array_equal(result.field("pressure"), reference.field("pressure"))
    for wrong in (0, -1, 1.5, "two", 100000):
        with pytest.raises(asp.CaseError, match="threads"):
            asp.set_threads(wrong)


def test_the_import_brings_nothing_heavy():
    # What only some of it needs is loaded when it is used: 0.15 s are promised for the import, most of them numpy's.
    heavy = ("matplotlib", "xarray", "IPython", "pandas", "distributed", "dask", "cloudpickle", "zarr", "SurfaceTopography", "scipy")
    code = f"import sys, asperity; print([m for m in {heavy} if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.strip() == "[]"


def test_examples_in_the_documentation_hold():
    import doctest
    import importlib
    import pkgutil

    pytest.importorskip("xarray")
    count = 0
    for found in pkgutil.iter_modules(asp.__path__):
        if found.name in ("_core", "_worker", "plot"):
            continue
        module = importlib.import_module(f"asperity.{found.name}")
        failed, tried = doctest.testmod(module)
        assert failed == 0, module.__name__
        count += tried
    failed, tried = doctest.testmod(asp)
    assert failed == 0 and count + tried >= 60


def test_stages_are_those_of_a_case(tmp_path):
    case = """
domain = { cells = [32, 32], size = ["1 mm", "1 mm"] }
surface = [{ kind = "sphere", radius = "10 mm" }]
body = [{ poisson = 0.5, material = { model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s" } }]
output = { fields = ["pressure"] }

[time]
end = "20 s"
spacing = "adaptive"
first = "10 ms"

[load]
stages = [
  { control = "load", history = { kind = "ramp", value = "2 mN", duration = "1 s" }, until = { approach = "2 um" }, duration = "1 s" },
  { control = "approach", history = { kind = "hold" }, duration = "5 s", steps = 4 },
  { control = "approach", history = { kind = "ramp", from = "current", value = "-5 um", duration = "2 s" }, until = "contact-lost" },
]
"""
    stored = asp.run(case, output=tmp_path / "case.zarr")
    sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    here = asp.solve(
        sphere,
        zener,
        times=asp.adaptive(20.0, first=1e-2),
        stages=[
            asp.Stage(load=asp.ramp(2e-3, duration=1.0), until=("approach", 2e-6), duration=1.0),
            asp.Stage(approach=asp.hold(), duration=5.0, times=asp.uniform(5.0, 4)),
            asp.Stage(approach=asp.ramp_to(-5e-6, duration=2.0), until="contact-lost"),
        ],
        progress=False,
    )
    for name in asp._result.ROW:
        assert np.array_equal(getattr(stored, name), getattr(here, name), equal_nan=True), name
    assert set(here.stage) == {0, 1, 2} and here.contact_area[-1] == 0.0

    # Adaptive steps end at output times, which stay through save and study.
    case = case.replace('["pressure"] }', '["pressure"], times = ["0.25 s", "3 s"] }')
    stored = asp.run(case, output=tmp_path / "times.zarr")
    assert 0.25 in stored.field_times and 0.25 in stored.time
    assert stored.to_xarray().field_time.values.tolist() == stored.field_times.tolist()
    stored.save(tmp_path / "again.zarr")
    again = asp.open(tmp_path / "again.zarr")
    assert np.array_equal(again.field_times, stored.field_times)
    assert np.array_equal(again._stack("pressure"), stored._stack("pressure"))


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (dict(stages=[]), "one at least"),
        (dict(stages=[1.0]), "asperity.Stage"),
        (dict(stages=[asp.Stage(load=1.0)], load=1.0), "one of them"),
        (dict(stages=[asp.Stage(load=1.0, approach=1.0)]), "one of them"),
        (dict(stages=[asp.Stage(load=1.0), asp.Stage(load=2.0)]), r"stages\[0\].*never ends"),
    ],
)
def test_stages_that_cannot_be_are_refused(wrong, words):
    sphere = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=10e-3)
    with pytest.raises(asp.CaseError, match=words):
        asp.solve(sphere, asp.Elastic(young=1e6, poisson=0.5), times=[1.0], progress=False, **wrong)


def test_an_elastic_contact_takes_a_hardness_for_each_cell():
    sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    soft = np.full((32, 32), 40e6)
    soft[:16] = 10e6
    contact = asp.elastic(sphere, 1e9, load=2.0, hardness=soft)
    assert contact.pressure[:16].max() == 10e6 and 10e6 < contact.pressure[16:].max() <= 40e6
    even = asp.elastic(sphere, 1e9, load=2.0, hardness=np.full((32, 32), 12e6))
    assert np.array_equal(even.pressure, asp.elastic(sphere, 1e9, load=2.0, hardness=12e6).pressure)
    for wrong, words in ((np.ones((3, 3)), r"\(3, 3\)"), (-soft, "greater than 0")):
        with pytest.raises(asp.CaseError, match=words):
            asp.elastic(sphere, 1e9, load=2.0, hardness=wrong)


def test_more_steps_than_there_may_be_are_refused_before_memory_is_taken(sphere):
    with pytest.raises(asp.CaseError, match="steps is 1000000000000"):
        asp.solve(sphere, asp.Zener(**ZENER), load=1.0, times=asp.uniform(1.0, 10**12))


def test_a_march_is_steered_between_rows(tmp_path):
    sphere = asp.Surface.sphere(cells=(24, 24), size=(1e-3, 1e-3), radius=10e-3)
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    times = asp.uniform(4.0, 16)
    run = asp.march(sphere, zener, load=asp.ramp(2e-3, duration=1.0), times=times)
    with pytest.raises(asp.CaseError, match="after the first row"):
        run.prescribe(load=1e-3)
    for row in run:
        if row.time == 2.0 and row.stage == 0:
            run.prescribe(approach=asp.hold())
        if row.time == 3.0 and row.stage == 1:
            with pytest.raises(asp.CaseError, match="^history.value is -0.001, but must be a force not less than 0"):
                run.prescribe(load=-1e-3)
            with pytest.raises(asp.CaseError, match="exactly one"):
                run.prescribe(load=1e-3, approach=1e-6)
            run.prescribe(pressure=1e-3 / 1e-6)
    steered = run.result()
    # The same as stages that end at these times, to the last bit.
    planned = asp.solve(sphere, zener, times=times, progress=False, stages=[
        asp.Stage(load=asp.ramp(2e-3, duration=1.0), duration=2.0),
        asp.Stage(approach=asp.hold(), duration=1.0),
        asp.Stage(pressure=1e-3 / 1e-6),
    ])
    for name in ("time", "load", "approach", "stage", "contact_area"):
        assert np.array_equal(getattr(steered, name), getattr(planned, name)), name
    steered.save(tmp_path / "steered.zarr")
    told = json.loads(asp.open(tmp_path / "steered.zarr").attributes["setup"])["prescribed"]
    assert [(one["row"], one["control"], one["history"]["kind"]) for one in told] == [(9, "approach", "hold"), (13, "pressure", "step")]
    assert steered.attributes["status"] == "complete" and len(run) == len(steered)
    with pytest.raises(asp.CaseError, match="before its last one"):
        run.prescribe(load=1e-3)
    # A line contact takes a load per length.
    line = asp.march(asp.Surface.cylinder(cells=64, size=2e-3, radius=10e-3), zener, load=1.0, times=[0.5, 1.0])
    next(line)
    line.prescribe(load=asp.ramp_to(2.0, duration=0.5))
    assert [row.load for row in line] == pytest.approx([2.0, 2.0], rel=1e-9)


def test_a_stage_ends_where_a_number_of_the_rows_reaches_a_value() -> None:
    sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)

    def pressed(until: dict[str, float]) -> asp.Result:
        return asp.solve(sphere, zener, times=asp.uniform(1.0, 20), stages=[asp.Stage(load=asp.ramp(2e-3, duration=1.0), until=until)])

    # A smooth number is met to a millionth of it; the contact fraction rises by cells of 1/1024 (or a few at once, by symmetry 8).
    result = pressed({"max_pressure": 2e4})
    assert abs(result.max_pressure[-1] - 2e4) <= 2e4 * 1e-6
    result = pressed({"contact_fraction": 0.05})
    assert result.contact_fraction[-2] < 0.05 <= result.contact_fraction[-1] <= 0.05 + 8 / 1024
    with pytest.raises(asp.CaseError, match="friction_coefficient.*slide"):
        pressed({"friction_coefficient": 0.1})
