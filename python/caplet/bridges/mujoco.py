# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Robots: MuJoCo's models, every geom as its exact solid."""
import os
import struct
import tempfile
import zlib

import numpy as np

from .. import cameras, lights as light_types
from ..errors import InputError
from ..scene import Scene
from .mujoco_looks import Looks, rgba_of
from ..spelling import keywords

_FAR = 100  # of an endless plane: so many times the model's extent to each side


def _transforms(data):
    out = np.zeros((len(data.geom_xpos), 4, 4))
    out[:, :3, :3] = np.asarray(data.geom_xmat).reshape(-1, 3, 3)
    out[:, :3, 3] = data.geom_xpos
    out[:, 3, 3] = 1
    return out


def _name(mujoco, model, geom):
    return mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom) or f"geom {geom}"


def _mesh_of(model, geom):
    """Vertices, faces, and texture coordinates of the vertices or None. Vertices are doubled where faces give them other ones."""
    mesh = model.geom_dataid[geom]
    first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    begin, faces = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
    vertices, corners = model.mesh_vert[first:first + count], model.mesh_face[begin:begin + faces]
    start = model.mesh_texcoordadr[mesh]
    if start < 0:
        return vertices, corners, None
    pairs = np.stack([corners, model.mesh_facetexcoord[begin:begin + faces]], axis=-1).reshape(-1, 2)
    kept, which = np.unique(pairs, axis=0, return_inverse=True)
    return vertices[kept[:, 0]], which.reshape(-1, 3), model.mesh_texcoord[start + kept[:, 1]]


def _height_field(model, geom):
    """Its surface, two triangles a cell, and the sides and bottom of its base."""
    field = model.geom_dataid[geom]
    rows, columns, first = model.hfield_nrow[field], model.hfield_ncol[field], model.hfield_adr[field]
    half_x, half_y, top, base = model.hfield_size[field]
    heights = model.hfield_data[first:first + rows * columns].reshape(rows, columns) * top
    x, y = np.meshgrid(np.linspace(-half_x, half_x, columns), np.linspace(-half_y, half_y, rows))
    upper = np.stack([x, y, heights], axis=2).reshape(-1, 3)
    lower = upper * [1, 1, 0] - [0, 0, base]
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.reshape(-1) for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    surface = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    around = np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])
    after = np.roll(around, -1)
    far = rows * columns
    sides = np.concatenate([np.stack([around + far, after + far, after], 1), np.stack([around + far, after, around], 1)])
    return np.concatenate([upper, lower]), np.concatenate([surface, surface[:, ::-1] + far, sides])


def _add_triangles(scene, looks, geom, vertices, faces, texcoords, options):
    uv = looks.uv(geom, vertices, texcoords)
    if "alpha" not in options:
        return scene.add_mesh(vertices, faces, uv=uv, **options)
    more = {} if uv is None else {"uv": uv}
    return scene.add("trianglemesh", P=vertices, indices=np.asarray(faces).reshape(-1), **more, **options)


def _add(scene, mujoco, model, geom, options, far, looks):
    kind, size = int(model.geom_type[geom]), np.asarray(model.geom_size[geom], dtype=np.float64)
    if kind == int(mujoco.mjtGeom.mjGEOM_SPHERE):
        return scene.add("sphere", radius=size[0], **options)
    if kind == int(mujoco.mjtGeom.mjGEOM_CAPSULE):
        return scene.add("capsule", p0=(0, 0, -size[1]), p1=(0, 0, size[1]), radius=size[0], **options)
    if kind == int(mujoco.mjtGeom.mjGEOM_CYLINDER):
        return scene.add("cylinder", p0=(0, 0, -size[1]), p1=(0, 0, size[1]), radius=size[0], **options)
    if kind == int(mujoco.mjtGeom.mjGEOM_BOX):
        return scene.add("box", p0=-size, p1=size, **options)
    if kind == int(mujoco.mjtGeom.mjGEOM_ELLIPSOID):
        options["transform"] = options["transform"] @ np.diag([*size, 1])
        return scene.add("sphere", radius=1, **options)
    if kind == int(mujoco.mjtGeom.mjGEOM_PLANE):
        x, y = (half if half > 0 else far for half in size[:2])
        corners = np.array([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)])
        uv = looks.uv(geom, corners)
        more = {} if uv is None else {"uv": uv}
        return scene.add("trianglemesh", P=corners, indices=[0, 1, 2, 0, 2, 3], onesided=True, **more, **options)  # as MuJoCo's
    if kind == int(mujoco.mjtGeom.mjGEOM_HFIELD):
        return _add_triangles(scene, looks, geom, *_height_field(model, geom), None, options)
    if kind in (int(mujoco.mjtGeom.mjGEOM_MESH), int(mujoco.mjtGeom.mjGEOM_SDF)):
        return _add_triangles(scene, looks, geom, *_mesh_of(model, geom), options)
    raise InputError(f"geom {geom}: MuJoCo's geom type {kind} is not known")


def _camera_number(mujoco, model, camera):
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, camera) if isinstance(camera, str) else int(camera)
    if not 0 <= number < model.ncam:
        raise InputError(f"camera: the model has no camera {camera!r}, of {model.ncam}")
    return number


def _camera(scene, mujoco, model, data, camera):
    number = _camera_number(mujoco, model, camera)
    place = np.eye(4)
    place[:3, :3] = np.asarray(data.cam_xmat[number]).reshape(3, 3) @ np.diag([1, 1, -1])  # it looks along -z
    place[:3, 3] = data.cam_xpos[number]
    scene.camera = cameras.perspective(fov=model.cam_fovy[number], transform=place)


def _png(image):
    """The bytes of a file of 8-bit RGB."""
    height, width, _ = image.shape
    rows = np.concatenate([np.zeros((height, 1), dtype=np.uint8), image.reshape(height, -1)], axis=1)

    def part(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + part(b"IHDR", header) + part(b"IDAT", zlib.compress(rows.tobytes())) + part(b"IEND", b"")


def _is_directional(mujoco, model, light):
    if hasattr(model, "light_type"):
        return int(model.light_type[light]) == int(mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
    return bool(model.light_directional[light])  # before MuJoCo 3.3


def _lights(scene, mujoco, model, data, sky):
    """MuJoCo's lights do not fade with the distance: theirs is as strong as meant at the model's middle.

    sky: of Looks.sky; it takes the place of the ambient light. The headlight comes from the scene's camera.
    """
    scene.remove_lights()
    head = model.vis.headlight
    active = np.asarray(model.light_active, dtype=bool)
    ambient = np.asarray(head.ambient) * (head.active != 0) + model.light_ambient[active].sum(axis=0)
    if sky is None:
        scene.add_light(light_types.infinite(L=tuple(ambient + 1e-6)))
    else:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sky.png")
            with open(path, "wb") as file:
                file.write(_png(sky[0]))
            scene.add_light(light_types.infinite(filename=path, scale=sky[1]))
    if head.active and np.any(head.diffuse):
        strength = tuple(np.pi * np.asarray(head.diffuse))
        scene.add_light(light_types.distant(L=strength, from_=(0, 0, 0), to=tuple(scene.camera[:3, 2])))
    for i in np.flatnonzero(active & model.light_diffuse.any(axis=1)):
        strength, at, way = np.pi * model.light_diffuse[i], data.light_xpos[i], data.light_xdir[i]
        if _is_directional(mujoco, model, i):
            scene.add_light(light_types.distant(L=tuple(strength), from_=(0, 0, 0), to=tuple(way)))
            continue
        away = np.sum((np.asarray(at) - model.stat.center)**2)
        strength = tuple(strength * away)
        if 0 < model.light_cutoff[i] < 90:
            scene.add_light(light_types.spot(I=strength, from_=tuple(at), to=tuple(at + way), coneangle=model.light_cutoff[i],
                                             conedeltaangle=model.light_cutoff[i] * 0.2))
        else:
            scene.add_light(light_types.point(I=strength, from_=tuple(at)))


def _states(model, qpos):
    qpos = np.asarray(qpos, dtype=np.float64)
    if qpos.ndim != 2 or qpos.shape[1] != model.nq:
        raise InputError(f"qpos: shape (n, {model.nq}) is needed, not {qpos.shape}")
    return qpos


def _places(mujoco, model, qpos, geoms, camera):
    """Where geoms are in each state (n, m, 4, 4), and the camera of this number (n, 4, 4), which looks along z, y down."""
    data = mujoco.MjData(model)
    worlds, poses = (np.zeros((len(qpos), *more, 4, 4)) for more in ((len(geoms),), ()))
    worlds[..., 3, 3] = poses[..., 3, 3] = 1
    for i, state in enumerate(qpos):
        data.qpos[:] = state
        mujoco.mj_kinematics(model, data)
        worlds[i, :, :3, :3] = data.geom_xmat[geoms].reshape(-1, 3, 3)
        worlds[i, :, :3, 3] = data.geom_xpos[geoms]
        if camera is not None:
            mujoco.mj_comPos(model, data)  # cameras may follow the centre of mass
            mujoco.mj_camlight(model, data)
            poses[i, :3, :3] = data.cam_xmat[camera].reshape(3, 3) * [1, -1, -1]  # MuJoCo's looks along -z, y up
            poses[i, :3, 3] = data.cam_xpos[camera]
    return worlds, poses


def _animate(scene, mujoco, model, times, qpos, first, names, camera):
    """Places the object definitions of the moving geoms, in order, and moves them and the camera."""
    number = None if camera is None else _camera_number(mujoco, model, camera)
    worlds, poses = _places(mujoco, model, qpos, scene.info["geom"][first:], number)
    for i, name in enumerate(names):
        instance = scene.add_instances(name, worlds[0, i])[0]
        scene.animate_instance(instance, times, worlds[:, i])
    if number is not None:
        scene.animate_camera(times, poses @ np.diag([1, -1, 1, 1]))
    scene.shutter(times[0], times[-1])


@keywords
def from_mujoco(model, data=None, groups=(0, 1, 2), camera=None, lights="studio", times=None, qpos=None):
    """A scene of a MuJoCo model as it stands: every geom of these groups is one shape, by its name, in MuJoCo's units.

    model, data: mujoco.MjModel and MjData (None: the model's initial pose). groups: geom groups that are shown; None: all.
    camera: one of the model's, by name or number; None: one that looks at the model's middle, z up. lights: "studio", or
    "model" for the model's own lights, headlight and sky.

    Spheres, capsules, cylinders, boxes and ellipsoids are exact; planes, meshes and height fields are triangles. Materials and
    textures are those of the program's reader of MJCF (docs/formats/robots.md); what has an alpha of 0 is left out. Cube
    textures of meshes and height fields stay where they are when these move.

    scene.info["geom"]: the geom of each shape, so that scene.info["geom"][image.object_id] is a segmentation;
    scene.info["moving"]: shapes of bodies that are not fixed to the world.
    update_mujoco(scene, data) moves all of it.

    times: seconds (k,) that rise, with qpos (k, model.nq), the states then: the model moves from one to the next, and is seen
    with the shutter open from the first to the last; Scene.shutter chooses another time. Moving geoms are then instances,
    behind the fixed ones in scene.info["geom"], and update_mujoco does not move them.
    """
    import mujoco
    if (times is None) != (qpos is None):
        raise InputError("times, qpos: both are needed, or none")
    if qpos is not None:
        qpos, times = _states(model, qpos), np.asarray(times, dtype=np.float64)
        if times.shape != (len(qpos),) or len(times) < 2 or not np.all(np.diff(times) > 0):
            raise InputError(f"times: two or more that rise are needed, one a state of {len(qpos)}")
    if data is None:
        data = mujoco.MjData(model)
        if qpos is not None:
            data.qpos[:] = qpos[0]
        mujoco.mj_forward(model, data)
    if lights not in ("studio", "model"):
        raise InputError(f'lights: "studio" or "model" is needed, not {lights!r}')
    scene, places, looks, geoms = Scene(), _transforms(data), Looks(mujoco, model), []
    far = _FAR * max(float(model.stat.extent), 1e-3)
    moves = (model.body_weldid[model.geom_bodyid] != 0) & (times is not None)
    objects = []
    for geom in sorted(range(model.ngeom), key=lambda geom: moves[geom]):
        if (groups is not None and model.geom_group[geom] not in groups) or rgba_of(model, geom)[3] <= 0:
            continue
        options = {"name": _name(mujoco, model, geom), "transform": places[geom], **looks.options(geom, places[geom])}
        if moves[geom]:
            objects.append(f"geom {geom}")
            options |= {"transform": np.eye(4), "object": objects[-1]}
        _add(scene, mujoco, model, geom, options, far, looks)
        geoms.append(geom)
    scene.info["geom"] = np.array(geoms, dtype=np.int64)
    scene.info["moving"] = np.flatnonzero(model.body_weldid[model.geom_bodyid[scene.info["geom"]]] != 0)
    scene.info["scale"] = {i: np.diag([*model.geom_size[geom], 1]) for i, geom in enumerate(geoms)
                           if model.geom_type[geom] == int(mujoco.mjtGeom.mjGEOM_ELLIPSOID)}
    if camera is not None:
        _camera(scene, mujoco, model, data, camera)
    elif geoms:  # MuJoCo's z is up
        center, extent = np.asarray(model.stat.center, dtype=np.float64), max(float(model.stat.extent), 1e-6)
        scene.look_at(center + 1.5 * extent * np.array([0.6, -0.7, 0.35]), center, (0, 0, 1))
        scene.fov = 45
    if lights == "model":
        _lights(scene, mujoco, model, data, looks.sky())
    if times is not None:
        scene.info["instances"] = len(objects)
        _animate(scene, mujoco, model, times, qpos, len(geoms) - len(objects), objects, camera)
    return scene


@keywords
def update_mujoco(scene, data):
    """Moves the shapes of a scene that from_mujoco made to where `data` has them; a Session's `update` follows in place."""
    if scene.info.get("instances"):
        raise InputError("update_mujoco: the scene moves by its states; from_mujoco makes one of others")
    places = _transforms(data)
    for number, geom in enumerate(scene.info["geom"]):
        scene.shape(number).transform = places[geom] @ scene.info["scale"].get(number, np.eye(4))


@keywords
def mujoco_camera(model, camera, width, height):
    """The caplet.sensors.Pinhole of one of the model's cameras, by name or number, for pictures of this size."""
    import mujoco
    from ..sensors import Pinhole
    return Pinhole(width, height, fx=height / 2 / np.tan(np.radians(model.cam_fovy[_camera_number(mujoco, model, camera)]) / 2))


@keywords
def mujoco_worlds(scene, model, qpos, camera=None):
    """The worlds of many states of a model, for caplet.Batch and caplet.render_batch of the scene that from_mujoco made of it: the
    transforms (n, m, 4, 4) of the shapes scene.info["moving"], those of bodies that are not fixed to the world.

    qpos: (n, model.nq), states as mujoco.MjData.qpos has them. camera: one of the model's, by name or number: then also its poses
    (n, 4, 4), for its mujoco_camera.
    """
    import mujoco
    qpos = _states(model, qpos)
    number = None if camera is None else _camera_number(mujoco, model, camera)
    moving = scene.info["moving"]
    worlds, poses = _places(mujoco, model, qpos, scene.info["geom"][moving], number)
    for i, shape in enumerate(moving):
        if shape in scene.info["scale"]:
            worlds[:, i] = worlds[:, i] @ scene.info["scale"][shape]
    return worlds if number is None else (worlds, poses)
