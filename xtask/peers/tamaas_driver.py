"""Tamaas: elastic contact by Polonsky, Keer and Rey; viscoelastic contact of a generalised Maxwell solid.

Its wheel is serial. E and nu are set before the non-periodic operator is registered, and the operator is set on the
solver: otherwise the modulus enters twice, or the domain stays periodic. The relaxed shear modulus of the Maxwell
solver is 1.
"""

import numpy as np
import tamaas as tm

from common import answer, case, clock

tm.set_log_level(tm.LogLevel.error)
c = case()
n = c["cells"]
# Its surfaces are heights with the apex up.
surface = np.ascontiguousarray(-c["gap"])
model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1.0, 1.0], [n, n])
if c["case"] == "elastic":
    model.E, model.nu = 1.0, 0.0
else:
    # mu = E/3 = 1: E* = 4, so lengths are scaled by the pressure.
    model.E, model.nu = 3.0, 0.5
if c["boundary"] == "free":
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")


def ready(solver):
    if c["boundary"] == "free":
        solver.setIntegralOperator("dcfft")
    solver.max_iter = 100000
    return solver


def solve(solver, pressure):
    error = solver.solve(pressure)
    assert error <= c["tolerance"], f"not converged: {error}"


if c["case"] == "elastic":
    solver = ready(tm.PolonskyKeerRey(model, surface, c["tolerance"]))
    seconds, _ = clock(lambda: solve(solver, c["pressure"]))
else:
    # Relaxed modulus 1, one branch of modulus 1 and relaxation time 1; steps of a fiftieth of it.
    solver = ready(tm.MaxwellViscoelastic(model, surface, c["tolerance"], 0.02, [1.0], [1.0]))
    seconds, _ = clock(lambda: [solve(solver, 4.0 * c["pressure"]) for _ in range(c["steps"])])
answer(seconds, np.asarray(model.traction), tm.__version__)
