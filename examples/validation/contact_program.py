"""Examples that the program CONTACT publishes with its results: a shifted ball, Spence's compression, a loaded square.

github.com/eve70a/CONTACT (Apache-2.0), examples `cattaneo`, `spence35` and `subsurf` with their reference outputs of
2023; after J. J. Kalker, Three-dimensional elastic bodies in rolling contact (1990), section 5.2.1.1 and figures 5.20
and 5.25.
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "Examples of the program CONTACT"
BESIDE = "another program"
LIMIT = "no steady rolling with friction"
COLUMNS = ("example", "quantity", "CONTACT", "asperity")

#: Below the middle of a unit square under unit pressure and a traction of 0.999 along x, nu = 0.28: depth, sxx, szz,
#: sxz, von Mises.
SUBSURF = np.array(
    [
        [0.1, -0.5559, -0.9943, -0.7364, 1.349],
        [0.2, -0.3666, -0.9604, -0.5118, 1.067],
        [0.3, -0.2273, -0.8915, -0.3427, 0.8908],
        [0.5, -0.07618, -0.7008, -0.1494, 0.6761],
        [0.8, -0.007388, -0.4492, -0.04720, 0.4493],
        [1.0, 0.003977, -0.3361, -0.02418, 0.3426],
        [1.25, 0.007719, -0.2409, -0.01164, 0.2495],
        [2.5, 0.004458, -0.07161, -0.000927, 0.07609],
        [5.0, 0.001325, -0.01879, -0.0000618, 0.02011],
    ]
)


@cache
def cattaneo():
    """A polyethylene ball of 50 mm on the same material under 9.1954 N, pulled with 7/8 of what friction holds."""
    side = 19 * 0.13333e-3
    ball = asp.Surface.sphere(cells=(19, 19), size=(side, side), radius=50e-3)
    polyethylene = asp.Elastic(shear=200e6, poisson=0.42)
    return asp.solve(
        ball,
        [polyethylene, polyethylene],
        load=9.1954,
        times=asp.uniform(1.0, 1),
        friction=0.4,
        tangential=asp.tangential(force=asp.ramp(0.875 * 0.4 * 9.1954, duration=1.0)),
        fields=["pressure", "contact"],
    )


@cache
def spence():
    """A soft sphere pressed on a rigid flat in 35 stages, which spreads and slips outwards."""
    side = 45 * 0.2e-3
    ball = asp.Surface.sphere(cells=(45, 45), size=(side, side), radius=1e-3 / (2 * 0.004116))
    return asp.solve(
        ball,
        [asp.Elastic(shear=0.5e6, poisson=0.0), asp.Elastic(shear=1e11, poisson=0.0)],
        load=asp.table([(float(k), (k / 45) ** 3) for k in range(36)]),
        times=asp.uniform(35.0, 35),
        friction=asp.Friction(0.2986, coupling="full"),
        tangential=asp.tangential(displacement=0.0),
        fields=["pressure", "contact"],
        field_times=[35.0],
    )


@cache
def subsurf():
    """xx, zz, xz and von Mises below the middle, at the depths of the table."""
    square = np.ones((5, 5))
    below = asp.stress(
        square,
        size=(1.0, 1.0),
        poisson=0.28,
        depths=SUBSURF[:, 0],
        boundary="free",
        tractions=[0.999 * square, 0.0 * square],
    )
    return np.array([part[:, 2, 2] for part in (below.xx, below.zz, below.xz, below.mises)]).T


def cells(result):
    """Cells that stick and that slip in the end."""
    kind = np.asarray(result.field("contact"))
    return int(((kind > 0) & (kind != 3)).sum()), int((kind == 3).sum())


def rows():
    ball, soft = cattaneo(), spence()
    shift = 1e6 * np.hypot(*ball.tangential_displacement[-1])
    found = [
        ("cattaneo", "shift [µm]", "8.155", f"{shift:.3f}"),
        ("cattaneo", "approach [µm]", "19.98", f"{1e6 * ball.approach[-1]:.2f}"),
        ("cattaneo", "largest pressure [MPa]", "4.393", f"{1e-6 * ball.field('pressure').max():.3f}"),
        ("cattaneo", "cells that stick, that slip", "45, 132", "{}, {}".format(*cells(ball))),
        ("spence35", "approach [µm]", "98.74", f"{1e6 * soft.approach[-1]:.2f}"),
        ("spence35", "largest pressure [kPa]", "23.92", f"{1e-3 * soft.field('pressure').max():.2f}"),
        ("spence35", "cells that stick, that slip", "225, 696", "{}, {}".format(*cells(soft))),
    ]
    for at in (0, 3, 5):
        depth, _, zz, _, mises = SUBSURF[at]
        found.append(
            (
                "subsurf",
                f"σzz, von Mises at z = {depth:g}",
                f"{zz:.4f}, {mises:.4g}",
                f"{subsurf()[at, 1]:.4f}, {subsurf()[at, 3]:.4g}",
            )
        )
    return found


def summary():
    ratio = 1e6 * np.hypot(*cattaneo().tangential_displacement[-1]) / 8.155
    stuck, slipping = cells(spence())
    return f"shift {ratio:.3f}; {stuck} of 225 cells stick and {slipping} of 696 slip"


def draw(figure):
    left, right = figure.subplots(1, 2)
    kind = np.asarray(spence().field("contact"))
    stuck = np.where(kind == 3, 1, np.where(kind > 0, 2, 0))
    left.imshow(stuck.T, origin="lower", cmap="Blues", vmin=0, vmax=2.6, extent=(-4.5, 4.5, -4.5, 4.5))
    left.set(xlabel="x [mm]", ylabel="y [mm]", title="spence35: cells that slip (light) and stick")
    for column, name, colour in ((1, "σxx", "#1f5fa8"), (2, "σzz", "#c1541c"), (4, "von Mises", "#3a7d34")):
        right.plot(SUBSURF[:, column], SUBSURF[:, 0], "o", ms=4, color=colour)
        right.plot(subsurf()[:, {1: 0, 2: 1, 4: 3}[column]], SUBSURF[:, 0], color=colour, lw=1, label=name)
    right.set(xlabel="stress", ylabel="depth", ylim=(3, 0), title="subsurf: CONTACT (points), asperity (lines)")
    right.legend(frameon=False, fontsize=8)
