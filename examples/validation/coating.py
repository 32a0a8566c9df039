"""Stiffness of silicon under 500 nm of thermal oxide over the depth of a Berkovich indentation; nothing is fitted.

Measured by continuous stiffness (75 Hz, 2 nm): example file MTS_1film_SiO2_Si_CSM-2nm of the NIMS toolbox
(github.com/DavidMercier/NIMS), ten of its 61 points. S/1.034 is the stiffness of a round contact of the same area.
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "Oxide on silicon: stiffness over depth"
BESIDE = "experiment"
LIMIT = "a film thinner by what the tip displaces; pile-up"
COLUMNS = (
    "depth [nm]",
    "a/t",
    "measured S/1.034 [kN/m]",
    "scatter",
    "predicted S [kN/m]",
    "predicted / measured",
    "with the film thinner by h_c/3",
)

THICKNESS = 500e-9
#: Depth [nm], stiffness [N/m], its standard deviation over the tests, contact radius of the instrument [nm].
MEASURED = np.array(
    [
        [30.7, 12167, 417, 80.74],
        [51.4, 19669, 563, 124.7],
        [75.2, 28735, 529, 174.6],
        [102.9, 40093, 593, 233.3],
        [134.9, 54785, 1036, 302.6],
        [171.9, 74437, 1075, 385.1],
        [214.7, 98089, 1962, 479.4],
        [264.5, 129670, 2144, 592.6],
        [321.7, 168590, 3187, 721.3],
        [388.5, 214710, 3623, 867.7],
    ]
)
#: Correction of a three-sided pyramid against a cone of the same area.
BERKOVICH = 1.034
#: Slope of the cone with the area of a Berkovich pyramid over depth.
SLOPE = 1.0 / np.tan(np.radians(70.3))

OXIDE = asp.Elastic(young=72e9, poisson=0.17)
SILICON = asp.Elastic(young=165e9, poisson=0.22)
DIAMOND = asp.Elastic(young=1141e9, poisson=0.07)


def stiffness(radius, body):
    """dW/dd of a cone of diamond on the body at that contact radius; what has yielded unloads elastically."""
    cone = asp.Surface.cone(cells=(64, 64), size=(3 * radius, 3 * radius), slope=SLOPE)
    approach = 0.5 * np.pi * radius * SLOPE
    for _ in range(3):
        pressed = asp.solve(
            cone, [body, DIAMOND], approach=approach, times=[1.0], quantities=["contact_stiffness"], fields=[]
        )
        found = float(np.sqrt(pressed.contact_area_corrected[-1] / np.pi))
        approach *= radius / found
    return float(pressed.contact_stiffness[-1]) * radius / found


def coated(thickness):
    return asp.Body(layers=[asp.Layer(thickness=thickness, material=OXIDE)], base=SILICON)


@cache
def compared():
    """Stiffness [N/m] at each depth: measured, predicted, predicted with what the tip displaces taken off."""
    radii = MEASURED[:, 3] * 1e-9
    predicted = np.array([stiffness(a, coated(THICKNESS)) for a in radii])
    # Contact depth of the cone: a times its slope; effective thickness t - h_c/3, as the NIMS toolbox has it.
    thinner = np.array([stiffness(a, coated(THICKNESS - a * SLOPE / 3)) for a in radii])
    return MEASURED[:, 1] / BERKOVICH, predicted, thinner


def bounds():
    """Stiffness [N/m] of the oxide and of the silicon alone, 2 a E*."""
    a = MEASURED[:, 3] * 1e-9
    return [2 * a / ((1 - 0.07**2) / 1141e9 + (1 - nu**2) / young) for young, nu in ((72e9, 0.17), (165e9, 0.22))]


def rows():
    return [
        (
            f"{depth:.1f}",
            f"{a * 1e-9 / THICKNESS:.2f}",
            f"{m / 1e3:.1f}",
            f"{100 * sd / s:.1f} %",
            f"{p / 1e3:.1f}",
            f"{p / m:.3f}",
            f"{t / m:.3f}",
        )
        for (depth, s, sd, a), m, p, t in zip(MEASURED, *compared())
    ]


def summary():
    measured, predicted, _ = compared()
    thin = MEASURED[:, 3] * 1e-9 < THICKNESS
    ratio = predicted / measured
    return f"{ratio[thin].min():.2f} to {ratio[thin].max():.2f} up to a = t, {ratio[-1]:.2f} at the deepest"


def draw(figure):
    measured, predicted, thinner = compared()
    left, right = figure.subplots(1, 2)
    depth, scatter = MEASURED[:, 0], MEASURED[:, 2] / BERKOVICH
    left.errorbar(
        depth, measured / 1e3, scatter / 1e3, fmt="o", ms=4, color="black", capsize=2, label="measured, S/1.034"
    )
    left.plot(depth, predicted / 1e3, color="#1f5fa8", label="oxide on silicon, predicted")
    for one, style, name in zip(bounds(), (":", "--"), ("oxide alone", "silicon alone")):
        left.plot(depth, one / 1e3, style, color="#888888", label=name)
    left.set(xlabel="depth [nm]", ylabel="stiffness [kN/m]")
    left.legend(frameon=False, fontsize=8)
    right.errorbar(
        MEASURED[:, 3] * 1e-9 / THICKNESS,
        predicted / measured,
        scatter / measured,
        fmt="o",
        ms=4,
        color="#1f5fa8",
        capsize=2,
        label="as deposited",
    )
    right.plot(
        MEASURED[:, 3] * 1e-9 / THICKNESS, thinner / measured, "x", ms=5, color="#c1541c", label="film thinner by h_c/3"
    )
    right.axhline(1.0, color="black", lw=0.8)
    right.set(xlabel="contact radius / thickness", ylabel="predicted / measured", ylim=(0.85, 1.1))
    right.legend(frameon=False, fontsize=8)
