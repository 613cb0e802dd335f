# SPDX-License-Identifier: MIT
"""Writes the scene for Arris: scene.toml, cloth.obj, and for each collider an OBJ file and, if it deforms, a .pc2.

The files are written into a folder of their own first and moved when all are there, so that an error leaves the
earlier scene whole.
"""

import shutil
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from .placements import axis_and_degrees, choose_keys, place, split_rigid
from .run_files import ArrisError
from .sampling import SceneError, choose_objects, frames_per_second, metres_per_unit, sample_scene

SCENE_FILE = "scene.toml"
RUN_FOLDER = "run"
LOG_FILE = "run.log"
RECORD_FILE = "blender.npz"  # in the run's folder: what leads from its cloth and messages back to objects
RECORD_KEYS = {"points", "placed", "matrices", "start", "rate", "frames", "unit", "uv_scale", "is_reversed", "cloth",
               "use_modifiers", "colliders", "collider_objects", "pin_groups", "first_face_line"}
SAME_UV = 1e-5               # closer UVs of one vertex are one; Blender's floats differ by 1e-7 where faces share a UV


@dataclass
class WrittenCloth:
    points: np.ndarray     # in the world at the first frame (m), of each of Blender's vertices
    uv_scale: float | None  # length of a unit of the UVs (m); None without UVs
    is_reversed: bool      # whether the file's faces run the other way round
    first_face_line: int   # of the file, counted from 1


@dataclass
class WrittenScene:
    folder: Path
    scene_file: Path
    run_folder: Path
    samples: object
    cloth: WrittenCloth
    placed: dict     # Arris's name -> points in the world at the first frame (m), of cloth and colliders
    warnings: list   # (name of an object or "", text)


# Text


def number(value):
    """A number as TOML, with all its digits."""
    return repr(float(value))


def setting(value):
    """A number that the user has typed, and Blender keeps as a float: 0.3, and not 0.30000001192092896."""
    return repr(float(str(np.float32(value))))


def vector(values):
    return "[" + ", ".join(number(v) for v in values) + "]"


def text(value):
    """A TOML string."""
    plain = "".join(c if c.isprintable() else " " for c in value)
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'


def write_obj(path, points, corners, counts, uvs=None, uv_corners=None, lines=(), lone=()):
    """`lines` are pairs of vertices, `lone` vertices; all count from 0."""
    rows = ["v {!r} {!r} {!r}".format(*p) for p in np.asarray(points, float).tolist()]
    words = [str(v + 1) for v in corners.tolist()]
    if uvs is not None:
        rows += ["vt {!r} {!r}".format(*uv) for uv in np.asarray(uvs, float).tolist()]
        words = [f"{word}/{uv + 1}" for word, uv in zip(words, uv_corners)]
    end = 0
    for count in counts.tolist():
        rows.append("f " + " ".join(words[end:end + count]))
        end += count
    rows += [f"l {a + 1} {b + 1}" for a, b in lines]
    rows += [f"p {v + 1}" for v in lone]
    path.write_text("\n".join(rows) + "\n")


# Cloth


def reverse_faces(corners, counts):
    """Indices of the corners with each face run the other way round."""
    ends = np.cumsum(counts)
    starts = ends - counts
    return np.repeat(starts + ends - 1, counts) - np.arange(len(corners))


def polygon_areas(points, corners, counts):
    """Area vector of each face (n x 3), right also for faces that are not convex."""
    starts = np.cumsum(counts) - counts
    own = np.repeat(np.arange(len(counts)), counts)
    following = np.arange(len(corners)) + 1
    following[starts + counts - 1] = starts
    origin = points[corners[starts]][own]
    cross = np.cross(points[corners] - origin, points[corners][following] - origin)
    return 0.5 * np.stack([np.bincount(own, cross[:, k], len(counts)) for k in range(3)], axis=1)


def join_uvs(mesh):
    """Different UVs, and for each corner the number of its own. UVs of one vertex that nearly agree are one."""
    uvs, numbers, of_vertex = [], [], {}
    for vertex, uv in zip(mesh.corners.tolist(), mesh.uvs.tolist()):
        known = of_vertex.setdefault(vertex, [])
        for k in known:
            if abs(uvs[k][0] - uv[0]) <= SAME_UV and abs(uvs[k][1] - uv[1]) <= SAME_UV:
                break
        else:
            k = len(uvs)
            uvs.append(uv)
            known.append(k)
        numbers.append(k)
    return np.array(uvs), np.array(numbers)


def measure_uv_scale(cloth, points, mesh, signed_areas):
    """Length of a unit of the UVs such that the cloth's area there is that of its mesh, over all of it."""
    if not np.isfinite(mesh.uvs).all():
        raise SceneError(cloth, "has a UV that is not finite; unwrap it anew")
    in_uvs = np.abs(signed_areas).sum()
    in_world = np.linalg.norm(polygon_areas(points, mesh.corners, mesh.counts), axis=1).sum()
    if not in_uvs > 0.0:
        raise SceneError(cloth, "its UVs have no area; unwrap it (UV > Unwrap), or remove the UV map if it is "
                                "flat")
    return float(np.sqrt(in_world / in_uvs))


def write_cloth(path, cloth, settings, samples):
    """Writes cloth.obj, with a `v` for each of Blender's vertices in their order.

    Where most UVs are mirrored, faces are reversed, so that Arris need not mirror the UVs.
    """
    mesh = samples.cloth
    points = place(samples.matrices[0], mesh.points)
    if mesh.uvs is None:
        write_obj(path, points, mesh.corners, mesh.counts)
        return WrittenCloth(points, None, False, len(points) + 1)
    flat = np.column_stack([mesh.uvs, np.zeros(len(mesh.uvs))]).astype(float)
    signed = polygon_areas(flat, np.arange(len(flat)), mesh.counts)[:, 2]
    scale = measure_uv_scale(cloth, points, mesh, signed)
    if settings.use_uv_scale:
        scale = float(setting(settings.uv_scale))
    is_reversed = bool(signed.sum() < 0.0)
    uvs, numbers = join_uvs(mesh)
    order = reverse_faces(mesh.corners, mesh.counts) if is_reversed else np.arange(len(mesh.corners))
    write_obj(path, points, mesh.corners[order], mesh.counts, uvs, numbers[order])
    return WrittenCloth(points, scale, is_reversed, len(points) + len(uvs) + 1)


def cloth_lines(settings, uv_scale):
    lines = ["[cloth]", 'file = "cloth.obj"']
    if uv_scale is not None:
        lines.append(f"uv_scale = {number(uv_scale)}")
    lines += ["", "[cloth.material]", f'preset = "{settings.preset}"']
    if settings.use_density:
        lines.append(f"density = {setting(settings.density)}")
    if settings.use_stiffness:
        lines.append(f"youngs_modulus = {setting(settings.stiffness)}")
    if settings.use_bending:
        lines.append(f"bending_stiffness = {setting(settings.bending * 1e-6)}")
    if settings.damping > 0.0:
        lines.append(f"damping = {setting(settings.damping)}")
    return lines + [f"thickness = {setting(settings.thickness)}"]


# Motion


def rotate_line(rotation):
    axis, degrees = axis_and_degrees(rotation)
    return f"{{ axis = {vector(axis)}, degrees = {number(degrees)} }}"


def keyframe_lines(rotations, translations, keys, rate):
    """Keyframes of an obstacle or a pin. Arris interpolates them linearly, as `choose_keys` expects."""
    return ["keyframes = ["] + [f"  {{ time = {number(k / rate)}, translate = {vector(translations[k])}, "
                                f"rotate = {rotate_line(rotations[k])} }}," for k in keys] + ["]"]


def collider_shape(mesh):
    """Edges that are wires and vertices that are nails: all of a mesh without faces, none of another."""
    if len(mesh.counts):
        return [], []
    return mesh.edges.tolist(), np.setdiff1d(np.arange(len(mesh.points)), mesh.edges).tolist()


def write_collider(folder, track, rate):
    """Writes the mesh of a collider. Returns the lines that say where it is in time, and its points at time 0 (m)."""
    mesh, matrices = track.mesh, np.array(track.matrices)
    first = place(matrices[0], mesh.points)
    is_mirrored = np.linalg.det(matrices[0][:, :3]) < 0.0
    order = reverse_faces(mesh.corners, mesh.counts) if is_mirrored else np.arange(len(mesh.corners))
    lines, lone = collider_shape(mesh)
    rigid = split_rigid(matrices) if track.cache is None else None
    if track.cache is None and rigid is None:
        if (matrices == matrices[0]).all():  # flat, as an object with a scale of 0 along one axis
            rigid = (np.eye(3)[None], np.zeros((1, 3)), None)
        else:
            track.deform()
            track.close()
    points = first
    if rigid is None:
        motion = [f'deform = {{ file = "{track.name}.pc2", frames_per_second = {number(rate)} }}']
    else:
        rotations, translations, scale = rigid
        if scale is not None:
            points = mesh.points.astype(float) @ scale.T
        radius = float(np.linalg.norm(points, axis=1).max())
        keys = choose_keys(rotations, translations, radius)
        motion = ([f"translate = {vector(translations[0])}", f"rotate = {rotate_line(rotations[0])}"]
                  if len(keys) == 1 else keyframe_lines(rotations, translations, keys, rate))
    write_obj(folder / f"{track.name}.obj", points, mesh.corners[order], mesh.counts, lines=lines, lone=lone)
    return motion, first


def collider_lines(track, motion, own):
    lines = ["", "[[obstacle]]", f'name = "{track.name}"', f'file = "{track.name}.obj"']
    if own.use_feature_angle:
        lines.append(f"feature_angle = {setting(own.feature_angle)}")
    if own.use_friction:
        lines.append(f"friction = {setting(own.friction)}")
    if own.use_slit and motion[0].startswith("deform"):
        motion = [motion[0].replace(" }", f", slit = {setting(own.slit)} }}")]
    return lines + motion


def pin_lines(track, scene, rate):
    pin = track.settings
    lines = ["", "[[pin]]", f"vertices = [{', '.join(map(str, track.vertices.tolist()))}]"]
    start = (pin.start - scene.frame_start) / rate if pin.use_start else 0.0
    if start > 0.0:
        lines.append(f"start = {number(start)}")
    if pin.use_release:
        release = (pin.release - scene.frame_start) / rate
        if release <= max(start, 0.0):
            raise SceneError(scene.arris.cloth, f"Pins: '{pin.vertex_group}' is released at frame {pin.release}; "
                                                "allowed: a frame after the first one and after it takes hold")
        lines.append(f"release = {number(release)}")
    if track.follow is not None:
        return lines + [f'follow = "{track.follow}"']
    first = np.vstack([track.matrices[0], [0.0, 0.0, 0.0, 1.0]])
    if abs(np.linalg.det(first)) < 1e-30:
        raise SceneError(track.owner, f"Pins: '{pin.vertex_group}' follows an object that has a scale of 0")
    rigid = split_rigid([matrix @ np.linalg.inv(first) for matrix in track.matrices])
    if rigid is None:
        raise SceneError(track.owner, f"Pins: '{pin.vertex_group}' follows an object whose scale changes; allowed: "
                                      "one that turns and moves, or a collider")
    rotations, translations, _ = rigid
    radius = float(np.linalg.norm(track.points, axis=1).max())
    keys = choose_keys(rotations, translations, radius)
    return lines if len(keys) == 1 else lines + keyframe_lines(rotations, translations, keys, rate)


# The scene


def effect_lines(scene, samples):
    """Gravity, friction, contact, wind and remeshing, and warnings of what is probably not meant."""
    settings, lines, warnings = scene.arris, [], []
    if scene.use_gravity:
        gravity = metres_per_unit(scene) * np.array([float(setting(g)) for g in scene.gravity])
        lines += ["", "[gravity]", f"acceleration = {vector(gravity)}"]
        size = float(np.linalg.norm(gravity))
        if metres_per_unit(scene) != 1.0 and not 0.5 < size / 9.81 < 2.0:
            warnings.append(("", f"gravity is {size:.3g} m/s^2, as Scene > Gravity shows at this unit scale; that of "
                                 "the Earth is 9.81"))
    if settings.use_friction:
        lines += ["", "[friction]", f"coefficient = {setting(settings.friction)}"]
    if settings.use_self_contact:
        lines += ["", "[self_contact]"]
    if samples.wind.any():
        lines += ["", "[wind]", f"velocity = {vector(samples.wind)}"]
    if settings.use_remesh:
        if settings.longest_edge <= settings.shortest_edge:
            raise SceneError(settings.cloth, "Remesh: the longest edge must be longer than the shortest, "
                                             f"{setting(settings.shortest_edge)} m")
        lines += ["", "[remesh]", f"edge_length = [{setting(settings.shortest_edge)}, "
                                  f"{setting(settings.longest_edge)}]"]
    return lines, warnings


def resolve_folder(scene):
    """The scene's folder as a Path. A folder beside the .blend file needs that file."""
    folder = scene.arris.folder
    if folder.startswith("//") and not bpy.data.filepath:
        raise SceneError("", f"Folder: {folder} is beside the .blend file, which has not been saved; save it, or "
                             "choose another folder")
    return Path(bpy.path.abspath(folder)).resolve()


def run_folder_of(scene):
    return resolve_folder(scene) / RUN_FOLDER


def run_folders(scenes):
    """Run folders of the scenes that have one; a folder beside a file that is not yet saved is none."""
    folders = set()
    for scene in scenes:
        try:
            folders.add(run_folder_of(scene))
        except ArrisError:
            pass
    return folders


def make_folder(folder):
    """Makes the folder, and in it one for files that are not yet complete."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return Path(tempfile.mkdtemp(prefix=".new_", dir=folder))
    except OSError as error:
        raise SceneError("", f"Folder: {folder} cannot be written: {error.strerror}") from error


def write_scene(context):
    """Samples the scene and writes it. Returns a WrittenScene; raises SceneError for what the user can mend."""
    folder = resolve_folder(context.scene)
    choose_objects(context)  # before a folder is made
    draft = make_folder(folder)
    try:
        samples = sample_scene(context, draft)
        written = write_files(context.scene, samples, draft, folder)
        for path in draft.iterdir():
            path.replace(folder / path.name)
        return written
    except OSError as error:
        raise SceneError("", f"Folder: {folder} cannot be written: {error.strerror}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def write_files(scene, samples, draft, folder):
    settings, rate = scene.arris, frames_per_second(scene)
    cloth = write_cloth(draft / "cloth.obj", settings.cloth, settings, samples)
    placed = {"cloth": cloth.points}
    effects, warnings = effect_lines(scene, samples)
    lines = [f"# Written by Blender {bpy.app.version_string}. It may be changed, and run without Blender.",
             f"title = {text(scene.name[:200])}",
             f"duration = {number((scene.frame_end - scene.frame_start) / rate)}",
             "", "[time]", f"step = {setting(settings.time_step)}",
             "", *cloth_lines(settings, cloth.uv_scale), *effects]
    for track in samples.colliders:
        motion, placed[track.name] = write_collider(draft, track, rate)
        lines += collider_lines(track, motion, track.thing.arris)
    for track in samples.pins:
        track.points = cloth.points[track.vertices]
        lines += pin_lines(track, scene, rate)
    lines += ["", "[output]", f"frames_per_second = {number(rate)}", ""]
    (draft / SCENE_FILE).write_text("\n".join(lines), encoding="utf-8")
    return WrittenScene(folder, folder / SCENE_FILE, folder / RUN_FOLDER, samples, cloth, placed,
                        warnings + samples.left_out)


def make_record(scene, written):
    """Record that leads from the run's cloth and messages back to objects, whatever becomes of the scene meanwhile."""
    samples, cloth = written.samples, written.cloth
    groups = [pin.settings.vertex_group for pin in samples.pins]
    return {"points": samples.cloth.points, "placed": cloth.points, "matrices": np.array(samples.matrices),
            "start": scene.frame_start, "rate": frames_per_second(scene), "frames": len(samples.matrices),
            "unit": metres_per_unit(scene), "uv_scale": cloth.uv_scale or 1.0, "is_reversed": cloth.is_reversed,
            "cloth": scene.arris.cloth.name_full, "use_modifiers": scene.arris.use_modifiers,
            "colliders": np.array([track.name for track in samples.colliders], str),  # as Arris names them
            "collider_objects": np.array([track.thing.name_full for track in samples.colliders], str),
            "pin_groups": np.array(groups, str), "first_face_line": cloth.first_face_line}


def write_record(run_folder, record):
    path = run_folder / RECORD_FILE
    draft = path.with_suffix(".part")
    with open(draft, "wb") as file:
        np.savez(file, **record)
    draft.replace(path)  # so that a half-written record leaves the earlier one whole


def read_record(run_folder):
    path = run_folder / RECORD_FILE
    try:
        with np.load(path) as arrays:
            record = {name: arrays[name] if arrays[name].ndim else arrays[name].item() for name in arrays.files}
        if not RECORD_KEYS <= record.keys():
            raise ValueError
        return record
    except OSError as error:
        raise ArrisError(f"{run_folder}: holds no run of a Blender scene ({RECORD_FILE}); use File > Import > Arris "
                         "run for other runs") from error
    except (EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:  # TypeError: no archive
        raise ArrisError(f"{path}: is damaged; simulate anew, or use File > Import > Arris run") from error
