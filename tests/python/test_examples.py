# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples in Python run, draw their pictures, and their figures are those of the closed forms."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples" / "python"))

import closed_form
import contact_force
import fit_friction
import frames
import matplotlib.image
import numpy as np


class Examples(unittest.TestCase):
    def draw(self, example):
        with tempfile.TemporaryDirectory() as folder:
            picture = f"{folder}/picture.png"
            result = example.main(picture)
            self.assertGreater(np.ptp(matplotlib.image.imread(picture)), 0.5)
        return result

    def test_closed_form(self):
        errors = self.draw(closed_form)
        self.assertLess(errors["with EOL vertices"], 3e-4)
        self.assertGreater(errors["without"], 0.1)

    def test_fit_friction(self):
        self.assertAlmostEqual(fit_friction.main(), fit_friction.TRUE_COEFFICIENT, delta=1e-3)

    def test_contact_force(self):
        rest, momentum = self.draw(contact_force)
        self.assertAlmostEqual(rest, 1.0, delta=1e-3)
        self.assertAlmostEqual(momentum, 1.0, delta=1e-3)

    def test_frames(self):
        self.draw(frames)


if __name__ == "__main__":
    unittest.main(verbosity=2)
