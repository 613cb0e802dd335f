# SPDX-License-Identifier: GPL-3.0-or-later
"""The install and the Debian package: the example builds against the one, the program of the other runs a scene.

usage: package_test.py BUILD_FOLDER CMAKE
"""
import gzip
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CMAKE = sys.argv.pop()
BUILD = pathlib.Path(sys.argv.pop()).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
GRAVITY = 9.81  # m/s^2
FALL_TOLERANCE = 0.005  # relative, of steps of 0.005 s in a fall of 0.05 s; measured 0.003


def call(*words, folder=None):
    done = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{words}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class InTemporaryFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="arris_package_")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)


class Install(InTemporaryFolder):
    def test_example_builds_against_the_install_and_cloth_slides_over_the_edge(self):
        call(CMAKE, "--install", BUILD, "--prefix", self.path / "prefix")
        # A copy elsewhere, so that nothing of the sources is within reach.
        example = ROOT / "examples/falling_cloth"
        self.assertLessEqual(len((example / "main.cpp").read_text().splitlines()), 40)
        sources = self.path / "example"
        sources.mkdir()
        for file in example.iterdir():
            (sources / file.name).write_bytes(file.read_bytes())
        call(CMAKE, "-S", sources, "-B", self.path / "build", f"-DCMAKE_PREFIX_PATH={self.path / 'prefix'}")
        call(CMAKE, "--build", self.path / "build")
        self.assertNotIn(str(ROOT), (self.path / "build/CMakeCache.txt").read_text())
        self.assert_falls_and_slides(call(self.path / "build/falling_cloth"))

    def assert_falls_and_slides(self, output):
        rows = [tuple(map(float, re.findall(r"-?\d+\.?\d*", line)[:3])) for line in output.splitlines()]
        self.assertEqual(len(rows), 60)
        for time, lowest, eol in rows:
            if lowest > 0.055:  # m: above the box, whose top is at 0.05 m
                self.assertEqual(eol, 0)
        time, lowest, _ = rows[9]
        fallen = GRAVITY * time * time / 2
        self.assertAlmostEqual((0.1 - lowest) / fallen, 1.0, delta=FALL_TOLERANCE)
        self.assertGreater(rows[-1][2], 8)  # EOL vertices on the box's upper edges
        self.assertLess(rows[-1][1], -0.1)  # the cloth hangs far below the top


class DebianPackage(InTemporaryFolder):
    def setUp(self):
        super().setUp()
        call("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", self.path)
        [self.package] = self.path.glob("*.deb")
        call("dpkg-deb", "-x", self.package, self.path / "root")
        self.usr = self.path / "root/usr"
        self.program = self.usr / "bin/arris"

    def test_names_what_it_needs_and_holds_what_it_should(self):
        depends = call("dpkg-deb", "-f", self.package, "Depends")
        for library in ("libassimp", "libcholmod", "libc6", "libstdc++6"):
            self.assertIn(library, depends)
        manual = gzip.decompress((self.usr / "share/man/man1/arris.1.gz").read_bytes()).decode()
        self.assertEqual(manual, call(self.program, "docs", "man"))
        completion = self.usr / "share/bash-completion/completions/arris"
        self.assertEqual(completion.read_text(), call(self.program, "docs", "bash"))
        for file in ("README.md", "copyright", "docs/scene.md"):
            self.assertTrue((self.usr / "share/doc/arris" / file).is_file(), file)
        self.assertFalse((self.usr / "include").exists())
        self.assertNotRegex(call("readelf", "-d", self.program), "RPATH|RUNPATH")  # no path of the build folder

    def test_program_runs_a_scene_with_a_mesh_file_of_the_package(self):
        scenes = self.usr / "share/arris/scenes"
        self.assertEqual({f.name for f in scenes.glob("*.toml")}, {f.name for f in (ROOT / "data/scenes").glob("*.toml")})
        call(self.program, "run", scenes / "chair.toml", "-o", "out", "--set", "duration=0.1", "--quiet", folder=self.path)
        report = json.loads((self.path / "out/report.json").read_text())
        self.assertEqual((report["status"], report["crossings"], report["max_penetration"]), ("finished", 0, 0))
        self.assertTrue((self.path / "out/viewer.html").is_file())


if __name__ == "__main__":
    unittest.main()
