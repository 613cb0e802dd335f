# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits the coefficient of friction to a measured way down a ramp, with SciPy.

A cloth lies on a ramp and slides. What it did is known here: way = g (sin a - mu cos a) t^2 / 2, so that the fit has a
truth to be compared with.
"""

import numpy as np
from scipy.optimize import brentq

import arris

SLOPE = 30.0  # degrees
TIME = 0.25  # s
TRUE_COEFFICIENT = 0.35


def down_the_ramp():
    angle = np.radians(SLOPE)
    return np.array([np.cos(angle), 0.0, -np.sin(angle)])


def closed_form(coefficient):
    """The way (m) after TIME."""
    angle = np.radians(SLOPE)
    return 9.81 * (np.sin(angle) - coefficient * np.cos(angle)) * TIME**2 / 2


def slide(coefficient):
    """The way (m) of the middle of a simulated cloth after TIME."""
    turned = {"axis": [0, 1, 0], "degrees": SLOPE}
    up = np.array([np.sin(np.radians(SLOPE)), 0.0, np.cos(np.radians(SLOPE))])
    simulation = arris.Simulation({
        "duration": TIME,
        "cloth": {"size": [0.2, 0.1], "resolution": [4, 2], "rotate": turned,
                  "translate": 0.0010001 * up - 0.1 * down_the_ramp() + [0, -0.05, 0]},
        "gravity": {},
        "friction": {"coefficient": coefficient},
        "obstacle": [{"name": "ramp", "box": [2.0, 1.0, 0.1], "rotate": turned, "translate": -0.05 * up}],
    })
    before = simulation.positions.mean(axis=0)
    simulation.run_until(TIME)
    return (simulation.positions.mean(axis=0) - before) @ down_the_ramp()


def main():
    measured = closed_form(TRUE_COEFFICIENT)
    fitted = brentq(lambda coefficient: slide(coefficient) - measured, 0.05, 0.55, xtol=1e-5)
    print(f"measured way: {1000 * measured:.3f} mm; fitted coefficient: {fitted:.5f} (true: {TRUE_COEFFICIENT})")
    return fitted


if __name__ == "__main__":
    main()
