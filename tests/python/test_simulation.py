# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module: steps are those of the program, arrays are views, states come back, bad input is one line.

usage: test_simulation.py PROGRAM [unittest arguments]; the package is on PYTHONPATH.
"""

import csv
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import arris
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "data" / "scenes"
PROGRAM = "arris"

def make_scene(**changes):
    """A small cloth above a box, hanging from one corner."""
    scene = {
        "duration": 0.5,
        "cloth": {"size": [0.4, 0.4], "resolution": [6, 6], "translate": [-0.2, -0.2, 0.03]},
        "gravity": {},
        "pin": [{"material": [[0.0, 0.0], [0.0, 0.0]]}],
        "obstacle": [{"name": "box", "box": [0.2, 0.2, 0.1], "translate": [0.0, 0.0, -0.05]}],
    }
    return scene | changes


class Steps(unittest.TestCase):
    def compare(self, name, *settings):
        """Every frame and row of a run by the program, with those of the module."""
        with tempfile.TemporaryDirectory() as folder:
            command = [PROGRAM, "run", SCENES / f"{name}.toml", "-o", f"{folder}/run", "--quiet",
                       "--set", "output.formats=[]"]
            for key, value in settings:
                command += ["--set", f"{key}={value}"]
            subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
            simulation = arris.Simulation(SCENES / f"{name}.toml", set=dict(settings))
            reports = {0.0: None}
            frames = sorted(Path(folder, "run", "frames").iterdir())
            rate = simulation.scene["output"]["frames_per_second"]
            for number, frame in enumerate(frames):
                while simulation.time < number / rate:
                    report = simulation.step()
                    reports[report["time"]] = report
                simulation.write_frame(f"{folder}/frame.ply")
                self.assertEqual(Path(folder, "frame.ply").read_bytes(), frame.read_bytes(), f"{name}: {frame.name}")
            self.assertGreater(len(frames), 3)
            with open(f"{folder}/run/steps.csv", encoding="ascii") as file:
                rows = [row for row in csv.DictReader(file) if float(row["time"]) in reports and row["step"] != "0"]
            self.assertGreater(len(rows), 3)
            for row in rows:
                report = reports[float(row["time"])]
                if report["parts"] > 1:
                    continue
                for column, cell in row.items():
                    if not column.endswith("_s"):
                        self.assertEqual(cell and float(cell), "" if report[column] is None else report[column], column)

    def test_are_those_of_the_program(self):
        self.compare("slipping", ("duration", 0.5))

    def test_are_those_of_the_program_with_pieces_seams_friction_and_moving_obstacles(self):
        self.compare("sleeve", ("duration", 0.2))
        self.compare("garments", ("duration", 0.15))
        self.compare("turning_box", ("duration", 0.2))
        self.compare("cape", ("duration", 0.15))

    def test_are_those_of_the_program_where_panels_are_sewn_first(self):
        self.compare("tube", ("duration", 0.2))

    def test_are_the_same_for_any_number_of_threads(self):
        positions = []
        for threads in (1, 2):
            simulation = arris.Simulation(SCENES / "slipping.toml", threads=threads)
            simulation.run_until(0.2)
            positions.append(simulation.positions)
            del simulation
        np.testing.assert_array_equal(*positions)

    def test_come_from_a_dict_as_from_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "scene.toml")
            path.write_text('duration = 0.2\ntitle = "a \\"b\\""\n[cloth]\nsize = [1, 0.5]\nresolution = [4, 2]\n'
                            "[gravity]\nacceleration = [0.0, 1.0, -3.0]\n[eol]\nenabled = false\n")
            of_file = arris.Simulation(path)
            of_dict = arris.Simulation({
                "duration": np.float32(0.2).astype(float).round(3), "title": 'a "b"',
                "cloth": {"size": np.array([1.0, 0.5]), "resolution": (np.int64(4), 2)},
                "gravity": {"acceleration": np.array([0, 1, -3])}, "eol": {"enabled": np.bool_(False)}})
            self.assertEqual(of_file.scene, of_dict.scene)
            for simulation in (of_file, of_dict):
                simulation.run_until(0.2)
            np.testing.assert_array_equal(of_file.positions, of_dict.positions)

    def test_read_meshes_that_paths_of_a_dict_name_from_its_folder(self):
        scene = make_scene(obstacle=[{"name": "chair", "file": "../meshes/chair.obj"}])
        scene["cloth"]["translate"] = [-0.2, -0.2, 2.0]
        simulation = arris.Simulation(scene, folder=SCENES)
        self.assertEqual(simulation.obstacles, ["chair"])
        with self.assertRaisesRegex(arris.InputError, "chair.obj"):
            arris.Simulation(scene)

    def test_take_a_scene_with_all_its_defaults(self):
        simulation = arris.Simulation(make_scene(title=None))
        self.assertEqual(arris.Simulation(simulation.scene).scene, simulation.scene)

    def test_end_with_the_scene(self):
        simulation = arris.Simulation(make_scene(duration=0.02))
        reports = list(simulation)
        self.assertTrue(simulation.is_over)
        self.assertEqual(reports[-1]["time"], 0.02)
        self.assertEqual(sum(report["dt"] for report in reports), 0.02)
        with self.assertRaisesRegex(arris.InputError, "duration"):
            simulation.step()
        self.assertIsNone(simulation.run_until(0.02))
        for time_ in (0.021, float("nan")):
            with self.assertRaisesRegex(arris.InputError, "0.02"):
                simulation.run_until(time_)

    def test_hold_vertices_as_a_box_does(self):
        """Whatever the mesh becomes: an edge and a corner of the cloth, as boxes and as vertices."""
        scene = make_scene(remesh={"edge_length": [0.02, 0.1]}, wind={"velocity": [2, 1, 0]}, duration=0.3)
        boxes = [{"material": [[0, 0], [0.2, 0.4]]}, {"material": [[0.4, 0.4], [0.4, 0.4]], "velocity": [0, 0, 0.1]}]
        by_box = arris.Simulation(scene | {"pin": boxes})
        near = [np.flatnonzero((by_box.material >= np.subtract(box["material"][0], 1e-9)).all(axis=1)
                               & (by_box.material <= np.add(box["material"][1], 1e-9)).all(axis=1)) for box in boxes]
        by_vertices = arris.Simulation(scene | {"pin": [{"vertices": near[0]},
                                                        {"vertices": near[1], "velocity": [0, 0, 0.1]}]})
        for simulation in (by_box, by_vertices):
            simulation.run_until(0.3)
        self.assertNotEqual(len(by_box.positions), 85)
        np.testing.assert_array_equal(by_box.positions, by_vertices.positions)

    def test_that_fail_raise_and_keep_the_state(self):
        plates = [{"name": name, "box": [1, 1, 0.1], "translate": [0, 0, height], "motion": {"velocity": [0, 0, speed]}}
                  for name, height, speed in (("low", -0.06, 0.5), ("high", 0.06, -0.5))]
        scene = {"duration": 1.0, "cloth": {"size": [0.4, 0.4], "resolution": [3, 3], "translate": [-0.2, -0.2, 0]},
                 "obstacle": plates}
        simulation = arris.Simulation(scene)
        with self.assertRaises(arris.StepError) as raised:
            simulation.run_until(1.0)
        self.assertIsInstance(raised.exception, RuntimeError)
        self.assertIn(raised.exception.status, ("infeasible", "not_converged"))
        self.assertIn(raised.exception.status, str(raised.exception))
        self.assertIn("low", str(raised.exception))
        self.assertGreater(simulation.time, 0.0)
        self.assertTrue(np.isfinite(simulation.positions).all())

    def test_warn_as_the_program(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            arris.Simulation(make_scene(wind={"velocity": [0, 0, 0], "gust": {"amplitude": 1, "frequency": 1}}))
        self.assertTrue(any("wind.gust" in str(line.message) for line in caught))
        self.assertTrue(all(line.category is arris.SceneWarning for line in caught))
        self.assertTrue(all(line.filename == __file__ for line in caught))


class Arrays(unittest.TestCase):
    def test_have_shapes_and_types(self):
        simulation = arris.Simulation(SCENES / "slipping.toml")
        simulation.run_until(0.4)
        n, m = len(simulation.positions), len(simulation.faces)
        for array, shape, kind in ((simulation.positions, (n, 3), "f8"), (simulation.velocities, (n, 3), "f8"),
                                   (simulation.material, (n, 2), "f8"), (simulation.faces, (m, 3), "i4"),
                                   (simulation.eol, (n,), "u1")):
            self.assertEqual((array.shape, array.dtype), (shape, np.dtype(kind)))
        self.assertGreater((simulation.eol > 0).sum(), 0)
        self.assertEqual(simulation.faces.max(), n - 1)

    def test_are_views_without_a_copy_that_nobody_may_write(self):
        simulation = arris.Simulation(make_scene())
        for name in ("positions", "velocities", "material", "faces"):
            self.assertTrue(np.shares_memory(getattr(simulation, name), getattr(simulation, name)), name)
            with self.assertRaises(ValueError):
                getattr(simulation, name)[0, 0] = 1

    def test_keep_their_values_when_the_simulation_goes_on_and_ends(self):
        simulation = arris.Simulation(make_scene())
        views, copies = [], []
        for _ in range(5):
            simulation.step()
            views.append((simulation.positions, simulation.velocities, simulation.faces))
            copies.append(tuple(view.copy() for view in views[-1]))
        simulation.load_state(arris.Simulation(make_scene()).save_state())
        simulation.step()
        del simulation
        for view, copy in zip(views, copies):
            for a, b in zip(view, copy):
                np.testing.assert_array_equal(a, b)
        self.assertFalse(np.array_equal(views[0][0], views[1][0]))

    def test_do_not_change_the_simulation(self):
        plain, watched = arris.Simulation(make_scene()), arris.Simulation(make_scene())
        kept = []
        for _ in range(20):
            plain.step()
            watched.step()
            kept.append((watched.positions, watched.contacts(), watched.energies()))
        np.testing.assert_array_equal(plain.positions, watched.positions)
        self.assertEqual(plain.save_state(), watched.save_state())

    def test_of_seams_have_further_points(self):
        simulation = arris.Simulation(SCENES / "sleeve.toml")
        points, faces = simulation.material_points, simulation.face_points
        self.assertGreater(len(points), len(simulation.positions))
        np.testing.assert_array_equal(points[: len(simulation.material)], simulation.material)
        corners = points[faces]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        self.assertGreater((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).min(), 0.0)


class Readings(unittest.TestCase):
    def test_of_contacts_hold_the_weight_of_cloth_at_rest(self):
        scene = {
            "duration": 1.0, "time": {"step": 0.01},
            "cloth": {"size": [0.3, 0.2], "resolution": [4, 3], "translate": [-0.15, -0.1, 0.0015],
                      "material": {"damping": 0.01}},
            "gravity": {}, "friction": {"coefficient": 0.5},
            "obstacle": [{"name": "plate", "box": [1, 1, 0.1], "translate": [0, 0, -0.05]}]}
        simulation = arris.Simulation(scene)
        self.assertEqual(len(simulation.contacts()["force"]), 0)
        simulation.run_until(1.0)
        contacts = simulation.contacts()
        weight = 0.3 * 0.2 * 0.15 * 9.81
        self.assertAlmostEqual(contacts["force"][:, 2].sum() / weight, 1.0, delta=1e-4)
        self.assertEqual(set(contacts["with"]), {"plate"})
        self.assertEqual(contacts["vertices"].shape, (len(contacts["with"]), 4))
        self.assertEqual(contacts["friction"].shape, (len(contacts["with"]), 3))

    def test_of_contacts_hold_the_weight_of_cloth_that_hangs_over_edges(self):
        """At rest, and their impulses while it falls: all that edges and corners exert counts."""
        for friction in (0.8, 0.2):
            scene = {
                "duration": 1.5, "time": {"integrator": "implicit_euler"},
                "cloth": {"size": [0.4, 0.4], "resolution": [8, 8], "translate": [-0.2, -0.2, 0.0011],
                          "material": {"damping": 0.02, "bending_stiffness": 1e-4}},
                "gravity": {}, "friction": {"coefficient": friction},
                "obstacle": [{"name": "table", "box": [0.3, 0.3, 0.2], "translate": [0, 0, -0.1]}]}
            simulation = arris.Simulation(scene)
            weight, impulse = 0.4 * 0.4 * 0.15 * 9.81, 0.0
            for report in simulation:
                contacts = simulation.contacts()
                impulse += report["dt"] * (contacts["force"] + contacts["friction"])[:, 2].sum()
            self.assertGreater((simulation.eol > 0).sum(), 10)
            contacts = simulation.contacts()
            total = (contacts["force"] + contacts["friction"]).sum(axis=0)
            np.testing.assert_allclose(total / weight, [0, 0, 1], atol=1e-3)
            self.assertAlmostEqual(impulse / (weight * simulation.time), 1.0, delta=0.01)

    def test_of_contacts_balance_between_two_obstacles(self):
        """A plate squeezes cloth on a table, with EOL vertices at the plate's edges: the difference is the weight."""
        for step in (0.003, 0.005, 0.008):
            simulation = arris.Simulation({
                "duration": 0.6, "time": {"step": step}, "gravity": {},
                "cloth": {"size": [0.2, 0.2], "resolution": [8, 8], "translate": [-0.1, -0.1, 0.0011],
                          "material": {"preset": "denim", "damping": 0.02}},
                "obstacle": [{"name": "table", "box": [1, 1, 0.1], "translate": [0, 0, -0.05]},
                             {"name": "plate", "box": [0.1, 0.1, 0.02],
                              "keyframes": [{"time": 0.05, "translate": [0, 0, 0.0125]},
                                            {"time": 0.2, "translate": [0, 0, 0.01197]}]}]})
            simulation.run_until(0.6)
            contacts = simulation.contacts()
            up = (contacts["force"] + contacts["friction"])[:, 2]
            self.assertLess(up[contacts["with"] == "plate"].sum(), -0.1)
            self.assertAlmostEqual(up.sum() / (0.04 * 0.4 * 9.81), 1.0, delta=0.01)

    def test_of_friction_are_coulombs_force_on_the_cloth(self):
        tilt = np.radians(30.0)
        up, down = np.array([np.sin(tilt), 0, np.cos(tilt)]), np.array([np.cos(tilt), 0, -np.sin(tilt)])
        turned = {"axis": [0, 1, 0], "degrees": 30}
        simulation = arris.Simulation({
            "duration": 0.2,
            "cloth": {"size": [0.2, 0.1], "resolution": [4, 2], "rotate": turned,
                      "translate": 0.0010001 * up - 0.1 * down - [0, 0.05, 0]},
            "gravity": {}, "friction": {"coefficient": 0.2},
            "obstacle": [{"name": "ramp", "box": [2, 1, 0.1], "rotate": turned, "translate": -0.05 * up}]})
        simulation.run_until(0.2)
        contacts = simulation.contacts()
        normal = contacts["force"].sum(axis=0)
        np.testing.assert_allclose(normal, normal @ up * up, atol=1e-9)
        np.testing.assert_allclose(contacts["friction"].sum(axis=0), -0.2 * (normal @ up) * down, atol=1e-6)

    def test_of_energies_and_probes_are_those_of_the_report(self):
        scene = make_scene(probe=[{"name": "corner", "material": [0.4, 0.4]}])
        simulation = arris.Simulation(scene)
        report = simulation.run_until(0.1)
        energies = simulation.energies()
        for name in ("kinetic", "gravity", "stretch", "bending"):
            self.assertEqual(energies[name], report[f"{name}_energy"])
        position, velocity = simulation.probes()["corner"]
        vertex = np.argmin(np.linalg.norm(simulation.material - 0.4, axis=1))
        np.testing.assert_allclose(position, simulation.positions[vertex], atol=1e-12)
        np.testing.assert_allclose(velocity, simulation.velocities[vertex], atol=1e-12)


class States(unittest.TestCase):
    def test_come_back_to_the_byte(self):
        simulation = arris.Simulation(SCENES / "slipping.toml")
        simulation.run_until(0.35)
        state = simulation.save_state()
        simulation.run_until(0.5)
        end = simulation.save_state()
        simulation.load_state(state)
        self.assertLess(simulation.time, 0.4)
        simulation.run_until(0.5)
        self.assertEqual(simulation.save_state(), end)
        other = arris.Simulation(SCENES / "slipping.toml")
        other.load_state(state)
        other.run_until(0.5)
        self.assertEqual(other.save_state(), end)

    def test_have_the_motion_that_was_set(self):
        simulation = arris.Simulation(make_scene())
        for k in range(6):
            simulation.set_pin(0, translate=[0.0, 0.002 * k, 0.0])
            simulation.set_obstacle("box", velocity=[0.1, 0, 0], angular_velocity=[0, 0, 1])
            simulation.step()
        state = simulation.save_state()
        untouched = arris.Simulation(make_scene())
        untouched.load_state(state)
        for other in (simulation, untouched):
            other.run_until(0.1)
        self.assertEqual(simulation.save_state(), untouched.save_state())
        fresh = arris.Simulation(make_scene())
        start = fresh.save_state()
        fresh.run_until(0.1)
        simulation.load_state(start)
        simulation.run_until(0.1)
        np.testing.assert_array_equal(simulation.positions, fresh.positions)

    def test_saved_before_the_first_step_of_a_motion_have_it(self):
        simulation, other = arris.Simulation(make_scene()), arris.Simulation(make_scene())
        simulation.run_until(0.05)
        simulation.set_obstacle("box", velocity=[0, 0, 0.1])
        other.load_state(simulation.save_state())
        for one in (simulation, other):
            one.run_until(0.1)
        self.assertEqual(simulation.save_state(), other.save_state())

    def test_know_whether_the_cloth_has_touched_anything(self):
        scene = make_scene(duration=0.2, pin=[])
        touched = arris.Simulation(scene)
        touched.run_until(0.19)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            other = arris.Simulation(scene)
            other.load_state(touched.save_state())
            other.run_until(0.2)
        self.assertFalse(any("touched none" in str(line.message) for line in caught))

    def test_of_another_scene_or_damaged_are_refused(self):
        simulation = arris.Simulation(make_scene())
        state = simulation.save_state()
        with self.assertRaisesRegex(arris.InputError, "another scene"):
            arris.Simulation(make_scene(duration=0.6)).load_state(state)
        damaged = bytearray(state)
        damaged[len(state) // 2] ^= 1
        for bad in (b"", b"nonsense", state[:-1], bytes(damaged), "text", None):
            with self.assertRaisesRegex(arris.InputError, "state"):
                simulation.load_state(bad)
        simulation.load_state(bytearray(state))
        simulation.step()


class Motion(unittest.TestCase):
    def test_of_pins_and_obstacles_is_that_of_keyframes(self):
        turn = {"axis": [0, 0, 1], "degrees": 0.3}
        given = arris.Simulation(make_scene())
        given.run_until(0.1)
        begin = given.time
        given.set_pin(0, translate=[0, 0, 0.001], rotate=turn)
        given.set_obstacle("box", [0, 0, -0.049])
        given.step()
        end = given.time
        keyed = arris.Simulation(make_scene(
            pin=[{"material": [[0, 0], [0, 0]],
                  "keyframes": [{"time": begin}, {"time": end, "translate": [0, 0, 0.001], "rotate": turn}]}],
            obstacle=[{"name": "box", "box": [0.2, 0.2, 0.1],
                       "keyframes": [{"time": begin, "translate": [0, 0, -0.05]},
                                     {"time": end, "translate": [0, 0, -0.049]}]}]))
        keyed.run_until(end)
        corner = np.flatnonzero((given.material == 0).all(axis=1))[0]
        np.testing.assert_allclose(given.positions[corner], keyed.positions[corner], atol=1e-15)
        np.testing.assert_allclose(given.obstacle_placement("box")[1], [0, 0, -0.049], atol=1e-15)
        given.step()
        np.testing.assert_allclose(given.obstacle_placement("box")[1], [0, 0, -0.049], atol=1e-15)

    def test_of_a_driven_obstacle_is_that_of_the_scenes_motion(self):
        still = make_scene(pin=[])
        moving = make_scene(pin=[])
        moving["obstacle"][0] = still["obstacle"][0] | {
            "motion": {"velocity": [0.2, 0, 0], "angular_velocity": [0, 0, 2], "pivot": [0.1, 0, 0]}}
        driven, scripted = arris.Simulation(still), arris.Simulation(moving)
        driven.set_obstacle("box", velocity=[0.2, 0, 0], angular_velocity=[0, 0, 2], pivot=[0.1, 0, 0])
        for time_, tolerance in ((0.1, 1e-3), (0.25, None)):
            for simulation in (driven, scripted):
                simulation.run_until(time_)
            for a, b in zip(driven.obstacle_placement("box"), scripted.obstacle_placement("box")):
                np.testing.assert_allclose(a, b, atol=1e-12)
            if tolerance:
                np.testing.assert_allclose(driven.positions, scripted.positions, atol=tolerance)
                self.assertGreater(len(driven.contacts()["force"]), 0)

    def test_that_jumps_gives_the_cloth_the_velocity_of_the_motion_and_no_other(self):
        """Cloth that is pinned all over, moved by velocity and by placements; a plate that starts under cloth."""
        pinned = {"duration": 0.5, "cloth": {"size": [0.4, 0.4], "resolution": [4, 4]},
                  "pin": [{"material": [[0, 0], [0.4, 0.4]]}]}
        simulation = arris.Simulation(pinned)
        simulation.run_until(0.1)
        simulation.set_pin(0, velocity=[0, 0, -1])
        for _ in range(3):
            simulation.step()
            np.testing.assert_allclose(simulation.velocities, [[0, 0, -1]] * len(simulation.positions), atol=1e-9)
        before = simulation.time, simulation.pin_placement(0)[1]
        simulation.set_pin(0, translate=[0, 0, -0.5])
        simulation.step()
        speed = (simulation.pin_placement(0)[1] - before[1]) / (simulation.time - before[0])
        np.testing.assert_allclose(simulation.velocities[0], speed, rtol=1e-9)
        simulation.step()
        np.testing.assert_allclose(simulation.velocities, 0.0, atol=1e-9)

        plate = {"name": "plate", "box": [1, 1, 0.1], "translate": [0, 0, -0.05]}
        lifted = arris.Simulation({"duration": 0.5, "obstacle": [plate],
                                   "cloth": {"size": [0.1, 0.1], "resolution": [2, 2],
                                             "translate": [-0.05, -0.05, 0.0010001]}})
        lifted.run_until(0.1)
        lifted.set_obstacle("plate", velocity=[0, 0, 1])
        for _ in range(5):
            lifted.step()
            np.testing.assert_allclose(lifted.velocities[:, 2], 1.0, atol=1e-3)

    def test_of_a_driven_pin_lasts_until_it_is_set_again(self):
        simulation = arris.Simulation(make_scene(obstacle=[]))
        corner = np.flatnonzero((simulation.material == 0).all(axis=1))[0]
        start = simulation.positions[corner]
        simulation.set_pin(0, velocity=[0, 0, 0.3])
        simulation.run_until(0.25)
        np.testing.assert_allclose(simulation.positions[corner], start + [0, 0, 0.3 * simulation.time], atol=1e-12)
        placed = simulation.pin_placement(0)[1]
        simulation.set_pin(0, translate=placed)
        simulation.step()
        simulation.step()
        np.testing.assert_allclose(simulation.positions[corner], start + placed, atol=1e-12)

    def test_that_makes_no_sense_is_refused(self):
        simulation = arris.Simulation(make_scene(
            pin=[{"material": [[0, 0], [0, 0]]}, {"material": [[0.4, 0.4], [0.4, 0.4]], "follow": "box"}]))
        for call in (lambda: simulation.set_pin(0), lambda: simulation.set_pin(2, [0, 0, 0]),
                     lambda: simulation.set_pin(-1, [0, 0, 0]), lambda: simulation.set_pin(1, [0, 0, 0]),
                     lambda: simulation.set_pin(0, [0, 0]), lambda: simulation.set_pin(0, [0, 0, float("nan")]),
                     lambda: simulation.set_pin(0, "up"), lambda: simulation.set_pin(0, [0, 0, 0], np.eye(2)),
                     lambda: simulation.set_pin(0, [0, 0, 0], -np.eye(3)),
                     lambda: simulation.set_pin(0, None, {"axis": 1}),
                     lambda: simulation.set_pin(0, None, {"axis": [0, 0, 0], "degrees": 3}),
                     lambda: simulation.set_pin(0, [0, 0, 0], velocity=[0, 0, 0]),
                     lambda: simulation.set_pin(0, [0, 0, 0], pivot=[0, 0, 0]),
                     lambda: simulation.set_pin(0.5, [0, 0, 0]), lambda: simulation.set_obstacle(3, [0, 0, 0]),
                     lambda: simulation.set_obstacle("bax", [0, 0, 0])):
            with self.assertRaises(arris.InputError) as raised:
                call()
            self.assertNotIn("\n", str(raised.exception))
        simulation.step()


class Errors(unittest.TestCase):
    def test_are_the_programs_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "bad.toml")
            path.write_text("duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, -2]\n")
            told = subprocess.run([PROGRAM, "check", path], capture_output=True, text=True, check=False).stderr
            with self.assertRaises(ValueError) as raised:
                arris.Simulation(path)
            self.assertIsInstance(raised.exception, arris.InputError)
            self.assertEqual(f"arris: {raised.exception}\n", told)

    def test_name_key_and_value(self):
        for scene, settings, words in (
                ({"duration": 1.0}, {}, "cloth"),
                ({"duration": float("inf"), "cloth": {"size": [1, 1], "resolution": [2, 2]}}, {}, "duration"),
                (make_scene(), {"time.step": "fast"}, "time.step"),
                (make_scene(), {"colour": 1}, "colour"),
                (make_scene(gravity={"acceleration": object()}), {}, "gravity.acceleration"),
                (make_scene(gravity={"acceleration": 1j}), {}, "gravity.acceleration"),
                ({1: 2}, {}, "1"),
                (SCENES / "none.toml", {}, "none.toml")):
            with self.assertRaisesRegex(arris.InputError, words):
                arris.Simulation(scene, set=settings)
        for threads in (0, -1, 1.5, "2", True, 1 << 40):
            with self.assertRaisesRegex(arris.InputError, "threads"):
                arris.Simulation(make_scene(), threads=threads)
        arris.Simulation(make_scene(), threads=np.int64(2))
        with self.assertRaisesRegex(arris.InputError, "set"):
            arris.Simulation(make_scene(), set=["time.step=1"])
        with self.assertRaisesRegex(arris.InputError, "title"):
            arris.Simulation(make_scene(title="\udcff"))

    def test_of_files_that_cannot_be_written_are_those_of_the_system(self):
        with self.assertRaises(OSError):
            arris.Simulation(make_scene()).write_frame("/nowhere/frame.ply")


class Interrupts(unittest.TestCase):
    SCENE = {"duration": 1.0, "cloth": {"size": [1, 1], "resolution": [60, 60], "translate": [-0.5, -0.5, 0.002]},
             "gravity": {}, "friction": {"coefficient": 0.5}, "self_contact": {},
             "obstacle": [{"name": "box", "box": [0.5, 0.5, 0.1], "translate": [0, 0, -0.05]}]}

    def test_leave_the_state_before_the_step(self):
        """Or after it, where the signal comes when the step is done."""
        undisturbed, interrupted = arris.Simulation(self.SCENE), arris.Simulation(self.SCENE)
        states = {0.0: undisturbed.save_state()}
        while undisturbed.time < 0.02:
            undisturbed.step()
            states[undisturbed.time] = undisturbed.save_state()
        count = 0
        while interrupted.time < 0.02 and count < 40:
            timer = threading.Timer(0.03 + 0.01 * count, lambda: os.kill(os.getpid(), signal.SIGINT))
            timer.start()
            try:
                interrupted.run_until(0.02)
                timer.join()
            except KeyboardInterrupt:
                count += 1
                self.assertEqual(interrupted.save_state(), states[interrupted.time])
        self.assertGreater(count, 0)

    def test_leave_given_motions_as_they_were(self):
        def make():
            simulation = arris.Simulation(self.SCENE)
            simulation.set_obstacle("box", velocity=[0, 0.1, 0], angular_velocity=[0, 0, 1], pivot=[0.1, 0, 0])
            return simulation

        undisturbed, interrupted = make(), make()
        undisturbed.step()
        with self.assertRaises(KeyboardInterrupt):  # a handler that raises, whenever the step first looks
            signal.setitimer(signal.ITIMER_REAL, 1e-3)
            previous = signal.signal(signal.SIGALRM, signal.default_int_handler)
            try:
                interrupted.step()
            finally:
                signal.signal(signal.SIGALRM, previous)
        if interrupted.time == 0.0:
            interrupted.step()
        self.assertEqual(undisturbed.save_state(), interrupted.save_state())

    def test_may_not_use_the_simulation_in_a_step(self):
        """Neither the handler of a signal, nor another thread. Either may come between two steps, where all may be
        done: so several are tried, and those that came in a step were refused everything."""
        simulation, seen = arris.Simulation(self.SCENE), []

        def use(*_):
            refused = 0
            calls = (simulation.save_state, simulation.contacts, lambda: simulation.positions, lambda: simulation.time,
                     lambda: simulation.set_obstacle("box", [0, 0, -0.05]), simulation.energies)
            for call in calls:
                try:
                    call()
                except RuntimeError as error:
                    refused += "in a step" in str(error)
            seen.append(refused / len(calls))

        previous = signal.signal(signal.SIGALRM, use)
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.02, 0.02)
            simulation.run_until(0.02)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, previous)
        self.assertIn(1.0, seen)
        self.assertLessEqual(set(seen), {0.0, 1.0})

        seen.clear()
        thread = threading.Thread(target=simulation.run_until, args=(0.04,))
        thread.start()
        while thread.is_alive():
            use()
            time.sleep(0.01)
        self.assertIn(1.0, seen)
        self.assertGreaterEqual(simulation.time, 0.04)

    def test_take_turns_with_the_same_bytes(self):
        """Two threads, each with a simulation; and a simulation that a signal's handler steps within a step."""
        scene = make_scene(self_contact={}, duration=0.15)
        alone = arris.Simulation(scene)
        alone.run_until(0.15)
        together = [arris.Simulation(scene) for _ in range(2)]
        threads = [threading.Thread(target=simulation.run_until, args=(0.15,)) for simulation in together]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        outer, inner = arris.Simulation(scene), arris.Simulation(scene)
        previous = signal.signal(signal.SIGALRM, lambda *_: inner.run_until(0.15))
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.02)
            outer.run_until(0.15)
        finally:
            signal.signal(signal.SIGALRM, previous)
        for simulation in (*together, outer, inner):
            np.testing.assert_array_equal(simulation.positions, alone.positions)

    def test_end_of_the_process_ends_steps_of_other_threads(self):
        code = ("import arris, threading, time; s = arris.Simulation({'duration': 9.0, 'cloth': {'size': [1, 1], "
                "'resolution': [80, 80]}, 'gravity': {}, 'pin': [{'material': [[0, 0], [0, 1]]}]}); "
                "threading.Thread(target=s.run_until, args=(9.0,), daemon=True).start(); time.sleep(0.3)")
        self.assertEqual(subprocess.run([sys.executable, "-c", code], stderr=subprocess.DEVNULL).returncode, 0)

    def test_other_threads_run_during_a_step(self):
        simulation = arris.Simulation(self.SCENE)
        counts, is_done = [], threading.Event()

        def count():
            while not is_done.is_set():
                counts.append(time.perf_counter())
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        begin = time.perf_counter()
        simulation.run_until(0.01)
        end = time.perf_counter()
        is_done.set()
        thread.join()
        self.assertGreater(sum(begin < at < end for at in counts), 10)


class Package(unittest.TestCase):
    def test_leaves_the_environment_as_it_was(self):
        code = ("import os; before = dict(os.environ); import arris; assert os.environ == before; "
                "print(arris.blas_kernel())")
        for kernel in ("Haswell", "Nehalem"):
            told = subprocess.run([sys.executable, "-c", code], env=os.environ | {"OPENBLAS_CORETYPE": kernel},
                                  capture_output=True, text=True, check=True).stdout
            self.assertEqual(told.strip(), kernel)
        environment = {key: value for key, value in os.environ.items() if key != "OPENBLAS_CORETYPE"}
        subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, check=True)

    def test_needs_no_numpy_until_arrays_are_asked_for(self):
        code = "import sys, arris; sys.exit('numpy' in sys.modules)"
        subprocess.run([sys.executable, "-c", code], check=True)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(verbosity=2, warnings="ignore")
