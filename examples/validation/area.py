"""Contact area over load of elastic rough surfaces: kappa in A/A0 = kappa P/(E* g), g the rms gradient.

Between sqrt(8/pi), Persson's theory, and sqrt(2 pi), that of Bush, Gibson and Thomas for light loads
(M. Paggi & M. Ciavarella, Wear 268 (2010) 1020).
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "Contact area over load"
BESIDE = "theories"
LIMIT = "falls with load and breadth of the spectrum"
COLUMNS = ("Hurst exponent", "P/(E* g)", "κ", "scatter of surfaces")

CELLS, SIDE, GRADIENT, MODULUS = 256, 1e-3, 0.1, 1e9
LOADS = (0.01, 0.02, 0.05, 0.1)
SEEDS = (1, 2, 3)
PERSSON, BUSH = float(np.sqrt(8 / np.pi)), float(np.sqrt(2 * np.pi))


@cache
def compared():
    """Hurst exponent, load, mean and standard deviation of kappa."""
    found = []
    for hurst in (0.5, 0.8):
        surfaces = [
            asp.Surface.self_affine(
                cells=(CELLS, CELLS),
                size=(SIDE, SIDE),
                hurst=hurst,
                rms_gradient=GRADIENT,
                longest=SIDE / 4,
                shortest=8 * SIDE / CELLS,
                seed=seed,
            )
            for seed in SEEDS
        ]
        for load in LOADS:
            slopes = []
            for surface in surfaces:
                contact = asp.elastic(surface, MODULUS, pressure=load * MODULUS * GRADIENT, boundary="periodic")
                slopes.append(contact.contact_area_corrected / SIDE**2 / load)
            found.append((hurst, load, float(np.mean(slopes)), float(np.std(slopes, ddof=1))))
    return found


def rows():
    return [(f"{hurst:g}", f"{load:g}", f"{kappa:.2f}", f"{sd:.2f}") for hurst, load, kappa, sd in compared()]


def summary():
    kappas = [row[2] for row in compared()]
    return f"κ = {min(kappas):.2f} to {max(kappas):.2f} between {PERSSON:.2f} and {BUSH:.2f}"


def draw(figure):
    axes = figure.subplots()
    for hurst, marker, colour in ((0.5, "o", "#1f5fa8"), (0.8, "s", "#c1541c")):
        mine = [row for row in compared() if row[0] == hurst]
        axes.errorbar(
            [row[1] for row in mine],
            [row[2] for row in mine],
            [row[3] for row in mine],
            marker=marker,
            ms=4,
            capsize=2,
            color=colour,
            label=f"H = {hurst:g}",
        )
    axes.axhline(BUSH, color="black", ls="--", lw=0.8, label="Bush, Gibson, Thomas")
    axes.axhline(PERSSON, color="black", ls=":", lw=0.8, label="Persson")
    axes.set(xscale="log", xlabel="P/(E* g)", ylabel="κ = A E* g/(A0 P)", ylim=(1.4, 3.0))
    axes.legend(frameon=False, fontsize=8, ncols=2)
