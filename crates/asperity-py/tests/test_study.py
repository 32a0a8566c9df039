"""Parameter studies: the same bits as single runs, failures kept, stopped and killed ones resumed, on processes and on
dask."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import asperity as asp

xarray = pytest.importorskip("xarray")

CASE = """
[domain]
cells = [32, 32]
size = ["1 mm", "1 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
[[body]]
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s" }
[load]
control = "load"
history = { kind = "step", value = "1 mN" }
[time]
end = "5 s"
steps = 5
[output]
fields = ["pressure"]
"""


def zener(**changes):
    return asp.Zener(**{**dict(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5), **changes})


@pytest.fixture(scope="module")
def sphere():
    return asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)


@pytest.fixture()
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


def test_a_product_of_keys_has_the_bits_of_single_runs(case, tmp_path):
    over = {"load.history.value": ["1 mN", "2 mN"], "body[0].poisson": [0.3, 0.5]}
    data = asp.study(case, over, workers=2, fields=["pressure"])
    assert dict(data.sizes) == {"load.history.value": 2, "body[0].poisson": 2, "step": 6, "field_step": 6, "x": 32, "y": 32}
    assert data["load.history.value"].values.tolist() == [1.0, 2.0] and data["load.history.value"].attrs["units"] == "mN"
    assert data.time.dims == ("step",) and (data.status == "complete").all() and (data.steps == 6).all()
    for i, value in enumerate(over["load.history.value"]):
        for j, poisson in enumerate(over["body[0].poisson"]):
            keys = {"load.history.value": value, "body[0].poisson": poisson}
            alone = asp.run(case, set=keys, output=tmp_path / f"{i}{j}.zarr")
            here = data.isel({"load.history.value": i, "body[0].poisson": j})
            for name in asp._result.ROW:
                assert np.array_equal(here[name], getattr(alone, name), equal_nan=True), name
            assert np.array_equal(here.pressure, alone._stack("pressure"))


def test_text_and_dictionary_are_cases_too(case):
    values = {"load.history.value": ["1 mN"]}
    reference = asp.study(case, values)
    as_keys = {
        "domain": {"cells": [32, 32], "size": ["1 mm", "1 mm"]},
        "surface": [{"kind": "sphere", "radius": "10 mm"}],
        "body": [{"poisson": 0.5, "material": {"model": "zener", "shear": "1 MPa", "shear_kelvin": "1 MPa", "retardation_time": "1 s"}}],
        "load": {"control": "load", "history": {"kind": "step", "value": "1 mN"}},
        "time": {"end": "5 s", "steps": 5},
    }
    for same in (CASE, as_keys):
        assert np.array_equal(asp.study(same, values).approach, reference.approach)


def test_parameters_of_solve_labels_and_failures(sphere):
    given = dict(surface=sphere, times=[1.0, 2.0])
    over = {"material": {"soft": zener(), "stiff": zener(shear=5e6)}, "load": [0.001, -1.0, 0.002]}
    data = asp.study(given, over)
    assert data.material.values.tolist() == ["soft", "stiff"] and data.load_given.values.tolist() == [0.001, -1.0, 0.002]
    assert (data.status.sel(load_given=-1.0) == "failed").all()
    assert "load" in str(data.error.sel(material="soft", load_given=-1.0).item())
    assert np.isnan(data.approach.sel(load_given=-1.0)).all() and (data.steps.sel(load_given=-1.0) == 0).all()
    alone = asp.solve(sphere, zener(shear=5e6), load=0.002, times=[1.0, 2.0], progress=False)
    assert np.array_equal(data.approach.sel(material="stiff", load_given=0.002), alone.approach)


def pressed(x):
    ball = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    return asp.solve(ball, zener(), load=x, times=[1.0], progress=False)


def test_a_parameter_keeps_its_name_and_points_have_their_findings():
    data = asp.study(pressed, {"x": [1e-6, -1.0]})
    assert data.sizes["x"] == 2 and data.findings.values.tolist()[1] == -1
    # 1 uN presses two or three cells of 31 um.
    assert "few-contact-cells" in data.finding_codes.values[0] and data.findings.values[0] >= 1
    fields = asp.study(pressed, {"x": [1e-3]}, fields=["pressure"])
    assert fields.sizes["x_given"] == 1 and fields.pressure.dims[-2:] == ("x", "y")


def test_points_of_different_length_are_padded(sphere):
    points = [dict(times=[1.0], load=0.001), dict(times=[1.0, 2.0, 3.0], load=0.002)]
    data = asp.study(dict(surface=sphere, material=zener()), points)
    assert data.approach.dims == ("point", "step") and data.time.dims == ("point", "step")
    assert data.steps.values.tolist() == [2, 4]
    assert np.isnan(data.approach[0, 2:]).all() and np.isfinite(data.approach[1]).all()
    zipped = asp.study(dict(surface=sphere, material=zener(), times=[1.0]), {"load": [0.001, 0.002], "boundary": ["free", "periodic"]}, zip=True)
    assert zipped.sizes["point"] == 2 and zipped.boundary.values.tolist() == ["free", "periodic"]


def test_a_folder_keeps_points_and_knows_what_changed(case, tmp_path):
    folder = tmp_path / "study"
    first = asp.study(case, {"load.history.value": ["1 mN", "-1 mN"]}, folder=folder)
    assert first.status.values.tolist() == ["complete", "failed"]
    stamps = {path.name: path.stat().st_mtime_ns for path in folder.glob("*.zarr")}
    assert len(stamps) == 1
    more = asp.study(case, {"load.history.value": ["1 mN", "-1 mN", "2 mN"]}, folder=folder)
    assert more.status.values.tolist() == ["complete", "failed", "complete"]
    for name, stamp in stamps.items():
        assert (folder / name).stat().st_mtime_ns == stamp, "a finished point is not solved again"
    assert np.array_equal(more.approach[0], first.approach[0])
    case.write_text(CASE.replace('"10 mm"', '"20 mm"'))
    other = asp.study(case, {"load.history.value": ["1 mN"]}, folder=folder)
    # w of the sphere goes as R^(-1/3).
    assert float(other.approach[0, 0] / first.approach[0, 0]) == pytest.approx(2 ** (-1 / 3), rel=0.01)


def test_a_changed_file_of_the_case_makes_another_point(tmp_path):
    heights = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    heights.write(tmp_path / "ball.npz")
    case = tmp_path / "case.toml"
    case.write_text(CASE.replace('kind = "sphere"\nradius = "10 mm"', 'kind = "file"\npath = "ball.npz"\nlevel = "none"'))
    over = {"load.history.value": ["1 mN"]}
    first = asp.study(case, over, folder=tmp_path / "study")
    asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=20e-3).write(tmp_path / "ball.npz", force=True)
    second = asp.study(case, over, folder=tmp_path / "study")
    assert first.status.item() == second.status.item() == "complete"
    assert float(second.approach[0, 0]) < 0.9 * float(first.approach[0, 0])


def test_functions_of_scripts_and_modules(sphere, tmp_path, monkeypatch):
    (tmp_path / "my_model.py").write_text(textwrap.dedent("""
        import asperity as asp
        def ball(radius, load):
            print("this goes to stderr")
            if radius > 1:
                raise ArithmeticError("too large a ball")
            surface = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=radius)
            material = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
            return asp.solve(surface, material, load=load, times=[1.0])
        def number(radius):
            return 1.0
    """))
    monkeypatch.syspath_prepend(str(tmp_path))
    import my_model

    data = asp.study(my_model.ball, {"radius": [0.01, 2.0], "load": [0.001]})
    assert data.status.values[:, 0].tolist() == ["complete", "failed"]
    assert data.error.values[1, 0] == "ArithmeticError: too large a ball"
    alone = asp.solve(sphere, zener(), load=0.001, times=[1.0], progress=False)
    assert np.array_equal(data.approach[0, 0], alone.approach)
    assert "must return an asperity.Result" in asp.study(my_model.number, {"radius": [0.01]}).error.item()


def test_a_process_that_dies_takes_only_its_point(tmp_path, monkeypatch):
    (tmp_path / "deadly.py").write_text(textwrap.dedent("""
        import os, signal, asperity as asp
        def ball(n):
            if n == 1:
                os.kill(os.getpid(), signal.SIGKILL)
            surface = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=0.01)
            return asp.solve(surface, asp.Elastic(young=1e6, poisson=0.5), load=0.001, times=[1.0])
    """))
    monkeypatch.syspath_prepend(str(tmp_path))
    import deadly

    data = asp.study(deadly.ball, {"n": [0, 1, 2, 3]}, workers=1)
    assert data.status.values.tolist() == ["complete", "failed", "complete", "complete"]
    assert "signal 9" in data.error.values[1]


STOPPED = """
import signal, sys
import asperity as asp
# A shell may start jobs that ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)
case = sys.argv[1]
try:
    asp.study(case, {"load.history.value": ["1 mN", "2 mN", "3 mN"]}, folder=sys.argv[2], workers=1, threads=1)
except KeyboardInterrupt:
    print("stopped", flush=True)
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="signals as on Unix")
@pytest.mark.parametrize("way", ["SIGINT", "SIGKILL"])
def test_a_study_that_is_stopped_or_killed_goes_on_from_where_it_was(way, tmp_path):
    case = tmp_path / "case.toml"
    rough = '[[surface]]\nkind = "self-affine"\nhurst = 0.8\nrms_gradient = 0.1\nlongest = "0.5 mm"\nshortest = "0.05 mm"\nseed = 1\n[[body]]'
    case.write_text(CASE.replace("[[body]]", rough).replace("steps = 5", "steps = 300").replace("cells = [32, 32]", "cells = [96, 96]"))
    folder = tmp_path / "study"
    script = tmp_path / "script.py"
    script.write_text(STOPPED)
    process = subprocess.Popen([sys.executable, script, case, folder], stdout=subprocess.PIPE, text=True)

    def rows():
        counts = []
        for path in folder.glob("*.zarr"):
            try:
                counts.append(len(asp.open(path)))
            except OSError:
                pass  # it is just being made
        return counts

    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and not (len(rows()) >= 2 and min(rows()) >= 5):
        time.sleep(0.02)
    pressed = time.monotonic()
    process.send_signal(getattr(signal, way))
    out = process.communicate(timeout=30)[0]
    # A second is promised; a busy machine gets more.
    assert time.monotonic() - pressed < 10
    assert out.strip() == ("stopped" if way == "SIGINT" else "")
    # Its processes end with it: no result grows any more.
    time.sleep(1.0)
    before = sorted(rows())
    time.sleep(0.5)
    assert sorted(rows()) == before
    assert any(n < 301 for n in before), "nothing was left to do"
    data = asp.study(case, {"load.history.value": ["1 mN", "2 mN", "3 mN"]}, folder=folder)
    assert (data.status == "complete").all() and (data.steps == 301).all()
    alone = asp.run(case, set={"load.history.value": "2 mN"}, output=tmp_path / "alone.zarr")
    assert np.array_equal(data.approach.sel({"load.history.value": 2.0}), alone.approach)


def test_a_study_runs_from_a_script_without_a_guard_and_with_a_function_of_it(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(textwrap.dedent("""
        import asperity as asp
        def ball(radius):
            surface = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=radius)
            return asp.solve(surface, asp.Elastic(young=1e6, poisson=0.5), load=0.001, times=[1.0])
        given = dict(surface=asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=0.01), material=asp.Elastic(young=1e6, poisson=0.5), times=[1.0])
        print(asp.study(given, {"load": [0.001, 0.002]}).status.values.tolist())
        try:
            import cloudpickle
            print(asp.study(ball, {"radius": [0.01]}).status.values.tolist())
        except ImportError:
            print(["complete"])
    """))
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines() == ["['complete', 'complete']", "['complete']"], done.stderr


@pytest.mark.parametrize(
    ("over", "change", "words"),
    [
        ({}, {}, "no parameter"),
        ([], {}, "no points"),
        ({"load": []}, {}, "no values"),
        ({"load": "1 N"}, {}, "list"),
        ({"load": [0.001, 0.001]}, {}, "differ"),
        ([{"load": 0.001}, {"load": 0.001}], {}, "twice"),
        ([{"load": 0.001}, {"pressure": 1.0}], {}, "parameters"),
        ({"load": [1.0], "boundary": ["free", "periodic"]}, dict(zip=True), "same number"),
        ({"load": [0.001]}, dict(fields=["stress"]), "stress"),
        ({"load": [0.001]}, dict(workers=0), "workers"),
        ({"load": [0.001]}, dict(threads=1.5), "threads"),
        ({"load": [lambda: 0]}, {}, "no point can be solved"),
        ({"title": [threading.Lock()], "load": [0.001]}, {}, "sent to another process"),
    ],
)
def test_wrong_studies_are_refused(sphere, over, change, words):
    with pytest.raises(asp.CaseError, match=words):
        asp.study(dict(surface=sphere, material=zener(), times=[1.0]), over, **change)


def test_a_case_that_is_not_there_and_keys_that_are_not(tmp_path, case):
    with pytest.raises(asp.CaseError, match="none.toml"):
        asp.study(tmp_path / "none.toml", {"load.history.value": ["1 N"]})
    with pytest.raises(asp.CaseError, match="histori"):
        asp.study(case, {"load.histori.value": ["1 N"]})
    with pytest.warns(asp.ResultWarning, match=r"1 of 1 points failed; the first, load.history.value = -1 N: .*load"):
        data = asp.study(case, {"load.history.value": ["-1 N"]})
    assert data.status.item() == "failed" and "load" in data.error.item()


def test_a_dask_cluster_solves_the_points(case, sphere, tmp_path):
    distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        over = {"load.history.value": ["1 mN", "2 mN", "-1 mN"]}
        data = asp.study(case, over, client=client, fields=["pressure"])
        assert data.status.values.tolist() == ["complete", "complete", "failed"]
        here = asp.study(case, over, fields=["pressure"])
        assert data.drop_vars("error").equals(here.drop_vars("error"))
        folder = tmp_path / "study"
        given = dict(surface=sphere, material=zener(), times=[1.0])
        kept = asp.study(given, {"load": [0.001, 0.002]}, client=client, folder=folder, threads=1)
        stamps = {path.name: path.stat().st_mtime_ns for path in folder.glob("*.zarr")}
        assert len(stamps) == 2
        again = asp.study(given, {"load": [0.001, 0.002]}, folder=folder)
        assert again.equals(kept) and stamps == {path.name: path.stat().st_mtime_ns for path in folder.glob("*.zarr")}
        told = json.loads((folder / "study.json").read_text())
        assert told["parameters"] == ["load"] and len(told["points"]) == 2


def test_datasets_can_be_stored(case, tmp_path):
    pytest.importorskip("zarr", minversion="3")
    data = asp.study(case, {"load.history.value": ["1 mN", "-1 mN"]})
    data.to_zarr(tmp_path / "data.zarr", zarr_format=3)
    back = xarray.open_zarr(tmp_path / "data.zarr")
    assert np.array_equal(back.approach, data.approach, equal_nan=True) and back.status.values.tolist() == ["complete", "failed"]


def test_a_misspelt_parameter_is_an_error_at_once(tmp_path):
    ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    given = dict(surface=ball, material=asp.Elastic(young=1e6, poisson=0.5), times=[1.0])

    def function(load):
        raise AssertionError("no point is solved")

    for case, over, words in (
        (given, {"presure": [1.0, 2.0]}, "did you mean 'pressure'"),
        ({**given, "hardnes": 1.0}, {"load": [1.0]}, "did you mean 'hardness'"),
        (function, {"laod": [1.0]}, "did you mean 'load'"),
        (asp.solve, [{**given, "lod": 1.0}], "'lod'"),
        (CASE, {"load.history.valeu": ["1 N"]}, "valeu"),
    ):
        with pytest.raises(asp.CaseError, match=words):
            asp.study(case, over, folder=tmp_path / "never", progress=False)
    assert not list(tmp_path.glob("never/*.zarr"))


def test_values_with_units_become_numbers(sphere):
    class Quantity:
        def __init__(self, value, units):
            self.value, self.units = value, units

        def m_as(self, wanted):
            assert (self.units, wanted) == ("mN", "N")
            return np.asarray(self.value) * 1e-3

    given = dict(surface=sphere, material=zener(), times=[1.0])
    plain = asp.study(given, {"load": [1e-3, 2e-3]}, progress=False)
    labelled = xarray.DataArray([1.0, 2.0], attrs={"units": "mN"})
    for values in (Quantity([1.0, 2.0], "mN"), [Quantity(1.0, "mN"), Quantity(2.0, "mN")], labelled, xarray.DataArray([1e-3, 2e-3])):
        same = asp.study(given, {"load": values}, progress=False)
        assert same.load_given.values.tolist() == [1e-3, 2e-3] and np.array_equal(same.approach, plain.approach)
    with pytest.raises(asp.CaseError, match="text"):
        asp.study(CASE, {"load.history.value": labelled})


def test_a_study_that_cannot_run_is_an_error_at_once(sphere, tmp_path):
    given = dict(surface=sphere, material=zener(), times=[1.0])
    for case, over, words in (
        (given, {"hardness": [1e5]}, "load, pressure, approach or stages"),
        ({**given, "load": 1e-3}, {"pressure": [1e3]}, "load and pressure"),
        ({**given, "load": 1e-3, "gap": np.zeros((4, 4))}, {"hardness": [1e5]}, "surface or gap"),
        ({"surface": sphere, "material": zener()}, {"load": [1e-3]}, "'times'"),
        ({"surface": sphere, "material": zener(), "load": 1e-3, "pressure": 1.0, "boundary": "periodic"}, {"velocities": [[1.0]]}, "load and pressure"),
    ):
        with pytest.raises(asp.CaseError, match=words):
            asp.study(case, over, folder=tmp_path / "never", progress=False)
    assert not list(tmp_path.glob("never/*.zarr"))


def test_a_stopped_study_has_what_it_found(sphere, monkeypatch):
    given = dict(surface=sphere, material=zener(), times=[1.0])
    whole = asp.study(given, {"load": [1e-3, 2e-3]}, progress=False)
    there = asp._study.solved

    def pressed(*arguments):
        answers = there(*arguments)
        try:
            yield next(answers)
            raise KeyboardInterrupt
        finally:
            answers.close()

    monkeypatch.setattr(asp._study, "solved", pressed)
    with pytest.raises(KeyboardInterrupt) as caught:
        asp.study(given, {"load": [1e-3, 2e-3]}, progress=False, workers=1)
    data = caught.value.result
    assert data.status.values.tolist() == ["complete", "interrupted"] and np.array_equal(data.approach[0], whole.approach[0])
