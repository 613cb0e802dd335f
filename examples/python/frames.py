# SPDX-License-Identifier: GPL-3.0-or-later
"""Six moments of a cloth that slips off a table, in one picture: for a notebook, the last line is `figure`."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import arris

SCENE = Path(__file__).resolve().parents[2] / "data" / "scenes" / "slipping.toml"


def draw(axes, simulation):
    x, y, z = simulation.positions.T
    axes.plot_trisurf(x, y, z, triangles=simulation.faces, color="tab:red", edgecolor="k", linewidth=0.1)
    on_edges = int((simulation.eol > 0).sum())
    axes.set(xlim=(-0.5, 0.6), ylim=(-0.55, 0.55), zlim=(-0.75, 0.35))
    axes.set_title(f"{simulation.time:.2f} s: {on_edges} vertices on edges", fontsize=9, y=0.98)
    axes.set_box_aspect((1, 1, 1), zoom=1.25)
    axes.set_axis_off()


def main(picture="frames.png"):
    simulation = arris.Simulation(SCENE)
    figure, axes = plt.subplots(2, 3, figsize=(9, 6), subplot_kw={"projection": "3d"}, layout="constrained")
    for place, time in zip(axes.flat, np.linspace(0.0, 0.9, 6)):
        simulation.run_until(time)
        draw(place, simulation)
    figure.savefig(picture, dpi=150)
    return figure


if __name__ == "__main__":
    main(*sys.argv[1:])
