"""Draws the figures of docs/validation.md and prints its tables: python examples/validation/draw.py [NAME ...]"""

import sys
import warnings
from pathlib import Path

import area
import coating
import conductance
import contact_program
import epdm
import flow_factors
import polystyrene
import rolling

COMPARISONS = (coating, conductance, epdm, polystyrene, rolling, flow_factors, area, contact_program)
PICTURES = Path(__file__).parents[2] / "docs/images/validation"


def picture(module):
    return PICTURES / f"{module.__name__.replace('_', '-')}.png"


def table(module):
    """The lines of its table in Markdown."""
    lines = [module.COLUMNS, ("---",) * len(module.COLUMNS), *module.rows()]
    return ["| " + " | ".join(line) + " |" for line in lines]


def draw(module):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.titlesize": 9})
    figure = plt.figure(figsize=(7.6, 3.1), layout="constrained")
    module.draw(figure)
    PICTURES.mkdir(parents=True, exist_ok=True)
    figure.savefig(picture(module), dpi=120)
    plt.close(figure)


if __name__ == "__main__":
    # The pages say where these cases leave what a finding looks at.
    warnings.simplefilter("ignore")
    for module in COMPARISONS:
        if len(sys.argv) < 2 or module.__name__ in sys.argv[1:]:
            print(f"\n## {module.TITLE}\n", *table(module), f"\n{module.summary()}", sep="\n")
            draw(module)
