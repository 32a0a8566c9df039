"""Pressure flow factor of rough gaps beside the formula of Patir and Cheng.

N. Patir & H. S. Cheng, J. Lubr. Technol. 100 (1978) 12: isotropic Gaussian roughness, phi = 1 - 0.90 exp(-0.56 h/s), a
fit to their finite differences. h is the distance of the mean planes, s the rms height; where the surfaces overlap the
gap is closed.
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "Flow factors of rough gaps"
BESIDE = "formula from finite differences"
LIMIT = "below h = 3 s, where the surfaces touch"
COLUMNS = ("h/s", "Patir and Cheng", "predicted", "scatter of surfaces", "predicted / formula")

CELLS, SIDE, HEIGHT = 128, 1e-3, 1e-6
GAPS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0)
SEEDS = (1, 2, 3)


def formula(ratio):
    return 1 - 0.90 * np.exp(-0.56 * np.asarray(ratio))


def factor(surface, gap):
    """Mean of both directions: conductance over that of parallel plates at the distance of the mean planes."""
    rough = np.maximum(gap - np.asarray(surface.heights), 0.0)
    leak = asp.leakage(rough, rough <= 0, size=(SIDE, SIDE), direction="both", sides="periodic")
    return float(np.trace(leak.conductance)) / 2 / gap**3


@cache
def compared():
    """h/s, formula, mean and standard deviation of the prediction."""
    surfaces = [
        asp.Surface.self_affine(
            cells=(CELLS, CELLS),
            size=(SIDE, SIDE),
            hurst=0.8,
            rms_height=HEIGHT,
            longest=SIDE / 6,
            shortest=8 * SIDE / CELLS,
            seed=seed,
        )
        for seed in SEEDS
    ]
    found = []
    for ratio in GAPS:
        factors = [factor(surface, ratio * HEIGHT) for surface in surfaces]
        found.append((ratio, float(formula(ratio)), float(np.mean(factors)), float(np.std(factors, ddof=1))))
    return found


def rows():
    return [
        (f"{ratio:g}", f"{stated:.3f}", f"{mean:.3f}", f"{sd:.3f}", f"{mean / stated:.2f}")
        for ratio, stated, mean, sd in compared()
    ]


def summary():
    ratio = {row[0]: row[2] / row[1] for row in compared()}
    wide = [value for gap, value in ratio.items() if gap >= 3]
    return f"{min(wide):.2f} to {max(wide):.2f} from h = 3 s on, {ratio[1.0]:.2f} at h = s"


def draw(figure):
    axes = figure.subplots()
    ratio = np.linspace(0.5, 6.5, 60)
    axes.plot(ratio, formula(ratio), color="black", lw=1, label="Patir and Cheng")
    gaps, _, mean, sd = np.array(compared()).T
    axes.errorbar(gaps, mean, sd, fmt="o", ms=4, capsize=2, color="#1f5fa8", label="predicted, 3 surfaces")
    axes.set(xlabel="distance of the mean planes / rms height", ylabel="pressure flow factor", ylim=(0, 1.05))
    axes.legend(frameon=False, fontsize=8)
