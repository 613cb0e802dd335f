# SPDX-License-Identifier: GPL-3.0-or-later
"""Completion, manual page and help tell the same commands as the program takes, and `arris view` opens the viewer.

usage: command_pages_test.py PROGRAM
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
SCENE = "duration = 0.1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[gravity]\n[output]\nformats = []\n"


def call(*arguments, environment=None):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, env=environment, check=True).stdout


def commands():
    """The names under "Subcommands:" of --help."""
    return re.findall(r"^  (\w+)", call("--help").split("Subcommands:")[1], re.MULTILINE)


def options(command):
    """The long options in the help of a command."""
    return set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", call(command, "--help"), re.MULTILINE))


def complete(*words):
    """What bash offers for the last of `words`."""
    script = ('eval "$("$1" docs bash)"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _arris; '
              'printf "%s\\n" "${COMPREPLY[@]}"')
    out = subprocess.run(["bash", "-c", script, "bash", PROGRAM, "arris", *words], capture_output=True, text=True, check=True)
    return out.stdout.split()


class Pages(unittest.TestCase):
    def test_bash_completes_commands_options_and_allowed_words(self):
        self.assertEqual(complete(""), commands())
        self.assertEqual(complete("st"), ["study"])
        for command in commands():
            self.assertEqual({w for w in complete(command, "-") if w.startswith("--")}, options(command), command)
        self.assertEqual(complete("study", "--engine", ""), ["local", "slurm"])
        self.assertEqual(complete("docs", "m"), ["man"])
        self.assertEqual(complete("run", ""), [])  # bash then completes file names
        self.assertEqual(complete("run", "--quiet", ""), [])

    def test_manual_has_every_command_option_and_example(self):
        page = call("docs", "man")
        for command in commands():
            entry = page.split(f".SS arris {command}\n")[1].split(".SS ")[0]
            for option in options(command):
                self.assertIn(option.replace("-", "\\-"), entry)
            self.assertIn(f"  arris {command} ", entry)

    def test_manual_is_sound_roff(self):
        with tempfile.NamedTemporaryFile("w", suffix=".1") as page:
            page.write(call("docs", "man"))
            page.flush()
            shown = subprocess.run(["man", "--warnings", "-l", page.name], capture_output=True, text=True, check=True)
        self.assertEqual(shown.stderr, "")

    def test_help_of_every_command_ends_with_an_example(self):
        for command in commands():
            self.assertRegex(call(command, "--help"), rf"Example:\n  arris {command} \S[^\n]*\n$")

    def test_examples_name_files_that_exist(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        for command in commands():
            for path in re.findall(r"data/\S+", call(command, "--help")):
                self.assertTrue((root / path).is_file(), path)


class View(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="arris view ")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        (self.path / "scene.toml").write_text(SCENE)
        call("run", self.path / "scene.toml", "-o", self.path / "a run", "--quiet")
        self.page = self.path / "a run" / "viewer.html"

    def view(self, opener=None, display=""):
        """`arris view`, where xdg-open is the script `opener`."""
        if opener:
            (self.path / "xdg-open").write_text(opener)
            (self.path / "xdg-open").chmod(0o755)
        environment = {"PATH": str(self.path), "DISPLAY": display, "LD_LIBRARY_PATH": os.environ.get("LD_LIBRARY_PATH", "")}
        return call("view", self.path / "a run", environment=environment)

    def test_makes_the_viewer_and_says_why_it_is_not_opened(self):
        self.assertFalse(self.page.exists())
        self.assertRegex(self.view(), rf"viewer  {self.page}\nnot opened: there is no display")
        self.assertTrue(self.page.exists())
        self.assertIn("not opened: xdg-open is not installed", self.view(display=":0"))
        self.assertIn("not opened: xdg-open failed", self.view("#!/bin/sh\nexit 3\n", ":0"))

    def test_opens_one_path_with_blanks(self):
        out = self.view('#!/bin/sh\nprintf "%s|" "$@" > "${0%/*}/opened"\n', ":0")
        self.assertEqual(out, f"viewer  {self.page}\n")
        self.assertEqual((self.path / "opened").read_text(), f"{self.page}|")

    def test_keeps_a_viewer_that_is_current_and_renews_an_old_one(self):
        self.page.write_text("mine")
        self.view()
        self.assertEqual(self.page.read_text(), "mine")
        os.utime(self.page, (0, 0))
        self.view()
        self.assertNotEqual(self.page.read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
