"""What a study reads from its folder: nothing that was computed with something else."""

import importlib
import os
import subprocess
import sys
import textwrap
import threading
import types
import warnings

import pytest

import asperity as asp
from asperity._digest import Walk

pytest.importorskip("xarray")

MODEL = """
import math
import {helpers}
import asperity as asp
RADIUS = 0.01
class Rubber:
    young = 1e6
    def material(self):
        return asp.Elastic(young=self.young, poisson=0.5)
rubber = Rubber()
def surface(radius):
    return asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=radius)
def made():
    height = RADIUS
    def ball(load, times=(1.0,)):
        from {helpers} import inner
        return asp.solve(surface(height * {helpers}.FACTOR), rubber.material(), load=load * inner.scale(), times=times, progress=False)
    return ball
"""


def hashed(function):
    return Walk().parts(function)


@pytest.fixture()
def model(tmp_path, monkeypatch, request):
    """A module of the user, with a package of helpers beside it."""
    name = f"helpers_{abs(hash(request.node.name))}"
    (tmp_path / name).mkdir()
    (tmp_path / name / "__init__.py").write_text("from . import inner\nFACTOR = 1.0\n")
    (tmp_path / name / "inner.py").write_text("def scale():\n    return 1.0\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()

    def load(old="", new=""):
        module = types.ModuleType("my_model")
        exec(MODEL.replace(old, new).format(helpers=name) if old else MODEL.format(helpers=name), vars(module))
        return module

    return load, name, tmp_path


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("RADIUS = 0.01", "RADIUS = 0.02"),  # a global that is held in a closure
        ("young = 1e6", "young = 2e6"),  # an attribute of the class of an object
        ("rubber = Rubber()", "rubber = Rubber(); rubber.young = 2e6"),  # of the object itself
        ("young=self.young", "young=2 * self.young"),  # a method
        ("radius=radius", "radius=2 * radius"),  # a function that the function calls
        ("(1.0,)", "(2.0,)"),  # a default
        ("load * inner", "2 * load * inner"),  # its own code
    ],
)
def test_what_a_function_reaches_makes_another_point(model, old, new):
    load, _, _ = model
    assert hashed(load().made()) == hashed(load().made())
    assert hashed(load(old, new).made()) != hashed(load().made())


def test_modules_of_the_user_count_by_their_source(model):
    load, name, folder = model
    before = hashed(load().made())
    sys.modules[name].FACTOR = 2.0
    assert hashed(load().made()) != before, "a number that was set at run time"
    sys.modules[name].FACTOR = 1.0
    assert hashed(load().made()) == before
    (folder / name / "inner.py").write_text("def scale():\n    return 2.0\n")
    assert hashed(load().made()) != before


def test_the_same_function_has_the_same_digest_in_another_process(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        MODEL.format(helpers="math").replace("math.FACTOR", "math.pi").replace("from math import inner", "inner = None").replace(" * inner.scale()", "")
        + textwrap.dedent("""
        import threading, logging
        from asperity._digest import Walk
        words, log = {"a", "b", "c", "d"}, logging.getLogger("x")
        def another(load): return made()(load), words, log, asp.fit_dma, threading.Thread, another
        print(Walk().parts(another))
        """)
    )
    told = {subprocess.run([sys.executable, script], capture_output=True, text=True, check=True).stdout for _ in range(2)}
    assert len(told) == 1 and len(told.pop().strip()) == 64


def test_what_cannot_be_known_is_told_where_points_are_read(tmp_path, monkeypatch):
    note = tmp_path / "note.txt"
    note.write_text("1e6")
    lock, path = threading.Lock(), str(note)
    ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=1e-2)

    def pressed(load):
        with lock, open(path, encoding="utf-8") as file:
            return asp.solve(ball, asp.Elastic(young=float(file.read()), poisson=0.5), load=eval("load"), times=[1.0], progress=False)

    walk = Walk()
    walk.parts(pressed)
    assert [words.partition(" ")[0] for words in walk.unknown] and walk.files == {path}
    assert any("lock" in words for words in walk.unknown) and any("eval" in words for words in walk.unknown)
    monkeypatch.setattr(asp._study, "solved", lambda tasks, *_: ((n, asp._points.solve_point(task)) for n, task in enumerate(tasks)))
    folder = tmp_path / "study"
    with warnings.catch_warnings():
        warnings.filterwarnings("error", "[0-9]+ point")
        first = asp.study(pressed, {"load": [1e-3]}, folder=folder, progress=False)
    assert first.status.item() == "complete", first.error.item()
    with pytest.warns(UserWarning, match="not known whether this changed"):
        asp.study(pressed, {"load": [1e-3]}, folder=folder, progress=False)


def test_a_changed_helper_is_solved_again(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(tmp_path))
    text = MODEL.format(helpers="math").replace("math.FACTOR", "1.0").replace("from math import inner", "").replace(" * inner.scale()", "") + "\nball = made()\n"
    (tmp_path / "my_study.py").write_text(text.replace("return ball", "ball.__qualname__ = 'ball'\n    return ball"))
    importlib.invalidate_caches()
    module = importlib.import_module("my_study")
    folder = tmp_path / "study"
    first = asp.study(module.ball, {"load": [1e-3]}, folder=folder, progress=False)
    assert first.status.item() == "complete", first.error.item()
    again = asp.study(module.ball, {"load": [1e-3]}, folder=folder, progress=False)
    assert again.equals(first) and len(list(folder.glob("*.zarr"))) == 1
    (tmp_path / "my_study.py").write_text((tmp_path / "my_study.py").read_text().replace("young = 1e6", "young = 8e6  # stiffer"))
    importlib.reload(module)
    stiffer = asp.study(module.ball, {"load": [1e-3]}, folder=folder, progress=False)
    # w of the sphere goes as E^(-2/3); a grid of 16 cells is off by less than a tenth.
    assert float(stiffer.approach[0, 0] / first.approach[0, 0]) == pytest.approx(8 ** (-2 / 3), rel=0.1)
    monkeypatch.delitem(sys.modules, "my_study")


def test_functions_of_a_script_within_arguments(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(textwrap.dedent("""
        import sys, asperity as asp
        def rising(t):
            return 1e-3 * (1.0 + t)
        given = dict(surface=asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=0.01), material=asp.Elastic(young=1e6, poisson=0.5), times=[1.0])
        if "none" in sys.argv:
            sys.modules["cloudpickle"] = None
        try:
            data = asp.study(given, {"load": {"rising": rising}}, progress=False)
            print(data.status.values.tolist(), round(data["load"][0, -1].item(), 12))
        except asp.CaseError as error:
            print(error)
    """))
    without = subprocess.run([sys.executable, "-W", "ignore", script, "none"], capture_output=True, text=True, timeout=60)
    assert "'rising' of this script or notebook cannot be sent to another process: install cloudpickle" in without.stdout, without.stderr
    pytest.importorskip("cloudpickle")
    told = subprocess.run([sys.executable, "-W", "ignore", script], capture_output=True, text=True, timeout=60)
    assert told.stdout.startswith("['complete'] 0.002"), (told.stdout, told.stderr)


def test_a_wrong_case_is_an_error_at_once(tmp_path):
    case = """
    [domain]
    cells = [16, 16]
    size = ["1 mm", "1 mm"]
    [[surface]]
    kind = "sphere"
    radius = "10 mm"
    [[body]]
    poisson = 0.7
    material = { model = "elastic", young = "1 MPa" }
    [load]
    control = "load"
    history = { kind = "step", value = "1 mN" }
    [time]
    end = "1 s"
    steps = 1
    """
    with pytest.raises(asp.CaseError, match="no point can be solved.*(\n.*)*poisson"):
        asp.study(case, {"load.history.value": ["1 mN", "2 mN"]}, folder=tmp_path / "never")
    # What varies may be what the case lacks, and a value that is wrong is that of its point.
    cured = asp.study(case, {"body[0].poisson": [0.3, 0.9]}, progress=False)
    assert cured.status.values.tolist() == ["complete", "failed"]
    ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=0.01)
    with pytest.raises(asp.CaseError, match="no point can be solved: .*material is 3"):
        asp.study(dict(surface=ball, material=3, times=[1.0]), {"load": [1e-3, 2e-3]}, folder=tmp_path / "never")
    assert not list(tmp_path.glob("never/*.zarr"))


HELPER = "FACTOR = 1.0\nCALLS = 0\n\n\ndef scale(load):\n    global CALLS\n    CALLS += 1\n    return FACTOR * load\n"


@pytest.fixture()
def helper(tmp_path, monkeypatch):
    """A module of the user that was written before this program began."""
    path = tmp_path / "a_helper_of_mine.py"
    path.write_text(HELPER)
    os.utime(path, (1e9, 1e9))
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    monkeypatch.delitem(sys.modules, "a_helper_of_mine", raising=False)
    return importlib.import_module("a_helper_of_mine"), path


def test_a_module_that_was_changed_in_memory_is_refused(helper, monkeypatch):
    pytest.importorskip("xarray")
    module, path = helper
    ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=1e-2)

    def pressed(load):
        return asp.elastic(ball, 4e6, load=module.scale(load))

    def study():
        return asp.study(pressed, {"load": [1e-3]}, progress=False, workers=1)["load"].item()

    # Another process reads the source, where a number that the module itself changes is no constant.
    module.CALLS = 7
    assert study() == pytest.approx(1e-3, rel=1e-12)
    monkeypatch.setattr(module, "FACTOR", 2.0)
    with pytest.raises(asp.CaseError, match="a_helper_of_mine.FACTOR is 2.0 here, but 1.0 in its source"):
        study()
    monkeypatch.undo()
    monkeypatch.setattr(module, "scale", lambda load: 3 * load)
    with pytest.raises(asp.CaseError, match="a_helper_of_mine.scale is a function of .* here"):
        study()


def test_a_module_that_was_edited_since_is_told(helper):
    pytest.importorskip("xarray")
    module, path = helper
    path.write_text(HELPER.replace("1.0", "2.0"))
    ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=1e-2)

    def pressed(load):
        return asp.elastic(ball, 4e6, load=module.scale(load)).to_result()

    with pytest.warns(UserWarning, match="FACTOR is 1.0 here, but 2.0 in its source, which is what the processes of the study read"):
        data = asp.study(pressed, {"load": [1e-3]}, progress=False, workers=1)
    assert data["load"].item() == pytest.approx(2e-3, rel=1e-12)


def test_the_environment_and_files_that_are_not_named_are_told(tmp_path, monkeypatch):
    def of_environment():
        return float(os.environ["ASPERITY_TEST_YOUNG"])

    def of_file(name):
        return np.loadtxt(f"{tmp_path}/{name}.txt")

    walk = Walk()
    walk.parts(of_environment)
    assert walk.unknown == [f"the variables of the environment that {of_environment.__qualname__} reads"]
    walk = Walk()
    walk.parts(of_file)
    assert walk.readers == {of_file.__qualname__} and not walk.files
