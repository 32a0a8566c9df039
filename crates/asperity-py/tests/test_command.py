"""The command that the wheel carries."""

import json
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pytest

import asperity as asp

#: The script that installing the wheel makes, and the same by the name of the package.
SCRIPT = Path(sysconfig.get_path("scripts")) / f"asperity{sysconfig.get_config_var('EXE')}"
COMMANDS = {"script": [str(SCRIPT)], "module": [sys.executable, "-m", "asperity"]}

CASE = """
domain = { cells = [%(cells)d, %(cells)d], size = ["1 mm", "1 mm"] }
surface = [{ kind = "sphere", radius = "20 mm" }]
body = [{ poisson = 0.5, material = { model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s" } }]
load = { control = "load", history = { kind = "ramp", value = "1 mN", duration = "10 s" } }
time = { end = "10 s", steps = %(steps)d }
output = { fields = [] }
"""


def run(words, **options):
    return subprocess.run(words, capture_output=True, text=True, encoding="utf-8", timeout=300, **options)


@pytest.mark.parametrize("command", COMMANDS.values(), ids=COMMANDS)
def test_it_runs_a_case_from_any_folder(command, tmp_path):
    (tmp_path / "case.toml").write_text(CASE % dict(cells=32, steps=4))
    ran = run([*command, "run", "case.toml", "-o", "a.zarr", "--json"], cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)["status"] == "complete"
    same = asp.run(tmp_path / "case.toml", output=tmp_path / "b.zarr")
    assert (asp.open(tmp_path / "a.zarr").approach == same.approach).all()


def test_its_version_is_that_of_the_package():
    assert run([*COMMANDS["script"], "--version"]).stdout.split() == ["asperity", asp.__version__]


@pytest.mark.parametrize(("words", "code"), [(["--help"], 0), (["run", "gone.toml"], 2), (["nonsense"], 2)])
def test_exit_codes_are_those_of_the_command(words, code, tmp_path):
    ran = run([*COMMANDS["module"], *words], cwd=tmp_path)
    assert ran.returncode == code
    assert "Usage: asperity" in ran.stdout + ran.stderr or "gone.toml" in ran.stderr


if sys.platform != "win32":  # where one process cannot press Ctrl-C for another

    def test_ctrl_c_ends_a_run_and_keeps_its_rows(tmp_path):
        (tmp_path / "case.toml").write_text(CASE % dict(cells=128, steps=20000))
        words = [*COMMANDS["script"], "run", "case.toml", "-o", "a.zarr"]
        process = subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        rows = tmp_path / "a.zarr" / "zarr.json"
        deadline = time.monotonic() + 120
        while not rows.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=120)
        assert process.returncode == 130, said
        assert "Traceback" not in said
        assert 0 < len(asp.open(tmp_path / "a.zarr").time) < 20001


def test_it_needs_no_file_of_the_source_tree(tmp_path):
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    folder = Path(shutil.copytree(Path(asp.__file__).parent, tmp_path / "elsewhere" / "asperity")).parent
    ran = run([sys.executable, "-c", "import asperity.__main__ as m; m.main()", "new", "hertz", "h.toml"],
              cwd=folder, env=environment)
    assert ran.returncode == 0, ran.stderr
    assert "[domain]" in (folder / "h.toml").read_text(encoding="utf-8")
