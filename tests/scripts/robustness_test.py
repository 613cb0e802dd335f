# SPDX-License-Identifier: GPL-3.0-or-later
"""The scripts that judge runs: each fault is found, and shrinking and comparing do what they say."""
import copy
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import tomllib
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from random_scene import RandomScene, SceneMaker, toml_text  # noqa: E402
from run_verdict import Outcome, RunFiles, find_faults, is_driven, run_program  # noqa: E402
from same_run import find_difference, lasting_rows  # noqa: E402
from shrink_scene import shrink  # noqa: E402

SOUND = {"kinetic_energy": 0.1, "gravity_energy": 0.5, "stretch_energy": 0.1, "bending_energy": "", "material_area": 1.0,
         "max_penetration": 0, "crossings": 0, "min_angle": 30, "kkt_residual": 1e-12, "factorisations": 2, "contacts": 1,
         "cpu_s": 0.1}
REPORT = {"status": "finished", "message": "", "steps": 2, "halved_steps": 0, "scene": {
    "cloth": {"material": {"density": 0.05}}, "solver": {"tolerance": 1e-9}, "gravity": {},
    "obstacle": [{"name": "lower"}, {"name": "upper", "motion": {"velocity": [0, 0, -1]}}]}}
PINNED = "no velocity keeps vertex 7, at [0, 0, 0], out of lower in the step: pin.0 holds the vertex where lower is; change"
CRUSHED = "no velocity keeps vertex 7, at [0, 0, 0], out of {} and {} in the step: these obstacles leave it no room"


def make_run(folder, last_row=(), report=()):
    folder.mkdir()
    rows = [SOUND, SOUND, {**SOUND, **dict(last_row)}]
    lines = [",".join(SOUND)] + [",".join(str(row[name]) for name in SOUND) for row in rows]
    (folder / "steps.csv").write_text("\n".join(lines) + "\n")
    (folder / "report.json").write_text(json.dumps({**REPORT, **dict(report)}))
    return folder


class Verdict(unittest.TestCase):
    def kinds(self, exit_status=0, last_row=(), still=True, **report):
        with tempfile.TemporaryDirectory() as folder:
            scene = copy.deepcopy(REPORT["scene"])
            if still:
                scene["obstacle"][1]["motion"]["velocity"] = [0, 0, 0]
            folder = make_run(pathlib.Path(folder) / "run", last_row, {"scene": scene, **report})
            return [fault.kind for fault in find_faults(Outcome(exit_status, "arris: why"), RunFiles(folder))]

    def test_a_sound_run_has_no_fault(self):
        self.assertEqual(self.kinds(), [])

    def test_each_bound_of_a_row_is_checked(self):
        for row, kind in (({"max_penetration": 1e-9}, "penetration"), ({"crossings": 1}, "crossings"),
                          ({"material_area": 1.0 + 1e-9}, "area"), ({"min_angle": 0}, "orientation"),
                          ({"kkt_residual": 1e-8}, "residual"), ({"factorisations": 401}, "factorisations"),
                          ({"kinetic_energy": "nan"}, "not finite"), ({"gravity_energy": 0.51}, "energy")):
            self.assertEqual(self.kinds(last_row=row)[:1], [kind], row)

    def test_a_driven_scene_may_gain_energy(self):
        self.assertEqual(self.kinds(last_row={"gravity_energy": 2.0}, still=False), [])

    def test_an_end_is_judged_by_status_and_line(self):
        self.assertEqual(self.kinds(exit_status=None), ["hang"])
        self.assertEqual(self.kinds(exit_status=2), ["refused"])
        self.assertEqual(self.kinds(exit_status=-11), ["crash"])
        self.assertEqual(self.kinds(exit_status=1, status="not_converged"), ["not_converged"])
        self.assertEqual(self.kinds(exit_status=1, status="infeasible", message=PINNED), [])
        self.assertEqual(self.kinds(exit_status=1, status="infeasible", message="no velocity"), ["infeasible"])

    def test_obstacles_leave_no_room_only_where_one_moves(self):
        crushed = CRUSHED.format("lower", "upper")
        self.assertEqual(self.kinds(1, still=False, status="infeasible", message=crushed), [])
        self.assertEqual(self.kinds(1, still=True, status="infeasible", message=crushed), ["infeasible"])

    def test_what_does_work_is_a_drive(self):
        self.assertFalse(is_driven({"gravity": {}, "pin": [{"velocity": [0, 0, 0]}]}))
        for part in ({"wind": {}}, {"pull": [{}]}, {"pin": [{"angular_velocity": [0, 0, 1]}]},
                     {"obstacle": [{"keyframes": [{"translate": [0, 0, 0]}, {"translate": [0, 0, 1]}]}]}):
            self.assertTrue(is_driven(part), part)


class Limits(unittest.TestCase):
    def test_a_program_that_spins_is_stopped(self):
        self.assertIsNone(run_program("sh", ["-c", "while :; do :; done"], 1).exit)

    def test_exit_status_and_errors_are_kept(self):
        outcome = run_program("sh", ["-c", "echo first >&2; echo why >&2; exit 2"], 5)
        self.assertEqual((outcome.exit, outcome.last_error), (2, "why"))


class Comparison(unittest.TestCase):
    def test_a_difference_is_found_and_seconds_are_none(self):
        with tempfile.TemporaryDirectory() as folder:
            a = make_run(pathlib.Path(folder) / "a")
            b = make_run(pathlib.Path(folder) / "b", {"cpu_s": 9.0}, {"threads": 7})
            c = make_run(pathlib.Path(folder) / "c", {"contacts": 2})
            self.assertIsNone(find_difference(a, b))
            self.assertEqual(find_difference(a, c), "steps.csv")
            (b / "more").write_text("x")
            self.assertEqual(find_difference(a, b), "files: more")

    def test_a_torn_line_is_left_out(self):
        self.assertEqual(lasting_rows("a,b,c_s\n1,2,3\n4,"), [{"a": "1", "b": "2"}])


class Shrinking(unittest.TestCase):
    def test_what_does_not_matter_is_dropped(self):
        made = SceneMaker(random.Random(5)).make("scene")
        made.scene["obstacle"] = [{"name": "o0", "box": [1, 1, 1]}, {"name": "o1", "points": [[0, 0, 0]]}]
        made.scene.update(wind={"velocity": [1, 0, 0]}, self_contact={}, remesh={"vertices": 4000})
        has_nail = lambda candidate: any("points" in o for o in candidate.scene.get("obstacle", []))
        small = shrink(made, lambda candidate: "fails" if has_nail(candidate) else None).scene
        self.assertEqual([o["name"] for o in small["obstacle"]], ["o1"])
        for effect in ("wind", "self_contact", "remesh"):
            self.assertNotIn(effect, small)
        self.assertLessEqual(max(small["cloth"]["resolution"]), 2)

    def test_faces_of_a_mesh_are_dropped(self):
        text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"
        scene = SceneMaker(random.Random(6)).make("scene").scene
        scene["obstacle"] = [{"name": "o0", "file": "random.obj"}]
        has_corner = lambda candidate: "v 0 0 1" in candidate.meshes.get("random.obj", "")
        small = shrink(RandomScene(scene, {"random.obj": text}), lambda c: "fails" if has_corner(c) else None)
        self.assertEqual(sum(line.startswith("f ") for line in small.meshes["random.obj"].splitlines()), 1)


class EveryScene(unittest.TestCase):
    def test_is_run_in_several_variants(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        lines = subprocess.run([root / "scripts/scenes", "--list"], check=True, capture_output=True, text=True).stdout
        runs = [line.split()[:3] for line in lines.splitlines()]
        scenes = {path.stem for path in (root / "data/scenes").glob("*.toml")}
        self.assertEqual({run[0] for run in runs}, scenes)
        for scene in scenes:
            self.assertGreaterEqual(len({tuple(run) for run in runs if run[0] == scene}), 6, scene)


class RandomScenes(unittest.TestCase):
    def test_are_the_same_for_the_same_seed_and_read_back(self):
        for number in range(200):
            made = SceneMaker(random.Random(f"1:{number}")).make("scene")
            again = SceneMaker(random.Random(f"1:{number}")).make("scene")
            self.assertEqual(made, again)
            self.assertEqual(tomllib.loads(toml_text(made.scene)), made.scene)


if __name__ == "__main__":
    unittest.main()
