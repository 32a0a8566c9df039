"""What the drivers of all peers share: the case from the command line, the clock, the answer.

A case is a JSON object: `gap` (a file of N x N little-endian f64, C-order, least value 0), `cells` N, `boundary`
("free" or "periodic"), `pressure` (mean, over E*), `tolerance`, and for a viscoelastic case `steps`. The domain has
side 1 and the contact modulus is 1. The answer is one JSON object on the last line of stdout: `seconds` of the
solve alone (planning is not counted, nor is it in ours), the contact `fraction`, the `version`.
"""

import json
import sys
import time

import numpy as np


def case():
    description = json.loads(sys.argv[1])
    cells = description["cells"]
    description["gap"] = np.fromfile(description["gap"], dtype="<f8").reshape(cells, cells)
    return description


def clock(work):
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def answer(seconds, pressure, version):
    print(json.dumps({"seconds": seconds, "fraction": float(np.mean(pressure > 0.0)), "version": version}))
