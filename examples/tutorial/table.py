# SPDX-License-Identifier: GPL-3.0-or-later
# Makes mine/table.stl: a round table of 0.8 m, in millimetres. Its legs end 10 mm below its top: no faces touch.
# usage: blender -b --python examples/tutorial/table.py, in the folder of Arris (docs/tutorial.md)
import bpy
from math import cos, pi, sin
bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
bpy.ops.mesh.primitive_cylinder_add(vertices=48, radius=400, depth=30, location=(0, 0, 735))
for i in range(4):
    place = (300 * cos(i * pi / 2), 300 * sin(i * pi / 2), 355)
    bpy.ops.mesh.primitive_cube_add(size=1, scale=(50, 50, 710), location=place)
bpy.ops.export_mesh.stl(filepath="mine/table.stl")
