#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares USD, VTK and OBJ exports of a run, read by OpenUSD, VTK and three.js, with the run's PLY frames.

usage: compare.py RUN_DIR FRAMES_PER_SECOND
"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from ply_frames import read_ply
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

HERE = Path(__file__).resolve().parent
FLOAT_TOLERANCE = 1e-6  # m: OpenUSD's points are floats, of a cloth within 4 m of the origin


def require(holds, message):
    if not holds:
        sys.exit(f"test_formats: {message}")


def is_same_mesh(a, b):
    """Whether two frames have the same vertices and faces."""
    return np.array_equal(a[0]["id"], b[0]["id"]) and np.array_equal(a[1]["vertices"], b[1]["vertices"])


def read_usd(stage, times):
    with tempfile.NamedTemporaryFile(suffix=".json") as output:
        done = subprocess.run(
            ["node", "--require", str(HERE / "browser_shim.cjs"), str(HERE / "read_usd.cjs"), str(stage),
             *map(str, times)],
            env={**os.environ, "ARRIS_OUTPUT": output.name}, capture_output=True, text=True, timeout=120, check=False)
        require(done.returncode == 0, f"OpenUSD did not read {stage}:\n{done.stderr[-2000:]}")
        return json.loads(Path(output.name).read_text())


def check_usd(run_dir, frames):
    """The cloth is the PLY's. Where the mesh changes at a constant number of vertices, it is held until then."""
    changes = [i for i in range(1, len(frames))
               if len(frames[i][0]) == len(frames[i - 1][0]) and not is_same_mesh(frames[i], frames[i - 1])]
    require(changes, "no mesh of this run changes at a constant number of vertices: the test shows nothing")
    wanted = {float(i): frames[i] for i in (0, len(frames) // 2, len(frames) - 1)}
    for i in changes:
        wanted.update({i - 0.75: frames[i - 1], i - 0.01: frames[i - 1], float(i): frames[i]})
    read = read_usd(run_dir / "cloth.usda", wanted)
    for time, (vertices, faces, _) in wanted.items():
        cloth = read[str(time)]["/arris/cloth"]
        require(np.array_equal(cloth["faces"], faces["vertices"].ravel()), f"USD at time code {time}: other faces")
        points = np.array(cloth["points"]).reshape(-1, 3)
        require(points.shape == vertices["x"].shape, f"USD at time code {time}: {len(points)} points")
        error = np.abs(points - vertices["x"]).max()
        require(error < FLOAT_TOLERANCE, f"USD at time code {time}: points differ by {error} m")
        require(cloth.get("st"), f"USD at time code {time}: no UVs")
        uv = np.array(cloth["st"]).reshape(-1, 2)
        require(uv.shape == vertices["u"].shape and np.abs(uv - vertices["u"]).max() < FLOAT_TOLERANCE,
                f"USD at time code {time}: other UVs")
    require(any("/obstacles/" in path for path in read["0.0"]), "USD: no obstacle is below the root")
    return f"USD at {len(wanted)} time codes, {2 * len(changes)} of them between different meshes"


def cells_of(cells):
    """n x k connectivity of cells that all have k points."""
    count = cells.GetNumberOfCells()
    connectivity = vtk_to_numpy(cells.GetConnectivityArray())
    return connectivity.reshape(count, -1) if count else connectivity.reshape(0, 2)


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    require(reader.GetErrorCode() == 0, f"VTK did not read {path}")
    return reader.GetOutput()


def check_vtk(run_dir, frames, frames_per_second):
    entries = ElementTree.parse(run_dir / "cloth.pvd").getroot().findall("./Collection/DataSet")
    cloth = [e for e in entries if e.get("part") == "0"]
    require(len(cloth) == len(frames), f"cloth.pvd names {len(cloth)} of {len(frames)} frames")
    for e in entries:
        require((run_dir / e.get("file")).exists(), f"cloth.pvd names {e.get('file')}, which does not exist")
    for i in (0, len(frames) // 2, len(frames) - 1):
        require(float(cloth[i].get("timestep")) == i / frames_per_second, f"cloth.pvd: time of frame {i}")
        vertices, faces, edges = frames[i]
        mesh = read_vtp(run_dir / cloth[i].get("file"))
        point_data, cell_data = mesh.GetPointData(), mesh.GetCellData()
        lines = np.zeros(len(edges))
        pairs = {
            "points": (vtk_to_numpy(mesh.GetPoints().GetData()), vertices["x"]),
            "polys": (cells_of(mesh.GetPolys()), faces["vertices"]),
            "lines": (cells_of(mesh.GetLines()), edges),
            "material": (vtk_to_numpy(point_data.GetArray("material"))[:, :2], vertices["u"]),
            "vertex_velocity": (vtk_to_numpy(point_data.GetArray("vertex_velocity")), vertices["v"]),
            "material_velocity": (vtk_to_numpy(point_data.GetArray("material_velocity")), vertices["w"]),
            "id": (vtk_to_numpy(point_data.GetArray("id")), vertices["id"]),
            "eol": (vtk_to_numpy(point_data.GetArray("eol")), vertices["eol"]),
            "contact": (vtk_to_numpy(point_data.GetArray("contact")), vertices["contact"]),
            "strain": (vtk_to_numpy(cell_data.GetArray("strain"))[len(edges):], faces["strain"]),
            "stretch_energy": (vtk_to_numpy(cell_data.GetArray("stretch_energy")), np.append(lines, faces["stretch"])),
            "bending_energy": (vtk_to_numpy(cell_data.GetArray("bending_energy")), np.append(lines, faces["bending"])),
        }
        for name, (got, want) in pairs.items():
            require(np.array_equal(got, want), f"VTK in frame {i}: other {name}")
    require(len(frames[len(frames) // 2][2]) > 0, "the frame in the middle has no EOL edges: the test shows nothing")
    obstacle = read_vtp(run_dir / next(e for e in entries if e.get("part") == "1").get("file"))
    require(obstacle.GetNumberOfPolys() > 0, "VTK: the obstacle has no faces")
    return "VTK at 3 frames"


def check_obj(run_dir, frames):
    chosen = (0, len(frames) // 2, len(frames) - 1)
    files = [str(run_dir / f"frames/cloth_{i:05d}.obj") for i in chosen]
    done = subprocess.run(["node", str(HERE / "read_obj.mjs"), *files], capture_output=True, text=True, timeout=60,
                          check=False)
    require(done.returncode == 0, f"three.js did not read {files}:\n{done.stderr[-2000:]}")
    for i, objects in zip(chosen, json.loads(done.stdout)):
        vertices, faces, edges = frames[i]
        wanted = {("cloth", "Mesh"): faces["vertices"], ("cloth_eol", "LineSegments"): edges}
        require({(o["name"], o["type"]) for o in objects} == {key for key, cells in wanted.items() if len(cells)},
                f"OBJ in frame {i}: objects {[(o['name'], o['type']) for o in objects]}")
        for o in objects:
            cells = wanted[o["name"], o["type"]].ravel()
            corners = vertices["x"][cells].astype("f4")
            require(np.array_equal(np.array(o["corners"], "f4").reshape(-1, 3), corners),
                    f"OBJ in frame {i}: other corners of {o['name']}")
            if o["type"] == "Mesh":
                uv = vertices["u"][cells].astype("f4")
                require(np.array_equal(np.array(o["uv"], "f4").reshape(-1, 2), uv), f"OBJ in frame {i}: other vt")
    return "OBJ at 3 frames"


def main():
    run_dir = Path(sys.argv[1])
    frames = [read_ply(path) for path in sorted(run_dir.glob("frames/cloth_*.ply"))]
    done = [check_usd(run_dir, frames), check_vtk(run_dir, frames, float(sys.argv[2])),
            check_obj(run_dir, frames)]
    print(f"formats: {'; '.join(done)}: as in the PLY frames")


if __name__ == "__main__":
    main()
