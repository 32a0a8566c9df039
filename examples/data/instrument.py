"""Makes a synthetic surface look measured: tilt, spikes, points without a height. See README.md."""

import sys

import numpy as np

source, target = sys.argv[1:]
surface = dict(np.load(source))
heights, (length_x, length_y) = surface["heights"], surface["size"]
nx, ny = heights.shape
random = np.random.default_rng(1)
x = (np.arange(nx)[:, None] + 0.5) * length_x / nx
y = (np.arange(ny)[None, :] + 0.5) * length_y / ny
heights = heights + np.tan(np.radians(0.5)) * x - np.tan(np.radians(0.3)) * y
spikes = random.random((nx, ny)) < 5e-4
heights[spikes] += 3e-6 * random.choice([-1, 1], spikes.sum())
# Drop-outs come in patches: where a smooth random field is high.
waves = [(random.integers(1, 9), random.integers(1, 9), *random.random(2)) for _ in range(12)]
field = sum(np.cos(2 * np.pi * (k * x / length_x + l * y / length_y + p)) * w for k, l, p, w in waves)
heights[field > np.quantile(field, 0.985)] = np.nan
surface["heights"] = np.ascontiguousarray(heights)
surface["history"] = np.array(str(surface["history"]) + "; tilt, spikes and points without a height were added")
np.savez(target, **surface)
