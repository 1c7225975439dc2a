#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Geoms and hits of robots beside the mujoco package.

    tools/beside_mujoco.py [--build build/release] [--rays N] [--masks PIXELS] [--key NAME] FILE.xml|FILE.urdf...

Of each file it compares every geom of MuJoCo with the shape of the same name (or number) that the importer made: its type, its
sizes, where its corners, axis ends or vertices lie in the world (whichever end or corner it is: fitted solids have axes of either sign). With --rays N, as many random rays are asked of `caplet pick` and of
mujoco.mj_ray, and their distances compared. With --masks PIXELS, which geom each pixel of a square picture shows is compared with
MuJoCo's renderer, for 20 states under random controls and each of the model's cameras. Needs the packages mujoco, numpy and scipy, and the targets list_geoms and
caplet; for masks the Python package of the build, and OSMesa.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

os.environ.setdefault("MUJOCO_GL", "osmesa")
import mujoco
import numpy as np

GEOM = mujoco.mjtGeom
TOLERANCE = 1e-6  # metres, of positions and sizes
ENDS = 1e-5       # of the ends of capsules
RAY = 1e-5        # of distances

# Without this MuJoCo writes its warnings into MUJOCO_LOG.TXT in the working folder.
mujoco.set_mju_user_warning(lambda text: print(f"mujoco: {text}", file=sys.stderr))


def model_of(path):
    """The model as it stands in the file: nothing fused or left out, and no meshes of URDF that are not there."""
    if path.suffix == ".urdf":
        tree = xml.etree.ElementTree.fromstring(path.read_text().rstrip("\0"))
        for link in tree.iter("link"):
            for part in [p for p in link if p.find("geometry/mesh") is not None]:
                link.remove(part)
        settings = xml.etree.ElementTree.SubElement(tree, "mujoco")
        xml.etree.ElementTree.SubElement(settings, "compiler", discardvisual="false", fusestatic="false", balanceinertia="true",
                                         boundmass="0.01", boundinertia="0.01")
        return mujoco.MjModel.from_xml_string(xml.etree.ElementTree.tostring(tree, encoding="unicode"))
    def spec():
        out = mujoco.MjSpec.from_file(str(path))
        out.compiler.fusestatic = False
        out.compiler.discardvisual = False
        return out
    try:
        return spec().compile()
    except ValueError:  # some do not compile without MuJoCo finding out the range of their actuators
        without = spec()
        for actuator in list(without.actuators):
            without.delete(actuator)
        for key in without.keys:
            key.ctrl = []
            key.act = []
        return without.compile()


def solid_of(model, data, geom):
    """A geom's type, sizes as the importer has them, and pose."""
    kind, size = GEOM(int(model.geom_type[geom])), model.geom_size[geom]
    pose = np.concatenate([data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom][:, None]], axis=1)
    return kind, size, pose


def points_of(model, data, geom):
    """The vertices of a mesh or height field in the world."""
    kind, size, pose = solid_of(model, data, geom)
    if kind == GEOM.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        faces = model.mesh_face[model.mesh_faceadr[mesh]:][:model.mesh_facenum[mesh]]
        points = model.mesh_vert[model.mesh_vertadr[mesh] + np.unique(faces)]  # those of some face
    else:
        field = model.geom_dataid[geom]
        rows, columns = model.hfield_nrow[field], model.hfield_ncol[field]
        x, y, top, _ = model.hfield_size[field]
        heights = model.hfield_data[model.hfield_adr[field]:][:rows * columns].reshape(rows, columns)
        xs, ys = np.meshgrid(np.linspace(-x, x, columns), np.linspace(-y, y, rows))
        points = np.stack([xs, ys, top * heights], axis=2).reshape(-1, 3)
    return points @ pose[:, :3].T + pose[:, 3]


def of_shape(shape, points):
    world = np.array(shape["world"]).reshape(3, 4)
    return np.asarray(points, dtype=float) @ world[:, :3].T + world[:, 3]


def apart(a, b):
    """How far a point of one set is from the other set at most."""
    from scipy.spatial import cKDTree
    return max(cKDTree(a).query(b)[0].max(), cKDTree(b).query(a)[0].max())


CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])


def difference(kind, size, pose, shapes, model, data, geom):
    """(The largest deviation, whether it is of capsules' ends), or a string that says what is wrong."""
    at = lambda points: np.asarray(points, dtype=float) @ pose[:, :3].T + pose[:, 3]
    shape = shapes[0]
    name = {GEOM.mjGEOM_SPHERE: "sphere", GEOM.mjGEOM_ELLIPSOID: "sphere", GEOM.mjGEOM_CAPSULE: "capsule",
            GEOM.mjGEOM_CYLINDER: "cylinder", GEOM.mjGEOM_BOX: "box"}.get(kind, "mesh")
    if shape["type"] != name:
        return f"is a {shape['type']}, not a {name}"
    if kind in (GEOM.mjGEOM_SPHERE, GEOM.mjGEOM_ELLIPSOID):
        axes = size if kind == GEOM.mjGEOM_ELLIPSOID else np.full(3, size[0])
        own = of_shape(shape, np.concatenate([np.zeros((1, 3)), shape["size"][0] * np.eye(3), -shape["size"][0] * np.eye(3)]))
        other = at(np.concatenate([np.zeros((1, 3)), np.diag(axes), -np.diag(axes)]))
        if kind == GEOM.mjGEOM_SPHERE:  # its turn is of no matter
            return max(np.abs(own[0] - other[0]).max(), abs(shape["size"][0] - size[0])), False
        return apart(own, other), False
    if kind in (GEOM.mjGEOM_CAPSULE, GEOM.mjGEOM_CYLINDER):
        own, other = of_shape(shape, [[0, 0, -shape["size"][1]], [0, 0, shape["size"][1]]]), at([[0, 0, -size[1]], [0, 0, size[1]]])
        return max(apart(own, other), abs(shape["size"][0] - size[0])), kind == GEOM.mjGEOM_CAPSULE
    if kind == GEOM.mjGEOM_BOX:
        return apart(of_shape(shape, CORNERS * shape["size"]), at(CORNERS * size)), False
    if kind == GEOM.mjGEOM_PLANE:
        local = (of_shape(shape, np.reshape(shape["points"], (-1, 3))) - pose[:, 3]) @ pose[:, :3]
        worst = np.abs(local[:, 2]).max() * (1 if min(size[:2]) > 0 else 1e-3)  # of an endless one: over its reach
        for axis in range(2):
            if size[axis] > 0:
                worst = max(worst, np.abs(np.abs(local[:, axis]) - size[axis]).max())
        return worst, False
    own = np.concatenate([of_shape(part, np.reshape(part["points"], (-1, 3))) for part in shapes])
    if kind == GEOM.mjGEOM_HFIELD:
        own = own[:len(own) // 2]
    return apart(own, points_of(model, data, geom)), False


def compare(path, list_geoms, key):
    words = [str(list_geoms), str(path), "groups=all"] + ([f"pose={key}"] if key else [])
    listed = subprocess.run(words, capture_output=True, text=True)
    if listed.returncode:
        return None, [listed.stderr.strip()], None, None
    shapes = {}
    for shape in json.loads(listed.stdout):
        shapes.setdefault(shape["name"], []).append(shape)
    model = model_of(path)
    for skin in range(model.nskin):  # no geoms
        shapes.pop(model.skin(skin).name or "skin", None)
    data = mujoco.MjData(model)
    if key:
        mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    mujoco.mj_kinematics(model, data)
    is_urdf = path.suffix == ".urdf"
    if is_urdf:  # by their places: URDF's geoms have no names
        remaining = [shape for group in shapes.values() for shape in group]
    worst, worst_ends, wrong, kinds, left_out = 0.0, 0.0, [], {}, 0
    for geom in range(model.ngeom):
        kind, size, pose = solid_of(model, data, geom)
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom) or f"geom {geom}"
        alpha = model.geom_rgba[geom, 3]
        if model.geom_matid[geom] >= 0 and tuple(model.geom_rgba[geom]) == (0.5, 0.5, 0.5, 1):
            alpha = model.mat_rgba[model.geom_matid[geom], 3]
        if is_urdf:
            found = [(difference(kind, size, pose, [shape], model, data, geom), i) for i, shape in enumerate(remaining)]
            found = [(gap, i) for gap, i in found if not isinstance(gap, str)]
            if not found:
                wrong.append(f"{name}: nothing like it")
                continue
            gap, i = min(found)
            remaining.pop(i)
        elif name not in shapes:
            if alpha == 0:  # not seen
                left_out += 1
                continue
            wrong.append(f"{name}: is not there")
            continue
        else:
            gap = difference(kind, size, pose, shapes[name], model, data, geom)
        if isinstance(gap, str):
            wrong.append(f"{name}: {gap}")
            continue
        value, ends = gap
        limit = ENDS if ends else TOLERANCE
        if kind in (GEOM.mjGEOM_MESH, GEOM.mjGEOM_HFIELD):  # floats of MuJoCo's, turned into its inertia's axes
            limit = TOLERANCE * max(1, float(np.abs(points_of(model, data, geom)).max()))
        if value > limit:
            wrong.append(f"{name} ({kind.name[7:].lower()}): {value:.3g} apart")
        worst, worst_ends = (worst, max(worst_ends, value)) if ends else (max(worst, value), worst_ends)
        kinds[kind.name[7:].lower()] = kinds.get(kind.name[7:].lower(), 0) + 1
    return kinds, wrong, (worst, worst_ends, left_out), (model, data)


def rays(path, caplet, model, data, count, key):
    """Distances by the program and by MuJoCo (-1: no hit), and how far origins are from the middle."""
    generator = np.random.default_rng(7)
    shown = [g for g in range(model.ngeom) if model.geom_group[g] <= 2]
    bounded = [g for g in shown if int(model.geom_type[g]) not in (int(GEOM.mjGEOM_PLANE), int(GEOM.mjGEOM_HFIELD))] or shown
    middle = np.mean(data.geom_xpos[bounded], axis=0)
    radius = max(np.max(np.linalg.norm(data.geom_xpos[bounded] - middle, axis=1) + model.geom_rbound[bounded]), 1e-3)
    def directions():
        d = generator.normal(size=(count, 3))
        return d / np.linalg.norm(d, axis=1, keepdims=True)
    origins = (middle + 2 * radius * directions()).astype(np.float32)
    targets = middle + radius * generator.uniform(size=(count, 1))**(1 / 3) * directions()
    ways = targets - origins
    ways = (ways / np.linalg.norm(ways, axis=1, keepdims=True)).astype(np.float32)
    with tempfile.TemporaryDirectory() as folder:
        np.save(f"{folder}/rays.npy", np.concatenate([origins, ways], axis=1))
        words = [str(caplet), "pick", str(path), "--up", "y", "--rays", f"{folder}/rays.npy", "--out", f"{folder}/hits.npy"]
        asked = subprocess.run(words + (["--pose", key] if key else []), capture_output=True, text=True)
        if asked.returncode:
            return asked.stderr.strip()
        hits = np.load(f"{folder}/hits.npy")
    own = np.full(count, -1.0)
    own[hits["ray"]] = hits["t"]
    groups = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
    other, geom = np.empty(count), np.zeros(1, dtype=np.int32)
    for i in range(count):
        way = ways[i].astype(float)
        other[i] = mujoco.mj_ray(model, data, origins[i].astype(float), way, groups, 1, -1, geom, None)
    return own, other, 2 * radius


def at_edges(geoms):
    """Whether one of a pixel's eight neighbours shows another geom."""
    padded, out = np.pad(geoms, 1, mode="edge"), np.zeros(geoms.shape, bool)
    for y in range(3):
        for x in range(3):
            out |= padded[y:y + geoms.shape[0], x:x + geoms.shape[1]] != geoms
    return out


def masks(path, build, size, states=20, steps=100):
    """By camera: pixels, those that show another geom than MuJoCo's renderer does, and those of them that are at no edge."""
    sys.path.insert(0, str(build.resolve() / "python"))
    import caplet
    from caplet.bridges.mujoco import update_mujoco
    model = model_of(path)
    model.vis.global_.offwidth = model.vis.global_.offheight = size
    model.vis.quality.numslices, model.vis.quality.numstacks = 128, 64  # of its meshes of round geoms
    data, generator = mujoco.MjData(model), np.random.default_rng(1)
    mujoco.mj_forward(model, data)
    scene, shown = caplet.from_mujoco(model, data), mujoco.MjvOption()
    shown.geomgroup[:] = [1, 1, 1, 0, 0, 0]
    counts = {}
    with mujoco.Renderer(model, size, size) as renderer:
        renderer.enable_segmentation_rendering()
        for _ in range(states):
            data.ctrl[:] = generator.uniform(-1, 1, model.nu)
            mujoco.mj_step(model, data, steps)
            mujoco.mj_forward(model, data)
            update_mujoco(scene, data)
            for camera in range(model.ncam):
                renderer.update_scene(data, camera=camera, scene_option=shown)
                seen = renderer.render()
                theirs = np.where(seen[..., 1] == int(mujoco.mjtObj.mjOBJ_GEOM), seen[..., 0], -1)
                pose = np.eye(4)
                pose[:3, :3] = data.cam_xmat[camera].reshape(3, 3) * (1, -1, -1)  # y down, z ahead
                pose[:3, 3] = data.cam_xpos[camera]
                pinhole = caplet.sensors.Pinhole(size, size, fx=size / 2 / np.tan(np.radians(model.cam_fovy[camera]) / 2))
                ours = np.full((size, size), -1)
                for shape in caplet.sensors.segment(scene, pinhole, pose, amodal=False):
                    ours[shape["mask"]] = scene.info["geom"][shape["shape"]]
                other = ours != theirs
                count = counts.setdefault(model.camera(camera).name or f"camera {camera}", np.zeros(3, int))
                count += (other.size, other.sum(), (other & ~(at_edges(ours) | at_edges(theirs))).sum())
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build/release"))
    parser.add_argument("--rays", type=int, default=0)
    parser.add_argument("--masks", type=int, default=0)
    parser.add_argument("--key")
    asked = parser.parse_args()
    found = list((asked.build / "tests").rglob("list_geoms"))
    failures = 0
    for path in asked.files:
        label = f"{path.parent.name}/{path.name}"
        try:
            kinds, wrong, worst, pair = compare(path, found[0], asked.key)
        except ValueError as error:
            print(f"{label}: MuJoCo does not read it: {str(error).splitlines()[0]}")
            continue
        if wrong:
            failures += 1
            print(f"{label}: WRONG: {len(wrong)}: " + "; ".join(wrong[:4]))
            if kinds is None:
                continue
        counts = ", ".join(f"{n} {kind}" for kind, n in sorted(kinds.items()))
        print(f"{label}: {counts}; at most {worst[0]:.1e} apart, capsule ends {worst[1]:.1e}"
              + (f"; {worst[2]} of alpha 0" if worst[2] else ""), flush=True)
        if asked.masks:
            for camera, (pixels, other, inside) in masks(path, asked.build, asked.masks).items():
                print(f"  masks by '{camera}': {other} of {pixels} pixels are of another geom, {inside} of them at no edge", flush=True)
        if asked.rays and pair[0].nskin:
            print("  rays: left out, since MuJoCo's go through skins")
        elif asked.rays:
            got = rays(path, asked.build / "bin/caplet", *pair, asked.rays, asked.key)
            if isinstance(got, str):
                failures += 1
                print("  rays: " + got)
                continue
            own, other, reach = got
            # Endless planes end here far off: hits beyond three times the way to the middle are not compared.
            own, other = (np.where(t > 3 * reach, -1, t) for t in (own, other))
            both = (own >= 0) & (other >= 0)
            one = (own >= 0) != (other >= 0)
            gaps = np.abs(own - other)[both]
            far = gaps > RAY * max(1, reach)
            print(f"  {len(own)} rays: {both.sum()} hit both, {one.sum()} one alone, {far.sum()} farther apart than {RAY:g}; "
                  f"else at most {gaps[~far].max() if (~far).any() else 0:.1e}", flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
