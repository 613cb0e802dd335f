# SPDX-License-Identifier: GPL-3.0-or-later
# Imports the run out/mine into Blender, and renders its frames to mine/frame_0001.png, ...
# usage: blender -b --python examples/tutorial/film.py, in the folder of Arris (docs/tutorial.md)
import os
import sys
import bpy
sys.path.append("blender")
from mathutils import Vector
import arris_blender
arris_blender.register()
bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
bpy.ops.import_scene.arris_run(directory="out/mine")

linen = bpy.data.materials.new("linen")
linen.diffuse_color = (0.7, 0.15, 0.12, 1)
linen.use_nodes = True
linen.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.7, 0.15, 0.12, 1)
bpy.data.objects["cloth"].data.materials.append(linen)
bpy.ops.object.light_add(type="SUN", rotation=(0.6, 0.4, 0))
bpy.context.object.data.energy = 1.6
bpy.ops.object.camera_add(rotation=(1.13, 0, 0.64))
scene = bpy.context.scene
scene.camera = bpy.context.object
scene.render.engine = "CYCLES"
scene.cycles.samples = 16
scene.cycles.use_denoising = False    # Debian's Blender has no denoiser
scene.view_settings.view_transform = "Standard"
sky = scene.world.node_tree.nodes["Background"].inputs
sky["Color"].default_value, sky["Strength"].default_value = (0.35, 0.42, 0.5, 1), 0.5
scene.render.resolution_x, scene.render.resolution_y = 480, 360
corners = [bpy.data.objects[name].matrix_world @ Vector(corner)
           for name in ("cloth", "table") for corner in bpy.data.objects[name].bound_box]
numbers = [x for corner in corners for x in corner]
place, _ = scene.camera.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), numbers)
scene.camera.location = place + scene.camera.matrix_world.to_3x3() @ Vector((0, 0, 0.5))    # half a metre back
scene.render.filepath = "//frame_"
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath("mine/film.blend"))
bpy.ops.render.render(animation=True)
