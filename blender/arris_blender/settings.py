# SPDX-License-Identifier: MIT
"""Settings of the user: `scene.arris` and, for each collider, `object.arris`.

Lengths are metres whatever the scene's unit scale is, so these properties state their unit in the name; Blender's own
length properties would show them scaled.
"""

import re

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

PRESETS = (
    ("cotton", "Cotton", "Shirting, 0.15 kg/m^2"),
    ("silk", "Silk", "Light silk, 0.07 kg/m^2"),
    ("wool", "Wool", "Suiting, 0.22 kg/m^2"),
    ("denim", "Denim", "0.4 kg/m^2"),
    ("leather", "Leather", "Garment leather, 0.7 kg/m^2"),
    ("rubber", "Rubber", "Rubber sheet 0.5 mm thick, 0.47 kg/m^2"),
)
RESULTS = (
    ("MESHES", "Meshes", "An object of its own, whose mesh is the simulated one at each frame, with its folds exactly "
                         "on edges. It has one material, and the cloth object is hidden"),
    ("CACHE", "Point cache", "The cloth object itself moves, by a Mesh Cache modifier. It keeps its mesh, materials "
                             "and UVs; where it folds over a sharp edge, its faces cut into it"),
)


def is_mesh(_settings, thing):
    return thing.type == "MESH" and "arris_frames" not in thing


def name_folder(scene):
    return "//arris/" + (re.sub(r"[/\\\0]", "_", scene.name).lstrip(".") or "scene")


def default_folder(scene):
    """Below the .blend file, one a scene."""
    taken = {other.arris.get("folder") for other in bpy.data.scenes if other != scene}
    number, unique = 2, name_folder(scene)
    while unique in taken:  # by a scene that has had this name
        unique, number = f"{name_folder(scene)}_{number}", number + 1
    return unique


def get_folder(settings):
    return settings.get("folder") or default_folder(settings.id_data)


def set_folder(settings, path):
    if path != get_folder(settings):
        settings["folder"], settings["is_default"] = path, False


def keep_folder(scene):
    """Stores the default folder, so that a renamed scene keeps its run. A copy of a scene takes a folder of its own."""
    settings = scene.arris
    is_copied = settings.get("is_default") and any(other != scene and other.arris.get("folder") == settings["folder"]
                                                   for other in bpy.data.scenes)
    if is_copied and settings["folder"] != name_folder(scene) or not settings.get("folder"):
        settings["folder"], settings["is_default"] = default_folder(scene), True


class ArrisPin(bpy.types.PropertyGroup):
    vertex_group: StringProperty(name="Vertex group", description="Of the cloth: vertices with a weight above 0.5 are "
                                                                  "held, and the cloth between them")
    target: PointerProperty(name="Follows", type=bpy.types.Object,
                            description="Object that the held vertices move with; without it, the cloth object. A "
                                        "collider may deform; other objects turn and move, without a change of scale")
    bone: StringProperty(name="Bone", description="Bone of the armature that the held vertices move with")
    use_start: BoolProperty(name="Hold from", description="Take hold of the cloth at this frame, where it then is")
    start: IntProperty(name="Frame", description="Frame at which the pin takes hold", default=1)
    use_release: BoolProperty(name="Release at", description="Let the cloth go at this frame")
    release: IntProperty(name="Frame", description="Frame at which the pin lets go", default=100)


class ArrisScene(bpy.types.PropertyGroup):
    cloth: PointerProperty(name="Cloth", type=bpy.types.Object, poll=is_mesh,
                           description="Mesh that is simulated, from its shape at the first frame on")
    use_modifiers: BoolProperty(
        name="Apply modifiers", default=False,
        description="Simulate the mesh as its modifiers make it; without this, the mesh itself. Modifiers after the "
                    "one that shows a point cache are never simulated, and act on the result")
    use_uv_scale: BoolProperty(
        name="UV scale", default=False,
        description="Give the length of a unit of the UVs. Without this it is found such that the cloth's area in the "
                    "UVs is that of its mesh")
    uv_scale: FloatProperty(name="UV unit (m)", description="Length of a unit of the UVs (m)", default=1.0, min=1e-6,
                            max=1000.0, precision=4)
    colliders: PointerProperty(name="Colliders", type=bpy.types.Collection,
                               description="Collection of the objects that the cloth collides with, and of "
                                           "collections in it. Objects hidden in the viewport are left out")
    pins: CollectionProperty(type=ArrisPin)
    pin_index: IntProperty()

    preset: EnumProperty(name="Fabric", description="Density and stiffness of the cloth", items=PRESETS)
    use_density: BoolProperty(name="Density", description="Give the density instead of the fabric's")
    density: FloatProperty(name="Density (kg/m²)", description="Mass of a square metre (kg/m^2)", default=0.15,
                           min=1e-6, max=1e4, precision=3)
    use_stiffness: BoolProperty(name="Stretch", description="Give the resistance to stretch instead of the fabric's")
    stiffness: FloatProperty(name="Stretch (N/m)", description="Tension per width at a strain of 1 (N/m)",
                             default=500.0, min=1e-6, max=1e12)
    use_bending: BoolProperty(name="Bending", description="Give the resistance to bending instead of the fabric's")
    bending: FloatProperty(name="Bending (µJ)", description="Bending moment per width and curvature (microjoules); 0: "
                                                            "the cloth bends freely", default=10.0, min=0.0, max=1e12)
    damping: FloatProperty(name="Damping (s)", description="Damping in proportion to the stiffness (s). 0.005 brings "
                                                           "cloth to rest within seconds", default=0.0, min=0.0,
                           max=1000.0, precision=4, step=0.1)
    thickness: FloatProperty(name="Thickness (m)", description="Distance kept from colliders and between layers (m)",
                             default=0.001, min=1e-7, max=1.0, precision=5, step=0.01)

    use_friction: BoolProperty(name="Friction", description="Simulate friction", default=True)
    friction: FloatProperty(name="Coefficient", description="Friction with colliders, and between layers of the cloth. "
                                                            "A collider may have its own (object properties)",
                            default=0.3, min=0.0, max=100.0)
    use_self_contact: BoolProperty(name="Self-contact", description="The cloth does not pass through itself",
                                   default=True)
    use_wind: BoolProperty(
        name="Wind", default=True,
        description="Take the wind from force fields of kind Wind, as they are at the first frame. Strength is the "
                    "speed of the air in m/s, along the field's local z. Several are added")
    use_remesh: BoolProperty(name="Remesh", description="Make cells finer where the cloth bends, and coarser where it "
                                                        "is smooth. The result is then best shown as meshes")
    shortest_edge: FloatProperty(name="Shortest (m)", description="Length of edges where the cloth bends (m)",
                                 default=0.01, min=1e-6, max=1e4, precision=4, step=0.1)
    longest_edge: FloatProperty(name="Longest (m)", description="Length of edges where the cloth is smooth (m)",
                                default=0.1, min=1e-6, max=1e4, precision=4, step=1)
    time_step: FloatProperty(name="Longest step (s)", description="Longest time step (s)", default=0.005, min=1e-6,
                             max=1.0, precision=4, step=0.1)

    result: EnumProperty(name="Result", items=RESULTS, description="How the simulated cloth is shown")
    folder: StringProperty(name="Folder", subtype="DIR_PATH", get=get_folder, set=set_folder,
                           description="Folder of scene file, meshes and frames. // is the folder of the .blend file. "
                                       "Files of an earlier run in it are replaced")


class ArrisCollider(bpy.types.PropertyGroup):
    use_friction: BoolProperty(name="Own friction", description="Give this collider a friction of its own")
    friction: FloatProperty(name="Friction", description="Coefficient of friction with this collider", default=0.3,
                            min=0.0, max=100.0)
    use_feature_angle: BoolProperty(name="Sharp edges", description="Say from which angle on edges are sharp")
    feature_angle: FloatProperty(name="Sharp from (°)", default=14.0, min=0.01, max=180.0,
                                 description="Convex edges whose faces turn by more than this angle (degrees) are "
                                             "sharp: cloth slides over them exactly. By default 14, of a deforming "
                                             "collider 45")
    use_slit: BoolProperty(name="Slit", description="Make room for cloth between parts of a deforming collider that "
                                                    "come together or cross, such as arm and trunk")
    slit: FloatProperty(name="Slit (m)", description="Distance to which the skin retreats there (m), at least 2.5 "
                                                     "times the cloth's thickness", default=0.005, min=1e-6,
                        max=1e4, precision=4, step=0.1)


CLASSES = (ArrisPin, ArrisScene, ArrisCollider)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.arris = PointerProperty(type=ArrisScene)
    bpy.types.Object.arris = PointerProperty(type=ArrisCollider)


def unregister():
    del bpy.types.Object.arris, bpy.types.Scene.arris
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
