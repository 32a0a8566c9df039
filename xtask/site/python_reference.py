"""The reference of the Python package: pages that mkdocstrings fills from signatures, types and docstrings."""

import re

TOPICS = {
    "Solve and run": "solve march run check elastic open study converge ErrorBar Step March Result Cycle ElasticContact ElasticCurve ConvergenceHistory".split(),
    "Surfaces": ["Surface", "Autocorrelation"],
    "Materials": "Material Elastic Maxwell KelvinVoigt Zener StandardLinearSolid Burgers Prony Creep Springpot PowerLaw FractionalMaxwell FractionalZener Body Layer "
    "layer_compliance CreepFunction Relaxation Spread".split(),
    "Fits and shifts": "fit_relaxation fit_creep fit_dma fit_file fit_indentation read_force_curves fit_force_map Fit IndentationFit PowerLawFit ForceFit ForceCurve Segment ForceMap wlf arrhenius shift_table Shift".split(),
    "Loads and times": "step ramp ramp_to hold triangle trapezoid sine table History Stage uniform log listed adaptive Times".split(),
    "Motion": "slide steady rubber_friction persson_friction PerssonFriction Magnification".split(),
    "Friction, wear and heat": "Friction tangential Tangential Wear Flash".split(),
    "Fluids, leakage, adhesion, stress": "leakage Leakage Fluid seal Seal Adhesion stress Stress".split(),
    "Messages, threads": "CaseError ConvergenceError Finding ResultWarning threads set_threads cite".split(),
    "Plots": ["plot.Plots", "plot.SurfacePlots", "plot.CurvePlots"],
    "Other programs": ["compat.prony_of_tamaas", "compat.topography"],
}


def pages(root, write):
    """Writes the pages and returns titles and places. Every public name is on one of them."""
    public = set(re.findall(r"\b(\w+) as \1\b", (root / "crates/asperity-py/python/asperity/__init__.py").read_text(encoding="utf-8")))
    told = {name.split(".")[0] for names in TOPICS.values() for name in names}
    if missing := public - told - {"__version__"}:
        raise SystemExit(f"python_reference.py: no topic for {', '.join(sorted(missing))}")
    found = []
    for topic, names in TOPICS.items():
        place = f"reference/python-{re.sub('[^a-z]+', '-', topic.lower())}.md"
        blocks = "\n\n".join(f"::: asperity.{name}" for name in names)
        write(place, f"# {topic}\n\nNames of the package `asperity` (`import asperity as asp`). All numbers are in SI units.\n\n{blocks}\n")
        found.append({topic: place})
    return found
