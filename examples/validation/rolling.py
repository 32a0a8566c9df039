"""Rolling loss of a sphere and a cylinder on rubber whose loss factor does not depend on the frequency.

J. A. Greenwood, H. Minshall, D. Tabor, Proc. R. Soc. A 259 (1961) 480: the loss of a sphere grows as W^(4/3), a fixed
share of the energy of the deformation per contact width. With a small tan d all waves of the Hertz pressure lose one
share, so that F = (6/pi^2) tan d W a/R for a sphere and (8/(3 pi)) tan d W a/R for a cylinder, a the contact radius or
half width.
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "Rolling loss"
BESIDE = "law"
LIMIT = "large loss; adhesion"
COLUMNS = ("body", "load", "a [mm]", "friction coefficient", "over its closed form")

SHEAR, LOSS, RADIUS, VELOCITY = 1e6, 0.0075, 10e-3, 0.05
#: Relaxation times: two to a decade keep tan d even within 1e-3 between them.
TIMES = np.geomspace(1e-5, 1e1, 13)
STEP = np.log(TIMES[1] / TIMES[0])
MODULUS = 4 * SHEAR
SPHERES, CYLINDERS = (0.05, 0.2, 0.8), (20.0, 80.0)


def rubber():
    """G'' = sum of G_i wt/(1 + (wt)^2) is G_i pi/(2 ln of the step) at any frequency inside."""
    each = SHEAR * LOSS * STEP / (np.pi / 2)
    return asp.Prony(
        equilibrium=SHEAR - each * len(TIMES) / 2,
        terms=[(each, float(time)) for time in TIMES],
        modulus="shear",
        poisson=0.5,
    )


def friction(surface, load):
    return float(
        asp.steady(surface, rubber(), load=load, velocities=[VELOCITY], kind="slide", fields=[]).friction_coefficient[0]
    )


def tan_delta(width):
    storage, loss = rubber().storage_loss(VELOCITY / width, measure="shear")
    return float(loss / storage)


@cache
def compared():
    """Body, load, contact radius or half width, friction coefficient, closed form."""
    found = []
    for load in SPHERES:
        a = (3 * load * RADIUS / (4 * MODULUS)) ** (1 / 3)
        mu = friction(asp.Surface.sphere(cells=(32, 32), size=(3 * a, 3 * a), radius=RADIUS), load)
        found.append(("sphere", load, a, mu, 6 / np.pi**2 * tan_delta(a) * a / RADIUS))
    for load in CYLINDERS:
        a = 2 * np.sqrt(load * RADIUS / (np.pi * MODULUS))
        mu = friction(asp.Surface.cylinder(cells=(256,), size=(3 * a,), radius=RADIUS), load)
        found.append(("cylinder", load, a, mu, 8 / (3 * np.pi) * tan_delta(a) * a / RADIUS))
    return found


def exponent():
    """d ln F/d ln W of the sphere."""
    mine = [(load, load * mu) for body, load, _, mu, _ in compared() if body == "sphere"]
    load, force = np.log(np.array(mine)).T
    return float(np.polyfit(load, force, 1)[0])


def rows():
    unit = {"sphere": "N", "cylinder": "N/m"}
    return [
        (body, f"{load:g} {unit[body]}", f"{1e3 * a:.2f}", f"{mu:.3e}", f"{mu / exact:.3f}")
        for body, load, a, mu, exact in compared()
    ]


def summary():
    ratio = [mu / exact for _, _, _, mu, exact in compared()]
    return f"F as W^{exponent():.3f}; {min(ratio):.3f} to {max(ratio):.3f} of the closed form"


def draw(figure):
    axes = figure.subplots()
    loads = np.geomspace(0.03, 1.2, 20)
    a = (3 * loads * RADIUS / (4 * MODULUS)) ** (1 / 3)
    axes.loglog(loads, 6 / np.pi**2 * LOSS * loads * a / RADIUS, color="black", lw=1, label="W^(4/3)")
    mine = [row for row in compared() if row[0] == "sphere"]
    axes.loglog(
        [row[1] for row in mine],
        [row[1] * row[3] for row in mine],
        "o",
        ms=5,
        color="#1f5fa8",
        label="sphere, predicted",
    )
    axes.set(xlabel="load [N]", ylabel="friction force [N]")
    axes.legend(frameon=False, fontsize=8)
