# SPDX-License-Identifier: Apache-2.0
"""Runs inside Blender: renders the wearers of the path-traced set and writes their cases.

    blender --background --python scripts/groundtruth_scene.py -- FOLDER SAMPLES

Light model: frame, lenses as smooth dielectrics with all bounces, skin lit as if the lenses were
absent (Zhang et al. 2017), one diffuse interreflection. Head and frame are shapes of formulas.
World axes are the head's at yaw 0: +x wearer's left, +y up, +z toward the camera.
"""

import json
import math
import os
import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import groundtruth_rays as rays  # noqa: E402  (the path has to be there first)

WIDTH, HEIGHT, FOCAL_PX, CAMERA_MM = 640, 480, 1120.0, 600.0
HALF_PD, VERTEX, PANTO, PLANE_Z = 32.0, 14.0, 8.0, -800.0
CROP = (152, 168, 336, 144)  # column, row, width, height
BLENDER_FROM_WORLD = Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
CASES = [
    {"name": "own_m5", "yaw": 0, "pitch": 0, "lens": (-5.0, 1.6, 3.0, 1.5)},
    {"name": "own_p4", "yaw": 14, "pitch": 4, "lens": (4.0, 1.5, 7.0, 4.2)},
]


def rotation(axis, degrees):
    return Matrix.Rotation(math.radians(degrees), 4, axis)


def node_material(name, build):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(build(tree), output.inputs["Surface"])
    return material


def math_node(tree, operation, *inputs):
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = operation
    for socket, value in zip(node.inputs, inputs):
        if isinstance(value, (int, float)):
            socket.default_value = value
        else:
            tree.links.new(value, socket)
    return node.outputs[0]


def colour_mix(tree, factor, a, b):
    node = tree.nodes.new("ShaderNodeMixRGB")
    for socket, value in zip(node.inputs, (factor, a, b)):
        if isinstance(value, tuple):
            socket.default_value = (*value, 1)
        else:
            tree.links.new(value, socket)
    return node.outputs[0]


def skin(tree):
    """Skin with spots of 2 to 3 mm, iris and pupil on the eyeballs."""
    position = tree.nodes.new("ShaderNodeTexCoord").outputs["Object"]
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value = 0.35
    noise.inputs["Detail"].default_value = 2
    tree.links.new(position, noise.inputs["Vector"])
    colour = colour_mix(tree, noise.outputs["Fac"], (0.62, 0.42, 0.33), (0.3, 0.19, 0.15))
    xyz = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(position, xyz.inputs[0])
    side = math_node(tree, "SUBTRACT", math_node(tree, "ABSOLUTE", xyz.outputs["X"]), HALF_PD)
    r = math_node(tree, "SQRT", math_node(tree, "ADD", math_node(tree, "MULTIPLY", side, side),
                                          math_node(tree, "MULTIPLY", xyz.outputs["Y"],
                                                    xyz.outputs["Y"])))
    for radius, tint in ((11.5, (0.7, 0.67, 0.64)), (5.85, (0.1, 0.16, 0.12)),
                         (2.0, (0.01, 0.01, 0.01))):
        colour = colour_mix(tree, math_node(tree, "LESS_THAN", r, radius), colour, tint)
    bsdf = tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(colour, bsdf.inputs["Color"])
    return bsdf.outputs[0]


def matt(albedo):
    def build(tree):
        bsdf = tree.nodes.new("ShaderNodeBsdfDiffuse")
        bsdf.inputs["Color"].default_value = (albedo, albedo, albedo, 1)
        return bsdf.outputs[0]
    return build


def glass(index):
    """A dielectric to what the camera sees; not there for light that falls on the skin."""
    def build(tree):
        path = tree.nodes.new("ShaderNodeLightPath")
        bsdf = tree.nodes.new("ShaderNodeBsdfGlass")
        bsdf.distribution = "SHARP"
        bsdf.inputs["IOR"].default_value = index
        mix = tree.nodes.new("ShaderNodeMixShader")
        absent = math_node(tree, "MAXIMUM", path.outputs["Is Shadow Ray"],
                           path.outputs["Is Diffuse Ray"])
        tree.links.new(absent, mix.inputs[0])
        tree.links.new(bsdf.outputs[0], mix.inputs[1])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[2])
        return mix.outputs[0]
    return build


def board(tree):
    """The background: a smooth pattern that shines by itself."""
    position = tree.nodes.new("ShaderNodeTexCoord").outputs["Object"]
    wave = tree.nodes.new("ShaderNodeTexNoise")
    wave.inputs["Scale"].default_value = 0.02
    wave.inputs["Detail"].default_value = 0
    tree.links.new(position, wave.inputs["Vector"])
    shine = tree.nodes.new("ShaderNodeEmission")
    shine.inputs["Strength"].default_value = 0.5
    tree.links.new(wave.outputs["Color"], shine.inputs["Color"])
    return shine.outputs[0]


def add_mesh(name, points, triangles, material, world_from_mesh, normals=None, smooth=False):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], triangles.tolist())
    mesh.polygons.foreach_set("use_smooth", [smooth or normals is not None] * len(mesh.polygons))
    if normals is not None:
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set(normals.reshape(-1, 3).tolist())
    mesh.materials.append(material)
    thing = bpy.data.objects.new(name, mesh)
    thing.matrix_world = BLENDER_FROM_WORLD @ world_from_mesh
    bpy.context.collection.objects.link(thing)
    return thing


def set_environment():
    light = rays.environment_map()
    height, width, _ = light.shape
    image = bpy.data.images.new("environment", width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear"
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = light[::-1]
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    world = bpy.data.worlds.new("environment")
    bpy.context.scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    turn = tree.nodes.new("ShaderNodeMapping")  # the image's centre lies toward the camera
    turn.inputs["Rotation"].default_value = (0, 0, math.pi / 2)
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(coordinates.outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    return light


def set_up_camera_and_cycles():
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.sensor_width, camera.sensor_fit = 36, "HORIZONTAL"
    camera.lens = FOCAL_PX * 36 / WIDTH
    camera.clip_end = 5000
    thing = bpy.data.objects.new("camera", camera)
    thing.matrix_world = BLENDER_FROM_WORLD @ Matrix.Translation((0, 0, CAMERA_MM))
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.exr_codec = "NONE"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.max_bounces, cycles.diffuse_bounces = 17, 1
    cycles.glossy_bounces = cycles.transmission_bounces = 16
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0


def render(folder, seed, samples, crop):
    """Linear radiance, rows from the top; the crop alone, or all of it."""
    scene = bpy.context.scene
    x, y, w, h = CROP if crop else (0, 0, WIDTH, HEIGHT)
    scene.render.use_border = scene.render.use_crop_to_border = crop
    scene.render.border_min_x, scene.render.border_max_x = x / WIDTH, (x + w) / WIDTH
    scene.render.border_min_y, scene.render.border_max_y = 1 - (y + h) / HEIGHT, 1 - y / HEIGHT
    scene.cycles.seed, scene.cycles.samples = seed, samples
    path = os.path.join(folder, "render.exr")
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Linear"
    assert tuple(image.size) == (w, h), (tuple(image.size), w, h)
    pixels = np.empty(4 * w * h, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    os.remove(path)
    return pixels.reshape(h, w, 4)[::-1, :, :3].copy()


def cropped(image):
    x, y, w, h = CROP
    return image[y:y + h, x:x + w]


def hit_map(head, frame, lens, head_from_lens, world_from_head):
    """RGB: where in the head's frame the ray through the pixel's centre ends; A: HitCode."""
    x0, y0, w, h = CROP
    col, row = np.meshgrid(np.arange(w) + x0 + 0.5, np.arange(h) + y0 + 0.5)
    d = np.stack([(col - WIDTH / 2) / FOCAL_PX, -(row - HEIGHT / 2) / FOCAL_PX,
                  -np.ones(col.shape)], -1).reshape(-1, 3)
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    head_from_world = np.array(world_from_head.inverted())
    eye = (head_from_world @ [0, 0, CAMERA_MM, 1])[:3]
    d = d @ head_from_world[:3, :3].T
    trees = [BVHTree.FromPolygons(p.tolist(), t.tolist(), epsilon=0) for p, t in (head, frame)]

    def cast(tree, origin, direction):
        place, _, _, distance = tree.ray_cast(Vector(origin), Vector(direction))
        return (np.array(place), distance) if place else (None, math.inf)

    traced = []
    for pose in head_from_lens:
        lens_from_head = np.linalg.inv(pose)
        o = np.broadcast_to((lens_from_head @ [*eye, 1])[:3], d.shape)
        traced.append(lens.trace(o, d @ lens_from_head[:3, :3].T))
    result = np.zeros((len(d), 4), np.float32)
    for i, direction in enumerate(d):
        _, to_frame = cast(trees[1], eye, direction)
        point, to_head = cast(trees[0], eye, direction)
        code, place = 5 if point is not None else 0, None
        if to_frame < to_head:
            code = 4
        for k, pose in enumerate(head_from_lens):
            p1, p2, out, entered, left = (a[i] for a in traced[k])
            at = (pose @ [*p1, 1])[:3]
            if not entered or np.linalg.norm(at - eye) > min(to_frame, to_head):
                continue
            code, place = 6, None
            origin, way = (pose @ [*p2, 1])[:3], pose[:3, :3] @ out
            inside = origin - at
            _, to_lip = cast(trees[1], at, inside / np.linalg.norm(inside))
            if to_lip < np.linalg.norm(inside):  # the rim reaches into the glass
                code = 4
            elif left:
                skin_at, to_skin = cast(trees[0], origin, way)
                _, to_rim = cast(trees[1], origin, way)
                code = 1 + k if skin_at is not None else 3
                place = skin_at
                if to_rim < to_skin:
                    code, place = 4, None
        result[i, 3] = code
        if place is not None:
            result[i, :3] = place
    return result.reshape(h, w, 4)


def rows(matrix):
    return [[round(float(v), 9) for v in row] for row in np.array(matrix)]


def make_case(folder, case, samples, head, frame):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    set_up_camera_and_cycles()
    set_environment()
    world_from_head = rotation("Y", case["yaw"]) @ rotation("X", case["pitch"])
    lens = rays.SphereLens(*case["lens"])
    add_mesh("head", *head, node_material("skin", skin), world_from_head, smooth=True)
    plane = np.array([(-1200, -900, 0), (1200, -900, 0), (1200, 900, 0), (-1200, 900, 0)], float)
    far = add_mesh("board", plane, np.array([(0, 1, 2), (0, 2, 3)]),
                   node_material("board", board), Matrix.Translation((0, 0, PLANE_Z)))
    far.visible_diffuse = far.visible_glossy = far.visible_shadow = False
    picture = render(folder, 1, max(1, samples // 2), False)
    fine = [render(folder, seed, 2 * samples, True) for seed in (3, 4)]
    cropped(picture)[:] = (fine[0] + fine[1]) / 2

    head_from_frame = Matrix.Translation((0, 0, VERTEX)) @ rotation("X", PANTO)
    add_mesh("frame", *frame, node_material("frame", matt(0.05)), world_from_head @ head_from_frame)
    bare = [render(folder, seed, samples, True) for seed in (5, 6)]
    points, triangles, normals = rays.lens_mesh(lens)
    poses = []
    for side in (-1, 1):
        pose = Matrix.Translation((side * HALF_PD, 0, VERTEX)) @ rotation("X", PANTO)
        poses.append(np.array(pose))
        add_mesh("lens", points, triangles, node_material("glass", glass(lens.index)),
                 world_from_head @ pose, normals)
    full = [render(folder, seed, 2 * samples, True) for seed in (7, 8)]
    placed = np.array(head_from_frame)
    frame_in_head = (frame[0] @ placed[:3, :3].T + placed[:3, 3], frame[1])
    hits = hit_map(head, frame_in_head, lens, poses, world_from_head)

    place = os.path.join(folder, case["name"])
    os.makedirs(place)
    rays.write_exr(os.path.join(place, "input.exr"), picture)
    rays.write_exr(os.path.join(place, "frame_only.exr"), (bare[0] + bare[1]) / 2)
    rays.write_exr(os.path.join(place, "full_nocaustic.exr"), (full[0] + full[1]) / 2)
    rays.write_exr(os.path.join(place, "hit.exr"), hits)
    code = np.rint(hits[..., 3])
    regions = {"lens_on_head": (code == 1) | (code == 2), "skin_direct": code == 5}

    def noise(halves):
        """Standard error of the mean of two halves."""
        return {name: {"rms_linear": float(np.sqrt(np.mean((halves[0] - halves[1])[m] ** 2)) / 2)}
                for name, m in regions.items()}

    sphere, index, front, thickness = case["lens"]
    description = {
        "schema": 1, "name": case["name"],
        "image": {"width": WIDTH, "height": HEIGHT, "crop_x0_y0_w_h": list(CROP)},
        "files": {"input": "input.exr", "frame_only": "frame_only.exr",
                  "full_nocaustic": "full_nocaustic.exr", "hit": "hit.exr",
                  "head_mesh": "../head.obj", "frame_mesh": "../frame.obj",
                  "environment": "../environment.exr"},
        "K": [[FOCAL_PX, 0, WIDTH / 2], [0, FOCAL_PX, HEIGHT / 2], [0, 0, 1]],
        "camera_from_head": rows(camera_from_world() @ world_from_head),
        "camera_from_world": rows(camera_from_world()),
        "head_from_frame": rows(head_from_frame),
        "background": {"plane_world_z_mm": PLANE_Z},
        "lenses": {name: {
            "Rx": {"sphere_D": sphere}, "index": index, "F1_D": front,
            "center_thickness_mm": thickness, "r1_mm": lens.r1,
            "r2_axis_meridian_mm": lens.r2, "r2_power_meridian_mm": lens.r2,
            "head_from_lens": rows(pose),
            "outline_lens_xy": [round(float(v), 6) for v in rays.outline().ravel()],
        } for name, pose in zip(("right", "left"), poses)},
        "noise": {"full_nocaustic": noise(full), "frame_only": noise(bare),
                  "input": noise(fine)},
        "samples_per_pixel": 4 * samples,
    }
    with open(os.path.join(place, "case.json"), "w", encoding="utf-8") as file:
        json.dump(description, file, indent=1)
        file.write("\n")
    print(case["name"], description["noise"])


def camera_from_world():
    return Matrix(((1, 0, 0, 0), (0, -1, 0, 0), (0, 0, -1, CAMERA_MM), (0, 0, 0, 1)))


def main():
    folder, samples = sys.argv[sys.argv.index("--") + 1:]
    folder = os.path.abspath(folder)
    head, frame = rays.head_mesh(), rays.frame_mesh()
    rays.write_obj(os.path.join(folder, "head.obj"), *head)
    rays.write_obj(os.path.join(folder, "frame.obj"), *frame)
    rays.write_exr(os.path.join(folder, "environment.exr"), rays.environment_map())
    for case in CASES:
        make_case(folder, case, int(samples), head, frame)


if __name__ == "__main__":
    main()
