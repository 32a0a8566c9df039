"""Draws the picture of the README: python rough_pmma.py RESULT.zarr PICTURE.png"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

result = xr.open_zarr(sys.argv[1])
side = float(result.x[-1] + result.x[0]) * 1e6
first, last = result.pressure.isel(field_time=0) / 1e6, result.pressure.isel(field_time=-1) / 1e6
top = float(max(first.max(), last.max()))

plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
figure = plt.figure(figsize=(10, 3.4), layout="constrained")
left, middle, right = figure.subplots(1, 3, width_ratios=[1, 1, 1.1])
colours = plt.get_cmap("inferno").copy()
colours.set_bad("#e9edf2")
for axes, field in ((left, first), (middle, last)):
    image = axes.imshow(
        np.where(field.T > 0, field.T, np.nan),
        origin="lower",
        extent=(0, side, 0, side),
        vmin=0,
        vmax=top,
        cmap=colours,
        interpolation="none",
    )
    fraction = 100 * float((field > 0).mean())
    axes.set_title(f"t = {float(field.field_time):g} s: {fraction:.1f} % in contact")
    axes.set_xlabel("x [µm]")
    axes.spines[["top", "right"]].set_visible(True)
left.set_ylabel("y [µm]")
bar = figure.colorbar(image, ax=[left, middle], shrink=0.85, pad=0.02)
bar.set_label("pressure [MPa], cut off at 300")

area = right.plot(result.time, 100 * result.contact_fraction, color="#1f5fa8", label="contact area")
right.set_xlabel("time [s]")
right.set_ylabel("contact area [% of the domain]", color="#1f5fa8")
right.set_title("area and approach under 0.5 N")
approach_axes = right.twinx()
approach_axes.spines["right"].set_visible(True)
approach = approach_axes.plot(result.time, 1e6 * result.approach, color="#c1541c", ls="--", label="approach")
approach_axes.set_ylabel("approach [µm]", color="#c1541c")
right.legend(handles=area + approach, loc="lower right", frameon=False)
figure.savefig(sys.argv[2], dpi=160)
