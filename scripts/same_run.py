# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the folders of two runs, byte by byte but for what differs each time: seconds, memory and threads."""
import csv
import io
import json
import pathlib

CHANGING_KEYS = ("wall_seconds", "cpu_seconds", "peak_memory_bytes", "phases", "threads")
PAGES = (".html",)  # they show the seconds of report.json


def lasting_rows(text):
    """Rows of steps.csv without seconds; a last line that is torn is left out."""
    whole = text[:text.rfind("\n") + 1]
    return [{name: cell for name, cell in row.items() if not name.endswith("_s")}
            for row in csv.DictReader(io.StringIO(whole))]


def lasting_content(path):
    """What must be equal of a file."""
    if path.name == "report.json":
        return {key: value for key, value in json.loads(path.read_text()).items() if key not in CHANGING_KEYS}
    if path.name == "steps.csv":
        return lasting_rows(path.read_text())
    return path.read_bytes()


def list_files(folder):
    return sorted(path.relative_to(folder) for path in pathlib.Path(folder).rglob("*")
                  if path.is_file() and path.suffix not in PAGES)


def find_difference(a, b):
    """The first difference of two runs, in words; None where they are the same."""
    if list_files(a) != list_files(b):
        return "files: " + ", ".join(map(str, sorted(set(list_files(a)) ^ set(list_files(b)))))
    for name in list_files(a):
        if lasting_content(pathlib.Path(a) / name) != lasting_content(pathlib.Path(b) / name):
            return str(name)
    return None
