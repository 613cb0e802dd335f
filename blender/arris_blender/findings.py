# SPDX-License-Identifier: MIT
"""Messages of `arris` on the scene, with the object that each message concerns, and the faces that cross.

Findings are kept here by scene, as they belong to no .blend file.
"""

import re
import subprocess
from dataclasses import dataclass

import numpy as np

from .run_files import ArrisError, read_bytes

CHECK_SECONDS = 600.0
CROSSINGS_FILE = "crossing-faces.obj"  # no collider has this file, since their names have no hyphen
PLACE = re.compile(r"^scene\.toml(:\d+)?: ([a-z_]+(\.[a-z_0-9]+)*( = [^:]*)?: )?(\w+\.(obj|pc2): )?")  # of a message
# Parts of messages that speak of keys of a scene file, and what says the same in Blender.
IN_BLENDER = (
    (" ('translate')", ""),
    ("; a file that is not in metres with z up needs 'units' or 'up'", ""),
    ("and without UVs; allowed: UVs in metres, or flat pieces", "and without UVs; allowed: unwrapped (UV > Unwrap), or "
                                                               "flat pieces"),
    ("scale the UVs in the file to metres, or set cloth.uv_scale", "unwrap it (UV > Unwrap), so that faces have in the "
                                                                  "UVs the proportions of the mesh, or set UV scale"),
)
SAME_PLACE = 1e-6  # of the mesh's size: the program states places with all digits, but may have welded vertices
findings = {}      # scene -> list of Finding
summaries = {}     # scene -> one line that says how the check ended


@dataclass
class Finding:
    severity: str  # ERROR or WARNING
    thing: str     # full name of the object concerned, or ""
    text: str

    def __str__(self):
        return f"{self.thing}: {self.text}" if self.thing else self.text


def mentions(text, name):
    return re.search(rf"(?<![A-Za-z0-9_]){re.escape(name)}(?![A-Za-z0-9_])", text) is not None


def find_concerned(text, record):
    """The object that a message of arris is about. `record` is that of the run, or of the scene that is checked."""
    names, things, cloth = record["colliders"].tolist(), record["collider_objects"].tolist(), record["cloth"]
    number = re.search(r"\bobstacle\.(\d+)", text)
    if number and int(number[1]) < len(things):
        return things[int(number[1])]
    if re.match(r"scene\.toml(:\d+)?: (cloth|pin)\b", text):
        return cloth
    for form in ("obstacle {}", "{}.obj", "{}.pc2", "{}"):
        for name, thing in zip(names, things):
            if mentions(text, form.format(name)):
                return thing
    return cloth if re.search(r"\b(cloth|pins?)\b", text) else ""


def read_message(severity, text, folder, record):
    """A message of arris on the scene in `folder` as a Finding."""
    text = text.replace(f"{folder}/", "")
    return Finding(severity, find_concerned(text, record), explain(text, record))


def run_check(program, written, record):
    """Runs `arris check` on the written scene. Returns findings and whether the scene can be simulated."""
    crossings = written.folder / CROSSINGS_FILE
    crossings.unlink(missing_ok=True)
    said = call([program, "check", str(written.scene_file), "--crossings", str(crossings)], written.folder)
    found = [Finding("WARNING", thing, text) for thing, text in written.warnings]
    for line in said.stderr.splitlines() + said.stdout.splitlines():
        for start, severity in (("warning: ", "WARNING"), ("arris: ", "ERROR"), ("intersection: ", "ERROR")):
            if line.startswith(start):
                found.append(read_message(severity, line[len(start):], written.folder, record))
    if said.returncode != 0 and not any(f.severity == "ERROR" for f in found):
        raise ArrisError(f"{program}: ended with status {said.returncode} while it checked {written.scene_file}")
    return sorted(found, key=lambda f: f.severity), said.returncode == 0


def call(command, folder):
    try:
        return subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=CHECK_SECONDS,
                              check=False, stdin=subprocess.DEVNULL, cwd=folder)
    except subprocess.TimeoutExpired as error:
        raise ArrisError(f"{command[0]}: the check took longer than {CHECK_SECONDS:.0f} s") from error
    except OSError as error:
        raise ArrisError(f"{command[0]}: cannot be run: {error.strerror}") from error


def explain(text, record):
    """The message in words of Blender: without places in files, and with what to do there."""
    pin = re.match(r"scene\.toml(:\d+)?: pin\.(\d+)", text)
    groups = record["pin_groups"].tolist()
    whose = f"pin '{groups[int(pin[2])]}': " if pin and int(pin[2]) < len(groups) else ""  # the file may be edited
    text = whose + re.sub(r"(\bthe )?\bface of line (\d+)", lambda m: f"face {find_face(int(m[2]), record)}",
                          PLACE.sub("", text))
    for part, instead in IN_BLENDER:
        text = text.replace(part, instead)
    return text


def find_face(line, record):
    """Number of the face in a line of cloth.obj, in which all `v` and `vt` come before the faces."""
    return line - record["first_face_line"]


# Crossing faces


def read_crossings(path):
    """Triangles (n x 3 x 3, m) that cross something, by the name of cloth or obstacle; {} without the file."""
    if not path.exists():
        return {}
    points, faces, name = [], {}, None
    for line in read_bytes(path).decode(errors="replace").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "o":
            name = words[1]
        elif words[0] == "v":
            points.append([float(w) for w in words[1:4]])
        elif words[0] == "f":
            faces.setdefault(name, []).append([int(w.split("/")[0]) - 1 for w in words[1:4]])
    points = np.array(points)
    return {name: points[np.array(triangles)] for name, triangles in faces.items()}


def find_polygons(mesh, placed, triangles):
    """Polygons of `mesh` (MeshArrays), whose vertices are at `placed`, that contain one of `triangles`."""
    size = max(float(np.ptp(placed, axis=0).max()), 1e-9)

    def keys(points):  # vertices that coincide share a key
        return [tuple(row) for row in np.round(points / (SAME_PLACE * size)).astype(np.int64).tolist()]

    number_at = {}
    of_vertex = [number_at.setdefault(key, len(number_at)) for key in keys(placed)]
    starts = np.cumsum(mesh.counts) - mesh.counts
    with_vertex = {}
    for polygon, (start, count) in enumerate(zip(starts.tolist(), mesh.counts.tolist())):
        for vertex in mesh.corners[start:start + count].tolist():
            with_vertex.setdefault(of_vertex[vertex], set()).add(polygon)
    found = set()
    for triangle in triangles:
        found |= set.intersection(*(with_vertex.get(number_at.get(key), set()) for key in keys(triangle)))
    return sorted(found)


def select_polygons(thing, polygons):
    """Selects polygons of a mesh for its edit mode, in which they are then seen."""
    mesh = thing.data
    is_selected = np.zeros(len(mesh.polygons), bool)
    is_selected[polygons] = True
    mesh.polygons.foreach_set("select", is_selected)
    in_vertex, in_edge = np.zeros(len(mesh.vertices), bool), np.zeros(len(mesh.edges), bool)
    for number in polygons:
        in_vertex[list(mesh.polygons[number].vertices)] = True
        in_edge[[mesh.loops[k].edge_index for k in mesh.polygons[number].loop_indices]] = True
    mesh.vertices.foreach_set("select", in_vertex)
    mesh.edges.foreach_set("select", in_edge)
    mesh.update()


def select_crossings(written, cloth):
    """Selects crossing faces on the objects concerned. Returns the findings that say so."""
    tracks = {track.name: (track.thing, track.mesh) for track in written.samples.colliders}
    tracks["cloth"] = (cloth, written.samples.cloth)
    found = []
    for name, triangles in read_crossings(written.folder / CROSSINGS_FILE).items():
        if name not in tracks:
            continue
        thing, mesh = tracks[name]
        polygons = find_polygons(mesh, written.placed[name], triangles)
        if thing.type == "MESH" and len(thing.data.polygons) == len(mesh.counts) and polygons:
            select_polygons(thing, polygons)
            found.append(Finding("WARNING", thing.name_full, f"{len(polygons)} faces cross others at the first frame; "
                                                             "they are selected in edit mode"))
        else:
            found.append(Finding("WARNING", thing.name_full, f"{len(triangles)} triangles cross others at the first "
                                                             "frame, of faces that its modifiers make"))
    return found
