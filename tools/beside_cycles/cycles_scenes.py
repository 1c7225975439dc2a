# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Four of Caplet's scenes for Blender's Cycles: neuron, hair, gallery and smoke.

usage: cycles_scenes.py SCENE FOLDER WIDTH HEIGHT OUT.exr SAMPLES SEED DENOISE    (runs with PyPI's bpy)

Prints the seconds of the render without those of one sample, which loads the scene. FOLDER holds what
compare.py writes: NAME.pbrt, sky.npy (neuron) and smoke.vdb. Shapes are curves and meshes here, and
materials are Blender's nearest, so each renderer's picture is compared with its own reference.
"""
import math
import pathlib
import re
import sys
import time

import bpy
import mathutils
import numpy as np

SIDES = 128  # of a round thing's meridians


def numbers(text):
    return [float(word) for word in text.split()]


def entries(text, name):
    """The lists of numbers of each parameter of this name in pbrt text."""
    return [numbers(found) for found in re.findall(r'"\w+ ' + name + r'"\s*\[([^\]]*)\]', text)]


# ---- materials ----

def shader(name, kind, **inputs):
    """A material of one node; inputs by Blender's names with _ for spaces."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    node = nodes.new(kind)
    for key, value in inputs.items():
        socket = node.inputs[key.replace("_", " ")]
        socket.default_value = (*value, 1) if isinstance(value, (tuple, list)) and len(value) == 3 and socket.type == "RGBA" else value
    out = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(node.outputs[0], out.inputs[0])
    return material


def diffuse(name, rgb):
    return shader(name, "ShaderNodeBsdfDiffuse", Color=rgb)


def metal(name, rgb, roughness):
    return shader(name, "ShaderNodeBsdfAnisotropic", Color=rgb, Roughness=math.sqrt(math.sqrt(roughness)))  # alpha = sqrt


def glass(name, index):
    return shader(name, "ShaderNodeBsdfGlass", Color=(1, 1, 1), Roughness=0, IOR=index)


def lamp(name, rgb, strength):
    return shader(name, "ShaderNodeEmission", Color=rgb, Strength=strength)


def inside(material, *volumes):
    """Adds volume nodes (kind, inputs) to a material; interface surfaces are transparent."""
    tree = material.node_tree
    out = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    last = None
    for kind, inputs in volumes:
        node = tree.nodes.new(kind)
        for key, value in inputs.items():
            node.inputs[key].default_value = (*value, 1) if isinstance(value, tuple) else value
        if last is None:
            last = node
        else:
            both = tree.nodes.new("ShaderNodeAddShader")
            tree.links.new(last.outputs[0], both.inputs[0])
            tree.links.new(node.outputs[0], both.inputs[1])
            last = both
    tree.links.new(last.outputs[0], out.inputs["Volume"])
    return material


# ---- shapes ----

def add(mesh, materials, smooth=True):
    for material in materials:
        mesh.materials.append(material)
    if smooth:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    made = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def turned(profiles, p0, p1, materials, turn=2 * math.pi, smooth=True):
    """Turns profiles, lists of (along, radius) a material, about the axis from p0 to p1."""
    p0, p1 = np.asarray(p0, float), np.asarray(p1, float)
    axis = p1 - p0
    axis = axis / np.linalg.norm(axis) if np.linalg.norm(axis) > 0 else np.array([0, 0, 1.0])
    a = np.cross(axis, [1, 0, 0] if abs(axis[0]) < 0.9 else [0, 1, 0])
    a /= np.linalg.norm(a)
    b = np.cross(axis, a)
    if abs(axis[2]) > 0.999:
        a, b = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    angles = np.linspace(0, turn, SIDES + 1)
    points, faces, which = [], [], []
    for k, profile in enumerate(profiles):
        first = len(points)
        for along, radius in profile:
            points += [tuple(p0 + axis * along + radius * (a * math.cos(t) + b * math.sin(t))) for t in angles]
        for i in range(len(profile) - 1):
            for j in range(SIDES):
                q = first + i * (SIDES + 1) + j
                faces.append((q, q + 1, q + SIDES + 2, q + SIDES + 1))
                which.append(k)
    mesh = bpy.data.meshes.new("turned")
    mesh.from_pydata(points, [], faces)
    if turn > 6.283:  # one vertex where the seam is and at the poles
        import bmesh
        work = bmesh.new()
        work.from_mesh(mesh)
        layer = work.faces.layers.int.new("which")
        for face, k in zip(work.faces, which):
            face[layer] = k
            face.material_index = k
        bmesh.ops.remove_doubles(work, verts=work.verts, dist=1e-6)
        bmesh.ops.recalc_face_normals(work, faces=work.faces)
        work.to_mesh(mesh)
        work.free()
    else:
        mesh.polygons.foreach_set("material_index", which)
    return add(mesh, materials, smooth)


def arc(middle, radius, begin, end, steps=64):
    """Profile of a circle's arc from angle begin to end, 0 at the lower pole."""
    return [(middle - radius * math.cos(t), max(0.0, radius * math.sin(t))) for t in np.linspace(begin, end, steps)]


def capsule(p0, p1, r0, r1, material):
    length = float(np.linalg.norm(np.subtract(p1, p0)))
    tilt = math.acos((r1 - r0) / length) if length > abs(r1 - r0) else math.pi / 2
    tilt = math.pi - tilt  # where the cone touches, as an angle from the lower pole
    return turned([arc(0, r0, 0, tilt) + arc(length, r1, tilt, math.pi)], p0, p1, [material])


def solid(p0, p1, r0, r1, round_end, materials):
    """A cylinder or cone: side, lower and upper cap."""
    length = float(np.linalg.norm(np.subtract(p1, p0)))
    upper = arc(length, r1, math.pi / 2, math.pi) if round_end else [(length, r1), (length, 0)]
    made = turned([[(0, r0), (length, r1)], [(0, 0), (0, r0)], upper], p0, p1, materials)
    made.modifiers.new("edges", "EDGE_SPLIT").split_angle = math.radians(40)
    return made


def flat(points, faces, material):
    mesh = bpy.data.meshes.new("flat")
    mesh.from_pydata([tuple(p) for p in points], [], faces)
    return add(mesh, [material] if not isinstance(material, list) else material, smooth=False)


def boolean(first, others, operation):
    for other in others:
        step = first.modifiers.new("csg", "BOOLEAN")
        step.operation, step.object, step.solver = operation, other, "EXACT"
        other.hide_render = True
    return first


def fibres(chains, material):
    """Round fibres: (points, radii) of each."""
    curves = bpy.data.hair_curves.new("fibres")
    curves.add_curves([len(points) for points, _ in chains])
    curves.attributes["position"].data.foreach_set("vector", np.concatenate([p for p, _ in chains]).astype(np.float32).ravel())
    radius = curves.attributes.get("radius") or curves.attributes.new("radius", "FLOAT", "POINT")
    radius.data.foreach_set("value", np.concatenate([r for _, r in chains]).astype(np.float32))
    curves.materials.append(material)
    made = bpy.data.objects.new("fibres", curves)
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.cycles_curves.shape = "THICK"


def bspline(points, steps):
    """Points of a uniform cubic B-spline."""
    points = np.asarray(points, float)
    out = []
    for i in range(len(points) - 3):
        for t in np.linspace(0, 1, steps, endpoint=i == len(points) - 4):
            weights = [(1 - t)**3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]
            out.append(sum(w * p for w, p in zip(weights, points[i:i + 4])) / 6)
    return np.array(out)


# ---- the world and the camera ----

def camera(world_from_camera, fov):
    m = np.eye(4)
    m[:3, 0] = np.cross(world_from_camera[:3, 2], world_from_camera[:3, 1])
    m[:3, 1], m[:3, 2], m[:3, 3] = world_from_camera[:3, 1], -world_from_camera[:3, 2], world_from_camera[:3, 3]
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle, data.clip_end = "VERTICAL", math.radians(fov), 1e5
    made = bpy.data.objects.new("camera", data)
    made.matrix_world = mathutils.Matrix(m.tolist())
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = made


def look_at(eye, target, up, fov):
    eye, target, up = (np.asarray(v, float) for v in (eye, target, up))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    camera(np.column_stack([np.append(-right, 0), np.append(np.cross(right, forward), 0), np.append(forward, 0), np.append(eye, 1)]), fov)


def sky(rgb=None, image=None):
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    if image is None:
        background.inputs[0].default_value = (*rgb, 1)
        return
    node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    rows, columns = image.shape[:2]
    node.image = bpy.data.images.new("sky", columns, rows, float_buffer=True, is_data=True)
    node.image.pixels.foreach_set(np.concatenate([image, np.ones((rows, columns, 1))], 2).astype(np.float32).ravel())
    node.image.update()
    world.node_tree.links.new(node.outputs[0], background.inputs[0])


def blackbody(kelvin):
    """About the colour of a black body in linear sRGB, by Tanner Helland's fit, its largest value 1."""
    h = kelvin / 100
    rgb = np.array([255 if h <= 66 else 329.7 * (h - 60)**-0.1332, 99.47 * math.log(h) - 161.12 if h <= 66 else 288.12 * (h - 60)**-0.0755,
                    255 if h >= 66 else 138.52 * math.log(h - 10) - 305.04]) / 255
    rgb = np.clip(rgb, 0, 1)
    return tuple(np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055)**2.4))


# ---- scenes ----

def neuron(folder, height):
    text = (folder / "neuron.pbrt").read_text()
    m = np.array(numbers(re.search(r"Transform \[([^\]]*)\]", text)[1])).reshape(4, 4).T
    fov = float(re.search(r'"float fov" (\S+)', text)[1])
    camera(m if text.startswith("Inverse") or "InverseTransform" in text else np.linalg.inv(m), fov)
    sky(image=np.load(folder / "sky.npy"))
    colors = {"soma": (0.86, 0.62, 0.22), "apical dendrite": (0.66, 0.22, 0.66), "basal dendrite": (0.95, 0.36, 0.18), "axon": (0.2, 0.62, 0.95)}
    kinds = [diffuse(name, rgb) for name, rgb in colors.items()]
    turned([arc(0, 7, 0, math.pi)], (0, 0, 0), (0, 0, 1), [kinds[0]])
    begin = text.index('Shape "capsules"')
    bulk = text[begin:]
    p0, p1 = (np.array(entries(bulk, name)[0]).reshape(-1, 3) for name in ("p0", "p1"))
    r0, r1 = (np.array(entries(bulk, name)[0]) for name in ("radius", "radius1"))
    which = np.array(re.findall(r'"integer \w+" \[([^\]]*)\]', bulk)[-1].split(), int)
    eye = np.array(bpy.context.scene.camera.matrix_world.translation)
    pixel = 2 * math.tan(math.radians(fov) / 2) / height
    least = lambda p, r: np.maximum(r, 0.75 * pixel * np.linalg.norm(p - eye, axis=1))
    r0, r1 = least(p0, r0), least(p1, r1)
    for k in np.unique(which):
        at = which == k
        fibres([(np.stack([a, b]), np.array([s, t])) for a, b, s, t in zip(p0[at], p1[at], r0[at], r1[at])], kinds[min(k + 1, 3)])
    return 5


def hair(folder, height):
    del height
    text = (folder / "hair.pbrt").read_text()
    look_at((0, -9, 0.6), (0, 0, -0.15), (0, 0, 1), 21)
    sky((0.2, 0.22, 0.26))
    for kelvin, scale, at, radius in ((5600, 110, (3.5, -5, 5), 0.9), (7500, 130, (-3.5, 1.8, 4), 0.6)):
        turned([arc(0, radius, 0, math.pi)], at, np.add(at, (0, 0, 1)), [lamp("lamp", blackbody(kelvin), scale)])
    flat([(-9, 3.4, -4), (9, 3.4, -4), (9, 3.4, 6), (-9, 3.4, 6)], [(0, 1, 2, 3)], diffuse("wall", (0.35, 0.33, 0.32)))
    eu, pheo = np.array([0.419, 0.697, 1.37]), np.array([0.187, 0.4, 1.05])
    beta = 0.3
    red = (np.log([0.55, 0.1, 0.06]) / (5.969 - 0.215 * beta + 2.532 * beta**2 - 10.73 * beta**3 + 5.574 * beta**4 + 0.245 * beta**5))**2
    locks = re.split(r"# --- \w+ ---", text)[1:]
    for part, absorption, m, n in zip(locks, (0.55 * eu + 0.2 * pheo, 0.06 * eu + 0.22 * pheo, red), (0.25, 0.22, 0.3), (0.35, 0.3, 0.3)):
        made = bpy.data.materials.new("hair")
        made.use_nodes = True
        tree = made.node_tree
        tree.nodes.clear()
        node = tree.nodes.new("ShaderNodeBsdfHairPrincipled")
        node.model, node.parametrization = "CHIANG", "ABSORPTION"
        node.inputs["Absorption Coefficient"].default_value = tuple(absorption)
        for name, value in (("Roughness", m), ("Radial Roughness", n), ("Offset", math.radians(2.5)), ("IOR", 1.55), ("Coat", 0), ("Random Roughness", 0)):
            node.inputs[name].default_value = value
        tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs[0])
        chains = []
        for points in entries(part, "P"):
            at = bspline(np.array(points).reshape(-1, 3), 6)
            chains.append((at, np.linspace(0.026, 0.007, len(at)) / 2))
        fibres(chains, made)
    return 24


def gallery(folder, height):
    del folder, height
    look_at((0, -13, 6.4), (0, -0.3, 0.5), (0, 0, 1), 25)
    sky((0.38, 0.44, 0.52))
    c = {name: diffuse(name, rgb) for name, rgb in {
        "floor": (0.6, 0.59, 0.57), "white": (0.8, 0.79, 0.76), "red": (0.7, 0.09, 0.06), "orange": (0.8, 0.36, 0.06), "yellow": (0.82, 0.65, 0.1),
        "green": (0.12, 0.45, 0.16), "teal": (0.06, 0.4, 0.42), "blue": (0.08, 0.18, 0.6), "violet": (0.35, 0.13, 0.5), "dark": (0.06, 0.06, 0.07)}.items()}
    c |= {"gold": metal("gold", (1, 0.78, 0.34), 0.05), "copper": metal("copper", (0.96, 0.64, 0.54), 0.1),
          "silver": metal("silver", (0.97, 0.96, 0.92), 0.03), "glass": glass("glass", 1.5168)}
    soft = turned([[(0, 0), (0, 1.2)]], (0, 0, 0), (0, 0, 1), [lamp("softbox", (1, 0.92, 0.8), 50)])
    soft.matrix_world = mathutils.Matrix.Translation((-4.5, -5, 8)) @ mathutils.Matrix.Rotation(math.radians(140), 4, mathutils.Vector((-5, 4.5, 0)))
    flat([(-60, -60, 0), (60, -60, 0), (60, 60, 0), (-60, 60, 0)], [(0, 1, 2, 3)], c["floor"])
    for name, x, low, high, r in (("red", -3.735, 0.015, 0.985, 0.015), ("orange", -3.537, 0.02325, 0.9767, 0.02325), ("yellow", -3.317, 0.03604, 0.964, 0.03604),
                                  ("green", -3.066, 0.05587, 0.9441, 0.05587), ("teal", -2.763, 0.0866, 0.9134, 0.0866), ("blue", -2.382, 0.1342, 0.8658, 0.1342),
                                  ("violet", -1.88, 0.2081, 0.7919, 0.2081), ("copper", -1.189, 0.3226, 0.6774, 0.3226)):
        capsule((x, -2.5, low), (x, -2.5, high), r, r, c[name])
    turned([arc(0, 0.5, 0, math.pi)], (-0.2067, -2.5, 0.5), (-0.2067, -2.5, 1.5), [c["gold"]])
    rim = math.acos(2.48 / 2.6)
    lens = turned([arc(-2.48, 2.6, math.pi - rim, math.pi)[::-1] + arc(2.48, 2.6, rim, 0)[::1]], (1.75, -2.1, 0.79), (1.75, -1.1, 0.79), [c["glass"]])
    lens.modifiers.new("edges", "EDGE_SPLIT").split_angle = math.radians(20)
    at = np.array([3.3, -2.6, 0])
    parts = [capsule(at + a, at + b, 0.2, r, c["glass"]) for a, b, r in
             (((0, 0, 0.2), (0, 0, 0.7), 0.2), ((0, 0, 0.7), (-0.35, 0, 1.25), 0.1), ((0, 0, 0.7), (0.35, 0, 1.25), 0.1))]
    boolean(parts[0], parts[1:], "UNION")
    solid((-3.5, -0.5, 0), (-3.5, -0.5, 1), 0.42, 0.42, False, [c["blue"], c["dark"], c["yellow"]])
    solid((-3.5, -0.5, 1.04), (-3.5, -0.5, 1.16), 0.25, 0.25, False, [c["dark"], c["dark"], lamp("cap", (1, 0.8, 0.4), 3)])
    way = np.array([math.cos(math.radians(35)), math.sin(math.radians(35)), 0])
    middle = np.array([-2.35, -0.4, 0.38])
    solid(middle - 0.35 * way, middle + 0.35 * way, 0.38, 0.38, True, [c["teal"], c["white"], c["orange"]])
    solid((-1.2, -0.5, 0), (-1.2, -0.5, 1.15), 0.45, 0, False, [c["green"], c["dark"], c["dark"]])
    solid((-0.1, -0.4, 0), (-0.1, -0.4, 0.7), 0.48, 0.28, True, [c["violet"], c["dark"], c["gold"]])
    turn = lambda at, degrees, axis: mathutils.Matrix.Translation(at) @ mathutils.Matrix.Rotation(math.radians(degrees), 4, mathutils.Vector(axis))
    corners = lambda a, b: [(x, y, z) for x in (a[0], b[0]) for y in (a[1], b[1]) for z in (a[2], b[2])]
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    box = flat(corners((-0.4, -0.4, 0), (0.4, 0.4, 0.8)), sides, [c[n] for n in ("red", "green", "yellow", "blue", "dark", "white")])
    box.data.polygons.foreach_set("material_index", range(6))
    box.matrix_world = turn((1, -0.5, 0), 33, (0, 0, 1))
    ball = bpy.data.meshes.new("dodecahedron")
    g = (1 + math.sqrt(5)) / 2
    import bmesh
    work = bmesh.new()
    for v in corners((-1, -1, -1), (1, 1, 1)) + [p for s in (-1, 1) for t in (-1, 1) for p in ((0, s / g, t * g), (s / g, t * g, 0), (t * g, 0, s / g))]:
        work.verts.new(np.array(v) * 0.36)
    bmesh.ops.convex_hull(work, input=work.verts)
    bmesh.ops.dissolve_limit(work, angle_limit=0.01, verts=work.verts, edges=work.edges)
    work.to_mesh(ball)
    made = add(ball, [c[n] for n in ("red", "yellow", "teal", "white")], smooth=False)
    made.data.polygons.foreach_set("material_index", [i % 4 for i in range(len(ball.polygons))])
    made.matrix_world = turn((2.2, -0.5, 0.5), 31.717, (1, 0, 0))
    cube = flat(corners((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), sides, [c["silver"], c["red"], c["gold"]])
    cutters = [turned([arc(0, 0.66, 0, math.pi)], (0, 0, 0), (0, 0, 1), [c["red"]])]
    shafts = [turned([[(0, 0), (0, 0.25), (2, 0.25), (2, 0)]], -np.eye(3)[i], np.eye(3)[i], [c["gold"]]) for i in range(3)]
    boolean(cube, cutters, "INTERSECT")
    boolean(cube, shafts, "DIFFERENCE")
    for part in (cube, *cutters, *shafts):
        part.matrix_world = turn((3.45, -0.5, 0.5), 30, (0, 0, 1))
    cube.modifiers.new("edges", "EDGE_SPLIT").split_angle = math.radians(30)
    capsule((-4.05, 1.9, 0.45), (-3.6, 1.8, 1.5), 0.45, 0.12, c["gold"])
    bowl = turned([arc(0, 0.55, 0, math.acos(-0.25 / 0.55))], (0, 0, 0), (0, 0, 1), [c["orange"]], math.radians(300))
    bowl.matrix_world = turn((-2.65, 1.7, 0.55), -35, (1, 0, 0))
    tube = turned([[(-0.6, 0.45), (0.6, 0.45)]], (0, 0, 0), (0, 0, 1), [c["teal"]], math.radians(250))
    tube.matrix_world = turn((-1.4, 1.8, 0.6), -100, (0, 0, 1))
    ring = turned([[(0, 0.25), (0, 0.6)]], (0, 0, 0), (0, 0, 1), [c["copper"]], math.radians(290))
    ring.matrix_world = turn((-0.1, 1.8, 0.62), 80, (1, 0, 0)) @ mathutils.Matrix.Rotation(math.radians(130), 4, "Z")
    n = 32
    patch = [np.array(p, float) for p in ((-0.55, -0.4, 0.1), (0.55, -0.4, 1.1), (-0.55, 0.5, 1.1), (0.55, 0.5, 0.1))]
    points = [(1 - u) * (1 - v) * patch[0] + u * (1 - v) * patch[1] + (1 - u) * v * patch[2] + u * v * patch[3]
              for v in np.linspace(0, 1, n + 1) for u in np.linspace(0, 1, n + 1)]
    saddle = bpy.data.meshes.new("saddle")
    saddle.from_pydata([tuple(p) for p in points], [], [(i * (n + 1) + j, i * (n + 1) + j + 1, (i + 1) * (n + 1) + j + 1, (i + 1) * (n + 1) + j)
                                                        for i in range(n) for j in range(n)])
    add(saddle, [c["violet"]]).matrix_world = turn((1.1, 1.8, 0), 20, (0, 0, 1))
    flat([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0), (0, 0, 1.1)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 3, 2, 1)],
         c["green"]).matrix_world = turn((2.35, 1.8, 0), 25, (0, 0, 1))
    t = np.arange(21)
    coil = bspline(np.column_stack([0.42 * np.cos((t - 1) * math.pi / 4), 0.42 * np.sin((t - 1) * math.pi / 4), 0.05611 + 0.0639 * t]), 12)
    fibres([(coil + (3.65, 1.8, 0), np.linspace(0.22, 0.05, len(coil)) / 2)], c["red"])
    egg = turned([arc(0, 1, 0, math.pi)], (0, 0, 0), (0, 0, 1), [c["blue"]])
    egg.matrix_world = mathutils.Matrix.Translation((4.55, 0.55, 0.35)) @ mathutils.Matrix.Diagonal((0.5, 0.5, 0.35, 1))
    return 12


def smoke(folder, height):
    del height
    look_at((0.2, -7.5, 2.6), (0.1, 0, 0.95), (0, 0, 1), 30)
    sky((0.25, 0.3, 0.38))
    turned([arc(0, 0.8, 0, math.pi)], (3, -3, 5), (3, -3, 6), [lamp("lamp", blackbody(4500), 20)])
    floor = diffuse("floor", (1, 1, 1))
    tree = floor.node_tree
    checks = tree.nodes.new("ShaderNodeTexChecker")
    checks.inputs["Color1"].default_value, checks.inputs["Color2"].default_value = (0.55, 0.52, 0.5, 1), (0.3, 0.29, 0.28, 1)
    checks.inputs["Scale"].default_value = 1 / 1.2
    place = tree.nodes.new("ShaderNodeNewGeometry")
    tree.links.new(place.outputs["Position"], checks.inputs["Vector"])
    tree.links.new(checks.outputs[0], next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE").inputs[0])
    flat([(-12, -12, -1e-4), (12, -12, -1e-4), (12, 12, -1e-4), (-12, 12, -1e-4)], [(0, 1, 2, 3)], floor)
    grid = bpy.data.volumes.new("smoke")
    grid.filepath = str(folder / "smoke.vdb")
    cloud = shader("smoke", "ShaderNodeVolumePrincipled", Color=(5 / 5.4,) * 3, Density=5.4, Anisotropy=0.3)
    links = cloud.node_tree.links
    out = next(n for n in cloud.node_tree.nodes if n.type == "OUTPUT_MATERIAL")
    node = next(n for n in cloud.node_tree.nodes if n.type == "PRINCIPLED_VOLUME")
    links.remove(out.inputs[0].links[0])
    links.new(node.outputs[0], out.inputs["Volume"])
    grid.materials.append(cloud)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("smoke", grid))
    scatter = lambda color, density, g=0.0: ("ShaderNodeVolumeScatter", {"Color": color, "Density": density, "Anisotropy": g})
    absorb = lambda rgb: ("ShaderNodeVolumeAbsorption", {"Color": tuple(1 - v / max(rgb) for v in rgb), "Density": max(rgb)})
    tea = inside(glass("tea", 1.4), absorb((0.35, 1.1, 2.6)), scatter((1, 1, 1), 0.05))
    solid((0.5, -0.3, 0.02), (0.5, -0.3, 1.25), 0.62, 0.62, False, [tea, tea, tea])
    clear = lambda name: shader(name, "ShaderNodeBsdfTransparent", Color=(1, 1, 1))
    milk = inside(clear("milk"), scatter((2.55 / 3.76, 3.21 / 3.76, 1), 6 * 3.76), absorb((0.0066, 0.0144, 0.0842)))
    turned([arc(0, 0.28, 0, math.pi)], (0.45, -0.3, 0.75), (0.45, -0.3, 1.75), [milk])
    glow = inside(glass("glow", 1.5), absorb((1.2, 1.2001, 1.2)), scatter((1, 1, 1), 0.4), ("ShaderNodeEmission", {"Color": blackbody(2600), "Strength": 3.0}))
    capsule((1.5, -1.3, 0.22), (2.4, -0.9, 0.22), 0.2, 0.2, glow)
    wax = shader("wax", "ShaderNodeBsdfPrincipled", Base_Color=(0.75, 0.5, 0.28), Roughness=math.sqrt(math.sqrt(0.1)), IOR=1.4, Subsurface_Weight=1,
                 Subsurface_Radius=(0.3, 0.16, 0.08), Subsurface_Scale=1)
    capsule((2.1, 0.5, 0.5), (2.1, 0.5, 1.2), 0.5, 0.32, wax)
    return 100


def main():
    name, folder, width, height, out, samples, seed, denoise = sys.argv[1:9]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    depth = {"neuron": neuron, "hair": hair, "gallery": gallery, "smoke": smoke}[name](pathlib.Path(folder), int(height))
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.use_adaptive_sampling, cycles.seed = "CPU", False, int(seed)
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.volume_bounces = depth - 1
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_indirect = cycles.light_sampling_threshold = cycles.blur_glossy = 0
    cycles.denoiser, cycles.denoising_prefilter, cycles.denoising_input_passes = "OPENIMAGEDENOISE", "ACCURATE", "RGB_ALBEDO_NORMAL"
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"
    scene.render.use_persistent_data = True
    scene.render.filepath = out
    seconds = []
    for turn, count in enumerate((1, 1, int(samples))):  # loads; loaded; the picture
        cycles.samples = count
        cycles.use_denoising = bool(int(denoise)) and turn == 2
        begin = time.perf_counter()
        bpy.ops.render.render(write_still=turn == 2)
        seconds.append(time.perf_counter() - begin)
    print(f"seconds {seconds[2] - seconds[1]:.4f}")


main()
