"""ContactMechanics: the constrained conjugate gradients of Polonsky and Keer.

Its default tolerance on the penetration is loose: here it is the case's, relative to the rms height, and the
tolerance on forces outside of the contact follows it.
"""

from importlib.metadata import version

import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace, PeriodicFFTElasticHalfSpace
from ContactMechanics.Optimization import constrained_conjugate_gradients
from SurfaceTopography import Topography

from common import answer, case, clock

c = case()
n = c["cells"]
heights = -c["gap"]
topography = Topography(heights, physical_sizes=(1.0, 1.0))
HalfSpace = FreeFFTElasticHalfSpace if c["boundary"] == "free" else PeriodicFFTElasticHalfSpace
substrate = HalfSpace((n, n), young=1.0, physical_sizes=(1.0, 1.0))
seconds, result = clock(
    lambda: constrained_conjugate_gradients(
        substrate,
        topography,
        external_force=c["pressure"],
        pentol=c["tolerance"] * heights.std(),
        forcetol=c["tolerance"],
        maxiter=100000,
    )
)
assert result.success, result.message
answer(seconds, np.asarray(result.jac)[:n, :n], version("ContactMechanics"))
