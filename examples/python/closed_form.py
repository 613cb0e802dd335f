# SPDX-License-Identifier: GPL-3.0-or-later
"""A strip slides over a table's edge: the way of its end against the closed form.

Without friction the hanging length of a strip of length L grows from x0 as x0 cosh(t sqrt(g / L)), until the strip
lifts off. Eight cells follow it, as cloth vertices lie on the edge and the material flows through them.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import arris

SCENE = Path(__file__).resolve().parents[2] / "data" / "scenes" / "slide.toml"
HANGING, GRAVITY, LENGTH = 0.1, 9.81, 1.0  # m, m/s^2, m
END = 0.66  # s: it lifts off at 0.74


def slide(settings):
    """Times (s), and the way down (m) of the strip's end."""
    simulation = arris.Simulation(SCENE, set={"cloth.material.youngs_modulus": 2e5} | settings)  # N/m: hardly stretches
    start = simulation.probes()["tip"][0, 2]
    times, ways = [0.0], [0.0]
    while simulation.time < END:
        simulation.step()
        times.append(simulation.time)
        ways.append(start - simulation.probes()["tip"][0, 2])
    return np.array(times), np.array(ways)


def closed_form(times):
    return HANGING * (np.cosh(times * np.sqrt(GRAVITY / LENGTH)) - 1)


def main(picture="closed_form.png"):
    figure, axes = plt.subplots()
    errors = {}
    for label, settings in (("with EOL vertices", {}), ("without", {"eol.enabled": False})):
        times, ways = slide(settings)
        axes.plot(times, ways, ".", markersize=3, label=label)
        errors[label] = np.abs(ways - closed_form(times)).max() / closed_form(times[-1])
        print(f"{label}: off by at most {100 * errors[label]:.2g} % of the way")
    axes.plot(times, closed_form(times), "k-", linewidth=0.8, label="closed form")
    axes.set(xlabel="time (s)", ylabel="way of the strip's end (m)")
    axes.legend()
    figure.savefig(picture, dpi=150)
    return errors


if __name__ == "__main__":
    main(*sys.argv[1:])
