# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the wheel of the package for `pip install .` (PEP 517), with CMake and Python's standard library alone.

The module is built in the folder `build` of the source tree, so that a program built there before is not built again.
`--config-settings build-dir=FOLDER` chooses another one.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BYTES_A_JOB = 2 << 30  # the largest source files, with CGAL, take nearly that much memory


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = choose_folder((config_settings or {}).get("build-dir"))
    build_module(folder)
    project, version = read_project()
    tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    name = f"arris-{version}-{tag}-{tag}-{platform}.whl"
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    package = folder / "python" / "arris"
    files = {f"arris/{path.name}": path.read_bytes()
             for path in sorted(package.iterdir()) if path.suffix == ".py" or path.name == f"_arris{suffix}"}
    files |= make_metadata(project, version, f"{tag}-{tag}-{platform}")
    write_wheel(Path(wheel_directory) / name, files, f"arris-{version}.dist-info/RECORD")
    return name


def choose_folder(name):
    """The folder asked for; else `build`, unless that is for another Python."""
    if name is not None:
        return (ROOT / name).resolve()
    cache = ROOT / "build" / "CMakeCache.txt"
    known = re.search(r"^Python3_EXECUTABLE:\w+=(.*)$", cache.read_text(), re.M) if cache.exists() else None
    is_other = known and os.path.realpath(known[1]) != os.path.realpath(sys.executable)
    return ROOT / ("build-python" if is_other else "build")


def build_module(folder):
    """Configures a folder that is new for the module alone, and leaves the settings of any other as they are."""
    python = os.path.realpath(sys.executable)
    settings = [f"-DPython3_EXECUTABLE={python}", "-DARRIS_PYTHON=ON"]
    if not (folder / "CMakeCache.txt").exists():
        settings += ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DARRIS_TESTS=OFF", "-DARRIS_BENCH=OFF"]
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, *settings], check=True)
    if not (folder / "python").exists():
        raise SystemExit("the headers of Python or pybind11 are missing; on Debian: apt-get install python3-dev "
                         "pybind11-dev")
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    jobs = max(1, min(os.cpu_count() or 1, memory // BYTES_A_JOB))
    subprocess.run(["cmake", "--build", folder, "--target", "arris_python", "-j", str(jobs)], check=True)


def read_project():
    """The table [project], and the version, which CMakeLists.txt states."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    version = re.search(r"project\(arris VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
    return project, version


def make_metadata(project, version, tag):
    metadata = ["Metadata-Version: 2.1", "Name: arris", f"Version: {version}", f"Summary: {project['description']}",
                "License: GPL-3.0-or-later", f"Requires-Python: {project['requires-python']}"]
    metadata += [f"Requires-Dist: {name}" for name in project["dependencies"]]
    wheel = ["Wheel-Version: 1.0", "Generator: arris", "Root-Is-Purelib: false", f"Tag: {tag}"]
    return {f"arris-{version}.dist-info/{name}": ("\n".join(lines) + "\n").encode()
            for name, lines in (("METADATA", metadata), ("WHEEL", wheel))}


def write_wheel(path, files, record):
    lines = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, data in files.items():
            wheel.writestr(name, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            lines.append(f"{name},sha256={digest},{len(data)}")
        wheel.writestr(record, "\n".join([*lines, f"{record},,"]) + "\n")
