"""Opens an export in Blender and compares what is there with the tables of the same run.

    shatterbox run SCENE --export film.glb --tables tables
    blender --background --factory-startup --python tests/sandbox/model/check_in_blender.py -- film.glb tables

Exit status 0 if objects, keyframes, visibility and poses agree.
"""

import json
import math
import os
import struct
import sys
import traceback

import bpy
import numpy
from mathutils import Quaternion, Vector

# Debian 12's Blender 3.4 imports with a name that its numpy 1.24 no longer has.
if "bool" not in numpy.__dict__:
    numpy.bool = bool


def read_table(folder, name):
    with open(os.path.join(folder, name + ".json")) as stream:
        table = json.load(stream)
    names = [column["name"] for column in table["columns"]]
    return [dict(zip(names, row)) for row in table["rows"]]


def read_gltf(path):
    with open(path, "rb") as stream:
        _, _, _, length, _ = struct.unpack("<5I", stream.read(20))
        return json.loads(stream.read(length))


def keys_of(thing, data_path):
    if thing.animation_data is None:
        return 0
    actions = [thing.animation_data.action] if thing.animation_data.action else []
    actions += [strip.action for track in thing.animation_data.nla_tracks for strip in track.strips]
    return max([len(c.keyframe_points) for a in actions for c in a.fcurves if c.data_path == data_path], default=0)


def check(path, folder):
    gltf = read_gltf(path)
    frames_per_second = gltf["asset"]["extras"]["frames_per_second"]
    frames = gltf["asset"]["extras"]["frames"]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = frames_per_second  # before the import, which turns seconds into frames by it
    bpy.ops.import_scene.gltf(filepath=path)

    objects = {o["body"]: o for o in bpy.data.objects if "body" in o.keys()}
    nodes = {n["extras"]["body"]: i for i, n in enumerate(gltf["nodes"]) if "body" in n.get("extras", {})}
    faults = []
    if objects.keys() != nodes.keys():
        faults.append(f"{len(objects)} objects for {len(nodes)} bodies")
    bodies = {row["body"]: row for row in read_table(folder, "bodies")}
    faults += [f"{row['name']} is missing" for id, row in bodies.items()
               if id not in objects and row["motion"] != "static"]

    animation = gltf["animations"][0]
    keys = 0
    for channel in animation["channels"]:
        node = gltf["nodes"][channel["target"]["node"]]
        if "body" not in node.get("extras", {}):
            continue
        kind = channel["target"]["path"]
        count = gltf["accessors"][animation["samplers"][channel["sampler"]]["input"]]["count"]
        path_of = {"translation": "location", "rotation": "rotation_quaternion", "scale": "scale"}[kind]
        there = keys_of(objects[node["extras"]["body"]], path_of)
        keys += there
        if there != count:
            faults.append(f"{node['name']}: {there} keys of {path_of}, {count} in the file")

    # glTF's y is up, Blender's z: (x, y, z) there is (x, -z, y) here.
    turn = Quaternion((math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0))
    rows = {}
    for row in read_table(folder, "trajectories"):
        rows.setdefault(row["frame"], {})[row["body"]] = row
    worst_place = worst_turn = 0.0
    poses = 0
    for frame in sorted(rows):
        scene.frame_set(frame)
        for id, thing in objects.items():
            is_there = min(abs(s) for s in thing.matrix_world.to_scale()) > 0.5
            if bodies[id]["motion"] != "static" and is_there != (id in rows[frame]):
                faults.append(f"frame {frame}: {thing.name} is {'' if is_there else 'not '}there")
            if id not in rows[frame]:
                continue
            row = rows[frame][id]
            place = turn @ Vector((row["x_m"], row["y_m"], row["z_m"]))
            worst_place = max(worst_place, (thing.matrix_world.translation - place).length)
            rotation = turn @ Quaternion((row["qw"], row["qx"], row["qy"], row["qz"])) @ turn.conjugated()
            found = thing.matrix_world.to_quaternion()
            worst_turn = max(worst_turn, min((found - rotation).magnitude, (found + rotation).magnitude))
            poses += 1
    if worst_place > 1e-5 or worst_turn > 1e-5:
        faults.append(f"poses differ by up to {worst_place:g} m and {worst_turn:g} of a quaternion")
    print(f"Blender {bpy.app.version_string}: {len(objects)} objects, {len(bpy.data.materials)} materials, "
          f"{keys} keys, {poses} poses in {frames} frames; "
          f"places within {worst_place:.2g} m, quaternions within {worst_turn:.2g}")
    for fault in faults[:20]:
        print("fault:", fault)
    return 1 if faults else 0


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1:]
    try:
        status = check(*arguments)
    except Exception:
        traceback.print_exc()
        status = 3
    sys.exit(status)
