"""Loss factor of rubber pads on a shaker, from a DMA of the same rubber.

EPDM 70, discs of 33.5 mm with a hole of 11.8 mm, 6 mm thick, 21 °C: github.com/MarcusNi96/dma-prony-validation. The DMA
is its file tf_015p (0.15 % strain): sweeps at five temperatures, seven of the frequencies of each. The loss factor of
the pads is that of a complex spring at the resonance of the mass upon it.
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "EPDM: loss factor of pads from a DMA"
BESIDE = "experiment"
LIMIT = "more strain (Payne effect)"
COLUMNS = ("acceleration [g]", "resonance [Hz]", "strain [%]", "measured", "tan δ of the DMA", "predicted / measured")

FREQUENCIES = (1, 1.9307, 3.72759, 7.19686, 13.895, 26.827, 51.7947)
#: Temperature [°C]: storage and loss modulus in shear [MPa] at these frequencies.
DMA = {
    -2.75: (
        (6.056, 6.326, 6.614, 6.906, 7.193, 7.484, 7.746),
        (0.6063, 0.6181, 0.6599, 0.7512, 0.9257, 1.19, 1.565),
    ),
    4.13: (
        (5.365, 5.616, 5.901, 6.159, 6.413, 6.647, 6.797),
        (0.5664, 0.5488, 0.5654, 0.6, 0.6648, 0.7929, 0.9305),
    ),
    11.06: (
        (4.813, 5.066, 5.339, 5.597, 5.835, 6.058, 6.184),
        (0.5396, 0.5496, 0.5416, 0.5656, 0.6, 0.6518, 0.7418),
    ),
    18.4: (
        (4.353, 4.591, 4.864, 5.117, 5.379, 5.632, 5.745),
        (0.5248, 0.5279, 0.541, 0.562, 0.6011, 0.6306, 0.6601),
    ),
    25.23: (
        (4.263, 4.503, 4.768, 5.024, 5.253, 5.507, 5.664),
        (0.5015, 0.5141, 0.5275, 0.5537, 0.5933, 0.6267, 0.6677),
    ),
}
#: Acceleration [g], resonance [Hz], largest strain [%], loss factor.
SHAKER = (
    (0.1, 511, 0.015, 0.104),
    (0.1, 361, 0.033, 0.101),
    (0.1, 240, 0.077, 0.098),
    (0.1, 166, 0.157, 0.096),
    (1, 508, 0.152, 0.108),
    (1, 354, 0.314, 0.108),
    (1, 230, 0.644, 0.125),
    (1, 154, 1.297, 0.134),
)


@cache
def fitted():
    storage, loss = (1e6 * np.concatenate([sweep[k] for sweep in DMA.values()]) for k in (0, 1))
    temperature = np.repeat(list(DMA), len(FREQUENCIES)) + 273.15
    frequency = np.tile(FREQUENCIES, len(DMA))
    return asp.fit_dma(
        frequency,
        storage,
        loss,
        modulus="shear",
        poisson=0.5,
        temperature=temperature,
        shift="estimated",
        reference=294.15,
    )


def tan_delta(frequency):
    storage, loss = fitted().material.storage_loss(2 * np.pi * np.asarray(frequency), measure="shear")
    return loss / storage


@cache
def compared():
    """Acceleration, resonance, strain, measured and predicted loss factor."""
    predicted = tan_delta([row[1] for row in SHAKER])
    return [(*row, float(p)) for row, p in zip(SHAKER, predicted)]


def rows():
    return [
        (f"{g:g}", f"{f}", f"{strain:g}", f"{eta:.3f}", f"{p:.3f}", f"{p / eta:.2f}")
        for g, f, strain, eta, p in compared()
    ]


def summary():
    parts = []
    for wanted, words in ((0.1, "up to 0.16 % strain"), (1, "up to 1.3 %")):
        ratio = [p / eta for g, _, _, eta, p in compared() if g == wanted]
        parts.append(f"{min(ratio):.2f} to {max(ratio):.2f} {words}")
    return ", ".join(parts)


def draw(figure):
    left, right = figure.subplots(1, 2)
    frequency = np.geomspace(1, 1000, 60)
    left.semilogx(frequency, tan_delta(frequency), color="#1f5fa8", label="tan δ of the DMA at 21 °C")
    for g, marker, colour in ((0.1, "o", "black"), (1, "s", "#c1541c")):
        mine = [row for row in compared() if row[0] == g]
        left.semilogx(
            [row[1] for row in mine], [row[3] for row in mine], marker, ms=5, color=colour, label=f"pads, {g:g} g"
        )
        right.semilogx(
            [row[2] for row in mine],
            [row[4] / row[3] for row in mine],
            marker,
            ms=5,
            color=colour,
            label=f"pads, {g:g} g",
        )
    left.set(xlabel="frequency [Hz]", ylabel="loss factor", ylim=(0, 0.16))
    left.legend(frameon=False, fontsize=8, loc="lower left")
    right.axhline(1.0, color="black", lw=0.8)
    right.axvline(0.15, color="#888888", ls=":", label="strain of the DMA")
    right.set(xlabel="strain of the pad [%]", ylabel="predicted / measured", ylim=(0.7, 1.2))
    right.legend(frameon=False, fontsize=8, loc="lower left")
