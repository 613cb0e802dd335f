# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a scene that fails smaller while it still fails in the same way, for scripts/fuzz."""
import copy
import itertools
import time

from random_scene import RandomScene

MOST_RUNS = 150       # of the program, for one failure
MOST_SECONDS = 600    # after these no further run is begun for it
PLAIN_MATERIAL = {"density": 0.05, "youngs_modulus": 50.0, "poisson_ratio": 0.01, "bending_stiffness": 1e-5,
                  "damping": 0.0, "thickness": 1e-3}
PLAIN_CLOTH = {"pattern": "diagonal", "pattern_angle": 0, "velocity": [0.0, 0.0, 0.0]}


def list_smaller(scene):
    """Scenes that differ from `scene` by one simplification; the boldest first."""
    def changed(change):
        other = copy.deepcopy(scene)
        change(other)
        return other

    for part in ("obstacle", "pin"):
        for k in range(len(scene.get(part, []))):
            yield changed(lambda s: s[part].pop(k) if len(s[part]) > 1 else s.pop(part))
    for part in ("self_contact", "remesh", "friction", "wind", "gravity"):
        if part in scene:
            yield changed(lambda s: s.pop(part))
    if scene["duration"] > 2 * scene["time"]["step"]:
        yield changed(lambda s: s.update(duration=round(0.5 * s["duration"], 6)))
        yield changed(lambda s: s.update(duration=round(0.8 * s["duration"], 6)))
    if "outline" in scene["cloth"]:
        for factor in (2, 1.25):
            longer = round(factor * scene["cloth"]["edge_length"], 6)
            if longer < max(map(max, scene["cloth"]["outline"])):
                yield changed(lambda s: s["cloth"].update(edge_length=longer))
        if "holes" in scene["cloth"]:
            yield changed(lambda s: s["cloth"].pop("holes"))
    cells = scene["cloth"].get("resolution", [1])
    if max(cells) > 2:
        yield changed(lambda s: s["cloth"].update(resolution=[max(1, n // 2) for n in cells]))
        yield changed(lambda s: s["cloth"].update(resolution=[max(1, n * 4 // 5) for n in cells]))
    for part in ("obstacle", "pin"):
        for k, thing in enumerate(scene.get(part, [])):
            for key in ("motion", "velocity", "angular_velocity", "release", "directions", "rotate", "follow"):
                if key in thing:
                    yield changed(lambda s: s[part][k].pop(key))
    if "bending_model" in scene["cloth"]["material"]:
        yield changed(lambda s: s["cloth"]["material"].pop("bending_model"))
    for key, plain in PLAIN_CLOTH.items():
        if scene["cloth"].get(key, plain) != plain:
            yield changed(lambda s: s["cloth"].pop(key))
    for key, plain in PLAIN_MATERIAL.items():
        if scene["cloth"]["material"].get(key, plain) != plain:
            yield changed(lambda s: s["cloth"]["material"].update({key: plain}))
    if scene["time"].get("integrator", "bdf2") != "bdf2":
        yield changed(lambda s: s["time"].pop("integrator"))
    if scene.get("eol", {}).get("enabled", False):
        yield changed(lambda s: s["eol"].update(enabled=False))


def without_faces(text, first, last):
    """A mesh file without some of its faces, and without the points that no face uses then."""
    points = [line for line in text.splitlines() if line.startswith("v ")]
    faces = [line.split()[1:] for line in text.splitlines() if line.startswith("f ")]
    faces = faces[:first] + faces[last:]
    used = sorted({int(k) for face in faces for k in face})
    number = {str(k): str(place + 1) for place, k in enumerate(used)}
    lines = [points[k - 1] for k in used] + ["f " + " ".join(number[k] for k in face) for face in faces]
    return "\n".join(lines) + "\n"


def list_smaller_meshes(meshes):
    """Meshes with one file that lacks a half, then a quarter, ... of its faces."""
    for name, text in meshes.items():
        count = sum(line.startswith("f ") for line in text.splitlines())
        for parts in (2, 4, 8):
            size = -(-count // parts)
            for first in range(0, count if count > size else 0, size):
                yield {**meshes, name: without_faces(text, first, first + size)}


def list_candidates(failing):
    for scene in list_smaller(failing.scene):
        used = [o.get("file") for o in scene.get("obstacle", [])]
        yield RandomScene(scene, {name: text for name, text in failing.meshes.items() if name in used})
    for meshes in list_smaller_meshes(failing.meshes):
        yield RandomScene(failing.scene, meshes)


def shrink(failing, kind_of):
    """The smallest scene found whose fault is of the same kind. `kind_of` runs a scene and returns the kind of its first
    fault, or None."""
    kind, runs = kind_of(failing), 0
    end = time.monotonic() + MOST_SECONDS
    is_smaller = kind is not None
    while is_smaller:
        is_smaller, at = False, 0
        while runs < MOST_RUNS and time.monotonic() < end:
            candidate = next(itertools.islice(list_candidates(failing), at, None), None)
            if candidate is None:
                break
            runs += 1
            if kind_of(candidate) == kind:
                failing, is_smaller = candidate, True  # the next candidate of this kind takes this one's place
            else:
                at += 1
    return failing
