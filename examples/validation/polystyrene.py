"""Shift factors of polystyrene from creep at nine temperatures.

D. J. Plazek, J. Phys. Chem. 69 (1965) 3480 (doi 10.1021/j100894a039), digitised in github.com/krlennon/mastercurves
(tts_plazek): about a dozen points of each curve. The digitiser states Plazek's own factor: 1.13 decades
(97 to 100 °C).
"""

from functools import cache

import numpy as np

import asperity as asp

TITLE = "Polystyrene: shift factors from creep"
BESIDE = "experiment"
LIMIT = "terminal creep shifts differently"
COLUMNS = ("from, to [°C]", "overlap of the curves", "predicted", "its stated uncertainty", "difference [decades]")

#: Decades from 100 to 97 °C, as Plazek's reduction has them.
PLAZEK = 1.13


def curve(times, compliances):
    """Numbers between blanks."""
    return tuple(tuple(float(number) for number in text.split()) for text in (times, compliances))


#: Temperature [°C]: time [s], and compliance as digitised, both rounded to four digits.
CREEP = {
    97.0: curve(
        "1.654 3.332 6.961 14.91 30.01 80.17 159.5 245.1 390.8 600.7 993.9 1977 3436 7822",
        "1.061e-10 1.153e-10 1.395e-10 1.729e-10 2.142e-10 3.024e-10 4.373e-10 5.549e-10 7.561e-10 9.823e-10 "
        "1.421e-9 2.485e-9 3.953e-9 8.266e-9",
    ),
    100.6: curve(
        "1 2.064 4.312 9.817 19.77 49.66 98.78 157.5 294.7 390.8 593.4 993.9 1977 4845",
        "1.901e-10 2.470e-10 3.406e-10 5.354e-10 8.120e-10 1.581e-9 2.766e-9 4.048e-9 7.339e-9 9.311e-9 "
        "1.331e-8 2.091e-8 3.792e-8 7.929e-8",
    ),
    101.8: curve(
        "0.988 2.089 4.259 9.939 20.01 49.66 98.78 161.4 294.7 405.5 593.4 1271 2497 4966",
        "2.412e-10 3.406e-10 4.985e-10 8.415e-10 1.421e-9 2.901e-9 5.259e-9 8.169e-9 1.412e-8 1.901e-8 "
        "2.653e-8 5.166e-8 8.516e-8 1.421e-7",
    ),
    104.5: curve(
        "1 2.115 4.312 9.939 19.77 50.27 98.78 161.4 298.3 395.7 499.7 993.9 2051 3981",
        "5.819e-10 1.043e-9 1.936e-9 4.000e-9 7.697e-9 1.688e-8 2.918e-8 4.322e-8 7.209e-8 8.825e-8 1.043e-7 "
        "1.678e-7 2.545e-7 3.229e-7",
    ),
    106.7: curve(
        "1 2.115 4.312 10.19 20.01 50.27 100 159.5 376.7 524.8 740.2 1124 1665 3311",
        "1.508e-9 2.971e-9 5.854e-9 1.254e-8 2.356e-8 5.105e-8 8.825e-8 1.174e-7 2.030e-7 2.370e-7 2.766e-7 "
        "3.386e-7 3.953e-7 4.725e-7",
    ),
    109.6: curve(
        "1.012 2.115 4.365 9.939 20.01 44.46 79.19 129.4 239.1 345.7 493.6 981.7 1977 3933",
        "5.854e-9 1.153e-8 2.167e-8 4.170e-8 7.383e-8 1.261e-7 1.846e-7 2.370e-7 3.153e-7 3.680e-7 4.195e-7 "
        "5.015e-7 5.716e-7 6.139e-7",
    ),
    114.5: curve(
        "1.012 2.141 4.365 10.06 20.01 44.46 79.19 129.4 239.1 349.9 441.9",
        "3.702e-8 6.712e-8 1.120e-7 1.846e-7 2.669e-7 3.814e-7 4.614e-7 5.197e-7 5.924e-7 6.362e-7 6.673e-7",
    ),
    125.0: curve(
        "1.012 2.089 4.259 9.939 19.77 59.70 131.0 198.9 395.7 593.4 993.9",
        "2.799e-7 3.814e-7 4.782e-7 5.785e-7 6.362e-7 6.752e-7 6.915e-7 6.998e-7 7.166e-7 7.252e-7 7.427e-7",
    ),
    133.8: curve(
        "0.988 2.115 4.259 9.939 20.01 59.70 129.4 198.9 345.7 593.4 1019 1977 3981 6918",
        "5.450e-7 6.287e-7 6.752e-7 7.082e-7 7.339e-7 7.606e-7 8.169e-7 8.169e-7 8.984e-7 9.649e-7 1.024e-6 "
        "1.113e-6 1.181e-6 1.239e-6",
    ),
}


def overlap(colder, warmer):
    """Mean distance of two curves in decades of time, over the compliances that both have."""
    (ta, ja), (tb, jb) = (np.log10(np.array(one)) for one in (colder, warmer))
    level = np.linspace(max(ja.min(), jb.min()), min(ja.max(), jb.max()), 30)
    return float((np.interp(level, jb, tb) - np.interp(level, ja, ta)).mean())


@cache
def fitted():
    time, compliance = (np.concatenate([one[k] for one in CREEP.values()]) for k in (0, 1))
    temperature = np.concatenate([np.full(len(one[0]), celsius + 273.15) for celsius, one in CREEP.items()])
    return asp.fit_creep(
        time, compliance, modulus="shear", temperature=temperature, shift="estimated", reference=373.15
    )


@cache
def compared():
    """Temperature [°C], decades from the curve at 97 °C by overlap and by the fit, and the uncertainty of the fit."""
    celsius = list(CREEP)
    chain = np.cumsum([0.0] + [overlap(CREEP[a], CREEP[b]) for a, b in zip(celsius, celsius[1:])])
    first = fitted().shift_factors[0][1]
    return [(t, float(c), log - first, error) for t, c, (_, log, error) in zip(celsius, chain, fitted().shift_factors)]


def from_100_to_97():
    """The reference of the fit is 100 °C."""
    return fitted().shift_factors[0][1]


def rows():
    found = [
        (f"97, {t:g}", f"{c:.2f}", f"{f:.2f}", f"{error:.2f}", f"{abs(f - c):.2f}") for t, c, f, error in compared()[1:]
    ]
    log, error = from_100_to_97(), fitted().shift_factors[0][2]
    return [*found, ("100, 97", f"{PLAZEK:.2f} (Plazek)", f"{log:.2f}", f"{error:.2f}", f"{abs(log - PLAZEK):.2f}")]


def summary():
    worst = max(abs(f - c) for _, c, f, _ in compared())
    return f"within {worst:.2f} of {-compared()[-1][2]:.1f} decades"


def draw(figure):
    left, right = figure.subplots(1, 2)
    for celsius, one in CREEP.items():
        left.loglog(*one, ".-", ms=3, lw=0.7, label=f"{celsius:g} °C")
    left.set(xlabel="time [s]", ylabel="creep compliance, as digitised", xlim=(0.5, 4e5))
    left.legend(frameon=False, fontsize=6)
    celsius, chain, factors, _ = np.array(compared()).T
    right.plot(celsius, chain, "ko", ms=5, label="overlap of the curves")
    right.plot(celsius, factors, color="#1f5fa8", label="fit_creep")
    right.set(xlabel="temperature [°C]", ylabel="decades from 97 °C")
    right.legend(frameon=False, fontsize=8)
