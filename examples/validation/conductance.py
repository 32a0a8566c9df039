"""Contact conductance of rough metals over pressure beside two correlations.

h = k S/(E* A) with the stiffness S of the contact spots (Barber 2003), k the harmonic mean conductivity, A the nominal
area. Plastic: M. G. Cooper, B. B. Mikic, M. M. Yovanovich, Int. J. Heat Mass Transf. 12 (1969) 279, in the form
h = 1.25 k m/s (P/H)^0.95. Elastic: B. B. Mikic, Int. J. Heat Mass Transf. 17 (1974) 205,
h = 1.55 k m/s (sqrt(2) P/(E* m))^0.94. s is the rms height and m the mean absolute slope, both of the gap.
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "Contact conductance of rough metals"
BESIDE = "correlations of experiments"
LIMIT = "E* m/H about 1; spots of few cells"
COLUMNS = (
    "slope m",
    "bodies",
    "P/H",
    "h s/(k m) of the correlation",
    "predicted",
    "scatter of surfaces",
    "predicted / correlation",
)

CELLS, SIDE, MODULUS = 256, 1e-3, 100e9
HARDNESS = MODULUS / 30
SEEDS = (1, 2, 3)
#: Mean slope, whether the hardness limits the pressure, pressures over the hardness.
CASES = ((0.15, True, (0.002, 0.005, 0.02)), (0.04, False, (0.002, 0.005, 0.02)))


def rough(slope, seed):
    """A Gaussian surface; the mean absolute slope of its profiles is the rms gradient over sqrt(pi)."""
    return asp.Surface.self_affine(
        cells=(CELLS, CELLS),
        size=(SIDE, SIDE),
        hurst=0.8,
        rms_gradient=slope * np.sqrt(np.pi),
        longest=SIDE / 4,
        shortest=16 * SIDE / CELLS,
        seed=seed,
    )


def slope_and_height(surface):
    z = np.asarray(surface.heights)
    slopes = [np.abs(np.roll(z, -1, axis) - z).mean() * CELLS / SIDE for axis in (0, 1)]
    return float(np.mean(slopes)), float(z.std())


def conductance(surface, pressure, plastic):
    """h s/(k m). All cells in contact conduct, also those at the hardness: S is that of flat punches in their place."""
    contact = asp.elastic(
        surface, MODULUS, pressure=pressure, boundary="periodic", hardness=HARDNESS if plastic else None
    )
    m, s = slope_and_height(surface)
    spots = np.where(np.asarray(contact.pressure) > 0, 0.0, np.inf)
    punch = asp.elastic(gap=spots, size=(SIDE, SIDE), contact_modulus=MODULUS, approach=1e-3 * s, boundary="periodic")
    return punch.load / punch.approach * s / (MODULUS * SIDE**2 * m)


def correlation(m, pressure, plastic):
    if plastic:
        return 1.25 * (pressure / HARDNESS) ** 0.95
    return 1.55 * (np.sqrt(2) * pressure / (MODULUS * m)) ** 0.94


@cache
def compared():
    """Of each case and pressure: slope, plastic, P/H, correlation, mean and standard deviation of the prediction."""
    found = []
    for slope, plastic, pressures in CASES:
        surfaces = [rough(slope, seed) for seed in SEEDS]
        for share in pressures:
            predicted = [conductance(surface, share * HARDNESS, plastic) for surface in surfaces]
            stated = np.mean(
                [correlation(slope_and_height(surface)[0], share * HARDNESS, plastic) for surface in surfaces]
            )
            found.append(
                (slope, plastic, share, float(stated), float(np.mean(predicted)), float(np.std(predicted, ddof=1)))
            )
    return found


def rows():
    return [
        (
            f"{m:g}",
            "plastic" if plastic else "elastic",
            f"{share:g}",
            f"{c:.5f}",
            f"{p:.5f}",
            f"{100 * sd / p:.0f} %",
            f"{p / c:.2f}",
        )
        for m, plastic, share, c, p, sd in compared()
    ]


def summary():
    parts = []
    for wanted, name in ((True, "plastic"), (False, "elastic")):
        ratio = [p / c for _, plastic, _, c, p, _ in compared() if plastic == wanted]
        parts.append(f"{min(ratio):.2f} to {max(ratio):.2f} {name}")
    return ", ".join(parts)


def draw(figure):
    axes = figure.subplots(1, 2)
    for axis, (slope, plastic, _) in zip(axes, CASES):
        mine = [row for row in compared() if row[0] == slope]
        shares = np.geomspace(1e-3, 4e-2, 30)
        name = "Cooper, Mikic, Yovanovich" if plastic else "Mikic, elastic"
        axis.loglog(shares, correlation(slope, shares * HARDNESS, plastic), color="black", lw=1, label=name)
        axis.errorbar(
            [row[2] for row in mine],
            [row[4] for row in mine],
            [row[5] for row in mine],
            fmt="o",
            ms=4,
            capsize=2,
            color="#c1541c",
            label="predicted",
        )
        axis.set(xlabel="pressure / hardness", title=f"mean slope {slope:g}, {'plastic' if plastic else 'elastic'}")
        axis.legend(frameon=False, fontsize=8)
        axis.yaxis.set_minor_formatter("")
    axes[0].set_ylabel("h s/(k m)")
