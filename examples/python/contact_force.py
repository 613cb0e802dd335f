# SPDX-License-Identifier: GPL-3.0-or-later
"""The force of a table on a cloth that falls onto it, over time.

However the cloth lands, the force's integral over time is the weight times the time since its fall began, less the
momentum that is left; in the end the force is the weight.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import arris

SIZE, DENSITY, GRAVITY = 0.3, 0.15, 9.81  # m, kg/m^2, m/s^2
WEIGHT = SIZE**2 * DENSITY * GRAVITY  # N
DURATION = 0.8  # s


def fall():
    """Times of steps' ends (s), and the mean upward force in each step (N)."""
    simulation = arris.Simulation({
        "duration": DURATION,
        "time": {"integrator": "implicit_euler"},  # its force is the mean force of the step
        "cloth": {"size": [SIZE, SIZE], "resolution": [8, 8], "translate": [-0.15, -0.15, 0.1],
                  "rotate": {"axis": [1, 1, 0], "degrees": 8}, "material": {"damping": 0.005}},
        "gravity": {},
        "obstacle": [{"name": "table", "box": [1.0, 1.0, 0.1], "translate": [0, 0, -0.05]}],
    })
    times, forces = [], []
    for report in simulation:
        times.append(report["time"])
        forces.append(simulation.contacts()["force"][:, 2].sum())
    return np.array(times), np.array(forces)


def main(picture="contact_force.png"):
    times, forces = fall()
    steps = np.diff(times, prepend=0.0)
    momentum = (forces * steps).sum()
    print(f"at rest: {forces[-1]:.6f} N, weight {WEIGHT:.6f} N")
    print(f"integral of the force: {momentum:.6f} N s, weight times time {WEIGHT * times[-1]:.6f} N s")
    figure, axes = plt.subplots()
    axes.plot(times, forces, linewidth=1, label="force of the table")
    axes.axhline(WEIGHT, color="k", linewidth=0.8, label="weight")
    axes.set(xlabel="time (s)", ylabel="force (N)")
    axes.legend()
    figure.savefig(picture, dpi=150)
    return forces[-1] / WEIGHT, momentum / (WEIGHT * times[-1])


if __name__ == "__main__":
    main(*sys.argv[1:])
