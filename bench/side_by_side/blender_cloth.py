# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own cloth on a scene of this folder, without a window: prints CPU seconds a simulated second and how deep a
vertex, or a point of an edge, of the cloth got into a box. Run by scripts/side_by_side, inside Blender:

    blender --background --factory-startup --python blender_cloth.py -- CELLS SECONDS QUALITY SCENE

The same rectangle of cloth, pins, boxes, gravity and thickness as SCENE.toml. Mass and stiffness have no common units:
Blender's are its defaults, for cotton. QUALITY: its steps a frame, 24 frames a second.
"""
import sys
import time

import bpy
import bmesh
from mathutils import Vector

CELLS, SECONDS, QUALITY, SCENE = sys.argv[sys.argv.index("--") + 1:]
CELLS, SECONDS, QUALITY = int(CELLS), float(SECONDS), int(QUALITY)
SCENES = {  # size and height of the cloth; its pinned corners; boxes: size, middle; friction; with itself
    "hold": ((1.0, 1.0), 0.0, [(1.0, 0.0), (1.0, 1.0)], [((1.2, 1.5, 1.0), (0.9175, 0.4425, -0.549))], 0.0, False),
    "drop": ((1.0, 1.0), 0.52, [], [((0.4, 0.4, 0.4), (0.45, 0.52, 0.3)), ((4, 4, 0.1), (0.5, 0.5, -0.05))], 0.3, True),
}
THICKNESS = 1e-3
(width, depth), height, pins, boxes, friction, with_itself = SCENES[SCENE]

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = 24
scene.gravity = (0, 0, -9.81)

mesh = bpy.data.meshes.new("cloth")
grid = bmesh.new()
corner = [[grid.verts.new((width * i / CELLS, depth * j / CELLS, height)) for j in range(CELLS + 1)]
          for i in range(CELLS + 1)]
for i in range(CELLS):
    for j in range(CELLS):
        grid.faces.new((corner[i][j], corner[i + 1][j], corner[i + 1][j + 1], corner[i][j + 1]))
grid.to_mesh(mesh)
cloth = bpy.data.objects.new("cloth", mesh)
scene.collection.objects.link(cloth)
group = cloth.vertex_groups.new(name="pin")
for u, v in pins:
    group.add([round(u * CELLS) * (CELLS + 1) + round(v * CELLS)], 1.0, "REPLACE")
modifier = cloth.modifiers.new("cloth", "CLOTH")
settings, collision = modifier.settings, modifier.collision_settings
settings.quality = QUALITY
if pins:
    settings.vertex_group_mass = "pin"
collision.distance_min = THICKNESS
collision.collision_quality = max(2, QUALITY // 4)
collision.use_self_collision = with_itself
collision.self_distance_min = THICKNESS
collision.friction = friction * 10  # Blender's 0 to 80

for number, (size, middle) in enumerate(boxes):
    bpy.ops.mesh.primitive_cube_add(size=1, location=middle)
    box = bpy.context.object
    box.scale = size
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    box.modifiers.new("collision", "COLLISION")
    box.collision.thickness_outer = THICKNESS
    box.collision.cloth_friction = friction * 10

def depth(point, size, middle):
    return min(half / 2 - abs(along) for half, along in zip(size, point - Vector(middle)))


frames = round(SECONDS * 24)
scene.frame_start, scene.frame_end = 1, frames + 1
modifier.point_cache.frame_start, modifier.point_cache.frame_end = 1, frames + 1
deepest, deepest_vertex, spent = 0.0, 0.0, 0.0
for frame in range(1, frames + 2):
    start = time.process_time()
    scene.frame_set(frame)
    shape = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    points = [vertex.co.copy() for vertex in shape.vertices]
    if frame > 1:
        spent += time.process_time() - start
    for size, middle in boxes:
        middle = Vector(middle)
        deepest_vertex = max([deepest_vertex] + [depth(point, size, middle) for point in points])
        for edge in shape.edges:
            a, b = (points[v] for v in edge.vertices)
            deepest = max([deepest] + [depth(a.lerp(b, t / 8), size, middle) for t in range(9)])
print("RESULT vertices %d cpu_s_per_s %.3f vertex_mm %.2f edge_mm %.2f" % (
    len(points), spent / SECONDS, 1e3 * deepest_vertex, 1e3 * deepest))
