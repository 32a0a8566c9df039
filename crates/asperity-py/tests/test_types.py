"""Type checkers find misspelt words, and accept what works."""

import os
import pathlib
import subprocess
import sys

import pytest

import asperity as asp

pytest.importorskip("mypy", reason="mypy is not installed")

RIGHT = """
import asperity as asp, numpy as np
ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
total = sum([ball, ball + np.zeros((8, 8)), -ball])
result = asp.open("a.zarr")
pressure = result.field("pressure")
asp.fit_relaxation(np.ones(3), np.ones(3), modulus="shear")
code: str = result.findings[0].code
asp.cite("bibtex")
ball.level("plane")
asp.elastic(ball, 1e6, load=1.0).stiffness
asp.Stage(load=1.0, until=("approach", 2e-6))
radius: float = ball.radius + asp.ramp(1.0, duration=2.0).duration
text: str = asp.solve(ball, asp.Elastic(young=1e6, poisson=0.5), load=lambda t: 2.0 * t, breaks=[1.0], times=[2.0]).methods(bibtex=True)
misfit = asp.Relaxation(lambda t: 1e6, window=(1.0, 2.0), poisson=0.5).fit
load = np.float32(1.0)
asp.elastic(ball, np.int64(10**6), load=load, size=np.ones(2)).to_xarray().pressure.mean()
asp.solve(ball, asp.Elastic(young=1e6, poisson=0.5), load=asp.ramp(load, duration=np.float32(1.0)), times=[1.0]).leakage().leak_rate.sum()
below = asp.stress(result, depths="auto").to_xarray("mises")
asp.leakage(np.ones((8, 8)), size=(1.0, 1.0), sides="closed").to_xarray()
held = result.field("gap", time=1.0, method="nearest")
ball.level().fill("nearest").filter(shortest=2e-6, edge="gaussian").window().flip("x")
"""
WRONG = [
    'asp.open("a.zarr").field("presure")',
    'ball.level("plan")',
    'asp.fit_relaxation(np.ones(3), np.ones(3), modulus="shearing")',
    'asp.fit_dma(np.ones(3), np.ones(3), np.ones(3), moduli="storge")',
    'asp.cite("bibtx")',
    'asp.open("a.zarr").findings[0].sevrity',
    'ball + "a"',
    'ball.raduis',
    'asp.elastic(ball, 1e6, load=1.0).stifness',
    'ball.fill("harmonc")',
    'ball.filter(edge="shrp")',
    'ball.window("hanning")',
    'ball.flip("z")',
    'asp.leakage(np.ones((8, 8)), size=(1.0, 1.0), sides="perodic")',
    'asp.Layer(thickness=1.0, material=asp.Elastic(young=1e6, poisson=0.5), interface="glued")',
    'asp.Stage(load=1.0, until="contact-los")',
    'asp.open("a.zarr").field("gap", time=1.0, method="linear")',
    'asp.elastic(object(), 1e6, load=1.0)',
]


def test_misspelt_words_are_found(tmp_path):
    text = RIGHT + "\n".join(WRONG) + "\n"
    (tmp_path / "script.py").write_text(text)
    package = pathlib.Path(asp.__file__).parent.parent
    # mypy finds installed packages by itself, and refuses to be told where.
    path = {} if "site-packages" in package.parts else {"MYPYPATH": str(package)}
    found = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "script.py"],
        cwd=tmp_path, env={**os.environ, **path}, capture_output=True, text=True,
    )  # fmt: skip
    lines = [int(line.split(":")[1]) for line in found.stdout.splitlines() if line.startswith("script.py") and ": error:" in line]
    first = RIGHT.count("\n") + 1
    assert lines == list(range(first, first + len(WRONG))), found.stdout + found.stderr
