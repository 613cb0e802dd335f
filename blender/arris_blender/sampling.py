# SPDX-License-Identifier: MIT
"""Samples the scene in one pass over its frames: the cloth at the first one, colliders and what pins follow at all.

The dependency graph evaluates modifiers, armatures, shape keys, constraints and parents. Lengths are metres: Blender's
units times the scene's unit scale. Objects are compared themselves, since a linked one may have the name of a local
one; messages name them by their full names.
"""

import re
import unicodedata
from contextlib import contextmanager, ExitStack
from dataclasses import dataclass, field

import numpy as np

from .placements import place
from .playback import pause_playback
from .point_cache import find_cache_modifier
from .run_files import ArrisError, Pc2Writer

COLLIDER_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
SHAPE_ROUNDING = 5e-7  # of a vertex against the largest coordinate: four units in the last place of a float


class SceneError(ArrisError):
    """An error that keeps the scene from being simulated. `thing` is the object concerned, its full name, or ""."""

    def __init__(self, thing, text):
        self.thing, self.text = getattr(thing, "name_full", thing), text
        super().__init__(f"{self.thing}: {text}" if thing else text)


@dataclass
class MeshArrays:
    """A mesh as arrays, in its object's own space."""

    points: np.ndarray         # vertices x 3
    corners: np.ndarray        # vertex of each corner of a face
    counts: np.ndarray         # corners of each face
    edges: np.ndarray          # edges x 2
    uvs: np.ndarray | None     # corners x 2, of the active UV layer


def array_of(collection, attribute, size, kind):
    values = np.empty(size * len(collection), kind)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, size) if size > 1 else values


def metres_per_unit(scene):
    """Metres in one of Blender's units; without a unit system the scale has no effect there either."""
    return scene.unit_settings.scale_length if scene.unit_settings.system != "NONE" else 1.0


def frames_per_second(scene):
    return scene.render.fps / scene.render.fps_base


def make_name(text, taken):
    """A name that Arris takes: letters, digits and _, not yet in `taken`."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    name = re.sub(r"[^A-Za-z0-9_]+", "_", plain)[:56]
    if not re.match(r"[A-Za-z_]", name):
        name = "object" + ("_" if name and name[0] != "_" else "") + name
    number, unique = 2, name
    while unique in taken or unique == "cloth":
        unique, number = f"{name}_{number}", number + 1
    return unique


@contextmanager
def evaluated_mesh(thing, depsgraph):
    evaluated = thing.evaluated_get(depsgraph)
    try:
        mesh = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
    except RuntimeError:  # a curve or text without a surface may have none
        mesh = None
    if mesh is None:
        raise SceneError(thing, "has no mesh")
    try:
        yield mesh
    finally:
        evaluated.to_mesh_clear()


def read_points(thing, mesh):
    points = array_of(mesh.vertices, "co", 3, "f4")
    if not np.isfinite(points).all():
        raise SceneError(thing, f"vertex {int(np.argmin(np.isfinite(points).all(axis=1)))} is not at a finite "
                                "place; delete it, or mend the modifier or shape key that moves it")
    return points


def read_mesh(thing, mesh):
    layer = mesh.uv_layers.active
    return MeshArrays(read_points(thing, mesh), array_of(mesh.loops, "vertex_index", 1, "i4"),
                      array_of(mesh.polygons, "loop_total", 1, "i4"), array_of(mesh.edges, "vertices", 2, "i4"),
                      array_of(layer.data, "uv", 2, "f4") if layer and len(layer.data) else None)


def metre_matrix(matrix, unit, thing):
    result = unit * np.array(matrix, float)[:3]
    if not np.isfinite(result).all():
        raise SceneError(thing, "its place or size is not finite")
    return result


class ColliderTrack:
    """A collider at all frames. As long as only its matrix changes, its mesh is kept once; else in a point cache."""

    def __init__(self, thing, name, mesh, cache_path, frame_count):
        self.thing, self.name, self.mesh = thing, name, mesh
        self.cache_path, self.frame_count = cache_path, frame_count
        self.rounding = SHAPE_ROUNDING * max(float(np.abs(mesh.points).max(initial=0.0)), 1e-9)
        self.matrices = []
        self.cache = None

    def append(self, points, counts, matrix, frame):
        if len(points) != len(self.mesh.points) or counts != len(self.mesh.counts):
            raise SceneError(self.thing, f"has {len(points)} vertices at frame {frame} and {len(self.mesh.points)} at "
                                         "the first; a collider may move its vertices, but not change their number")
        if self.cache is None and np.abs(points - self.mesh.points).max(initial=0.0) > self.rounding:
            self.deform()
        self.matrices.append(matrix)
        if self.cache is not None:
            self.cache.append(place(matrix, points))

    def deform(self):
        """Begins the cache, with the frames so far. Also for a collider whose scale changes, at the end."""
        self.cache = Pc2Writer(self.cache_path, len(self.mesh.points), self.frame_count)
        for matrix in self.matrices:
            self.cache.append(place(matrix, self.mesh.points))

    def close(self):
        if self.cache is not None:
            self.cache.close()


@dataclass
class PinTrack:
    settings: object
    vertices: np.ndarray           # indices into the cloth's vertices
    follow: str | None = None      # Arris's name of a collider
    owner: str = ""                # full name of the object whose matrices follow
    points: np.ndarray = None      # in the world at the first frame (m)
    matrices: list = field(default_factory=list)


@dataclass
class SceneSamples:
    cloth: MeshArrays
    matrices: list                 # of the cloth's object
    colliders: list
    pins: list
    left_out: list                 # (name, reason) of objects that are no colliders, though among them
    wind: np.ndarray               # m/s


def find_cloth(scene, view_layer):
    cloth = scene.arris.cloth
    if cloth is None:
        raise SceneError("", "Cloth: choose a mesh object")
    if cloth not in set(view_layer.objects):
        raise SceneError(cloth, f"Cloth: the object is not in the view layer {view_layer.name} of this scene; "
                                "choose another one")
    return cloth


def why_left_out(thing, is_shown):
    """Why the cloth does not collide with an object among the colliders; "" if it does."""
    if "arris_frames" in thing:
        return "shows frames of a run, so the cloth does not collide with it"
    if thing.instance_type == "COLLECTION":
        return ("is an instance of a collection, so the cloth does not collide with it; make it real (Object > Apply > "
                "Make Instances Real)")
    if thing.type not in COLLIDER_TYPES:
        return f"is of the kind {thing.type.lower()}, which has no surface, so the cloth does not collide with it"
    return "" if is_shown else "is hidden in the viewport, so the cloth does not collide with it"


def only_moves_others(thing):
    """Whether an object is expected among colliders without being one."""
    return thing.type in {"ARMATURE", "LATTICE"} or \
        thing.type == "EMPTY" and thing.instance_type == "NONE" and len(thing.children) > 0


def find_colliders(scene, view_layer, cloth):
    """The colliders, and for each object that is left out, or for their collection, its name and the reason."""
    collection = scene.arris.colliders
    if collection is None:
        return [], []
    if cloth in set(collection.all_objects):
        raise SceneError(cloth, f"is the cloth and in the collection of colliders, {collection.name}; move it to "
                                "another collection")
    in_layer, colliders, left_out = set(view_layer.objects), [], []
    for thing in collection.all_objects:
        reason = why_left_out(thing, thing in in_layer and thing.visible_get(view_layer=view_layer))
        if not reason:
            colliders.append(thing)
        elif not only_moves_others(thing):
            left_out.append((thing.name_full, reason))
    if not colliders:
        left_out.append(("", f"Colliders: the collection {collection.name} has no object that the cloth can collide "
                             "with"))
    return colliders, left_out


@contextmanager
def plain_cloth(scene, cloth):
    """The cloth as it is to be simulated: visible, and only with the modifiers that are applied."""
    modifiers, cache = list(cloth.modifiers), find_cache_modifier(cloth)
    applied = modifiers.index(cache) if cache is not None else len(modifiers)
    off = [modifier for modifier in modifiers[applied if scene.arris.use_modifiers else 0:] if modifier.show_viewport]
    is_hidden, is_off = cloth.hide_get(), cloth.hide_viewport
    try:
        cloth.hide_set(False)
        cloth.hide_viewport = False
        for modifier in off:
            modifier.show_viewport = False
        yield
    finally:
        for modifier in off:
            modifier.show_viewport = True
        cloth.hide_viewport = is_off
        cloth.hide_set(is_hidden)


@contextmanager
def current_frame(scene):
    frame, subframe = scene.frame_current, scene.frame_subframe
    try:
        yield
    finally:
        scene.frame_set(frame, subframe=subframe)


def find_pinned(cloth, mesh, pin, used):
    """Vertices of `mesh` that the pin's group holds; `used` are the vertices with faces."""
    group = cloth.vertex_groups.get(pin.vertex_group)
    if group is None:
        raise SceneError(cloth, f"Pins: there is no vertex group '{pin.vertex_group}'; choose one of the cloth's"
                         if pin.vertex_group else "Pins: a pin has no vertex group; choose one of the cloth's")
    held = [vertex.index for vertex in mesh.vertices
            if used[vertex.index] and any(g.group == group.index and g.weight > 0.5 for g in vertex.groups)]
    if not held:
        raise SceneError(cloth, f"Pins: no vertex of the group '{group.name}' has a weight above 0.5")
    return np.array(held)


def start_pin(pin, cloth, vertices, tracks, view_layer):
    """The track of a pin, which follows a collider, a bone, an object, or the cloth's own object."""
    target = pin.target or cloth
    if pin.target is not None and target not in set(view_layer.objects):
        raise SceneError(target, f"Pins: the object that '{pin.vertex_group}' follows is not in this scene")
    if pin.bone:
        if target.type != "ARMATURE" or pin.bone not in target.pose.bones:
            raise SceneError(target, f"Pins: there is no bone '{pin.bone}' for '{pin.vertex_group}' to follow")
        return PinTrack(pin, vertices, owner=target.name_full)
    for track in tracks:
        if track.thing == target:
            return PinTrack(pin, vertices, follow=track.name)
    return PinTrack(pin, vertices, owner=target.name_full)


def pin_matrix(pin, cloth, depsgraph):
    target = (pin.target or cloth).evaluated_get(depsgraph)
    return target.matrix_world @ target.pose.bones[pin.bone].matrix if pin.bone else target.matrix_world


def measure_wind(scene, depsgraph):
    wind = np.zeros(3)
    for thing in scene.objects:
        if thing.field is not None and thing.field.type == "WIND" and thing.visible_get():
            axis = np.array(thing.evaluated_get(depsgraph).matrix_world, float)[:3, 2]
            wind += thing.field.strength * axis / max(np.linalg.norm(axis), 1e-30)
    return np.round(wind, 6)  # Blender's floats are good to 1e-7


def require_range(scene):
    if scene.frame_end <= scene.frame_start:
        raise SceneError("", f"Frame range: the last frame, {scene.frame_end}, must be after the first, "
                             f"{scene.frame_start}")


def begin_samples(context, folder, colliders, left_out):
    """Samples the first frame, and starts a track for each thing that is followed from there on."""
    scene, depsgraph = context.scene, context.evaluated_depsgraph_get()
    settings, cloth = scene.arris, scene.arris.cloth
    if not cloth.visible_get(view_layer=context.view_layer):
        raise SceneError(cloth, "Cloth: its collection is hidden in the viewport; show it")
    frame_count = scene.frame_end - scene.frame_start + 1
    names, tracks = set(), []
    for thing in colliders:
        with evaluated_mesh(thing, depsgraph) as mesh:
            arrays = read_mesh(thing, mesh)
        if not len(arrays.points):
            raise SceneError(thing, "is a collider without vertices; give it some, or take it out of the "
                                    f"collection {settings.colliders.name}")
        name = make_name(thing.name, names)
        names.add(name)
        tracks.append(ColliderTrack(thing, name, arrays, folder / f"{name}.pc2", frame_count))
    with evaluated_mesh(cloth, depsgraph) as mesh:
        arrays = read_mesh(cloth, mesh)
        if not len(arrays.counts):
            raise SceneError(cloth, "Cloth: the mesh has no faces")
        used = np.zeros(len(arrays.points), bool)
        used[arrays.corners] = True
        pins = [start_pin(pin, cloth, find_pinned(cloth, mesh, pin, used), tracks, context.view_layer)
                for pin in settings.pins]
    wind = measure_wind(scene, depsgraph) if settings.use_wind else np.zeros(3)
    return SceneSamples(arrays, [], tracks, pins, left_out, wind)


def sample_frame(context, samples, frame):
    scene = context.scene
    scene.frame_set(frame)
    depsgraph = context.evaluated_depsgraph_get()
    unit, cloth = metres_per_unit(scene), scene.arris.cloth
    samples.matrices.append(metre_matrix(cloth.evaluated_get(depsgraph).matrix_world, unit, cloth))
    for track in samples.colliders:
        with evaluated_mesh(track.thing, depsgraph) as mesh:
            matrix = metre_matrix(track.thing.evaluated_get(depsgraph).matrix_world, unit, track.thing)
            track.append(read_points(track.thing, mesh), len(mesh.polygons), matrix, frame)
    for pin in samples.pins:
        if pin.follow is None:
            pin.matrices.append(metre_matrix(pin_matrix(pin.settings, cloth, depsgraph), unit, pin.owner))


def choose_objects(context):
    """The colliders, and what is left out; raises SceneError where the choice of objects cannot be right."""
    require_range(context.scene)
    cloth = find_cloth(context.scene, context.view_layer)
    return find_colliders(context.scene, context.view_layer, cloth)


def sample_scene(context, folder):
    """Samples all frames of the scene's range; caches of deforming colliders go to `folder`, a Path."""
    scene, cloth = context.scene, context.scene.arris.cloth
    colliders, left_out = choose_objects(context)
    frames = range(scene.frame_start, scene.frame_end + 1)
    with ExitStack() as stack:
        stack.enter_context(pause_playback())
        stack.enter_context(current_frame(scene))
        stack.enter_context(plain_cloth(scene, cloth))
        context.window_manager.progress_begin(0, len(frames))
        stack.callback(context.window_manager.progress_end)
        scene.frame_set(scene.frame_start)
        samples = begin_samples(context, folder, colliders, left_out)
        stack.callback(lambda: [track.close() for track in samples.colliders])
        for done, frame in enumerate(frames):
            sample_frame(context, samples, frame)
            context.window_manager.progress_update(done + 1)
    return samples
