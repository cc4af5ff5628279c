# Blender's collapse modifier as a command: blender --background --python peer_blender.py -- INPUT OUTPUT RATIO
import sys

import bpy
import numpy

if not hasattr(numpy, "bool"):
    numpy.bool = bool  # which the glTF add-on of Blender 3.4 still asks for
source, result, ratio = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=source, merge_vertices=True)
for item in bpy.data.objects:
    if item.type == "MESH":
        modifier = item.modifiers.new("Decimate", "DECIMATE")
        modifier.ratio = float(ratio)
        modifier.use_collapse_triangulate = True
bpy.ops.export_scene.gltf(filepath=result, export_format="GLB", export_apply=True)
