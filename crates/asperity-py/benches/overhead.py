"""What the Python layer costs: one case (512 x 512 cells, 100 steps) by the command, by `asperity.run` and by `asperity.solve`.

    python crates/asperity-py/benches/overhead.py target/release/asperity [runs]

Processes take turns, on one thread; the least processor time of each counts, so that other work on the machine does not. Package
and command must be of the same build profile.
"""

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

CASE = """
[domain]
cells = [512, 512]
size = ["1 mm", "1 mm"]
boundary = "periodic"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_gradient = 0.1
longest = "0.25 mm"
shortest = "8 um"
seed = 1
[[body]]
poisson = 0.38
material = { model = "prony", modulus = "young", equilibrium = "1973 MPa", terms = [{ modulus = "254.776 MPa", time = "8.93 s" }, { modulus = "263.6628 MPa", time = "117.96 s" }] }
[load]
control = "pressure"
history = { kind = "step", value = "10 MPa" }
[time]
end = "500 s"
steps = 100
[output]
fields = ["pressure"]
every = 100
"""
RUN = "import sys, asperity; asperity.run(sys.argv[1], output=sys.argv[2], force=True, progress=False)"
SOLVE = """
import asperity as asp
rough = asp.Surface.self_affine(cells=(512, 512), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.1, longest=0.25e-3, shortest=8e-6, seed=1)
pmma = asp.Prony(equilibrium=1973e6, terms=[(254.776e6, 8.93), (263.6628e6, 117.96)], poisson=0.38)
asp.solve(rough, pmma, pressure=10e6, times=asp.uniform(500.0, 100), boundary="periodic", every=100, progress=False)
"""


def processor_time(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    binary, runs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5
    with tempfile.TemporaryDirectory() as folder:
        case, result = Path(folder, "case.toml"), Path(folder, "case.zarr")
        case.write_text(CASE)
        commands = {
            "asperity run": [binary, "run", "--quiet", "--force", "-o", result, case],
            "asperity.run": [sys.executable, "-c", RUN, case, result],
            "asperity.solve": [sys.executable, "-c", SOLVE],
            "import asperity": [sys.executable, "-c", "import asperity"],
        }
        times = {name: [] for name in commands}
        for _ in range(runs):
            for name, command in commands.items():
                times[name].append(processor_time(command))
    base = min(times["asperity run"])
    for name, taken in times.items():
        print(f"{name:16} {min(taken):7.2f} s  {100 * (min(taken) / base - 1):+6.1f} %  of {', '.join(f'{t:.2f}' for t in taken)}")


if __name__ == "__main__":
    main()
