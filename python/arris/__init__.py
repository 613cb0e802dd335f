# SPDX-License-Identifier: GPL-3.0-or-later
"""Arris: cloth that slides over sharp edges without snagging.

    import arris

    simulation = arris.Simulation("data/scenes/slipping.toml", set={"time.step": 0.002})
    for report in simulation:
        print(report["time"], report["kinetic_energy"], simulation.positions[:, 2].min())

Units are SI (m, kg, s, N), angles are in degrees, up is +z. The page docs/python.md has more.
"""

import os as _os


def _chosen_kernel():
    """The BLAS kernel that the program `arris` chooses, too, so that both give the same bytes; None: as OpenBLAS does.
    OpenBLAS reads the variable when it is loaded: where NumPy has loaded the same library before, that decides."""
    if "OPENBLAS_CORETYPE" in _os.environ:
        return None
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            flags = next((line.split() for line in file if line.startswith("flags")), [])
    except OSError:
        return None
    return "Haswell" if "avx2" in flags and "fma" in flags else None


_kernel = _chosen_kernel()
if _kernel:
    _os.environ["OPENBLAS_CORETYPE"] = _kernel
try:
    from ._arris import InputError, blas_kernel, version as __version__
finally:
    if _kernel:
        del _os.environ["OPENBLAS_CORETYPE"]

from .simulation import SceneWarning, Simulation, StepError

__all__ = ["InputError", "SceneWarning", "Simulation", "StepError", "blas_kernel"]
