"""A file of force curves, as an instrument writes it: made by afmformats, which also reads it."""

import numpy as np

RADIUS, YOUNG, WORK = 10e-6, 1e6, 5e-3


def jkr(n=200, young=YOUNG, work=WORK):
    """Load and depth of the JKR equations down to pull-off, then of the free sphere."""
    stiffness = 4 / 3 * young / 0.75
    a = np.linspace(2.2, 0.551, n)
    load = np.pi * work * RADIUS * (a**3 - np.sqrt(6) * a**1.5)
    depth = (np.pi**2 * work**2 * RADIUS / stiffness**2) ** (1 / 3) * (a**2 - 2 / 3 * np.sqrt(6 * a))
    return np.append(load, np.zeros(n // 2)), np.append(depth, depth[-1] - np.linspace(1e-9, 3e-7, n // 2))


def stiffness_of(shape):
    """Young's moduli of the map: a stiff inclusion in the middle of a body of YOUNG."""
    x, y = (np.linspace(-1.0, 1.0, count) for count in shape)
    return YOUNG * (1.0 + 2.0 * np.exp(-4.0 * (x[:, None] ** 2 + y[None, :] ** 2)))


def write_force_map(path, shape=(6, 5), noise=1e-9, side=2e-6):
    """Approach and retraction at each pixel, with noise of the force [N]; pixels are squares of this side."""
    import afmformats
    import h5py

    random = np.random.default_rng(3)
    with h5py.File(path, "w") as file:
        for n, (i, j) in enumerate(np.ndindex(*shape)):
            load, depth = jkr(young=stiffness_of(shape)[i, j])
            force = np.concatenate([load[::-1], load]) + random.normal(0.0, noise, 2 * len(load))
            deep = np.concatenate([depth[::-1], depth])
            columns = {
                "force": force,
                # Heights grow away from the sample: the tip is at height + force/k.
                "height (measured)": -deep - force / 0.5,
                "segment": np.repeat(np.array([0, 1], dtype=np.uint8), len(load)),
                "time": 0.01 * np.arange(len(force)),
            }
            about = {"imaging mode": "force-distance", "spring constant": 0.5, "path": path, "point count": len(force), "enum": n}
            for axis, index, count in zip("xy", (i, j), shape):
                about |= {f"grid index {axis}": index, f"grid shape {axis}": count, f"grid size {axis}": count * side}
            afmformats.AFMForceDistance(columns, about).export_data(file, metadata=True, fmt="hdf5")
